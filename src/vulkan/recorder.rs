//! Recording, submitting and awaiting the commands of one frame.

#![allow(unsafe_code, reason = "every Vulkan command is an unsafe call")]

use std::ffi::CString;
use std::sync::{Arc, PoisonError};

use ash::vk;

use super::device::Device;
use super::error::{Called, VulkanError};
use super::memory::{Buffer, Image};
use super::pipelines::{Pipeline, TargetFormats, pool_sizes};
use super::program::BindingKind;
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

/// A dependency on one mip level of an image, with its change of layout.
pub(crate) struct ImageBarrier<'a> {
    pub(crate) image: &'a Image,
    pub(crate) mip: u32,
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

/// An attachment of a raster pass.
#[derive(Clone, Copy)]
pub(crate) struct Attachment {
    pub(crate) view: vk::ImageView,
    pub(crate) layout: vk::ImageLayout,
    /// `None`: it keeps what it holds.
    pub(crate) clear: Option<vk::ClearValue>,
    pub(crate) store: bool,
}

/// All attachments of a raster pass; a colour that nobody takes is `None`.
#[derive(Default)]
pub(crate) struct Attachments {
    pub(crate) extent: [u32; 2],
    pub(crate) colors: Vec<Option<Attachment>>,
    pub(crate) depth: Option<Attachment>,
    pub(crate) stencil: Option<Attachment>,
    pub(crate) formats: TargetFormats,
}

/// What a descriptor points to.
pub(crate) enum Descriptor {
    Image { view: vk::ImageView, layout: vk::ImageLayout, sampler: vk::Sampler },
    Texels(vk::BufferView),
    Buffer(vk::Buffer),
}

/// A command buffer, its fence and its descriptor pool, used frame after frame: one frame is in flight at a time.
pub(crate) struct Recorder {
    device: Arc<Device>,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    descriptors: vk::DescriptorPool,
    capacity: u32,
}

impl Recorder {
    pub(crate) fn new(device: &Arc<Device>) -> Result<Recorder, VulkanError> {
        let mut recorder = Recorder {
            device: device.clone(),
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            descriptors: vk::DescriptorPool::null(),
            capacity: 0,
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

    /// Starts a recording with room for `sets` descriptor sets. The previous one has been waited for.
    pub(crate) fn begin(&mut self, sets: u32) -> Result<(), VulkanError> {
        let raw = &self.device.raw;
        // SAFETY: the fence of the previous recording was waited for by `finish`, so nothing here is in use.
        unsafe {
            raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()).called("vkResetCommandPool")?;
            if sets > self.capacity {
                raw.destroy_descriptor_pool(self.descriptors, None);
                self.descriptors = vk::DescriptorPool::null();
                self.capacity = 0;
                let capacity = sets.next_power_of_two().max(64);
                let sizes = pool_sizes(capacity);
                let info = vk::DescriptorPoolCreateInfo::default().max_sets(capacity).pool_sizes(&sizes);
                self.descriptors = raw.create_descriptor_pool(&info, None).called("vkCreateDescriptorPool")?;
                self.capacity = capacity;
            } else if self.capacity > 0 {
                raw.reset_descriptor_pool(self.descriptors, vk::DescriptorPoolResetFlags::empty())
                    .called("vkResetDescriptorPool")?;
            }
            let info = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            raw.begin_command_buffer(self.commands, &info).called("vkBeginCommandBuffer")
        }
    }

    /// Submits what was recorded and waits until the device has done it.
    pub(crate) fn finish(&mut self) -> Result<(), VulkanError> {
        let raw = &self.device.raw;
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        let queue = self.device.queue.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the command buffer was begun by `begin`; the queue is locked; the fence is unsignalled.
        unsafe {
            raw.end_command_buffer(self.commands).called("vkEndCommandBuffer")?;
            raw.queue_submit2(*queue, &submit, self.fence).called("vkQueueSubmit2")?;
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
                    base_array_layer: 0,
                    layer_count: vk::REMAINING_ARRAY_LAYERS,
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

    /// A descriptor set of this recording.
    pub(crate) fn descriptor_set(
        &self,
        layout: vk::DescriptorSetLayout,
        bindings: &[(u32, BindingKind, Descriptor)],
    ) -> Result<vk::DescriptorSet, VulkanError> {
        write_descriptor_set(&self.device, self.descriptors, layout, bindings)
    }

    pub(crate) fn bind_pipeline(&self, pipeline: Pipeline) {
        // SAFETY: the command buffer is recording; the pipeline is alive.
        unsafe { self.device.raw.cmd_bind_pipeline(self.commands, pipeline.bind_point, pipeline.raw) };
    }

    pub(crate) fn bind_set(&self, pipeline: Pipeline, number: u32, set: vk::DescriptorSet) {
        // SAFETY: as above; the set was made for this pipeline's layout.
        unsafe {
            self.device.raw.cmd_bind_descriptor_sets(
                self.commands,
                pipeline.bind_point,
                pipeline.layout,
                number,
                &[set],
                &[],
            )
        };
    }

    pub(crate) fn push_constants(&self, pipeline: Pipeline, bytes: &[u8]) {
        if !bytes.is_empty() {
            // SAFETY: as above; the bytes have the size that the layout declares, both from the same SPIR-V.
            unsafe { self.device.raw.cmd_push_constants(self.commands, pipeline.layout, pipeline.stages, 0, bytes) };
        }
    }

    pub(crate) fn dispatch(&self, groups: [u32; 3]) {
        // SAFETY: a compute pipeline and its sets are bound; the graph checks the group count against the limits.
        unsafe { self.device.raw.cmd_dispatch(self.commands, groups[0], groups[1], groups[2]) };
    }

    pub(crate) fn dispatch_indirect(&self, buffer: &Buffer, offset: u64) {
        // SAFETY: as above; the buffer holds three words at `offset`.
        unsafe { self.device.raw.cmd_dispatch_indirect(self.commands, buffer.raw, offset) };
    }

    pub(crate) fn begin_rendering(&self, attachments: &Attachments) {
        let convert = |attachment: &Attachment| {
            let load =
                if attachment.clear.is_some() { vk::AttachmentLoadOp::CLEAR } else { vk::AttachmentLoadOp::LOAD };
            let store = if attachment.store { vk::AttachmentStoreOp::STORE } else { vk::AttachmentStoreOp::NONE };
            let info =
                vk::RenderingAttachmentInfo::default().image_view(attachment.view).image_layout(attachment.layout);
            info.load_op(load).store_op(store).clear_value(attachment.clear.unwrap_or_default())
        };
        let colors: Vec<_> = attachments
            .colors
            .iter()
            .map(|color| color.as_ref().map_or_else(vk::RenderingAttachmentInfo::default, convert))
            .collect();
        let (depth, stencil) = (attachments.depth.as_ref().map(convert), attachments.stencil.as_ref().map(convert));
        let [width, height] = attachments.extent;
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        let mut info = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&colors);
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        if let Some(stencil) = &stencil {
            info = info.stencil_attachment(stencil);
        }
        // SAFETY: the command buffer is recording outside a render pass; the views are alive and in the layouts given.
        unsafe { self.device.raw.cmd_begin_rendering(self.commands, &info) };
    }

    pub(crate) fn end_rendering(&self) {
        // SAFETY: begun by `begin_rendering`.
        unsafe { self.device.raw.cmd_end_rendering(self.commands) };
    }

    /// `viewport`: x, y, width, height; drawing is cut off at `scissor`: x, y, width, height.
    pub(crate) fn viewport(&self, viewport: [f32; 4], scissor: [u32; 4]) {
        let [x, y, width, height] = viewport;
        let viewport = vk::Viewport { x, y, width, height, min_depth: 0.0, max_depth: 1.0 };
        let [x, y, width, height] = scissor;
        let offset = vk::Offset2D { x: i32::try_from(x).unwrap_or(i32::MAX), y: i32::try_from(y).unwrap_or(i32::MAX) };
        let scissor = vk::Rect2D { offset, extent: vk::Extent2D { width, height } };
        // SAFETY: the command buffer is recording.
        unsafe {
            self.device.raw.cmd_set_viewport(self.commands, 0, &[viewport]);
            self.device.raw.cmd_set_scissor(self.commands, 0, &[scissor]);
        }
    }

    pub(crate) fn bind_vertices(&self, buffers: &[&Buffer], indices: Option<&Buffer>) {
        let raw: Vec<_> = buffers.iter().map(|buffer| buffer.raw).collect();
        // SAFETY: the command buffer is recording; the buffers are alive.
        unsafe {
            if !raw.is_empty() {
                self.device.raw.cmd_bind_vertex_buffers(self.commands, 0, &raw, &vec![0; raw.len()]);
            }
            if let Some(indices) = indices {
                self.device.raw.cmd_bind_index_buffer(self.commands, indices.raw, 0, vk::IndexType::UINT32);
            }
        }
    }

    pub(crate) fn draw(&self, vertices: u32, instances: u32) {
        // SAFETY: a raster pipeline and its sets are bound within a render pass.
        unsafe { self.device.raw.cmd_draw(self.commands, vertices, instances, 0, 0) };
    }

    pub(crate) fn draw_indexed(&self, indices: u32, first_index: u32, vertex_offset: i32, instance: u32) {
        // SAFETY: as above; index and vertex ranges were checked when the scene was loaded.
        unsafe { self.device.raw.cmd_draw_indexed(self.commands, indices, 1, first_index, vertex_offset, instance) };
    }

    pub(crate) fn draw_indirect(&self, buffer: &Buffer, offset: u64, count: u32) {
        let at_once = if self.device.survey.features.multi_draw_indirect == vk::TRUE { count } else { 1 };
        let mut first = 0;
        while first < count {
            let offset = offset + u64::from(first) * 16;
            // SAFETY: as above; the buffer holds `count` commands of four words at `offset`.
            unsafe { self.device.raw.cmd_draw_indirect(self.commands, buffer.raw, offset, at_once, 16) };
            first += at_once;
        }
    }

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

    pub(crate) fn clear_image(&self, image: &Image, mip: u32, value: vk::ClearColorValue) {
        let range = vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            base_mip_level: mip,
            level_count: 1,
            base_array_layer: 0,
            layer_count: vk::REMAINING_ARRAY_LAYERS,
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

    /// Copies one mip level of every layer to `buffer`, rows close together.
    pub(crate) fn read_image(&self, image: &Image, mip: u32, buffer: &Buffer, offset: u64) {
        let regions = [copy_region(image, mip, 0, image.info.layers, offset)];
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
            let [width, height, _] = image.info.extent.map(|length| i32::try_from((length >> mip).max(1)).unwrap_or(1));
            [vk::Offset3D::default(), vk::Offset3D { x: width, y: height, z: 1 }]
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

fn write_descriptor_set(
    device: &Device,
    pool: vk::DescriptorPool,
    layout: vk::DescriptorSetLayout,
    bindings: &[(u32, BindingKind, Descriptor)],
) -> Result<vk::DescriptorSet, VulkanError> {
    let layouts = [layout];
    let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
    // SAFETY: pool and layout are alive.
    let set = unsafe { device.raw.allocate_descriptor_sets(&info) }.called("vkAllocateDescriptorSets")?[0];
    enum Info {
        Image([vk::DescriptorImageInfo; 1]),
        Texels([vk::BufferView; 1]),
        Buffer([vk::DescriptorBufferInfo; 1]),
    }
    let infos: Vec<Info> = bindings
        .iter()
        .map(|(_, _, descriptor)| match *descriptor {
            Descriptor::Image { view, layout, sampler } => {
                Info::Image([vk::DescriptorImageInfo { sampler, image_view: view, image_layout: layout }])
            }
            Descriptor::Texels(view) => Info::Texels([view]),
            Descriptor::Buffer(buffer) => {
                Info::Buffer([vk::DescriptorBufferInfo { buffer, offset: 0, range: vk::WHOLE_SIZE }])
            }
        })
        .collect();
    let writes: Vec<_> = bindings
        .iter()
        .zip(&infos)
        .map(|((binding, kind, _), info)| {
            let write = vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(*binding)
                .descriptor_count(1)
                .descriptor_type(kind.descriptor_type());
            match info {
                Info::Image(info) => write.image_info(info),
                Info::Texels(views) => write.texel_buffer_view(views),
                Info::Buffer(info) => write.buffer_info(info),
            }
        })
        .collect();
    // SAFETY: the set was just made and is not in use; everything the writes point to is alive.
    unsafe { device.raw.update_descriptor_sets(&writes, &[]) };
    Ok(set)
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

/// Descriptor sets that outlive a frame: what materials bind for their draws.
pub(crate) struct MaterialSets {
    device: Arc<Device>,
    pool: vk::DescriptorPool,
    sets: Vec<vk::DescriptorSet>,
}

impl MaterialSets {
    /// One set for each element of `materials`, all with `layout`.
    pub(crate) fn new(
        device: &Arc<Device>,
        layout: vk::DescriptorSetLayout,
        materials: &[Vec<(u32, BindingKind, Descriptor)>],
    ) -> Result<MaterialSets, VulkanError> {
        let count = u32::try_from(materials.len()).unwrap_or(u32::MAX).max(1);
        let sizes =
            [vk::DescriptorPoolSize { ty: vk::DescriptorType::COMBINED_IMAGE_SAMPLER, descriptor_count: count * 8 }];
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(count).pool_sizes(&sizes);
        // SAFETY: the device is alive.
        let pool =
            unsafe { device.raw.create_descriptor_pool(&info, None) }.called("vkCreateDescriptorPool for materials")?;
        let mut made = MaterialSets { device: device.clone(), pool, sets: Vec::new() };
        for bindings in materials {
            made.sets.push(write_descriptor_set(device, pool, layout, bindings)?);
        }
        Ok(made)
    }

    pub(crate) fn get(&self, index: usize) -> vk::DescriptorSet {
        self.sets[index]
    }
}

impl Drop for MaterialSets {
    fn drop(&mut self) {
        // SAFETY: the last frame that used the sets has finished (module invariant).
        unsafe { self.device.raw.destroy_descriptor_pool(self.pool, None) };
    }
}
