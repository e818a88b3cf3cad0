//! Where photons meet surfaces: they land on diffuse ones, and go on from specular ones.

use ash::vk;

use super::bvh::shift;
use super::choose::Choice;
use super::records::{DISPATCH_WORD, PhotonRays, STAGE_WORDS};
use super::turn::Sending;
use super::ways::Ways;
use crate::frame::inputs::FrameInputs;
use crate::graph::Graph;
use crate::shaders::groups::Landing;
use crate::shaders::photons::{Land, LandTraced};
use crate::shaders::types::LandingStage;

const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const WORDS: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Lands the photons of a stage.
pub(super) fn land(
    graph: &mut Graph<'_>,
    frame: &FrameInputs<'_>,
    sending: &Sending,
    (ways, rays): (&Ways<'_>, &PhotonRays),
) {
    let Ways { choice, landed, arrivals: next, scene, .. } = ways;
    let data = frame.data;
    let name = sending.pass(&format!("trace/land.{}", rays.stage));
    // The first stage starts the list, the others add to it.
    let photons = if rays.stage == 0 { landed.photons.start() } else { landed.photons.modify() };
    let ellipses = if rays.stage == 0 { landed.ellipses.start() } else { landed.ellipses.modify() };
    let push = LandingStage {
        shift: scene.map_or([0.0; 3], |(traced, _)| shift(data, traced)),
        stage: rays.stage as u32,
        goes_on: u32::from(rays.stage + 1 < landed.stage),
        landed_stage: landed.stage as u32,
        capacity: rays.capacity,
        landed_capacity: landed.capacity,
        radius: data.radius as f32,
        disc_scale: sending.discs.scale,
        beams_decide: u32::from(sending.discs.by_beams),
    };
    let landing = Landing {
        rays: rays.rays.texels(RECORDS),
        hits: rays.hits.texels(RECORDS),
        choice: choice.choice.texels(WORDS),
        photons,
        arrivals: next.arrivals.start(),
        surfaces: next.surfaces.start(),
        counts: choice.counts.read_write(),
        arrival_counts: choice.arrival_counts.read_write(),
        beams: rays.beams.texels(FLOATS),
        arrival_beams: next.beams.start(),
        ellipses,
    };
    let geometry = frame.geometry.clone();
    let pass = match scene.map(|(_, rays)| rays.clone()) {
        None => graph.pass(&name, Land { geometry, landing, push }),
        Some(scene_rays) => graph.pass(&name, LandTraced { geometry, landing, scene_rays, push }),
    };
    pass.unordered()
        .count("landed so far", choice.counts, Choice::count_word(landed.stage))
        .threads_indirect(choice.counts, STAGE_WORDS * rays.stage + DISPATCH_WORD);
}
