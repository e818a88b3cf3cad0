//! The image: the sum of the slots. And slots that come from estimators.

use std::sync::Arc;

use ash::vk;

use super::gbuffer::GBuffer;
use crate::graph::bindings::{ImageRef, SampledImage};
use crate::graph::{Dependence, Graph};
use crate::shaders::compose::{Estimate, Image, ImagePush};
use crate::slot::Slot;

/// Declares the pass that adds up the slots that there are; a slot that no method fills is `None`.
pub(crate) fn compose(
    graph: &mut Graph<'_>,
    buffer: &GBuffer,
    sky: [f32; 3],
    slot: impl Fn(Slot) -> Option<ImageRef>,
) -> ImageRef {
    let image = graph.image("image", vk::Format::R32G32B32A32_SFLOAT, buffer.size);
    // Where the slot `emission` shows the sky the depth is not read.
    let depth = slot(Slot::Emission).is_none().then_some(buffer.depth);
    let bound = |name: Slot| SampledImage::of(slot(name));
    let present = (0..).zip(Slot::ALL).filter(|(_, name)| slot(*name).is_some()).map(|(bit, _)| 1_u32 << bit).sum();
    let pass = Image {
        depth: SampledImage::of(depth),
        emission: bound(Slot::Emission),
        direct: bound(Slot::Direct),
        diffuse: bound(Slot::Diffuse),
        caustics: bound(Slot::Caustics),
        specular: bound(Slot::Specular),
        image: image.write(),
        push: ImagePush { sky, slots: present },
    };
    graph.pass("compose/image", pass).pixels(buffer.size);
    image
}

/// Declares the pass that takes a slot from an estimator's means, three floats a pixel, whose content `key` names.
pub(crate) fn estimated(graph: &mut Graph<'_>, slot: Slot, size: [u32; 2], means: &Arc<[u8]>, key: u64) -> ImageRef {
    let all = Dependence::GEOMETRY | Dependence::MATERIALS | Dependence::LIGHTS | Dependence::CAMERA;
    let means = graph.upload_shared::<f32>(&format!("estimate.{slot}.means"), means.clone(), key, all);
    let image = graph.image(&format!("estimate.{slot}"), vk::Format::R32G32B32A32_SFLOAT, size);
    let pass = Estimate { means: means.read(), slot: image.write() };
    graph.pass(&format!("compose/estimate-{slot}"), pass).pixels(size);
    image
}
