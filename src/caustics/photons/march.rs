//! Photon rays marched over the pixels of the scene's lists (glsl/photon_lists/march.comp).

use ash::vk;

use super::scene_lists::SceneLists;
use crate::frame::photons::records::{DISPATCH_WORD, PhotonRays, STAGE_WORDS};
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::photon_lists::{March, MarchPush};

/// Finds what the rays hit; `counts` holds how many there are.
pub(crate) fn trace(graph: &mut Graph<'_>, lists: &SceneLists, rays: &PhotonRays, counts: BufferRef<u32>) {
    let words = vk::Format::R32G32B32A32_UINT;
    // Steps taken, rays that hit nothing, and those cut off at a bound that none should reach.
    let work = graph.buffer::<u32>(&format!("photons.march_work.{}", rays.stage), 3);
    graph.fill_buffer(&format!("caustics/photons/trace/march-clear.{}", rays.stage), work, 0);
    let pass = March {
        rays: rays.rays.texels(words),
        photon_lists: lists.group(),
        blocks: lists.blocks.slices.texels(words),
        counts: counts.read(),
        hits: rays.hits.start(),
        work: work.read_write(),
        push: MarchPush {
            resolution: lists.resolution,
            view_count: lists.view_count,
            stage: rays.stage as u32,
            capacity: rays.capacity,
            top: lists.blocks.top,
            first_of_level: lists.blocks.first_of_level,
        },
    };
    graph
        .pass(&format!("caustics/photons/trace/march.{}", rays.stage), pass)
        .count("steps", work, 0)
        .count("misses", work, 1)
        .count("cut off", work, 2)
        .threads_indirect(counts, STAGE_WORDS * rays.stage + DISPATCH_WORD);
}
