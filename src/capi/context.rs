//! Contexts: a device each, and what renderers on it share.

use std::collections::BTreeMap;
use std::ffi::{CString, c_char, c_void};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::border::{call, create, take};
use super::descriptor::{descriptors, read_optional};
use super::log::{LogFunction, dispatch};
use super::status::{Fault, Status};
use super::text::{self, optional_text};
use super::vulkan::{self, DeviceDescriptor};
use super::workers::Workers;
use crate::renderer::{Context, ContextOptions};
use crate::vulkan::{SharedBuffer, Validation};

/// No validation layer.
pub const IRRADIA_VALIDATION_OFF: u32 = 0;
/// Correct use of the interface.
pub const IRRADIA_VALIDATION_CORE: u32 = 1;
/// The same, and hazards between commands.
pub const IRRADIA_VALIDATION_SYNCHRONIZATION: u32 = 2;
/// Correct use, and shaders that check their memory accesses; slow.
pub const IRRADIA_VALIDATION_GPU: u32 = 3;

/// How a context is made.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ContextDescriptor {
    /// sizeof(irradia_context_descriptor).
    pub size: usize,
    /// A part of the device's name, or its index; null: the first discrete GPU, else integrated, else CPU.
    pub device: *const c_char,
    /// One of IRRADIA_VALIDATION_…. Beside 0 the validation layer must be installed.
    pub validation: u32,
    /// The least urgent messages that `log` hears, one of IRRADIA_LOG_…; 0: IRRADIA_LOG_WARNING.
    pub log_level: u32,
    /// Hears what the library says; null: nobody does.
    pub log: LogFunction,
    /// Given to `log`.
    pub log_user: *mut c_void,
    /// The host's own device in place of one of the library's; `device` and `validation` must be zero then. Null: the library opens one.
    pub host_device: *const DeviceDescriptor,
}

descriptors! {
    ContextDescriptor = "context descriptor", size_of::<ContextDescriptor>();
}

/// What a context's renderers and scenes share.
pub(super) struct Shared {
    pub(super) context: Context,
    pub(super) workers: Workers,
    device_name: CString,
    /// Buffers that frames may fill, by the number of the resource.
    buffers: Mutex<BTreeMap<u64, Arc<SharedBuffer>>>,
}

impl Shared {
    pub(super) fn buffers(&self) -> MutexGuard<'_, BTreeMap<u64, Arc<SharedBuffer>>> {
        self.buffers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs work on the context's threads; all that is said goes to its log.
    pub(super) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.workers.listen(|| self.workers.run(work))
    }
}

/// A Vulkan device and what is shared on it. Its calls may come from several threads at once.
pub struct ContextHandle {
    shared: Arc<Shared>,
}

/// The shared part of a context.
///
/// # Safety
/// `context` is null, which is a fault, or a context that has not been destroyed.
pub(super) unsafe fn shared(context: *const ContextHandle) -> Result<Arc<Shared>, Fault> {
    // SAFETY: the caller's.
    let context = unsafe { context.as_ref() };
    context.map(|context| context.shared.clone()).ok_or_else(|| Fault::argument("the context is a null pointer"))
}

/// Opens a device.
///
/// `descriptor`: null for a descriptor of zeros: the default device, no validation, no log.
/// `context`: receives the new context, which irradia_context_destroy() ends; null where the call fails.
///
/// Errors: IRRADIA_ERROR_DEVICE without a Vulkan 1.3 loader, a device that can be used, or the validation layer that was asked for; IRRADIA_ERROR_ARGUMENT.
/// From any thread. Takes tens of milliseconds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_context_create(
    descriptor: *const ContextDescriptor,
    context: *mut *mut ContextHandle,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    unsafe { create(context, |_| open(descriptor)) }
}

/// # Safety
/// `descriptor` is null or a descriptor.
unsafe fn open(descriptor: *const ContextDescriptor) -> Result<ContextHandle, Fault> {
    // SAFETY: the caller's.
    let given = unsafe { read_optional(descriptor) }?;
    let given = given.unwrap_or(ContextDescriptor {
        size: 0,
        device: std::ptr::null(),
        validation: 0,
        log_level: 0,
        log: None,
        log_user: std::ptr::null_mut(),
        host_device: std::ptr::null(),
    });
    let validation = match given.validation {
        IRRADIA_VALIDATION_OFF => Validation::Off,
        IRRADIA_VALIDATION_CORE => Validation::Core,
        IRRADIA_VALIDATION_SYNCHRONIZATION => Validation::Synchronization,
        IRRADIA_VALIDATION_GPU => Validation::GpuAssisted,
        other => return Err(Fault::argument(format!("validation is {other}; write one of IRRADIA_VALIDATION_…"))),
    };
    // SAFETY: the caller's.
    let device = unsafe { optional_text(given.device, "the device's name") }?.map(str::to_owned);
    let workers = Workers::new(dispatch(given.log, given.log_user, given.log_level)?)?;
    let options = ContextOptions { device, validation, ..ContextOptions::default() };
    let context = if given.host_device.is_null() {
        workers.listen(|| Context::new(&options))?
    } else {
        if options.device.is_some() || options.validation != Validation::Off {
            return Err(Fault::argument("a context on the host's device chooses neither a device nor validation"));
        }
        // SAFETY: the caller's.
        workers.listen(|| unsafe { vulkan::context_on(given.host_device) })?
    };
    let device_name = text::owned(&context.device().name);
    Ok(ContextHandle { shared: Arc::new(Shared { context, workers, device_name, buffers: Mutex::default() }) })
}

/// Ends a context. What was made on it and is still there keeps its device open until it is destroyed too. Null is allowed.
///
/// From any thread, once, with no other call on it in progress.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_context_destroy(context: *mut ContextHandle) {
    // SAFETY: the host gives back what it was given.
    unsafe { take(context) };
}

/// The name of the device in use, UTF-8. Stands as long as the context does. Null for a null context.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_context_device_name(context: *const ContextHandle) -> *const c_char {
    // SAFETY: null or a context.
    unsafe { context.as_ref() }.map_or(std::ptr::null(), |context| context.shared.device_name.as_ptr())
}

/// What the validation layer found so far: how many messages, and one of them.
///
/// `count`: receives their number; may be null.
/// `index`, `buffer`, `capacity`, `needed`: the message to copy, as irradia_renderer_settings() copies; `buffer` and `needed` null: none.
///
/// Errors: IRRADIA_ERROR_ARGUMENT beyond the last message or for a buffer that is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_context_validation_message(
    context: *const ContextHandle,
    count: *mut usize,
    index: usize,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
) -> Status {
    call(|_| {
        // SAFETY: the host's pointers are what the header asks for.
        let messages = unsafe { shared(context) }?.context.validation_messages();
        if !count.is_null() {
            // SAFETY: as above.
            unsafe { count.write(messages.len()) };
        }
        if buffer.is_null() && needed.is_null() {
            return Ok(());
        }
        let Some(message) = messages.get(index) else {
            return Err(Fault::argument(format!("there are {} messages, none of index {index}", messages.len())));
        };
        // SAFETY: as above.
        unsafe { text::copy(message, buffer, capacity, needed) }
    })
}

/// How many device allocations of the context are alive, and their bytes; either place may be null. Without renderers there are none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_context_allocations(
    context: *const ContextHandle,
    count: *mut usize,
    bytes: *mut u64,
) -> Status {
    call(|_| {
        // SAFETY: the host's pointers are what the header asks for.
        let live = unsafe { shared(context) }?.context.live_allocations();
        if !count.is_null() {
            // SAFETY: as above.
            unsafe { count.write(live.len()) };
        }
        if !bytes.is_null() {
            // SAFETY: as above.
            unsafe { bytes.write(live.iter().map(|(_, bytes)| bytes).sum()) };
        }
        Ok(())
    })
}
