//! Getting a scene's data onto the device, once, before frames use it.

use std::sync::Arc;

use ash::vk;

use super::device::Device;
use super::error::VulkanError;
use super::memory::{Buffer, Image, ImageInfo, Location};
use super::recorder::{Barriers, ImageBarrier, Recorder, Scope};

/// A device buffer that holds `bytes` and is only read from now on.
pub(crate) fn buffer_with(device: &Arc<Device>, name: &str, bytes: &[u8], usage: vk::BufferUsageFlags) -> Result<Arc<Buffer>, VulkanError> {
    let size = bytes.len() as u64;
    let mut buffer = Buffer::new(device, name, size, usage | vk::BufferUsageFlags::TRANSFER_DST, Location::Device)?;
    // On the software driver, and wherever device memory is the host's, no copy is needed.
    if !buffer.write(0, bytes) {
        let staging = staging(device, name, bytes)?;
        let mut recorder = Recorder::new(device)?;
        recorder.begin(0)?;
        recorder.copy(&staging, 0, &buffer, 0, size.max(4));
        recorder.full_barrier();
        recorder.finish()?;
    }
    Ok(Arc::new(buffer))
}

/// A sampled image whose layers hold the mip chains given: `layers[layer][mip]` bytes.
pub(crate) fn image_with(device: &Arc<Device>, name: &str, info: ImageInfo, layers: &[Vec<Vec<u8>>], flags: vk::ImageCreateFlags) -> Result<Arc<Image>, VulkanError> {
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let image = Image::new(device, name, info, usage, flags)?;
    let relayout = |old_layout, new_layout| Barriers {
        memory: None,
        images: (0..info.mips).map(|mip| ImageBarrier { image: &image, mip, scope: Scope::FULL, old_layout, new_layout }).collect(),
    };
    let mut recorder = Recorder::new(device)?;
    // One layer at a time bounds the staging memory.
    for (number, layer) in (0..).zip(layers) {
        let staging = staging(device, name, &layer.concat())?;
        recorder.begin(0)?;
        if number == 0 {
            recorder.barriers(&relayout(vk::ImageLayout::UNDEFINED, vk::ImageLayout::TRANSFER_DST_OPTIMAL));
        }
        let mut offset = 0;
        for (mip, bytes) in (0..).zip(layer) {
            recorder.write_image(&staging, offset, &image, mip, number);
            offset += bytes.len() as u64;
        }
        if number as usize + 1 == layers.len() {
            recorder.barriers(&relayout(vk::ImageLayout::TRANSFER_DST_OPTIMAL, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL));
        }
        recorder.finish()?;
    }
    drop(recorder);
    Ok(Arc::new(image))
}

fn staging(device: &Arc<Device>, name: &str, bytes: &[u8]) -> Result<Buffer, VulkanError> {
    let mut staging = Buffer::new(device, &format!("{name}, staging"), bytes.len() as u64, vk::BufferUsageFlags::TRANSFER_SRC, Location::Upload)?;
    let written = staging.write(0, bytes);
    debug_assert!(written, "upload memory is mapped");
    Ok(staging)
}
