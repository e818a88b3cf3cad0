//! The indirect illumination map: final gathering at texels, by rays or by hemicubes.

use super::formats::{FLOATS4, WORD};
use super::hemicube;
use super::options::{LightmapsGather, LightmapsOptions};
use super::texels::{Chosen, LightTexels};
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::lightmaps::{Gather, GatherPush};

/// Steps that the loops of one ray may take: through the hierarchy, and where it ends.
const STEPS: u32 = 1024;

/// Declares passes that gather all texels.
pub(super) fn all(
    graph: &mut Graph<'_>,
    texels: &LightTexels,
    (aim, maps): (BufferRef<[f32; 4]>, u32),
    options: &LightmapsOptions,
) -> BufferRef<[f32; 4]> {
    let gathered = graph.buffer::<[f32; 4]>("lightmaps.gathered", texels.count() * maps as usize);
    graph.fill_buffer("diffuse/lightmaps/iim/clear", gathered, 0);
    gather(graph, texels, (aim, gathered, maps), texels.all(), options);
    gathered
}

/// Declares passes that gather those that are chosen; the others stand.
pub(super) fn gather(
    graph: &mut Graph<'_>,
    texels: &LightTexels,
    maps: (BufferRef<[f32; 4]>, BufferRef<[f32; 4]>, u32),
    chosen: Chosen,
    options: &LightmapsOptions,
) {
    match options.gather {
        LightmapsGather::Rays => by_rays(graph, texels, maps, chosen, options),
        LightmapsGather::Hemicube => hemicube::gather(graph, texels, maps, chosen, options),
    }
}

fn by_rays(
    graph: &mut Graph<'_>,
    texels: &LightTexels,
    (aim, gathered, maps): (BufferRef<[f32; 4]>, BufferRef<[f32; 4]>, u32),
    chosen: Chosen,
    options: &LightmapsOptions,
) {
    let most = ((graph.traits().loop_steps + 1) / STEPS).max(1);
    for (number, first) in (0..options.rays).step_by(most as usize).enumerate() {
        let end = (first + most).min(options.rays);
        let pass = Gather {
            scene_rays: texels.rays.clone(),
            lightmap: texels.group.clone(),
            received: aim.texels(FLOATS4),
            list: chosen.list.texels(WORD),
            head: chosen.head.texels(WORD),
            gathered: gathered.read_write(),
            maps,
            push: GatherPush { first, end, count: options.rays, texel_count: texels.map.count },
        };
        let pass = graph.pass(&format!("diffuse/lightmaps/iim/gather.{number}"), pass);
        let pass = pass.note("rays a texel", u64::from(end - first)).count("texels", chosen.head, 3);
        pass.threads_indirect(chosen.head, 0);
    }
}
