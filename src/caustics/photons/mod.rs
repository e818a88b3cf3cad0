//! `photons`: caustics by photons that leave the specular surfaces which lights see (Quyen 2014, section 3.3).
//!
//! The light views tell where light first meets a specular surface, and how much. Photons are drawn from there by flux, reflected or
//! refracted, traced through the scene, and land on diffuse surfaces; at specular ones they go on, up to the number of bounces. All counts
//! stay on the device.

mod bvh;
mod choose;
mod discs;
mod emit;
mod grid;
mod inputs;
mod land;
mod layers;
pub(crate) mod lines;
mod list_views;
pub(crate) mod lists;
pub(crate) mod march;
mod options;
pub(crate) mod records;
pub(crate) mod scene_lists;
pub(crate) mod splat;
mod splat_tiles;
pub(crate) mod sums;
mod tiles;
mod upsample;
mod views;

use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use emit::Arrivals;
use records::{LandedPhotons, PhotonRays};
use splat::{SplatInputs, splat};

pub(crate) use self::inputs::PhotonInputs;
pub use self::options::{
    ListProjection, PhotonFootprint, PhotonGeometry, PhotonKernel, PhotonSettings, PhotonSplatting, PhotonTracing,
};

/// What every device lets a kernel see of one buffer, bytes.
const LARGEST_BUFFER: u32 = 1 << 27;
/// The largest record of a photon at a specular surface (glsl/photons/beam.glsl), and where it lands (glsl/photon_splat/disc.glsl).
const ARRIVAL_BYTES: u32 = 80;
const DISC_BYTES: u32 = 48;

/// Declares the method's passes in the order in which they run; returns the slot.
pub(crate) fn photons(graph: &mut Graph<'_>, inputs: &PhotonInputs<'_>) -> Option<ImageRef> {
    if inputs.settings.trace == PhotonTracing::Bvh && inputs.traced.is_none() {
        graph.skip("caustics/photons", "no scene to trace photons through");
        return None;
    }
    let traced = trace_all(graph, inputs);
    let splatted = SplatInputs {
        buffer: inputs.buffer,
        settings: inputs.settings,
        length: inputs.data.radius,
        tiles_at_once: sums::TILES_AT_ONCE,
    };
    Some(splat(graph, &splatted, &traced.landed))
}

/// Photons where they landed, and what led there.
pub(crate) struct TracedPhotons {
    pub(crate) landed: LandedPhotons,
    /// What the device chose (glsl/photons/choice.glsl).
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) choice: BufferRef<u32>,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) arrival_counts: BufferRef<u32>,
    /// Photons at the surfaces that the last stage's rays leave: those which lights see, if there is one bounce.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) arrivals: BufferRef<[u32; 4]>,
    /// The rays of the last stage.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) rays: PhotonRays,
}

/// Photons from the specular surfaces that lights see to where they land. At most `max`, and as many as fit into one buffer if all land at
/// every bounce.
pub(crate) fn trace_all(graph: &mut Graph<'_>, inputs: &PhotonInputs<'_>) -> TracedPhotons {
    let settings = inputs.settings;
    let stages = settings.bounces.max(1) as usize;
    let capacity = settings
        .max
        .min(LARGEST_BUFFER / ARRIVAL_BYTES)
        .min(LARGEST_BUFFER / DISC_BYTES / settings.bounces.max(1))
        .max(1);
    let views = views::specular_views(graph, inputs);
    let choice = choose::choose(graph, inputs.set, &views, capacity, stages);
    let landed = LandedPhotons::declare(graph, choice.counts, stages, capacity * settings.bounces.max(1));
    let arrivals = Arrivals::declare(graph, capacity);
    let by_triangles = settings.trace == PhotonTracing::Bvh;
    let lists = (!by_triangles).then(|| {
        lists::build(
            graph,
            &scene_lists::ListInputs {
                data: inputs.data,
                geometry: inputs.geometry,
                camera: Some(inputs.camera),
                settings,
            },
        )
    });
    let scene = inputs.traced.filter(|_| by_triangles).map(|traced| (traced, traced.import(graph)));
    let through = scene.as_ref().map(|(traced, bindings)| (*traced, bindings));
    emit::emit(graph, inputs, &views, &choice, arrivals);
    let all_rays = PhotonRays::declare(graph, 0, capacity);
    let mut rays = all_rays;
    for stage in 0..stages {
        rays = PhotonRays { stage, ..all_rays };
        emit::scatter(graph, inputs, &choice, arrivals, &rays);
        match (through, lists) {
            (Some((traced, bindings)), _) => bvh::trace(graph, inputs.data, traced, bindings, &rays, choice.counts),
            (None, Some(lists)) if settings.trace == PhotonTracing::Lines => {
                lines::trace(graph, &lists, &rays, choice.counts);
            }
            (None, Some(lists)) => march::trace(graph, &lists, &rays, choice.counts),
            (None, None) => unreachable!("photons() has seen that there is something to trace through"),
        }
        land::land(graph, inputs, through, &choice, &rays, (&landed, arrivals));
    }
    TracedPhotons {
        landed,
        choice: choice.choice,
        arrival_counts: choice.arrival_counts,
        arrivals: arrivals.arrivals,
        rays,
    }
}
