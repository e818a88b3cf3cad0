//! Device memory that other processes see.

use std::sync::Arc;

use super::border::{call, create, take};
use super::context::{ContextHandle, Shared, shared};
use super::descriptor::{descriptors, write};
use super::status::{Fault, Status};
use crate::method::Error;
use crate::vulkan::SharedBuffer;

/// What another process needs to import a shared buffer's memory: VkImportMemoryFdInfoKHR with VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT, and a VkBuffer of
/// `byte_count` bytes for transfers from and to it and as a storage buffer, to which that memory is dedicated.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SharedBufferDescriptor {
    /// sizeof(irradia_shared_buffer_descriptor).
    pub size: usize,
    /// For irradia_target_descriptor::resource of this context's frames.
    pub resource: u64,
    /// Bytes of the buffer.
    pub byte_count: u64,
    /// Bytes of its memory: VkMemoryAllocateInfo::allocationSize.
    pub memory_byte_count: u64,
    /// VkMemoryAllocateInfo::memoryTypeIndex, on the same device.
    pub memory_type: u32,
    /// Zero.
    pub reserved: u32,
    /// VkPhysicalDeviceIDProperties::deviceUUID of the context's device, and the driver's: only where both agree can the memory be imported.
    pub device_uuid: [u8; 16],
    /// VkPhysicalDeviceIDProperties::driverUUID.
    pub driver_uuid: [u8; 16],
}

descriptors! {
    SharedBufferDescriptor = "shared buffer descriptor", size_of::<SharedBufferDescriptor>();
}

/// A buffer whose memory other processes can import. Frames of its context fill it as a target. Its calls may come from several threads at once.
pub struct SharedBufferHandle {
    buffer: Arc<SharedBuffer>,
    shared: Arc<Shared>,
}

/// # Safety
/// `buffer` is null, which is a fault, or alive.
unsafe fn known<'a>(buffer: *const SharedBufferHandle) -> Result<&'a SharedBufferHandle, Fault> {
    // SAFETY: the caller's.
    unsafe { buffer.as_ref() }.ok_or_else(|| Fault::argument("the shared buffer is a null pointer"))
}

/// Makes a buffer on a context's own device whose memory other processes can import.
///
/// `byte_count`: at least 1; 16 a pixel.
/// `buffer`: receives it; irradia_shared_buffer_destroy() ends it.
///
/// Errors: IRRADIA_ERROR_DEVICE if the driver exports no memory, or the device is the host's, which shares what it likes; IRRADIA_ERROR_MEMORY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_shared_buffer_create(
    context: *const ContextHandle,
    byte_count: u64,
    buffer: *mut *mut SharedBufferHandle,
) -> Status {
    let make = || {
        // SAFETY: the host's pointer is what the header asks for.
        let shared = unsafe { shared(context) }?;
        if byte_count == 0 {
            return Err(Fault::argument("a shared buffer of 0 bytes"));
        }
        let device = shared.context.shared_device();
        let buffer = shared.workers.listen(|| SharedBuffer::new(device, byte_count)).map_err(Error::from)?;
        let buffer = Arc::new(buffer);
        shared.buffers().insert(buffer.resource(), buffer.clone());
        Ok(SharedBufferHandle { buffer, shared })
    };
    // SAFETY: as above.
    unsafe { create(buffer, |_| make()) }
}

/// Fills a descriptor, whose size is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_shared_buffer_get(
    buffer: *const SharedBufferHandle,
    descriptor: *mut SharedBufferDescriptor,
) -> Status {
    call(|_| {
        // SAFETY: the host's pointers are what the header asks for.
        let SharedBufferHandle { buffer, .. } = unsafe { known(buffer) }?;
        let identity = buffer.identity();
        let filled = SharedBufferDescriptor {
            size: size_of::<SharedBufferDescriptor>(),
            resource: buffer.resource(),
            byte_count: buffer.bytes,
            memory_byte_count: buffer.memory_bytes,
            memory_type: buffer.memory_type,
            reserved: 0,
            device_uuid: identity.device,
            driver_uuid: identity.driver,
        };
        // SAFETY: as above.
        unsafe { write(descriptor, &filled) }
    })
}

/// Exports its memory as a file descriptor, as often as it is asked.
///
/// `fd`: receives a new one, which the caller closes, or hands to another process and closes; a Vulkan that imports one closes it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_shared_buffer_export(buffer: *const SharedBufferHandle, fd: *mut i32) -> Status {
    call(|_| {
        if fd.is_null() {
            return Err(Fault::argument("the place for the file descriptor is a null pointer"));
        }
        // SAFETY: the host's pointers are what the header asks for.
        unsafe { fd.write(-1) };
        // SAFETY: as above.
        let SharedBufferHandle { buffer, shared } = unsafe { known(buffer) }?;
        let exported = shared.workers.listen(|| buffer.export()).map_err(Error::from)?;
        // SAFETY: as above.
        unsafe { fd.write(exported) };
        Ok(())
    })
}

/// Ends a shared buffer; memory that was imported elsewhere stays there. Null is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_shared_buffer_destroy(buffer: *mut SharedBufferHandle) {
    // SAFETY: null or alive.
    if let Some(known) = unsafe { buffer.as_ref() } {
        known.shared.buffers().remove(&known.buffer.resource());
    }
    // SAFETY: the host gives back what it was given.
    unsafe { take(buffer) };
}
