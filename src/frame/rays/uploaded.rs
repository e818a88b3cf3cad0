//! A list that rays read, on the device.

use std::sync::Arc;

use ash::vk;
use bytemuck::Pod;

use crate::graph::bindings::TexelBuffer;
use crate::graph::{Dependence, Graph};
use crate::vulkan::{Buffer, Device, VulkanError, buffer_with};

pub(super) const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
pub(super) const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
pub(super) const FLOAT: vk::Format = vk::Format::R32_SFLOAT;
pub(super) const BYTES: vk::Format = vk::Format::R8G8B8A8_UNORM;
pub(super) const HALVES: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// Elements in device memory, and what names them.
#[derive(Clone)]
pub(super) struct Uploaded {
    name: &'static str,
    buffer: Arc<Buffer>,
    format: vk::Format,
    /// Names the content.
    pub(super) key: u64,
}

impl Uploaded {
    pub(super) fn new<T: Pod>(
        device: &Arc<Device>,
        name: &'static str,
        elements: &[T],
        format: vk::Format,
        key: u64,
    ) -> Result<Uploaded, VulkanError> {
        let bytes = bytemuck::cast_slice(elements);
        let buffer = buffer_with(device, name, bytes, vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER)?;
        Ok(Uploaded { name, buffer, format, key })
    }

    pub(super) fn texels(&self, graph: &mut Graph<'_>, dependence: Dependence) -> TexelBuffer {
        graph.import_buffer::<u32>(self.name, &self.buffer, self.key, dependence).texels(self.format)
    }

    pub(super) fn bytes(&self) -> u64 {
        self.buffer.bytes()
    }
}
