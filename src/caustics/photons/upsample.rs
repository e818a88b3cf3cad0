//! From irradiance at every second or fourth pixel to the slot (Quyen 2014, section 3.3.2.4).

use super::splat_tiles::Splat;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::photon_splat::{Upsample, UpsamplePush};

/// Declares the pass, once for each list of tiles.
pub(super) fn upsample(graph: &mut Graph<'_>, splat: &Splat<'_>, slot: ImageRef) {
    for &list in splat.lists() {
        let pass = Upsample {
            splat: splat.group(list),
            surface: splat.buffer.group.clone(),
            irradiance: splat.result.sampled(),
            result: slot.modify(),
            push: UpsamplePush { image_size: splat.image_size, downscale: splat.downscale, list: list.word() as u32 },
        };
        graph.pass(&list.pass_name("upsample"), pass).threads_indirect(splat.state, list.word());
    }
}
