//! What a pass binds on the device: pipelines, descriptors, attachments.

use std::sync::Arc;

use ash::vk;

use super::bindings::{Access, BufferUse, ImageUse};
use super::declare::Graph;
use super::needs::{READ_ONLY_DEPTH, layout_of};
use super::pass::{ClearColor, Pass, Targets};
use super::resource::Body;
use crate::vulkan::program::{BindingKind, ImageDim};
use crate::vulkan::{
    Attachment, Attachments, Buffer, Descriptor, Image, Pipeline, SubresourceView, TargetFormats, TexelFormats,
    VulkanError,
};

impl Graph<'_> {
    pub(super) fn memory_of_image(&self, id: usize) -> Arc<Image> {
        match &self.resources[id].body {
            Body::ExternalImage(image) => image.clone(),
            _ => self.store.images[&self.resources[id].name].image.clone(),
        }
    }

    pub(super) fn memory_of_buffer(&self, id: usize) -> Arc<Buffer> {
        match &self.resources[id].body {
            Body::ExternalBuffer(buffer) => buffer.clone(),
            _ => self.store.buffers[&self.resources[id].name].buffer.clone(),
        }
    }

    pub(super) fn bind(&self, pass: &Pass, targets: Option<&TargetFormats>) -> Result<Pipeline, VulkanError> {
        let program = pass.program.expect("transfers bind nothing");
        let pipelines = &self.store.pipelines;
        let recorder = &self.store.recorder;
        let texels = texel_formats(pass);
        let pipeline = match (&pass.raster, targets) {
            (Some((state, _)), Some(targets)) => {
                pipelines.raster(program, &pass.constants, (state, targets), texels)?
            }
            _ => pipelines.compute(program, &pass.constants, texels)?,
        };
        recorder.bind_pipeline(pipeline);
        let mut descriptors = Vec::new();
        for (number, access) in &pass.bindings {
            let kind = program.binding(*number).kind;
            descriptors.push((*number, kind, self.descriptor(access, kind)?));
        }
        if !descriptors.is_empty() {
            let set = recorder.descriptor_set(pipelines.set_layout(program, 0)?, &descriptors)?;
            recorder.bind_set(pipeline, 0, set);
        }
        recorder.push_constants(pipeline, &pass.push);
        Ok(pipeline)
    }

    fn descriptor(&self, access: &Access, kind: BindingKind) -> Result<Descriptor, VulkanError> {
        Ok(match access {
            Access::Image { image, part, usage } => {
                let image = self.memory_of_image(*image);
                let (BindingKind::SampledImage(dim) | BindingKind::StorageImage(dim)) = kind else {
                    unreachable!("typed by the generated bindings")
                };
                let aspect = image.info.aspect() & !vk::ImageAspectFlags::STENCIL;
                let aspect = if aspect.is_empty() { image.info.aspect() } else { aspect };
                let (mips, layers, format) = (part.mips.clone(), part.layers.clone(), image.info.format);
                let view = image.view(&SubresourceView { dim, mips, layers, aspect, format })?;
                match usage {
                    ImageUse::Sampled(sampler) => {
                        let sampler = self.store.pipelines.sampler(*sampler)?;
                        let holds_depth = image.info.aspect() != vk::ImageAspectFlags::COLOR;
                        Descriptor::Image { view, layout: layout_of(*usage, holds_depth), sampler }
                    }
                    _ => Descriptor::Image { view, layout: vk::ImageLayout::GENERAL, sampler: vk::Sampler::null() },
                }
            }
            Access::Buffer { buffer, usage: BufferUse::Texels(format) } => {
                let buffer = self.memory_of_buffer(*buffer);
                buffer.texels(*format)?.map_or(Descriptor::Buffer(buffer.raw), Descriptor::Texels)
            }
            Access::Buffer { buffer, .. } => Descriptor::Buffer(self.memory_of_buffer(*buffer).raw),
        })
    }

    pub(super) fn attachments(&self, targets: &Targets) -> Result<Attachments, VulkanError> {
        let view = |access: &Access,
                    aspect: vk::ImageAspectFlags|
         -> Result<(vk::ImageView, vk::Format, vk::ImageLayout), VulkanError> {
            let Access::Image { image, part, usage } = access else { unreachable!("attachments are images") };
            let image = self.memory_of_image(*image);
            // Attachments of an image that holds both depth and stencil share one view of both.
            let aspect = if aspect == vk::ImageAspectFlags::COLOR { aspect } else { image.info.aspect() };
            let what = SubresourceView {
                dim: ImageDim::D2,
                mips: part.mips.start..part.mips.start + 1,
                layers: part.layers.start..part.layers.start + 1,
                aspect,
                format: image.info.format,
            };
            Ok((image.view(&what)?, image.info.format, layout_of(*usage, true)))
        };
        let mut made = Attachments { extent: targets.extent, ..Attachments::default() };
        for color in &targets.colors {
            let Some((access, clear)) = color else {
                made.colors.push(None);
                made.formats.colors.push(vk::Format::UNDEFINED);
                continue;
            };
            let (view, format, layout) = view(access, vk::ImageAspectFlags::COLOR)?;
            let clear = clear.map(|value| vk::ClearValue { color: clear_value(value) });
            made.colors.push(Some(Attachment { view, layout, clear, store: true }));
            made.formats.colors.push(format);
        }
        if let Some((access, clear)) = &targets.depth {
            let (view, format, layout) = view(access, vk::ImageAspectFlags::DEPTH)?;
            let clear =
                clear.map(|depth| vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 } });
            made.depth = Some(Attachment { view, layout, clear, store: layout != READ_ONLY_DEPTH });
            made.formats.depth = format;
        }
        if let Some((access, clear)) = &targets.stencil {
            let (view, format, layout) = view(access, vk::ImageAspectFlags::STENCIL)?;
            let clear = clear
                .map(|stencil| vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 0.0, stencil } });
            made.stencil = Some(Attachment { view, layout, clear, store: layout != READ_ONLY_DEPTH });
            made.formats.stencil = format;
        }
        Ok(made)
    }
}

/// What the bindings that are read as texels hold.
fn texel_formats(pass: &Pass) -> TexelFormats {
    let bindings = pass.bindings.iter();
    let texels = bindings.filter_map(|(number, access)| match access {
        Access::Buffer { usage: BufferUse::Texels(format), .. } => Some((*number, *format)),
        _ => None,
    });
    texels.collect()
}

pub(super) fn clear_value(value: ClearColor) -> vk::ClearColorValue {
    match value {
        ClearColor::Float(float32) => vk::ClearColorValue { float32 },
        ClearColor::Uint(uint32) => vk::ClearColorValue { uint32 },
    }
}
