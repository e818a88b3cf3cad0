//! The image: the sum of the slots.

use ash::vk;

use super::gbuffer::GBuffer;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::compose::{Image, ImagePush};
use crate::slot::Slot;

/// Declares the pass that adds up the slots that there are; a slot that no method fills is `None`.
pub(crate) fn compose(
    graph: &mut Graph<'_>,
    buffer: &GBuffer,
    sky: [f32; 3],
    slot: impl Fn(Slot) -> Option<ImageRef>,
) -> ImageRef {
    let image = graph.image("image", vk::Format::R32G32B32A32_SFLOAT, buffer.size);
    // What stands for an absent slot is bound but not read.
    let bound = |name: Slot| slot(name).unwrap_or(buffer.depth).sampled();
    let present = (0..).zip(Slot::ALL).filter(|(_, name)| slot(*name).is_some()).map(|(bit, _)| 1_u32 << bit).sum();
    let pass = Image {
        depth: buffer.depth.sampled(),
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
