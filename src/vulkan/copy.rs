//! Commands that fill, clear and copy buffers and images.

#![allow(unsafe_code, reason = "every Vulkan command is an unsafe call")]

use std::ops::Range;

use ash::vk;

use super::memory::{Buffer, Image};
use super::recorder::Recorder;

impl Recorder {
    /// Fills `size` bytes at `offset` with a word.
    pub(crate) fn fill(&self, buffer: &Buffer, offset: u64, size: u64, word: u32) {
        // SAFETY: the command buffer is recording outside a render pass; the range lies within the buffer.
        unsafe { self.device.raw.cmd_fill_buffer(self.commands, buffer.raw, offset, size, word) };
    }

    pub(crate) fn copy(&self, from: &Buffer, from_offset: u64, to: &Buffer, to_offset: u64, size: u64) {
        let region = vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size };
        // SAFETY: as above.
        unsafe { self.device.raw.cmd_copy_buffer(self.commands, from.raw, to.raw, &[region]) };
    }

    pub(crate) fn clear_image(&self, image: &Image, [mip, layer]: [u32; 2], value: vk::ClearColorValue) {
        let range = vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            base_mip_level: mip,
            level_count: 1,
            base_array_layer: layer,
            layer_count: 1,
        };
        // SAFETY: as above; the image is in the transfer layout.
        unsafe {
            self.device.raw.cmd_clear_color_image(
                self.commands,
                image.raw,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &value,
                &[range],
            )
        };
    }

    /// Copies one mip level of some layers to `buffer`, rows close together.
    pub(crate) fn read_image(&self, image: &Image, mip: u32, layers: Range<u32>, buffer: &Buffer, offset: u64) {
        let regions = [copy_region(image, mip, layers.start, layers.end - layers.start, offset)];
        // SAFETY: as above; the image is in the transfer layout; the buffer is large enough.
        unsafe {
            self.device.raw.cmd_copy_image_to_buffer(
                self.commands,
                image.raw,
                vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                buffer.raw,
                &regions,
            )
        };
    }

    /// Makes mip level `mip` from the one above it, averaging texels; sRGB texels are averaged as light.
    pub(crate) fn halve_mip(&self, image: &Image, mip: u32) {
        let layers = |mip_level| vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            mip_level,
            base_array_layer: 0,
            layer_count: image.info.layers,
        };
        let corner = |mip: u32| {
            let [x, y, z] = image.info.extent.map(|length| i32::try_from((length >> mip).max(1)).unwrap_or(1));
            [vk::Offset3D::default(), vk::Offset3D { x, y, z }]
        };
        let regions = [vk::ImageBlit {
            src_subresource: layers(mip - 1),
            src_offsets: corner(mip - 1),
            dst_subresource: layers(mip),
            dst_offsets: corner(mip),
        }];
        let (from, to) = (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        // SAFETY: the command buffer is recording; the levels are in the transfer layouts.
        unsafe {
            self.device.raw.cmd_blit_image(self.commands, image.raw, from, image.raw, to, &regions, vk::Filter::LINEAR)
        };
    }

    /// Copies `buffer` at `offset` to one layer of one mip level.
    pub(crate) fn write_image(&self, buffer: &Buffer, offset: u64, image: &Image, mip: u32, layer: u32) {
        let regions = [copy_region(image, mip, layer, 1, offset)];
        // SAFETY: as above.
        unsafe {
            self.device.raw.cmd_copy_buffer_to_image(
                self.commands,
                buffer.raw,
                image.raw,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &regions,
            )
        };
    }
}

fn copy_region(image: &Image, mip: u32, layer: u32, layer_count: u32, offset: u64) -> vk::BufferImageCopy {
    let aspect = image.info.aspect() & !vk::ImageAspectFlags::STENCIL;
    let [width, height, depth] = image.info.extent.map(|length| (length >> mip).max(1));
    vk::BufferImageCopy::default()
        .buffer_offset(offset)
        .image_subresource(vk::ImageSubresourceLayers {
            aspect_mask: aspect,
            mip_level: mip,
            base_array_layer: layer,
            layer_count,
        })
        .image_extent(vk::Extent3D { width, height, depth })
}
