//! Getting a scene's data onto the device, once, before frames use it.

use std::sync::Arc;

use ash::vk;

use super::descriptor_counts::DescriptorCounts;
use super::device::Device;
use super::error::VulkanError;
use super::memory::{Buffer, Image, ImageInfo, Location};
use super::recorder::{Barriers, ImageBarrier, Recorder, Scope};

/// A device buffer that holds `bytes` and is only read from now on.
pub(crate) fn buffer_with(
    device: &Arc<Device>,
    name: &str,
    bytes: &[u8],
    usage: vk::BufferUsageFlags,
) -> Result<Arc<Buffer>, VulkanError> {
    let size = bytes.len() as u64;
    let mut buffer = Buffer::new(device, name, size, usage | vk::BufferUsageFlags::TRANSFER_DST, Location::Device)?;
    // On the software driver, and wherever device memory is the host's, no copy is needed.
    if !buffer.write(0, bytes) {
        let staging = staging(device, name, bytes)?;
        let mut recorder = Recorder::new(device)?;
        recorder.begin(&DescriptorCounts::default())?;
        recorder.copy(&staging, 0, &buffer, 0, size.max(4));
        recorder.full_barrier();
        recorder.finish()?;
    }
    Ok(Arc::new(buffer))
}

/// Overwrites parts of a buffer of [`buffer_with`], each an offset and its bytes, if nobody else holds it. Whether it was done.
pub(crate) fn overwrite(
    device: &Arc<Device>,
    buffer: &mut Arc<Buffer>,
    parts: &[(u64, &[u8])],
) -> Result<bool, VulkanError> {
    let Some(target) = Arc::get_mut(buffer) else { return Ok(false) };
    let mut left = Vec::new();
    for &(offset, bytes) in parts {
        let place = usize::try_from(offset).unwrap_or(usize::MAX);
        if !target.write(place, bytes) {
            left.push((offset, bytes));
        }
    }
    if left.is_empty() {
        return Ok(true);
    }
    let all: Vec<u8> = left.iter().flat_map(|(_, bytes)| *bytes).copied().collect();
    let staging = staging(device, "parts of a list", &all)?;
    let mut recorder = Recorder::new(device)?;
    recorder.begin(&DescriptorCounts::default())?;
    let mut from = 0;
    for (offset, bytes) in left {
        recorder.copy(&staging, from, target, offset, bytes.len() as u64);
        from += bytes.len() as u64;
    }
    recorder.full_barrier();
    recorder.finish()?;
    Ok(true)
}

/// A sampled image of 8-bit texels whose `layers` are given at full size; smaller mip levels are made from them.
pub(crate) fn image_with(
    device: &Arc<Device>,
    name: &str,
    info: ImageInfo,
    layers: &[&[u8]],
) -> Result<Arc<Image>, VulkanError> {
    use vk::ImageLayout as Layout;
    if info.mips > 1 {
        device.check_draws()?;
    }
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::TRANSFER_SRC;
    let image = Image::new(device, name, info, usage, vk::ImageCreateFlags::empty())?;
    let relayout = |mips: std::ops::Range<u32>, old_layout, new_layout| Barriers {
        memory: None,
        images: mips
            .map(|mip| ImageBarrier {
                image: &image,
                mip,
                layers: 0..info.layers,
                scope: Scope::FULL,
                old_layout,
                new_layout,
            })
            .collect(),
    };
    let mut recorder = Recorder::new(device)?;
    // One layer at a time bounds the staging memory.
    for (number, layer) in (0..).zip(layers) {
        let staging = staging(device, name, layer)?;
        recorder.begin(&DescriptorCounts::default())?;
        if number == 0 {
            recorder.barriers(&relayout(0..info.mips, Layout::UNDEFINED, Layout::TRANSFER_DST_OPTIMAL));
        }
        recorder.write_image(&staging, 0, &image, 0, number);
        recorder.finish()?;
    }
    recorder.begin(&DescriptorCounts::default())?;
    for mip in 1..info.mips {
        recorder.barriers(&relayout(mip - 1..mip, Layout::TRANSFER_DST_OPTIMAL, Layout::TRANSFER_SRC_OPTIMAL));
        recorder.halve_mip(&image, mip);
    }
    let last = info.mips - 1;
    recorder.barriers(&relayout(0..last, Layout::TRANSFER_SRC_OPTIMAL, Layout::SHADER_READ_ONLY_OPTIMAL));
    recorder.barriers(&relayout(last..info.mips, Layout::TRANSFER_DST_OPTIMAL, Layout::SHADER_READ_ONLY_OPTIMAL));
    recorder.finish()?;
    drop(recorder);
    Ok(Arc::new(image))
}

fn staging(device: &Arc<Device>, name: &str, bytes: &[u8]) -> Result<Buffer, VulkanError> {
    let mut staging = Buffer::new(
        device,
        &format!("{name}, staging"),
        bytes.len() as u64,
        vk::BufferUsageFlags::TRANSFER_SRC,
        Location::Upload,
    )?;
    let written = staging.write(0, bytes);
    debug_assert!(written, "upload memory is mapped");
    Ok(staging)
}
