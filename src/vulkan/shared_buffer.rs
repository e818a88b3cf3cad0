//! Device memory that other processes see: a buffer whose memory is exported as a file descriptor (VK_KHR_external_memory_fd).

#![allow(unsafe_code, reason = "objects that gpu-allocator cannot make")]

use std::sync::Arc;

use ash::vk;
use ash::vk::Handle;

use super::device::Device;
use super::error::{Called, VulkanError};

const HANDLE: vk::ExternalMemoryHandleTypeFlags = vk::ExternalMemoryHandleTypeFlags::OPAQUE_FD;
const USAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
    vk::BufferUsageFlags::TRANSFER_SRC.as_raw()
        | vk::BufferUsageFlags::TRANSFER_DST.as_raw()
        | vk::BufferUsageFlags::STORAGE_BUFFER.as_raw(),
);

/// A buffer in memory of its own, which can be exported any number of times.
pub(crate) struct SharedBuffer {
    device: Arc<Device>,
    raw: vk::Buffer,
    memory: vk::DeviceMemory,
    /// Bytes of the buffer.
    pub(crate) bytes: u64,
    /// Bytes of its memory, and the type of that.
    pub(crate) memory_bytes: u64,
    pub(crate) memory_type: u32,
    id: u64,
}

/// Which device and driver memory belongs to: only the same can import it.
pub(crate) struct Identity {
    pub(crate) device: [u8; 16],
    pub(crate) driver: [u8; 16],
}

impl SharedBuffer {
    /// # Errors
    /// If the device exports no such memory, or has none left.
    pub(crate) fn new(device: &Arc<Device>, bytes: u64) -> Result<SharedBuffer, VulkanError> {
        if device.sharing.is_none() || !device.exports_buffers(USAGE, HANDLE) {
            let reason = "its driver exports no memory as file descriptors (VK_KHR_external_memory_fd)".to_owned();
            return Err(VulkanError::Unfit { device: device.report().name.clone(), reason });
        }
        let mut shared = SharedBuffer {
            device: device.clone(),
            raw: vk::Buffer::null(),
            memory: vk::DeviceMemory::null(),
            bytes,
            memory_bytes: 0,
            memory_type: 0,
            id: 0,
        };
        let mut external = vk::ExternalMemoryBufferCreateInfo::default().handle_types(HANDLE);
        let info = vk::BufferCreateInfo::default().size(bytes).usage(USAGE).push_next(&mut external);
        // SAFETY: the device is alive. From here on `drop` frees what there is.
        shared.raw = unsafe { device.raw.create_buffer(&info, None) }.called("vkCreateBuffer")?;
        // SAFETY: the buffer was just made.
        let needs = unsafe { device.raw.get_buffer_memory_requirements(shared.raw) };
        shared.memory_bytes = needs.size;
        shared.memory_type = device.memory_type(needs.memory_type_bits);
        let mut dedicated = vk::MemoryDedicatedAllocateInfo::default().buffer(shared.raw);
        let mut export = vk::ExportMemoryAllocateInfo::default().handle_types(HANDLE);
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needs.size)
            .memory_type_index(shared.memory_type)
            .push_next(&mut dedicated)
            .push_next(&mut export);
        // SAFETY: the type is one of those that the buffer takes.
        let memory = unsafe { device.raw.allocate_memory(&info, None) };
        shared.memory = memory.map_err(|result| match result {
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY | vk::Result::ERROR_OUT_OF_HOST_MEMORY => VulkanError::OutOfMemory {
                what: "a shared buffer".to_owned(),
                mib: needs.size as f64 / f64::from(1 << 20),
                last_pass: "none".to_owned(),
            },
            result => VulkanError::Call { call: "vkAllocateMemory".to_owned(), result: result.to_string() },
        })?;
        // SAFETY: the memory is as large as the buffer needs.
        unsafe { device.raw.bind_buffer_memory(shared.raw, shared.memory, 0) }.called("vkBindBufferMemory")?;
        device.set_name(shared.raw, "shared buffer");
        shared.id = device.register("shared buffer", needs.size);
        Ok(shared)
    }

    /// The `VkBuffer`, as a number.
    pub(crate) fn resource(&self) -> u64 {
        self.raw.as_raw()
    }

    /// A new file descriptor of its memory, which the caller closes or imports.
    pub(crate) fn export(&self) -> Result<i32, VulkanError> {
        let info = vk::MemoryGetFdInfoKHR::default().memory(self.memory).handle_type(HANDLE);
        let functions = self.device.sharing.as_ref().expect("looked at when the buffer was made");
        // SAFETY: the memory was allocated to be exported so.
        unsafe { functions.get_memory_fd(&info) }.called("vkGetMemoryFdKHR")
    }

    pub(crate) fn identity(&self) -> Identity {
        let mut ids = vk::PhysicalDeviceIDProperties::default();
        self.device.properties_into(&mut ids);
        Identity { device: ids.device_uuid, driver: ids.driver_uuid }
    }
}

impl Drop for SharedBuffer {
    fn drop(&mut self) {
        // SAFETY: no frame uses it any more: those that fill it hold it. Both may be null.
        unsafe {
            self.device.raw.destroy_buffer(self.raw, None);
            self.device.raw.free_memory(self.memory, None);
        }
        self.device.forget(self.id);
    }
}
