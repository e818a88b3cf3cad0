//! Photons where they landed, as records that need nothing else (glsl/photons/kept.glsl).

use ash::vk;

use super::records::LandedPhotons;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::photons::{Keep, KeepPush};

const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const WORDS: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Of a photon.
pub(crate) const KEPT_TEXELS: usize = 3;

/// Photons where they landed.
#[derive(Clone, Copy)]
pub(crate) struct KeptPhotons {
    /// [`KEPT_TEXELS`] each.
    pub(crate) photons: BufferRef<[u32; 4]>,
    /// Places; some hold none.
    pub(crate) count: u32,
}

/// Declares the pass that keeps all photons that landed.
pub(crate) fn keep(graph: &mut Graph<'_>, level: &str, landed: &LandedPhotons) -> KeptPhotons {
    let kept = KeptPhotons {
        photons: graph.buffer("photons.kept", KEPT_TEXELS * landed.capacity as usize),
        count: landed.capacity,
    };
    let dropped = graph.buffer::<u32>("photons.kept_dropped", 1);
    graph.fill_buffer(&format!("{level}/clear-dropped"), dropped, 0);
    let pass = Keep {
        landed: landed.photons.texels(RECORDS),
        ellipses: landed.ellipses.texels(FLOATS),
        counts: landed.counts.texels(WORDS),
        photons: kept.photons.write(),
        dropped: dropped.read_write(),
        push: KeepPush { landed_stage: landed.stage as u32, first: 0, capacity: landed.capacity },
    };
    let pass = graph.pass(&format!("{level}/keep"), pass);
    pass.count("dropped", dropped, 0).threads([landed.capacity, 1, 1]);
    kept
}
