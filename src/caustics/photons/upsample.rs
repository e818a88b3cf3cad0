//! From irradiance at every second or fourth pixel to the slot (Quyen 2014, section 3.3.2.4).

use super::splat::{Splat, TILES_WORD};
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::photon_splat::{Upsample, UpsamplePush};

/// Declares the pass.
pub(super) fn upsample(graph: &mut Graph<'_>, splat: &Splat<'_>, slot: ImageRef) {
    let buffer = splat.buffer;
    let (specular, has_specular) = buffer.specular();
    let pass = Upsample {
        camera: buffer.camera.clone(),
        depth: buffer.depth.sampled(),
        surface: buffer.surface.sampled(),
        specular: specular.sampled(),
        state: splat.state_texels(),
        tiles: splat.tile_texels(),
        irradiance: splat.result.sampled(),
        result: slot.modify(),
        push: UpsamplePush { image_size: splat.image_size, downscale: splat.downscale, has_specular },
    };
    graph.pass("caustics/photons/upsample", pass).threads_indirect(splat.state, TILES_WORD);
}
