//! Images of ours copied into images and buffers of a host, on the device, between the host's semaphores.

#![allow(unsafe_code, reason = "the host's handles")]

use ash::vk;
use ash::vk::Handle;

use super::descriptor_counts::DescriptorCounts;
use super::error::{Called, VulkanError};
use super::memory::Image;
use super::recorder::Recorder;

/// How a host's resource is used before or after: what `VkImageMemoryBarrier2` asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ForeignUse {
    /// A `VkImageLayout`; without meaning for buffers.
    pub(crate) layout: i32,
    /// The queue family that owns it, or `u32::MAX`: the one of the device's queue.
    pub(crate) family: u32,
    /// `VkPipelineStageFlags2` of the uses before or after.
    pub(crate) stages: u64,
    /// `VkAccessFlags2` of these.
    pub(crate) access: u64,
}

/// Where pixels go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ForeignPlace {
    /// The first layer of the first mip level of a `VkImage`, two-dimensional, at least as large as the frame, with usage for transfers to it. Its format is a
    /// `VkFormat`: R32G32B32A32_SFLOAT is copied, another colour format converted.
    Image {
        /// The handle.
        image: u64,
        /// A `VkFormat`.
        format: i32,
    },
    /// A `VkBuffer` with usage for transfers to it: four floats a pixel.
    Buffer {
        /// The handle.
        buffer: u64,
        /// Bytes to the first pixel, a multiple of 16.
        offset: u64,
        /// Pixels from one row to the next; 0: the frame's width.
        row_pixels: u32,
    },
}

/// A resource of a host, and how it is used there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ForeignTarget {
    /// What it is.
    pub(crate) place: ForeignPlace,
    /// How the host used it before.
    pub(crate) before: ForeignUse,
    /// How the host will use it.
    pub(crate) after: ForeignUse,
}

/// A timeline semaphore of a host, and a value of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TimelinePoint {
    /// The `VkSemaphore`.
    pub(crate) semaphore: u64,
    /// The value to wait for, or to signal.
    pub(crate) value: u64,
}

/// One copy.
pub(crate) struct HandOut<'a> {
    /// In the layout for transfers from it; `None`: black.
    pub(crate) from: Option<&'a Image>,
    pub(crate) to: ForeignTarget,
    pub(crate) size: [u32; 2],
}

/// Seconds from a fence to the semaphores that are signalled with it.
const SIGNALLED_WITHIN: f64 = 10.0;
/// The format of slots.
const COPIED: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Formats that a blit makes of floats: whole numbers and depths are none.
const CONVERTED: [vk::Format; 29] = [
    vk::Format::R8_UNORM,
    vk::Format::R8_SRGB,
    vk::Format::R8G8_UNORM,
    vk::Format::R8G8_SRGB,
    vk::Format::R8G8B8_UNORM,
    vk::Format::R8G8B8_SRGB,
    vk::Format::B8G8R8_UNORM,
    vk::Format::B8G8R8_SRGB,
    vk::Format::R8G8B8A8_UNORM,
    vk::Format::R8G8B8A8_SRGB,
    vk::Format::B8G8R8A8_UNORM,
    vk::Format::B8G8R8A8_SRGB,
    vk::Format::A8B8G8R8_UNORM_PACK32,
    vk::Format::A8B8G8R8_SRGB_PACK32,
    vk::Format::A2R10G10B10_UNORM_PACK32,
    vk::Format::A2B10G10R10_UNORM_PACK32,
    vk::Format::R5G6B5_UNORM_PACK16,
    vk::Format::R16_UNORM,
    vk::Format::R16_SFLOAT,
    vk::Format::R16G16_UNORM,
    vk::Format::R16G16_SFLOAT,
    vk::Format::R16G16B16_SFLOAT,
    vk::Format::R16G16B16A16_UNORM,
    vk::Format::R16G16B16A16_SFLOAT,
    vk::Format::R32_SFLOAT,
    vk::Format::R32G32_SFLOAT,
    vk::Format::R32G32B32_SFLOAT,
    vk::Format::B10G11R11_UFLOAT_PACK32,
    vk::Format::E5B9G9R9_UFLOAT_PACK32,
];
const EVERYTHING: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};
const LAYERS: vk::ImageSubresourceLayers = vk::ImageSubresourceLayers {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    mip_level: 0,
    base_array_layer: 0,
    layer_count: 1,
};

impl Recorder {
    /// Waits on the host until all points are reached.
    ///
    /// # Errors
    /// If they are not after `seconds`.
    pub(crate) fn await_points(&self, points: &[TimelinePoint], seconds: f64) -> Result<(), VulkanError> {
        if points.is_empty() {
            return Ok(());
        }
        let semaphores: Vec<_> = points.iter().map(|point| vk::Semaphore::from_raw(point.semaphore)).collect();
        let values: Vec<_> = points.iter().map(|point| point.value).collect();
        let info = vk::SemaphoreWaitInfo::default().semaphores(&semaphores).values(&values);
        let nanoseconds = (seconds * 1e9).clamp(0.0, 9e18) as u64;
        // SAFETY: the host's semaphores are timelines and alive.
        match unsafe { self.device.raw.wait_semaphores(&info, nanoseconds) } {
            Err(vk::Result::TIMEOUT) => Err(VulkanError::Host(format!(
                "a semaphore did not reach the value that was to be waited for within {seconds:.3} s; what signals it must have been submitted before"
            ))),
            done => done.called("vkWaitSemaphores"),
        }
    }

    /// Whether pixels can be copied there.
    ///
    /// # Errors
    /// For a format that does not hold radiance, or that the device cannot convert into.
    pub(crate) fn check_target(&self, target: &ForeignTarget) -> Result<(), VulkanError> {
        let ForeignPlace::Image { format, .. } = target.place else { return Ok(()) };
        let format = vk::Format::from_raw(format);
        if format == COPIED {
            return Ok(());
        }
        if !CONVERTED.contains(&format) {
            let fault = format!(
                "an image of VkFormat {} is not one for colours in floats or in parts of 1: it takes no radiance",
                format.as_raw()
            );
            return Err(VulkanError::Host(fault));
        }
        self.device.check_draws()?;
        if self.device.format_features(format).contains(vk::FormatFeatureFlags::BLIT_DST) {
            return Ok(());
        }
        Err(VulkanError::Host(format!("it converts nothing into images of VkFormat {}", format.as_raw())))
    }

    /// Starts a recording that ends in [`Recorder::hand_out`].
    pub(crate) fn begin_hand_out(&mut self) -> Result<(), VulkanError> {
        self.begin(&DescriptorCounts::default())
    }

    /// Records all copies behind what was recorded since `begin`, submits them between the points, and waits until they are done.
    pub(crate) fn hand_out(
        &mut self,
        copies: &[HandOut<'_>],
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
    ) -> Result<(), VulkanError> {
        copies.iter().for_each(|copy| self.record_hand_out(copy));
        let infos = |points: &[TimelinePoint]| -> Vec<vk::SemaphoreSubmitInfo<'static>> {
            let info = |point: &TimelinePoint| {
                vk::SemaphoreSubmitInfo::default()
                    .semaphore(vk::Semaphore::from_raw(point.semaphore))
                    .value(point.value)
                    .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            };
            points.iter().map(info).collect()
        };
        self.finish_between(&infos(waits), &infos(signals))?;
        // Mesa 22.3 may signal the fence a moment before the semaphores of the same submission.
        self.await_points(signals, SIGNALLED_WITHIN)
    }

    fn record_hand_out(&self, copy: &HandOut<'_>) {
        let ForeignTarget { place, before, after } = copy.to;
        let [width, height] = copy.size;
        let ours = self.device.survey.queue_family;
        let family = |family: u32| if family == u32::MAX { ours } else { family };
        let transfer = ForeignUse {
            layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL.as_raw(),
            family: ours,
            stages: vk::PipelineStageFlags2::ALL_TRANSFER.as_raw(),
            access: vk::AccessFlags2::TRANSFER_WRITE.as_raw(),
        };
        match place {
            ForeignPlace::Image { image, format } => {
                let (image, format) = (vk::Image::from_raw(image), vk::Format::from_raw(format));
                let barrier = |from: ForeignUse, to: ForeignUse| {
                    let [from_family, to_family] = families(family(from.family), family(to.family));
                    let barrier = vk::ImageMemoryBarrier2::default()
                        .src_stage_mask(vk::PipelineStageFlags2::from_raw(from.stages))
                        .src_access_mask(vk::AccessFlags2::from_raw(from.access))
                        .dst_stage_mask(vk::PipelineStageFlags2::from_raw(to.stages))
                        .dst_access_mask(vk::AccessFlags2::from_raw(to.access))
                        .old_layout(vk::ImageLayout::from_raw(from.layout))
                        .new_layout(vk::ImageLayout::from_raw(to.layout))
                        .src_queue_family_index(from_family)
                        .dst_queue_family_index(to_family)
                        .image(image)
                        .subresource_range(EVERYTHING);
                    let barriers = [barrier];
                    let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
                    // SAFETY: the command buffer is recording; the image is the host's word.
                    unsafe { self.device.raw.cmd_pipeline_barrier2(self.commands, &info) };
                };
                barrier(before, transfer);
                self.fill_foreign_image(copy.from, image, format, [width, height]);
                barrier(transfer, after);
            }
            ForeignPlace::Buffer { buffer, offset, row_pixels } => {
                let buffer = vk::Buffer::from_raw(buffer);
                let barrier = |from: ForeignUse, to: ForeignUse| {
                    let [from_family, to_family] = families(family(from.family), family(to.family));
                    let barriers = [vk::BufferMemoryBarrier2::default()
                        .src_stage_mask(vk::PipelineStageFlags2::from_raw(from.stages))
                        .src_access_mask(vk::AccessFlags2::from_raw(from.access))
                        .dst_stage_mask(vk::PipelineStageFlags2::from_raw(to.stages))
                        .dst_access_mask(vk::AccessFlags2::from_raw(to.access))
                        .src_queue_family_index(from_family)
                        .dst_queue_family_index(to_family)
                        .buffer(buffer)
                        .size(vk::WHOLE_SIZE)];
                    let info = vk::DependencyInfo::default().buffer_memory_barriers(&barriers);
                    // SAFETY: the command buffer is recording; the buffer is the host's word.
                    unsafe { self.device.raw.cmd_pipeline_barrier2(self.commands, &info) };
                };
                barrier(before, transfer);
                let row = if row_pixels == 0 { width } else { row_pixels };
                let raw = &self.device.raw;
                match copy.from {
                    Some(from) => {
                        let regions = [vk::BufferImageCopy::default()
                            .buffer_offset(offset)
                            .buffer_row_length(row)
                            .image_subresource(LAYERS)
                            .image_extent(vk::Extent3D { width, height, depth: 1 })];
                        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
                        // SAFETY: as above; our image is in the layout.
                        unsafe { raw.cmd_copy_image_to_buffer(self.commands, from.raw, layout, buffer, &regions) };
                    }
                    None => {
                        for line in 0..u64::from(height) {
                            let start = offset + line * u64::from(row) * 16;
                            // SAFETY: as above.
                            unsafe { raw.cmd_fill_buffer(self.commands, buffer, start, u64::from(width) * 16, 0) };
                        }
                    }
                }
                barrier(transfer, after);
            }
        }
    }

    fn fill_foreign_image(
        &self,
        from: Option<&Image>,
        image: vk::Image,
        format: vk::Format,
        [width, height]: [u32; 2],
    ) {
        use vk::ImageLayout as Layout;
        let (raw, commands) = (&self.device.raw, self.commands);
        let Some(from) = from else {
            let black = vk::ClearColorValue { float32: [0.0, 0.0, 0.0, 1.0] };
            // SAFETY: the command buffer is recording; the image is in the layout.
            unsafe { raw.cmd_clear_color_image(commands, image, Layout::TRANSFER_DST_OPTIMAL, &black, &[EVERYTHING]) };
            return;
        };
        if format == COPIED {
            let regions = [vk::ImageCopy::default()
                .src_subresource(LAYERS)
                .dst_subresource(LAYERS)
                .extent(vk::Extent3D { width, height, depth: 1 })];
            let (before, after) = (Layout::TRANSFER_SRC_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL);
            // SAFETY: as above.
            unsafe { raw.cmd_copy_image(commands, from.raw, before, image, after, &regions) };
            return;
        }
        let corner = |side: u32| i32::try_from(side).unwrap_or(i32::MAX);
        let corners = [vk::Offset3D::default(), vk::Offset3D { x: corner(width), y: corner(height), z: 1 }];
        let regions = [vk::ImageBlit {
            src_subresource: LAYERS,
            src_offsets: corners,
            dst_subresource: LAYERS,
            dst_offsets: corners,
        }];
        let (before, after) = (Layout::TRANSFER_SRC_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL);
        // SAFETY: as above; the format takes blits (`check_target`).
        unsafe { raw.cmd_blit_image(commands, from.raw, before, image, after, &regions, vk::Filter::NEAREST) };
    }
}

/// A change of owner has both families; otherwise a barrier has none.
fn families(from: u32, to: u32) -> [u32; 2] {
    if from == to { [vk::QUEUE_FAMILY_IGNORED; 2] } else { [from, to] }
}
