//! Photons through the scene's hierarchy of triangles: what they hit, exactly.

use ash::vk;

use super::records::{DISPATCH_WORD, PhotonRays, STAGE_WORDS};
use crate::frame::rays::{TracedBindings, TracedScene};
use crate::frame::scene_data::SceneData;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::photons::{Trace, TracePush};

/// From render space to that of the traced scene.
pub(crate) fn shift(data: &SceneData, traced: &TracedScene) -> [f32; 3] {
    (data.origin - traced.origin).as_vec3().to_array()
}

/// Fills the rays' hits.
pub(crate) fn trace(
    graph: &mut Graph<'_>,
    data: &SceneData,
    traced: &TracedScene,
    scene: &TracedBindings,
    rays: &PhotonRays,
    counts: BufferRef<u32>,
) {
    let pass = Trace {
        rays: rays.rays.texels(vk::Format::R32G32B32A32_UINT),
        counts: counts.texels(vk::Format::R32_UINT),
        bvh_nodes: scene.bvh_nodes.clone(),
        bvh_triangles: scene.bvh_triangles.clone(),
        hits: rays.hits.write(),
        triangles: scene.triangles.clone(),
        corner_colors: scene.corner_colors.clone(),
        corner_texcoords: scene.corner_texcoords.clone(),
        materials: scene.materials.clone(),
        material_textures: scene.material_textures.clone(),
        texture_table: scene.texture_table.clone(),
        texels: scene.texels.clone(),
        alpha_masks: u32::from(traced.facts.alpha_masked),
        vertex_colors: u32::from(traced.facts.vertex_colors),
        push: TracePush { shift: shift(data, traced), stage: rays.stage as u32 },
    };
    let name = format!("caustics/photons/trace.{}", rays.stage);
    graph.pass(&name, pass).threads_indirect(counts, STAGE_WORDS * rays.stage + DISPATCH_WORD);
}
