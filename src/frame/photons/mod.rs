//! Photons from the specular surfaces that lights see: where they start, and their ways from surface to surface (Quyen 2014, section 3.3.1, and what Larsen & Christensen
//! 2004, section 5, ask of them). What becomes of those that land is the method's business.
//!
//! The light views tell where light first meets a specular surface, and how much. Photons are drawn from there by flux, reflected or refracted, and land on diffuse
//! surfaces; at specular ones they go on, up to the number of stages. All counts stay on the device.

pub(crate) mod bvh;
pub(crate) mod choose;
mod emit;
pub(crate) mod field;
pub(crate) mod kept;
mod land;
pub(crate) mod records;
pub(crate) mod turn;
pub(crate) mod views;
pub(crate) mod ways;

use self::records::PhotonRays;
use self::turn::Sending;
use self::ways::Ways;
use crate::frame::inputs::FrameInputs;
use crate::graph::Graph;

/// Declares the passes from the first specular surfaces to where photons land; `find` declares those that find what the rays of a stage hit.
pub(crate) fn send(
    graph: &mut Graph<'_>,
    frame: &FrameInputs<'_>,
    sending: &Sending,
    ways: &Ways<'_>,
    mut find: impl FnMut(&mut Graph<'_>, &PhotonRays),
) {
    choose::start(graph, sending, ways.choice);
    emit::emit(graph, frame, sending, ways);
    for stage in 0..sending.stages {
        let rays = PhotonRays { stage, ..ways.rays };
        emit::scatter(graph, frame, sending, (ways, &rays));
        find(graph, &rays);
        land::land(graph, frame, sending, (ways, &rays));
    }
}
