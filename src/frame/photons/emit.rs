//! Photons at specular surfaces: made where light meets the first, and sent on from each.

use ash::vk;

use super::choose::Choice;
use super::records::{DISPATCH_WORD, PhotonRays, STAGE_WORDS};
use super::turn::Sending;
use super::ways::Ways;
use crate::frame::inputs::FrameInputs;
use crate::graph::Graph;
use crate::shaders::groups::Lobes;
use crate::shaders::photons::{Emit, EmitPush, Scatter, ScatterPush};

const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const WORDS: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

pub(super) fn emit(graph: &mut Graph<'_>, frame: &FrameInputs<'_>, sending: &Sending, ways: &Ways<'_>) {
    let (views, choice, made) = (ways.views, ways.choice, ways.arrivals);
    let turn = sending.turn;
    let pass = Emit {
        geometry: frame.geometry.clone(),
        light_views: frame.light_views().group.clone(),
        mask: views.mask.sampled(),
        levels: choice.levels.clone(),
        pyramid: choice.pyramid.texels(WORDS),
        choice: choice.choice.texels(WORDS),
        blocks: choice.blocks.texels(WORDS),
        tile_views: choice.tile_views.clone(),
        specular_surface: views.surface.sampled(),
        specular_layer: views.layer.sampled(),
        arrivals: made.arrivals.start(),
        surfaces: made.surfaces.start(),
        arrival_beams: made.beams.start(),
        push: EmitPush {
            tiles_per_row: choice.tiles_per_row,
            radius: frame.data.radius as f32,
            first: turn.first,
            stride: turn.stride,
        },
    };
    graph.pass(&sending.pass("trace/emit"), pass).threads_indirect(choice.arrival_counts, DISPATCH_WORD);
}

/// Sends the photons that arrived on as the rays of a stage.
pub(super) fn scatter(
    graph: &mut Graph<'_>,
    frame: &FrameInputs<'_>,
    sending: &Sending,
    (ways, rays): (&Ways<'_>, &PhotonRays),
) {
    let (choice, arrived) = (ways.choice, ways.arrivals);
    let pass = Scatter {
        arrivals: arrived.arrivals.texels(RECORDS),
        surfaces: arrived.surfaces.texels(RECORDS),
        arrival_counts: choice.arrival_counts.texels(WORDS),
        rays: rays.rays.start(),
        arrival_beams: arrived.beams.texels(FLOATS),
        beams: rays.beams.start(),
        counts: choice.counts.read_write(),
        lobes: Lobes { specular_lobes: 1, transmissive: u32::from(frame.facts.transmissive) },
        first: u32::from(rays.stage == 0),
        push: ScatterPush {
            stage: rays.stage as u32,
            capacity: rays.capacity,
            beams_decide: u32::from(sending.discs.by_beams),
        },
    };
    graph
        .pass(&sending.pass(&format!("trace/scatter.{}", rays.stage)), pass)
        .unordered()
        .count("rays", choice.counts, Choice::count_word(rays.stage))
        .threads_indirect(choice.arrival_counts, STAGE_WORDS * rays.stage);
}
