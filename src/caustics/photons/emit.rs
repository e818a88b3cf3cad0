//! Photons at specular surfaces: made where light meets the first, and sent on from each.

use ash::vk;

use super::choose::{CHOICE_EMIT, Choice};
use super::options::{PhotonFootprint, PhotonOptions};
use super::records::{PhotonRays, STAGE_WORDS};
use super::views::SpecularViews;
use crate::frame::light_set::LightSet;
use crate::frame::view_layout::TILE;
use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph};
use crate::method::FrameCx;
use crate::shaders::groups::Lobes;
use crate::shaders::photons::{Emit, EmitPush, Scatter, ScatterPush};

const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const WORDS: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

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

/// The view of each square of 16x16 texels of the atlas; 0 where there is none, and no flux either.
fn views_of_tiles(set: &LightSet) -> (Vec<u32>, u32) {
    let [columns, rows] = set.atlas.size.map(|side| side.div_ceil(TILE).max(1));
    let mut views = vec![0; (columns * rows) as usize];
    for tile in &set.atlas.tiles {
        let [column, row] = tile.origin.map(|at| at.cast_unsigned() / TILE);
        views[(row * columns + column) as usize] = tile.view;
    }
    (views, columns)
}

pub(crate) fn emit(cx: &mut FrameCx<'_, '_>, views: &SpecularViews, choice: &Choice, made: Arrivals) {
    let (tiles, tiles_per_row) = views_of_tiles(cx.frame.set);
    let (lights, graph) = (cx.lights(), &mut *cx.graph);
    let tile_views = graph.upload("photons.tile_views", &tiles, Dependence::LIGHTS);
    let pass = Emit {
        geometry: cx.frame.geometry.clone(),
        light_views: lights.group.clone(),
        mask: views.mask.sampled(),
        levels: choice.levels.clone(),
        pyramid: choice.pyramid.texels(WORDS),
        choice: choice.choice.texels(WORDS),
        blocks: choice.blocks.texels(WORDS),
        tile_views: tile_views.texels(WORDS),
        specular_surface: views.surface.sampled(),
        specular_layer: views.layer.sampled(),
        arrivals: made.arrivals.start(),
        surfaces: made.surfaces.start(),
        arrival_beams: made.beams.start(),
        push: EmitPush { tiles_per_row, radius: cx.frame.data.radius as f32 },
    };
    graph.pass("caustics/photons/trace/emit", pass).threads_indirect(choice.choice, CHOICE_EMIT);
}

/// Sends the photons that arrived on as the rays of a stage.
pub(crate) fn scatter(
    cx: &mut FrameCx<'_, '_>,
    options: &PhotonOptions,
    choice: &Choice,
    arrived: Arrivals,
    rays: &PhotonRays,
) {
    let pass = Scatter {
        arrivals: arrived.arrivals.texels(RECORDS),
        surfaces: arrived.surfaces.texels(RECORDS),
        arrival_counts: choice.arrival_counts.texels(WORDS),
        rays: rays.rays.start(),
        arrival_beams: arrived.beams.texels(FLOATS),
        beams: rays.beams.start(),
        counts: choice.counts.read_write(),
        lobes: Lobes { specular_lobes: 1, transmissive: u32::from(cx.frame.facts.transmissive) },
        first: u32::from(rays.stage == 0),
        push: ScatterPush {
            stage: rays.stage as u32,
            capacity: rays.capacity,
            beams_decide: u32::from(options.footprint == PhotonFootprint::Beam),
        },
    };
    cx.graph
        .pass(&format!("caustics/photons/trace/scatter.{}", rays.stage), pass)
        .unordered()
        .count("rays", choice.counts, Choice::count_word(rays.stage))
        .threads_indirect(choice.arrival_counts, STAGE_WORDS * rays.stage);
}
