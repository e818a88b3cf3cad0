//! The image: the sum of the slots. And slots that come from estimators.

use std::sync::Arc;

use ash::vk;

use super::gbuffer::GBuffer;
use crate::graph::bindings::{ImageRef, SampledImage};
use crate::graph::{Dependence, Graph, hash_of};
use crate::shaders::compose::{Estimate, EstimatePush, Image, ImagePush};
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

/// Bytes of means that one pass takes: what every device lets a kernel see of one buffer.
pub(crate) const MEANS_AT_ONCE: usize = 1 << 27;

/// Declares the passes that take a slot from an estimator's means, three floats a pixel, row by row, whose content `key` names. A pass takes as many
/// rows as `bytes_at_once` hold.
pub(crate) fn estimated(
    graph: &mut Graph<'_>,
    slot: Slot,
    size: [u32; 2],
    (means, key): (&Arc<[u8]>, u64),
    bytes_at_once: usize,
) -> ImageRef {
    let all = Dependence::GEOMETRY | Dependence::MATERIALS | Dependence::LIGHTS | Dependence::CAMERA;
    let image = graph.image(&format!("estimate.{slot}"), vk::Format::R32G32B32A32_SFLOAT, size);
    let row_bytes = 3 * size_of::<f32>() * size[0] as usize;
    let rows_at_once = (bytes_at_once / row_bytes).max(1);
    for (part, rows) in means.chunks(rows_at_once * row_bytes).enumerate() {
        let whole = rows.len() == means.len();
        let name = if part == 0 { format!("{slot}") } else { format!("{slot}-{}", part + 1) };
        let shared = if whole { means.clone() } else { rows.into() };
        let held = graph.upload_shared::<f32>(&format!("estimate.{name}.means"), shared, hash_of(&(key, part)), all);
        let push = EstimatePush { first_row: (part * rows_at_once) as u32, row_count: (rows.len() / row_bytes) as u32 };
        let slot = match part {
            _ if whole => image.write(),
            0 => image.start(),
            _ => image.modify(),
        };
        let pass = Estimate { means: held.read(), slot, push };
        graph.pass(&format!("compose/estimate-{name}"), pass).pixels([size[0], push.row_count]);
    }
    image
}
