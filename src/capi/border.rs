//! What stands around every call: no panic crosses it, no handle is used by two threads at once, and what a panic left half done is not used again.

use std::cell::{Cell, UnsafeCell};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;
use std::sync::atomic::{AtomicU32, Ordering};

use super::status::{Fault, IRRADIA_ERROR_BUSY, IRRADIA_ERROR_INTERNAL, IRRADIA_OK, Status, remember};

const FREE: u32 = 0;
const BUSY: u32 = 1;
/// A panic left it in the middle of something.
const BROKEN: u32 = 2;

/// What a host's handle points to: a value that one thread uses at a time.
pub(super) struct Guarded<T> {
    state: AtomicU32,
    value: UnsafeCell<T>,
}

// SAFETY: `Border::enter` gives the value to one thread at a time.
unsafe impl<T: Send> Sync for Guarded<T> {}

impl<T> Guarded<T> {
    pub(super) fn new(value: T) -> Guarded<T> {
        Guarded { state: AtomicU32::new(FREE), value: UnsafeCell::new(value) }
    }
}

/// A handle type: what is behind it, and what messages call it.
pub(super) trait Handle {
    type Value;
    const NAME: &'static str;

    fn guarded(&self) -> &Guarded<Self::Value>;
}

/// What is behind handle types, whose one field of that name it is. The types themselves are written out: cbindgen sees no macros.
macro_rules! handles {
    ($($handle:ident($value:ty) = $name:literal;)*) => {$(
        impl $crate::capi::border::Handle for $handle {
            type Value = $value;
            const NAME: &'static str = $name;

            fn guarded(&self) -> &$crate::capi::border::Guarded<$value> {
                &self.guarded
            }
        }
    )*};
}
pub(super) use handles;

/// A call in progress: the handles that it holds.
#[derive(Default)]
pub(super) struct Border<'a> {
    held: Vec<&'a AtomicU32>,
}

impl<'a> Border<'a> {
    /// The value behind a handle, this call's alone until it returns.
    ///
    /// # Safety
    /// `handle` is null or a handle of this type that has not been destroyed, nor will be during the call.
    pub(super) unsafe fn enter<H>(&mut self, handle: *const H) -> Result<&'a mut H::Value, Fault>
    where
        H: Handle + 'a,
        H::Value: 'a,
    {
        // SAFETY: the caller's.
        let Some(handle) = (unsafe { handle.as_ref() }) else {
            return Err(Fault::argument(format!("the {} is a null pointer", H::NAME)));
        };
        let guarded = handle.guarded();
        match guarded.state.compare_exchange(FREE, BUSY, Ordering::Acquire, Ordering::Relaxed) {
            Ok(_) => {
                self.held.push(&guarded.state);
                // SAFETY: the state was free, so nobody else holds the value, and it is held until the call returns.
                Ok(unsafe { &mut *guarded.value.get() })
            }
            Err(BROKEN) => Err(Fault {
                status: IRRADIA_ERROR_INTERNAL,
                sentence: format!("the {} was in use when the library failed; destroy it", H::NAME),
            }),
            Err(_) => Err(Fault {
                status: IRRADIA_ERROR_BUSY,
                sentence: format!("the {} is in use by another call; one call at a time may use it", H::NAME),
            }),
        }
    }

    fn leave(self, state: u32) {
        self.held.into_iter().for_each(|held| held.store(state, Ordering::Release));
    }
}

thread_local! {
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// This thread works for calls alone.
pub(super) fn stay_inside() {
    INSIDE.set(true);
}

/// Whether the calling thread is inside of a call; says so from now on. A thread that is ending is.
fn go_inside(inside: bool) -> bool {
    INSIDE.try_with(|known| known.replace(inside)).unwrap_or(true)
}

/// Panics inside of a call are told by its status; the standard hook would write to the terminal.
fn keep_panics_quiet() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let others = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            // Scenes without a context work on rayon's own threads, which nobody told.
            if INSIDE.try_with(Cell::get).unwrap_or(true) || rayon::current_thread_index().is_some() {
                tracing::error!("{info}");
            } else {
                others(info);
            }
        }));
    });
}

/// Runs the body of a call of the host's.
pub(super) fn call<'a>(body: impl FnOnce(&mut Border<'a>) -> Result<(), Fault>) -> Status {
    keep_panics_quiet();
    let mut border = Border::default();
    let outside = go_inside(true);
    // Values of handles that a panic leaves half done are not looked at again: their state says so.
    let done = catch_unwind(AssertUnwindSafe(|| body(&mut border)));
    go_inside(outside);
    let (fault, state) = match done {
        Ok(Ok(())) => (None, FREE),
        Ok(Err(fault)) => (Some(fault), FREE),
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            let text = text.unwrap_or_else(|| "no reason given".to_owned());
            let sentence = format!("the library failed ({text}): report it, and destroy the handles of this call");
            // What was thrown may itself panic where it is dropped.
            std::mem::forget(panic);
            (Some(Fault { status: IRRADIA_ERROR_INTERNAL, sentence }), BROKEN)
        }
    };
    border.leave(state);
    fault.map_or(IRRADIA_OK, |Fault { status, sentence }| {
        remember(&sentence);
        status
    })
}

/// The whole of a call that gives the host a handle. For who does not look at the status, one that could not be made is null.
///
/// # Safety
/// `place` is null, which is a fault, or may be written to.
pub(super) unsafe fn create<'a, H>(
    place: *mut *mut H,
    make: impl FnOnce(&mut Border<'a>) -> Result<H, Fault>,
) -> Status {
    call(|border| {
        if place.is_null() {
            return Err(Fault::argument("the place for the new handle is a null pointer"));
        }
        // SAFETY: the caller's.
        unsafe { place.write(std::ptr::null_mut()) };
        let handle = Box::into_raw(Box::new(make(border)?));
        // SAFETY: as above.
        unsafe { place.write(handle) };
        Ok(())
    })
}

/// Takes a handle back, whatever state it is in.
///
/// # Safety
/// `handle` is null or came from [`create`], and is used no more.
pub(super) unsafe fn take<H>(handle: *mut H) {
    if !handle.is_null() {
        let destroy = AssertUnwindSafe(|| {
            // SAFETY: the caller's.
            drop(unsafe { Box::from_raw(handle) });
        });
        keep_panics_quiet();
        let outside = go_inside(true);
        if let Err(panic) = catch_unwind(destroy) {
            std::mem::forget(panic);
        }
        go_inside(outside);
    }
}

#[cfg(test)]
mod tests {
    use std::ffi::CStr;

    use super::super::status::{IRRADIA_ERROR_ARGUMENT, irradia_last_error};
    use super::*;

    struct Number(Guarded<u32>);

    impl Handle for Number {
        type Value = u32;
        const NAME: &'static str = "number";

        fn guarded(&self) -> &Guarded<u32> {
            &self.0
        }
    }

    fn said() -> String {
        // SAFETY: the text stands until the next call that fails.
        unsafe { CStr::from_ptr(irradia_last_error()) }.to_string_lossy().into_owned()
    }

    #[test]
    fn a_panic_is_a_status_and_what_it_held_is_broken() {
        let number = Number(Guarded::new(3));
        let status = call(|border| {
            // SAFETY: alive.
            let value = unsafe { border.enter(&number) }?;
            *value += 1;
            panic!("a test: {value}");
        });
        assert_eq!(status, IRRADIA_ERROR_INTERNAL);
        assert!(said().contains("a test: 4"), "{}", said());
        // SAFETY: alive.
        let again = call(|border| unsafe { border.enter(&number) }.map(|_| ()));
        assert_eq!(again, IRRADIA_ERROR_INTERNAL);
        assert!(said().contains("destroy it"), "{}", said());
    }

    #[test]
    fn a_handle_is_used_by_one_call_at_a_time() {
        let number = Number(Guarded::new(3));
        let status = call(|border| {
            // SAFETY: alive.
            unsafe { border.enter(&number) }?;
            // SAFETY: alive.
            let inner = call(|border| unsafe { border.enter(&number) }.map(|_| ()));
            assert_eq!(inner, IRRADIA_ERROR_BUSY);
            Ok(())
        });
        assert_eq!(status, IRRADIA_OK);
        // SAFETY: alive.
        assert_eq!(call(|border| unsafe { border.enter(&number) }.map(|_| ())), IRRADIA_OK);
        // SAFETY: null is a fault.
        let none = call(|border| unsafe { border.enter(std::ptr::null::<Number>()) }.map(|_| ()));
        assert_eq!(none, IRRADIA_ERROR_ARGUMENT);
    }
}
