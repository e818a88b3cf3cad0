//! Lists of the particles by which irradiance is read around each.

use super::formats::WORD;
use super::stage::Stage;
use crate::graph::Graph;
use crate::graph::bindings::TexelBuffer;
use crate::shaders::particles::{List, ListPush};

/// Makes the lists, each of a fixed room.
pub(super) fn list(graph: &mut Graph<'_>, stage: &Stage) {
    let Stage { particle_count, placed, kept, moved, .. } = stage;
    let (lists, lengths, key) = (kept.lists, kept.list_lengths, kept.key());
    let counts = graph.buffer::<u32>("particles.list_counts", 3);
    graph.fill_buffer("diffuse/particles/lists/clear", counts, 0);
    let pass = List {
        scene_rays: placed.rays.clone(),
        particles: placed.group.clone(),
        lists: if moved.is_some() { lists.read_write() } else { lists.start_then_read() },
        lengths: if moved.is_some() { lengths.read_write() } else { lengths.start_then_read() },
        counts: counts.read_write(),
        touched: moved.as_ref().map_or_else(TexelBuffer::absent, |moved| moved.touched.texels(WORD)),
        push: ListPush { particle_count: *particle_count, again: u32::from(moved.is_some()) },
    };
    let pass = graph.pass("diffuse/particles/lists/list", pass).leaves(lists, key).leaves(lengths, key);
    pass.count("entries", counts, 0)
        .count("shortened", counts, 1)
        .count("left out", counts, 2)
        .threads(stage.threads());
}
