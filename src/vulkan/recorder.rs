//! Recording, submitting and awaiting the commands of one frame: labels, barriers and timestamps here, work in `draw` and `copy`.

#![allow(unsafe_code, reason = "every Vulkan command is an unsafe call")]

use std::ffi::CString;
use std::ops::Range;
use std::sync::Arc;

use ash::vk;

use super::descriptor_counts::DescriptorCounts;
use super::device::Device;
use super::error::{Called, VulkanError};
use super::memory::Image;
use super::queries::Queries;

/// An execution and memory dependency between two groups of stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Scope {
    pub(crate) from_stages: vk::PipelineStageFlags2,
    pub(crate) from_access: vk::AccessFlags2,
    pub(crate) to_stages: vk::PipelineStageFlags2,
    pub(crate) to_access: vk::AccessFlags2,
}

impl Scope {
    /// No dependency.
    pub(crate) const NONE: Scope = Scope {
        from_stages: vk::PipelineStageFlags2::NONE,
        from_access: vk::AccessFlags2::NONE,
        to_stages: vk::PipelineStageFlags2::NONE,
        to_access: vk::AccessFlags2::NONE,
    };

    /// Everything before it is done and visible to everything after it.
    pub(crate) const FULL: Scope = Scope {
        from_stages: vk::PipelineStageFlags2::ALL_COMMANDS,
        from_access: vk::AccessFlags2::MEMORY_WRITE,
        to_stages: vk::PipelineStageFlags2::ALL_COMMANDS,
        to_access: vk::AccessFlags2::from_raw(
            vk::AccessFlags2::MEMORY_READ.as_raw() | vk::AccessFlags2::MEMORY_WRITE.as_raw(),
        ),
    };
}

/// A dependency on one mip level of some layers of an image, with its change of layout.
pub(crate) struct ImageBarrier<'a> {
    pub(crate) image: &'a Image,
    pub(crate) mip: u32,
    pub(crate) layers: Range<u32>,
    pub(crate) scope: Scope,
    pub(crate) old_layout: vk::ImageLayout,
    pub(crate) new_layout: vk::ImageLayout,
}

/// All dependencies that stand before one pass: one call.
#[derive(Default)]
pub(crate) struct Barriers<'a> {
    pub(crate) memory: Option<Scope>,
    pub(crate) images: Vec<ImageBarrier<'a>>,
}

/// A command buffer, its fence and its descriptor pool, used frame after frame: one frame is in flight at a time.
pub(crate) struct Recorder {
    pub(super) device: Arc<Device>,
    pool: vk::CommandPool,
    pub(super) commands: vk::CommandBuffer,
    fence: vk::Fence,
    pub(super) descriptors: vk::DescriptorPool,
    capacity: DescriptorCounts,
}

impl Recorder {
    pub(crate) fn new(device: &Arc<Device>) -> Result<Recorder, VulkanError> {
        let mut recorder = Recorder {
            device: device.clone(),
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            descriptors: vk::DescriptorPool::null(),
            capacity: DescriptorCounts::default(),
        };
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(device.survey.queue_family);
        // SAFETY: the device is alive; what is made is destroyed by `drop`, for which null handles are no-ops.
        unsafe {
            recorder.pool = device.raw.create_command_pool(&info, None).called("vkCreateCommandPool")?;
            let info = vk::CommandBufferAllocateInfo::default().command_pool(recorder.pool).command_buffer_count(1);
            recorder.commands = device.raw.allocate_command_buffers(&info).called("vkAllocateCommandBuffers")?[0];
            recorder.fence = device.raw.create_fence(&vk::FenceCreateInfo::default(), None).called("vkCreateFence")?;
        }
        Ok(recorder)
    }

    /// Starts a recording with room for so many descriptors. The previous one has been waited for.
    pub(crate) fn begin(&mut self, wanted: &DescriptorCounts) -> Result<(), VulkanError> {
        let raw = &self.device.raw;
        // SAFETY: the fence of the previous recording was waited for by `finish`, so nothing here is in use.
        unsafe {
            raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()).called("vkResetCommandPool")?;
            if !self.capacity.holds(wanted) {
                raw.destroy_descriptor_pool(self.descriptors, None);
                self.descriptors = vk::DescriptorPool::null();
                let capacity = std::mem::take(&mut self.capacity).grown_to(wanted);
                let sizes = capacity.pool_sizes(self.device.traits().texels_in_storage);
                let info = vk::DescriptorPoolCreateInfo::default().max_sets(capacity.sets()).pool_sizes(&sizes);
                self.descriptors = raw.create_descriptor_pool(&info, None).called("vkCreateDescriptorPool")?;
                self.capacity = capacity;
            } else if self.descriptors != vk::DescriptorPool::null() {
                raw.reset_descriptor_pool(self.descriptors, vk::DescriptorPoolResetFlags::empty())
                    .called("vkResetDescriptorPool")?;
            }
            let info = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            raw.begin_command_buffer(self.commands, &info).called("vkBeginCommandBuffer")
        }
    }

    /// Submits what was recorded and waits until the device has done it.
    pub(crate) fn finish(&mut self) -> Result<(), VulkanError> {
        self.finish_between(&[], &[])
    }

    /// The same, after some semaphores have been signalled, and signalling others.
    pub(super) fn finish_between(
        &mut self,
        waits: &[vk::SemaphoreSubmitInfo<'_>],
        signals: &[vk::SemaphoreSubmitInfo<'_>],
    ) -> Result<(), VulkanError> {
        let raw = &self.device.raw;
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
        let submit = [vk::SubmitInfo2::default()
            .command_buffer_infos(&commands)
            .wait_semaphore_infos(waits)
            .signal_semaphore_infos(signals)];
        // SAFETY: the command buffer was begun by `begin`.
        unsafe { raw.end_command_buffer(self.commands) }.called("vkEndCommandBuffer")?;
        // SAFETY: the queue is this call's; the fence is unsignalled.
        let submitted = self.device.submit(|queue| unsafe { raw.queue_submit2(queue, &submit, self.fence) });
        submitted.called("vkQueueSubmit2")?;
        // SAFETY: the fence was submitted.
        unsafe {
            raw.wait_for_fences(&[self.fence], true, u64::MAX).called("vkWaitForFences")?;
            raw.reset_fences(&[self.fence]).called("vkResetFences")
        }
    }

    pub(crate) fn begin_label(&self, name: &str) {
        let (Some(labels), Ok(name)) = (&self.device.labels, CString::new(name)) else { return };
        let label = vk::DebugUtilsLabelEXT::default().label_name(&name);
        // SAFETY: the command buffer is recording.
        unsafe { labels.cmd_begin_debug_utils_label(self.commands, &label) };
    }

    pub(crate) fn end_label(&self) {
        if let Some(labels) = &self.device.labels {
            // SAFETY: the command buffer is recording; the graph ends every label that it begins.
            unsafe { labels.cmd_end_debug_utils_label(self.commands) };
        }
    }

    pub(crate) fn barriers(&self, barriers: &Barriers<'_>) {
        if barriers.memory.is_none() && barriers.images.is_empty() {
            return;
        }
        let memory: Vec<_> = barriers
            .memory
            .iter()
            .map(|scope| {
                let barrier =
                    vk::MemoryBarrier2::default().src_stage_mask(scope.from_stages).src_access_mask(scope.from_access);
                barrier.dst_stage_mask(scope.to_stages).dst_access_mask(scope.to_access)
            })
            .collect();
        let images: Vec<_> = barriers
            .images
            .iter()
            .map(|barrier| {
                let range = vk::ImageSubresourceRange {
                    aspect_mask: barrier.image.info.aspect(),
                    base_mip_level: barrier.mip,
                    level_count: 1,
                    base_array_layer: barrier.layers.start,
                    layer_count: barrier.layers.end - barrier.layers.start,
                };
                vk::ImageMemoryBarrier2::default()
                    .src_stage_mask(barrier.scope.from_stages)
                    .src_access_mask(barrier.scope.from_access)
                    .dst_stage_mask(barrier.scope.to_stages)
                    .dst_access_mask(barrier.scope.to_access)
                    .old_layout(barrier.old_layout)
                    .new_layout(barrier.new_layout)
                    .image(barrier.image.raw)
                    .subresource_range(range)
            })
            .collect();
        let info = vk::DependencyInfo::default().memory_barriers(&memory).image_memory_barriers(&images);
        // SAFETY: the command buffer is recording outside a render pass; the images are alive.
        unsafe { self.device.raw.cmd_pipeline_barrier2(self.commands, &info) };
    }

    pub(crate) fn full_barrier(&self) {
        self.barriers(&Barriers { memory: Some(Scope::FULL), images: Vec::new() });
    }

    /// Writes a timestamp once everything before it is done. Full barriers must stand around it for its value to
    /// separate passes (the software driver bins it with the raster work that follows otherwise).
    pub(crate) fn timestamp(&self, queries: &Queries, index: u32) {
        // SAFETY: the command buffer is recording; the index is below the pool's capacity, which the graph checks.
        unsafe {
            self.device.raw.cmd_write_timestamp2(
                self.commands,
                vk::PipelineStageFlags2::ALL_COMMANDS,
                queries.timestamps,
                index,
            )
        };
    }

    pub(crate) fn begin_statistics(&self, queries: &Queries, index: u32) {
        if let Some(pool) = queries.statistics {
            // SAFETY: as for timestamps; the graph ends what it begins.
            unsafe { self.device.raw.cmd_begin_query(self.commands, pool, index, vk::QueryControlFlags::empty()) };
        }
    }

    pub(crate) fn end_statistics(&self, queries: &Queries, index: u32) {
        if let Some(pool) = queries.statistics {
            // SAFETY: begun by `begin_statistics`.
            unsafe { self.device.raw.cmd_end_query(self.commands, pool, index) };
        }
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        let raw = &self.device.raw;
        // SAFETY: the last recording was waited for, or the device is lost, in which case nothing runs any more.
        unsafe {
            raw.destroy_fence(self.fence, None);
            raw.destroy_descriptor_pool(self.descriptors, None);
            raw.destroy_command_pool(self.pool, None);
        }
    }
}
