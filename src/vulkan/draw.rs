//! Commands that run pipelines: dispatches and draws, and what is bound for them.

#![allow(unsafe_code, reason = "every Vulkan command is an unsafe call")]

use ash::vk;

use super::memory::Buffer;
use super::pipelines::{Pipeline, TargetFormats};
use super::recorder::Recorder;

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

impl Recorder {
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
        let at_once = if self.device.survey.features.core.multi_draw_indirect == vk::TRUE { count } else { 1 };
        let mut first = 0;
        while first < count {
            let offset = offset + u64::from(first) * 16;
            // SAFETY: as above; the buffer holds `count` commands of four words at `offset`.
            unsafe { self.device.raw.cmd_draw_indirect(self.commands, buffer.raw, offset, at_once, 16) };
            first += at_once;
        }
    }
}
