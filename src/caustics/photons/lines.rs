//! Photon rays drawn as lines over the scene's lists (Quyen 2014, section 3.3.2.2).

use ash::vk;

use super::scene_lists::SceneLists;
use crate::frame::photons::records::{DISPATCH_WORD, PhotonRays, STAGE_WORDS};
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::photon_lists::{
    LineArguments, LineArgumentsPush, Lines, LinesPush, LinesResolve, LinesResolvePush,
};
use crate::vulkan::RasterState;

/// Words of the arguments of a draw.
const DRAW_WORDS: usize = 4;

/// Finds what the rays hit; `counts` holds how many there are.
pub(crate) fn trace(graph: &mut Graph<'_>, lists: &SceneLists, rays: &PhotonRays, counts: BufferRef<u32>) {
    let words = vk::Format::R32G32B32A32_UINT;
    let stage = rays.stage;
    let arguments = graph.buffer::<u32>(&format!("photons.line_arguments.{stage}"), DRAW_WORDS);
    let push = LineArgumentsPush { stage: stage as u32, capacity: rays.capacity };
    let pass = LineArguments { counts: counts.read(), arguments: arguments.write(), push };
    graph.pass(&format!("caustics/photons/trace/lines-arguments.{stage}"), pass).groups([1, 1, 1]);
    graph.fill_buffer(&format!("caustics/photons/trace/lines-clear.{stage}"), rays.hits, u32::MAX);
    for view_index in 0..lists.view_count {
        let pass = Lines {
            rays: rays.rays.texels(words),
            photon_lists: lists.group(),
            hits: rays.hits.read_write(),
            push: LinesPush { view_index, resolution: lists.resolution },
        };
        let state = RasterState { topology: vk::PrimitiveTopology::LINE_LIST, ..RasterState::default() };
        graph
            .raster(&format!("caustics/photons/trace/lines.{stage}.{view_index}"), pass, state)
            .area([lists.resolution; 2])
            .draw_indirect(arguments, 0, 1);
    }
    let resolve = LinesResolve {
        rays: rays.rays.texels(words),
        photon_lists: lists.group(),
        hits: rays.hits.read_write(),
        counts: counts.read(),
        push: LinesResolvePush {
            resolution: lists.resolution,
            view_count: lists.view_count,
            stage: stage as u32,
            capacity: rays.capacity,
        },
    };
    graph
        .pass(&format!("caustics/photons/trace/lines-resolve.{stage}"), resolve)
        .threads_indirect(counts, STAGE_WORDS * stage + DISPATCH_WORD);
}
