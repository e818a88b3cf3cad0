//! The buffers that photons live in on their way (glsl/photons/records.glsl), and the counts that go with them.
//!
//! Every buffer holds texels of four words, so that kernels read it as a texel buffer. `counts` has eight words a stage: the arguments of
//! an indirect dispatch of groups of 64 (3), the count, and the arguments of an indirect draw of six vertices an instance (4). Stage b is
//! that of the rays which leave the specular surface number b, counted from 0; the last stage is that of the photons.

use crate::graph::Graph;
use crate::graph::bindings::BufferRef;

/// What every device lets a kernel see of one buffer, bytes.
pub(crate) const LARGEST_BUFFER: u32 = 1 << 27;
/// The largest record of a photon at a specular surface (glsl/photons/beam.glsl).
pub(crate) const ARRIVAL_BYTES: u32 = 80;
// The arithmetic of shares takes no more photons (glsl/photons/shares.glsl).
const _: () = assert!(LARGEST_BUFFER / ARRIVAL_BYTES < 1 << 21);

/// Words of a stage in `counts`.
pub(crate) const STAGE_WORDS: usize = 8;
/// Where a stage's arguments of an indirect dispatch, its count, and its arguments of an indirect draw are.
pub(crate) const DISPATCH_WORD: usize = 0;
pub(crate) const COUNT_WORD: usize = 3;
pub(crate) const DRAW_WORD: usize = 4;

/// Texels of four words.
const RAY_TEXELS: usize = 3;
const PHOTON_TEXELS: usize = 2;
const RAY_BEAM_TEXELS: usize = 3;

/// Photons that reached a specular surface (glsl/photons/arrivals.glsl).
#[derive(Clone, Copy)]
pub(crate) struct Arrivals {
    pub(crate) arrivals: BufferRef<[u32; 4]>,
    pub(crate) surfaces: BufferRef<[u32; 4]>,
    /// How the photons beside each run (glsl/photons/beam.glsl).
    pub(crate) beams: BufferRef<[f32; 4]>,
}

impl Arrivals {
    pub(crate) fn declare(graph: &mut Graph<'_>, capacity: u32) -> Arrivals {
        Arrivals {
            arrivals: graph.buffer("photons.arrivals", 3 * capacity as usize),
            surfaces: graph.buffer("photons.surfaces", 2 * capacity as usize),
            beams: graph.buffer("photons.arrival_beams", 5 * capacity as usize),
        }
    }
}

/// Rays of one stage, and what they hit.
#[derive(Clone, Copy)]
pub(crate) struct PhotonRays {
    pub(crate) rays: BufferRef<[u32; 4]>,
    /// One texel a ray, as words, since the nearest hit may be found by an atomic minimum.
    pub(crate) hits: BufferRef<u32>,
    /// How the rays beside each run (glsl/photons/beam.glsl).
    pub(crate) beams: BufferRef<[f32; 4]>,
    pub(crate) stage: usize,
    pub(crate) capacity: u32,
}

/// Photons where they landed.
#[derive(Clone, Copy)]
pub(crate) struct LandedPhotons {
    pub(crate) photons: BufferRef<[u32; 4]>,
    /// Of each, the direction and the length of the smaller radius of its disc (glsl/photons/records.glsl).
    pub(crate) ellipses: BufferRef<[f32; 4]>,
    pub(crate) counts: BufferRef<u32>,
    pub(crate) stage: usize,
    pub(crate) capacity: u32,
}

impl PhotonRays {
    pub(crate) fn declare(graph: &mut Graph<'_>, stage: usize, capacity: u32) -> PhotonRays {
        PhotonRays {
            rays: graph.buffer(&format!("photons.rays.{stage}"), RAY_TEXELS * capacity as usize),
            hits: graph.buffer(&format!("photons.hits.{stage}"), 4 * capacity as usize),
            beams: graph.buffer(&format!("photons.beams.{stage}"), RAY_BEAM_TEXELS * capacity as usize),
            stage,
            capacity,
        }
    }
}

impl LandedPhotons {
    pub(crate) fn declare(graph: &mut Graph<'_>, counts: BufferRef<u32>, stage: usize, capacity: u32) -> LandedPhotons {
        let photons = graph.buffer("photons.landed", PHOTON_TEXELS * capacity as usize);
        let ellipses = graph.buffer("photons.ellipses", capacity as usize);
        LandedPhotons { photons, ellipses, counts, stage, capacity }
    }
}
