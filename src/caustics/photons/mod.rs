//! `photons`: caustics by photons that leave the specular surfaces which lights see (Quyen 2014, section 3.3).
//!
//! Where photons start and how they go on is the business of `frame/photons/`; here is what they are traced through, if it is lists of pixels, and how they become
//! irradiance.

mod discs;
mod grid;
mod layers;
pub(crate) mod lines;
mod list_views;
pub(crate) mod lists;
pub(crate) mod march;
pub(crate) mod options;
pub(crate) mod scene_lists;
pub(crate) mod splat;
mod splat_tiles;
pub(crate) mod sums;
mod tiles;
mod upsample;

use self::options::{PhotonFootprint, PhotonGeometry, PhotonOptions, PhotonSplatting, PhotonTracing};
use self::splat::{SplatInputs, TOLERANCE, splat};
use crate::frame::inputs::FrameInputs;
use crate::frame::light_views::Views;
use crate::frame::mirrored::MirroredPoints;
use crate::frame::photons::field::{Widths, light_mirrored};
use crate::frame::photons::kept::keep;
use crate::frame::photons::records::{ARRIVAL_BYTES, Arrivals, LARGEST_BUFFER, LandedPhotons, PhotonRays};
use crate::frame::photons::turn::{Discs, Sending, Turn};
use crate::frame::photons::ways::Ways;
use crate::frame::photons::{bvh, choose, send, views};
use crate::frame::scene_data::SceneData;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{CausticPaths, LightPaths, Slot};

/// Of the passes that light what mirrors show.
const MIRRORED: &str = "caustics/photons/mirrored";
/// Of a photon where it lands (glsl/photon_splat/disc.glsl).
const DISC_BYTES: u32 = 48;

/// Photons that are sent, of `options.max`.
fn held(options: &PhotonOptions) -> u32 {
    options.max.min(LARGEST_BUFFER / ARRIVAL_BYTES).min(LARGEST_BUFFER / DISC_BYTES / options.bounces.max(1))
}

/// Photons from the specular surfaces that lights see, splatted.
pub(crate) struct Photons;

impl Method for Photons {
    const NAME: &'static str = "photons";
    const SLOT: Slot = Slot::Caustics;
    type Options = PhotonOptions;
    const LIGHTS_MIRRORED: bool = true;

    fn light_paths(options: &PhotonOptions) -> LightPaths {
        LightPaths { bounces: Some(options.bounces), caustics: CausticPaths::Specular, mirrors: None }
    }

    fn inputs(options: &PhotonOptions) -> Inputs {
        let rays = if options.trace == PhotonTracing::Bvh { Rays::ToSurfaces } else { Rays::None };
        Inputs { light_depth: Views::All, rays, ..Inputs::default() }
    }

    fn shaders(options: &PhotonOptions, _: bool) -> Vec<&'static str> {
        let choose =
            ["photons/pyramid", "photons/choose", "photons/start", "photons/mark", "photons/number", "photons/list"];
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
            "photons/keep",
            "photons/field*",
            "buckets/starts",
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
        // Hits among triangles are on their surfaces.
        let length = if options.trace == PhotonTracing::Bvh { 0.0 } else { cx.frame.data.reach };
        if cx.frame.offers.get::<MirroredPoints>().is_some() {
            let kept = keep(cx.graph, MIRRORED, &traced.landed);
            let widths = Widths { radius: 0.0, scale: 1.0, tolerance: (length * TOLERANCE) as f32 };
            light_mirrored(cx.graph, cx.frame, MIRRORED, kept, widths);
        }
        let splatted = SplatInputs { buffer: cx.frame.surface, options, length, tiles_at_once: sums::TILES_AT_ONCE };
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
    let sending = Sending {
        piece: "caustics/photons",
        turn: Turn::ALL,
        stages: options.bounces.max(1) as usize,
        discs: discs_of(options, data),
    };
    let capacity = held(options).max(1);
    let views = views::specular_views(cx.graph, cx.frame, sending.piece);
    let choice = choose::choose(cx.graph, set, &sending, &views, capacity);
    let by_triangles = options.trace == PhotonTracing::Bvh;
    let lists = (!by_triangles)
        .then(|| lists::build(cx.graph, &scene_lists::ListInputs { data, geometry, camera: Some(camera), options }));
    let scene = cx.rays().filter(|_| by_triangles).map(|traced| (traced, traced.rays(cx.graph)));
    let through = scene.as_ref().map(|(traced, bindings)| (*traced, bindings));
    let landed_capacity = capacity * options.bounces.max(1);
    let ways = Ways {
        views: &views,
        choice: &choice,
        arrivals: Arrivals::declare(cx.graph, capacity),
        rays: PhotonRays::declare(cx.graph, 0, capacity),
        landed: LandedPhotons::declare(cx.graph, choice.counts, sending.stages, landed_capacity),
        scene: through,
    };
    send(cx.graph, cx.frame, &sending, &ways, |graph, rays| match (through, lists) {
        (Some(scene), _) => bvh::trace(graph, data, &sending, scene, (rays, choice.counts)),
        (None, Some(lists)) if options.trace == PhotonTracing::Lines => {
            lines::trace(graph, &lists, rays, choice.counts);
        }
        (None, Some(lists)) => march::trace(graph, &lists, rays, choice.counts),
        (None, None) => unreachable!("the hierarchy is there for a method that says it sends rays"),
    });
    TracedPhotons {
        landed: ways.landed,
        choice: choice.choice,
        arrival_counts: choice.arrival_counts,
        arrivals: ways.arrivals.arrivals,
        rays: PhotonRays { stage: sending.stages - 1, ..ways.rays },
    }
}

fn discs_of(options: &PhotonOptions, data: &SceneData) -> Discs {
    match options.footprint {
        PhotonFootprint::Way => {
            Discs { scale: (options.radius * data.area.sqrt() / data.radius) as f32, by_beams: false }
        }
        PhotonFootprint::Beam => Discs { scale: options.radius as f32, by_beams: true },
    }
}
