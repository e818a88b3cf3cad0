//! What passes make of programs and formats, for the test of the table of what methods need (src/renderer/limits.rs).

use ash::vk;

use super::bindings::{Access, BufferUse, ImageUse};
use super::declare::Graph;
use super::resource::Body;
use crate::vulkan::SamplerKind;

/// A pass that ran: its piece, its program, and each format with what an image or a texel buffer of it served for.
#[derive(Clone, Debug)]
pub(crate) struct ProgramUse {
    pub(crate) piece: String,
    pub(crate) program: &'static str,
    pub(crate) images: Vec<(vk::Format, vk::FormatFeatureFlags)>,
    pub(crate) texels: Vec<vk::Format>,
}

impl Graph<'_> {
    pub(super) fn note_program(&mut self, index: usize) {
        let pass = &self.passes[index];
        let Some(program) = pass.program else { return };
        let mut noted =
            ProgramUse { piece: pass.piece.clone(), program: program.name, images: Vec::new(), texels: Vec::new() };
        let additive = pass.raster.as_ref().is_some_and(|(state, _)| state.additive);
        let targets = pass.raster.iter().flat_map(|(_, targets)| {
            let colors = targets.colors.iter().flatten().map(|(access, _)| access);
            let depth = targets.depth.iter().map(|(access, _)| access);
            colors.chain(depth).chain(targets.stencil.iter().map(|(access, _)| access))
        });
        for access in pass.bindings.iter().map(|(_, access)| access).chain(targets) {
            match access {
                Access::Image { image, usage, .. } => {
                    let format = match &self.resources[*image].body {
                        Body::Image(info) => info.format,
                        Body::ExternalImage(image) => image.info.format,
                        _ => continue,
                    };
                    noted.images.push((format, features_of(*usage, additive)));
                }
                Access::Buffer { usage: BufferUse::Texels(format), .. } => noted.texels.push(*format),
                Access::Buffer { .. } => {}
            }
        }
        self.store.uses.push(noted);
    }
}

fn features_of(usage: ImageUse, additive: bool) -> vk::FormatFeatureFlags {
    use vk::FormatFeatureFlags as Feature;
    match usage {
        ImageUse::Sampled(SamplerKind::NearestClamp) => Feature::SAMPLED_IMAGE,
        ImageUse::Sampled(_) => Feature::SAMPLED_IMAGE | Feature::SAMPLED_IMAGE_FILTER_LINEAR,
        ImageUse::Color { .. } if additive => Feature::COLOR_ATTACHMENT | Feature::COLOR_ATTACHMENT_BLEND,
        ImageUse::Color { .. } => Feature::COLOR_ATTACHMENT,
        ImageUse::StorageRead | ImageUse::StorageWrite | ImageUse::StorageStart | ImageUse::StorageModify => {
            Feature::STORAGE_IMAGE
        }
        ImageUse::Depth { .. } | ImageUse::DepthTest => Feature::DEPTH_STENCIL_ATTACHMENT,
        _ => Feature::empty(),
    }
}
