//! From irradiance at every second or fourth pixel to the slot (Quyen 2014, section 3.3.2.4).

use super::splat_tiles::Splat;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::photon_splat::{Upsample, UpsamplePush};

/// Declares the pass, once for each list of tiles.
pub(super) fn upsample(graph: &mut Graph<'_>, splat: &Splat<'_>, slot: ImageRef) {
    let buffer = splat.buffer;
    let (specular, has_specular) = buffer.specular();
    for &list in splat.lists() {
        let pass = Upsample {
            camera: buffer.camera.clone(),
            depth: buffer.depth.sampled(),
            surface: buffer.surface.sampled(),
            specular: specular.sampled(),
            state: splat.state_texels(),
            tiles: splat.tile_texels(list),
            irradiance: splat.result.sampled(),
            result: slot.modify(),
            push: UpsamplePush {
                image_size: splat.image_size,
                downscale: splat.downscale,
                has_specular,
                list: list.word() as u32,
            },
        };
        graph.pass(&list.pass_name("upsample"), pass).threads_indirect(splat.state, list.word());
    }
}
