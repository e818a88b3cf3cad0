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
mod land;
mod layers;
pub(crate) mod lines;
mod list_views;
pub(crate) mod lists;
pub(crate) mod march;
pub(crate) mod options;
pub(crate) mod records;
pub(crate) mod scene_lists;
pub(crate) mod splat;
mod splat_tiles;
pub(crate) mod sums;
mod tiles;
mod upsample;
mod views;

use self::emit::Arrivals;
use self::options::{PhotonGeometry, PhotonOptions, PhotonSplatting, PhotonTracing};
use self::records::{LandedPhotons, PhotonRays};
use self::splat::{SplatInputs, splat};
use crate::frame::inputs::FrameInputs;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{CausticPaths, LightPaths, Slot};

/// What every device lets a kernel see of one buffer, bytes.
const LARGEST_BUFFER: u32 = 1 << 27;
/// The largest record of a photon at a specular surface (glsl/photons/beam.glsl), and where it lands (glsl/photon_splat/disc.glsl).
const ARRIVAL_BYTES: u32 = 80;
const DISC_BYTES: u32 = 48;

/// Photons that are sent, of `options.max`.
fn held(options: &PhotonOptions) -> u32 {
    options.max.min(LARGEST_BUFFER / ARRIVAL_BYTES).min(LARGEST_BUFFER / DISC_BYTES / options.bounces.max(1))
}
// The arithmetic of shares takes no more (glsl/photons/shares.glsl).
const _: () = assert!(LARGEST_BUFFER / ARRIVAL_BYTES < 1 << 21);

/// Photons from the specular surfaces that lights see, splatted.
pub(crate) struct Photons;

impl Method for Photons {
    const NAME: &'static str = "photons";
    const SLOT: Slot = Slot::Caustics;
    type Options = PhotonOptions;

    fn light_paths(options: &PhotonOptions) -> LightPaths {
        LightPaths { bounces: Some(options.bounces), caustics: CausticPaths::Specular, mirrors: None }
    }

    fn inputs(options: &PhotonOptions) -> Inputs {
        let rays = if options.trace == PhotonTracing::Bvh { Rays::ToSurfaces } else { Rays::None };
        Inputs { light_depth: true, rays, ..Inputs::default() }
    }

    fn shaders(options: &PhotonOptions, _: bool) -> Vec<&'static str> {
        let choose = ["photons/pyramid", "photons/choose", "photons/mark", "photons/number", "photons/list"];
        let mut shaders = [&choose[..], &["photons/specular*", "photons/emit", "photons/scatter"]].concat();
        if options.trace == PhotonTracing::Bvh {
            shaders.extend(["photons/trace", "photons/land_traced"]);
        } else {
            shaders.push("photons/land");
            match options.geometry {
                PhotonGeometry::Lists => shaders.push("photon_lists/append*"),
                PhotonGeometry::Layers(_) => shaders.extend(["photon_lists/peel*", "photon_lists/layer"]),
            }
            match options.trace {
                PhotonTracing::Lines => shaders.push("photon_lists/line*"),
                _ => shaders.extend(["photon_lists/march", "photon_lists/occupancy", "photon_lists/coarser"]),
            }
        }
        shaders.extend([
            "photon_splat/start",
            "photon_splat/project",
            "photon_splat/touch",
            "photon_splat/clear",
            "photon_splat/resolve",
        ]);
        match options.splat {
            PhotonSplatting::Discs => shaders.push("photon_splat/discs"),
            _ => shaders.extend(["photon_splat/scan", "photon_splat/scatter", "photon_splat/gather"]),
        }
        if options.downscale != 1 {
            shaders.push("photon_splat/upsample");
        }
        shaders
    }

    fn skip(options: &PhotonOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.specular, facts.diffuse, options.max.min(options.bounces)) {
            (false, ..) => Some("no specular or transmissive surface"),
            (_, false, _) => Some("no diffuse surface"),
            (.., 0) => Some("no photons asked for"),
            _ => None,
        }
    }

    fn reduced(options: &PhotonOptions) -> Option<String> {
        let (max, held) = (options.max, held(options));
        (held < max).then(|| {
            format!(
                "photons.max is {max}, but buffers hold {held} at photons.bounces {}: so many are sent",
                options.bounces
            )
        })
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &PhotonOptions) -> Result<Option<ImageRef>, Error> {
        let traced = trace_all(cx, options);
        let splatted = SplatInputs {
            buffer: cx.frame.surface,
            options,
            // Hits among triangles are on their surfaces.
            length: if options.trace == PhotonTracing::Bvh { 0.0 } else { cx.frame.data.reach },
            tiles_at_once: sums::TILES_AT_ONCE,
        };
        Ok(Some(splat(cx.graph, &splatted, &traced.landed)))
    }
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

/// Photons from the specular surfaces that lights see to where they land: `max` of them, or as many as fit into one buffer if all land at
/// every bounce.
pub(crate) fn trace_all(cx: &mut FrameCx<'_, '_>, options: &PhotonOptions) -> TracedPhotons {
    let FrameInputs { data, geometry, camera, set, .. } = *cx.frame;
    let stages = options.bounces.max(1) as usize;
    let capacity = held(options).max(1);
    let views = views::specular_views(cx);
    let choice = choose::choose(cx.graph, set, &views, capacity, stages);
    let landed = LandedPhotons::declare(cx.graph, choice.counts, stages, capacity * options.bounces.max(1));
    let arrivals = Arrivals::declare(cx.graph, capacity);
    let by_triangles = options.trace == PhotonTracing::Bvh;
    let lists = (!by_triangles)
        .then(|| lists::build(cx.graph, &scene_lists::ListInputs { data, geometry, camera: Some(camera), options }));
    let scene = cx.rays().filter(|_| by_triangles).map(|traced| (traced, traced.rays(cx.graph)));
    let through = scene.as_ref().map(|(traced, bindings)| (*traced, bindings));
    emit::emit(cx, &views, &choice, arrivals);
    let all_rays = PhotonRays::declare(cx.graph, 0, capacity);
    let mut rays = all_rays;
    for stage in 0..stages {
        rays = PhotonRays { stage, ..all_rays };
        emit::scatter(cx, options, &choice, arrivals, &rays);
        match (through, lists) {
            (Some((traced, bindings)), _) => bvh::trace(cx.graph, data, traced, bindings, &rays, choice.counts),
            (None, Some(lists)) if options.trace == PhotonTracing::Lines => {
                lines::trace(cx.graph, &lists, &rays, choice.counts);
            }
            (None, Some(lists)) => march::trace(cx.graph, &lists, &rays, choice.counts),
            (None, None) => unreachable!("the hierarchy is there for a method that says it sends rays"),
        }
        land::land(cx, options, through, &choice, &rays, (&landed, arrivals));
    }
    TracedPhotons {
        landed,
        choice: choice.choice,
        arrival_counts: choice.arrival_counts,
        arrivals: arrivals.arrivals,
        rays,
    }
}
