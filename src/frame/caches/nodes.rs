//! Neighbouring groups of lights together, for caches that see these small (glsl/caches/light_nodes.glsl).

use super::lights::AreaLights;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::caches::{Nodes, NodesPush};

/// Levels above the groups.
const LEVELS: u32 = 3;

/// Declares the pass of that name: spheres around 4, 16 and 64 groups each.
pub(crate) fn nodes(graph: &mut Graph<'_>, name: &str, lights: &AreaLights) -> BufferRef<[f32; 4]> {
    let count: u32 = (1..=LEVELS).map(|level| lights.group_count.div_ceil(1 << (2 * level))).sum();
    let nodes = graph.buffer::<[f32; 4]>(name, count as usize);
    let pass = Nodes {
        area_lights: lights.group.clone(),
        nodes: nodes.start(),
        push: NodesPush { group_count: lights.group_count.cast_signed() },
    };
    graph.pass(name, pass).threads([count, 1, 1]);
    nodes
}
