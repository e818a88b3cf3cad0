//! Structs that begin with their size: a program that was built with an older header passes shorter ones, whose missing end is zero; one that was built with a
//! newer header passes longer ones, which are taken as long as what this library does not know is zero.

use super::status::{Fault, IRRADIA_ERROR_VERSION};

/// More than any descriptor will ever have: what says so was never set.
const MOST_BYTES: usize = 1 << 16;

/// # Safety
/// The type is `repr(C)`, its first field is `size: usize`, and it consists of numbers, raw pointers and optional function pointers, so that zeros are a value
/// of it and so is whatever a C program writes.
pub(super) unsafe trait Descriptor: Copy {
    /// What messages call it.
    const NAME: &'static str;
    /// Bytes that it had in the first version that had it.
    const FIRST_BYTES: usize;
}

/// Declares descriptors.
macro_rules! descriptors {
    ($($type:ident = $name:literal, $first_bytes:expr;)*) => {$(
        // SAFETY: `repr(C)`, `size` comes first, all the rest are numbers and pointers.
        unsafe impl $crate::capi::descriptor::Descriptor for $type {
            const NAME: &'static str = $name;
            const FIRST_BYTES: usize = $first_bytes;
        }
    )*};
}
pub(super) use descriptors;

fn size_of_caller<D: Descriptor>(pointer: *const D) -> Result<usize, Fault> {
    if pointer.is_null() {
        return Err(Fault::argument(format!("the {} is a null pointer", D::NAME)));
    }
    if !pointer.is_aligned() {
        return Err(Fault::argument(format!("the {} is not aligned as a struct is", D::NAME)));
    }
    // SAFETY: every descriptor begins with its size, which the host owes us.
    let size = unsafe { pointer.cast::<usize>().read() };
    if size < D::FIRST_BYTES || size > MOST_BYTES {
        let sentence = format!("the {} says that it has {size} bytes; set its size to sizeof of it", D::NAME);
        return Err(Fault::argument(sentence));
    }
    Ok(size)
}

/// A copy of the host's descriptor.
///
/// # Safety
/// `pointer` is null or points to as many bytes as the size there says.
pub(super) unsafe fn read<D: Descriptor>(pointer: *const D) -> Result<D, Fault> {
    let size = size_of_caller(pointer)?;
    let mut copy = std::mem::MaybeUninit::<D>::zeroed();
    let known = size.min(size_of::<D>());
    // SAFETY: the caller has `size` bytes, the copy `size_of::<D>()`.
    unsafe { std::ptr::copy_nonoverlapping(pointer.cast::<u8>(), copy.as_mut_ptr().cast::<u8>(), known) };
    // SAFETY: the caller's.
    let rest = unsafe { std::slice::from_raw_parts(pointer.cast::<u8>().add(known), size - known) };
    if rest.iter().any(|&byte| byte != 0) {
        let sentence = format!(
            "the {} has {size} bytes and asks for something in those that this version of the library, which knows {}, does not have; use a newer one",
            D::NAME,
            size_of::<D>()
        );
        return Err(Fault { status: IRRADIA_ERROR_VERSION, sentence });
    }
    // SAFETY: zeros are a value of every descriptor, and so is what the host writes.
    Ok(unsafe { copy.assume_init() })
}

/// The same, or nothing where the pointer is null.
///
/// # Safety
/// As [`read`].
pub(super) unsafe fn read_optional<D: Descriptor>(pointer: *const D) -> Result<Option<D>, Fault> {
    // SAFETY: the caller's.
    if pointer.is_null() { Ok(None) } else { unsafe { read(pointer) }.map(Some) }
}

/// Fills the host's descriptor, as much as it has room for, but for its size.
///
/// # Safety
/// As [`read`], and may be written to.
pub(super) unsafe fn write<D: Descriptor>(pointer: *mut D, value: &D) -> Result<(), Fault> {
    let size = size_of_caller(pointer)?;
    let known = size.min(size_of::<D>());
    let head = size_of::<usize>();
    let (from, to) = (std::ptr::from_ref(value).cast::<u8>(), pointer.cast::<u8>());
    // SAFETY: the caller has `size` bytes, the value `size_of::<D>()`; they are no part of each other.
    unsafe {
        std::ptr::copy_nonoverlapping(from.add(head), to.add(head), known - head);
        to.add(known).write_bytes(0, size - known);
    }
    Ok(())
}

/// An array of the host's.
///
/// # Safety
/// `pointer` is null or points to `count` values, which nobody changes during the call.
pub(super) unsafe fn slice<'a, T>(pointer: *const T, count: usize, what: &str) -> Result<&'a [T], Fault> {
    if count == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err(Fault::argument(format!("{what}: {count} of them at a null pointer")));
    }
    if !pointer.is_aligned() || count.checked_mul(size_of::<T>()).is_none_or(|bytes| bytes > isize::MAX as usize) {
        return Err(Fault::argument(format!("{what}: {count} of them cannot be at this address")));
    }
    // SAFETY: the caller's.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// A field without a meaning so far, which a newer library may give one.
pub(super) fn zero(reserved: u32, what: &str) -> Result<(), Fault> {
    if reserved == 0 {
        return Ok(());
    }
    let sentence = format!(
        "the {what} has {reserved} in a reserved field, of which this version of the library knows nothing; write 0"
    );
    Err(Fault { status: IRRADIA_ERROR_VERSION, sentence })
}

/// A boolean of the host's.
pub(super) fn boolean(value: u32, what: &str) -> Result<bool, Fault> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Fault::argument(format!("{what} is {value}; write 0 or 1"))),
    }
}

#[cfg(test)]
mod tests {
    use super::super::status::IRRADIA_ERROR_ARGUMENT;
    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq)]
    #[repr(C)]
    struct Old {
        size: usize,
        width: u32,
        height: u32,
    }

    #[derive(Clone, Copy, Debug, PartialEq)]
    #[repr(C)]
    struct New {
        size: usize,
        width: u32,
        height: u32,
        depth: u64,
    }

    descriptors! {
        Old = "size of a picture", size_of::<Old>();
        New = "size of a picture", size_of::<Old>();
    }

    #[test]
    fn an_older_program_leaves_the_rest_at_zero() {
        let old = Old { size: size_of::<Old>(), width: 3, height: 4 };
        // SAFETY: as long as it says.
        let new = unsafe { read(std::ptr::from_ref(&old).cast::<New>()) }.expect("an older one");
        assert_eq!((new.width, new.height, new.depth), (3, 4, 0));
    }

    #[test]
    fn a_newer_program_is_taken_as_long_as_it_asks_for_nothing_new() {
        let mut new = New { size: size_of::<New>(), width: 3, height: 4, depth: 0 };
        // SAFETY: as long as it says.
        let old = unsafe { read(std::ptr::from_ref(&new).cast::<Old>()) }.expect("nothing new");
        assert_eq!((old.width, old.height), (3, 4));
        new.depth = 1;
        // SAFETY: as long as it says.
        let fault = unsafe { read(std::ptr::from_ref(&new).cast::<Old>()) }.expect_err("something new");
        assert_eq!(fault.status, IRRADIA_ERROR_VERSION, "{}", fault.sentence);
    }

    #[test]
    fn what_is_written_fits_both() {
        let value = New { size: size_of::<New>(), width: 5, height: 6, depth: 7 };
        let mut old = Old { size: size_of::<Old>(), width: 0, height: 0 };
        // SAFETY: as long as it says.
        unsafe { write(std::ptr::from_mut(&mut old).cast::<New>(), &value) }.expect("room for a part");
        assert_eq!(old, Old { size: size_of::<Old>(), width: 5, height: 6 });
        let mut new = New { size: size_of::<New>(), width: 0, height: 0, depth: 9 };
        // SAFETY: as long as it says.
        unsafe { write(std::ptr::from_mut(&mut new).cast::<Old>(), &old) }.expect("more room than needed");
        assert_eq!(new, New { size: size_of::<New>(), width: 5, height: 6, depth: 0 });
    }

    #[test]
    fn sizes_that_were_never_set_are_refused() {
        for size in [0, 8, usize::MAX] {
            let old = Old { size, width: 0, height: 0 };
            // SAFETY: nothing behind the size is read.
            let fault = unsafe { read(&old) }.expect_err("no size");
            assert_eq!(fault.status, IRRADIA_ERROR_ARGUMENT, "{}", fault.sentence);
        }
        // SAFETY: null is a fault.
        assert!(unsafe { read(std::ptr::null::<Old>()) }.is_err());
        assert!(boolean(2, "a choice").is_err());
    }
}
