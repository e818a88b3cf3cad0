//! Photons through the scene's hierarchy of triangles: what they hit, exactly.

use ash::vk;

use super::records::{DISPATCH_WORD, PhotonRays, STAGE_WORDS};
use super::turn::Sending;
use crate::frame::rays::TracedScene;
use crate::frame::scene_data::SceneData;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::groups::SceneRays;
use crate::shaders::photons::{Trace, TracePush};

/// From render space to that of the traced scene.
pub(crate) fn shift(data: &SceneData, traced: &TracedScene) -> [f32; 3] {
    (data.origin - traced.origin).as_vec3().to_array()
}

/// Fills the rays' hits.
pub(crate) fn trace(
    graph: &mut Graph<'_>,
    data: &SceneData,
    sending: &Sending,
    (traced, scene): (&TracedScene, &SceneRays),
    (rays, counts): (&PhotonRays, BufferRef<u32>),
) {
    let pass = Trace {
        scene_rays: scene.clone(),
        rays: rays.rays.texels(vk::Format::R32G32B32A32_UINT),
        counts: counts.texels(vk::Format::R32_UINT),
        hits: rays.hits.start(),
        push: TracePush { shift: shift(data, traced), stage: rays.stage as u32 },
    };
    let name = sending.pass(&format!("trace/bvh.{}", rays.stage));
    graph.pass(&name, pass).threads_indirect(counts, STAGE_WORDS * rays.stage + DISPATCH_WORD);
}
