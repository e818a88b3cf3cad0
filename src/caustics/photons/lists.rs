//! The scene as per-pixel lists: all surfaces behind each texel of a few views (Quyen 2014, section 3.3.2.1, after Yang et al. 2010), or the
//! nearest of them (`layers`), and which depths of a block of texels are occupied.
//!
//! Nobody knows the number of nodes before the lists are drawn. The pool starts with some for every texel; what does not fit is counted all the
//! same, and the frame is made again with a pool that holds it ([`Graph::grows`]). Layers have a node for every texel, a number known beforehand.

use super::layers;
use super::list_views::{ListView, list_views};
use super::options::{ListProjection, PhotonGeometry};
use super::scene_lists::{Blocks, ListInputs, MOST_LEVELS, SceneLists, draw_views, is_solid};
use crate::frame::geometry::{Attributes, draw_list};
use crate::frame::scene_data::DrawnInstance;
use crate::graph::{Dependence, Graph};
use crate::shaders::photon_lists::{Append, AppendMasked, Coarser, CoarserPush, Occupancy, OccupancyPush};
use crate::vulkan::RasterState;

/// The pool's first size, nodes for each texel of each view.
const NODES_PER_TEXEL: u32 = 4;
/// A block of level l covers 4^l × 4^l texels (glsl/photon_lists/slices.glsl).
const LEVEL_BITS: u32 = 2;
/// The coarsest level has so many blocks to a side at least.
const COARSEST: u32 = 4;

/// Declares the passes that make the lists.
pub(crate) fn build(graph: &mut Graph<'_>, inputs: &ListInputs<'_>) -> SceneLists {
    let options = inputs.options;
    let views = match options.projection {
        ListProjection::Camera => 1,
        ListProjection::Scene => options.views,
    };
    let per_texel = match options.geometry {
        PhotonGeometry::Lists => NODES_PER_TEXEL,
        PhotonGeometry::Layers(count) => count,
    };
    build_from(graph, inputs, (per_texel * views * options.resolution * options.resolution) as usize)
}

/// As [`build`], with a pool of so many nodes at first.
pub(crate) fn build_from(graph: &mut Graph<'_>, inputs: &ListInputs<'_>, pool: usize) -> SceneLists {
    let resolution = inputs.options.resolution;
    let views = list_views(inputs.data, inputs.camera, inputs.options);
    let texels: Vec<[f32; 4]> = views.iter().flat_map(|view| view.texels.map(|texel| texel.to_array())).collect();
    let depends = match inputs.options.projection {
        ListProjection::Camera => Dependence::CAMERA,
        ListProjection::Scene => Dependence::GEOMETRY,
    };
    let view_count = views.len() as u32;
    let pixel_count = (resolution * resolution) as usize * views.len();
    let (top, first_of_level, block_count) = levels(resolution, view_count);
    let lists = SceneLists {
        resolution,
        view_count,
        views: graph.upload("photons.lists.views", &texels, depends),
        pixels: graph.buffer("photons.lists.pixels", 4 * pixel_count),
        nodes: match inputs.options.geometry {
            PhotonGeometry::Lists => graph.growing_buffer("photons.lists.nodes", pool),
            PhotonGeometry::Layers(_) => graph.buffer("photons.lists.nodes", pool),
        },
        node_count: graph.buffer("photons.lists.node_count", 1),
        blocks: Blocks { slices: graph.buffer("photons.lists.blocks", block_count), top, first_of_level },
    };
    graph.fill_buffer("caustics/photons/lists/clear", lists.pixels, u32::MAX);
    graph.fill_buffer("caustics/photons/lists/clear-count", lists.node_count, 0);
    match inputs.options.geometry {
        PhotonGeometry::Lists => {
            append(graph, inputs, &lists, &views);
            graph.grows(lists.nodes, lists.node_count, 0);
        }
        PhotonGeometry::Layers(count) => layers::peel(graph, inputs, &lists, &views, count),
    }
    occupy(graph, &lists);
    lists
}

/// The coarsest level, where each level's blocks start, and how many there are.
fn levels(resolution: u32, view_count: u32) -> (u32, [u32; MOST_LEVELS], usize) {
    let side = |level: u32| resolution.div_ceil(1 << (LEVEL_BITS * level));
    let top = (1..MOST_LEVELS as u32).take_while(|&level| side(level + 1) >= COARSEST).count() as u32 + 1;
    let mut first_of_level = [0; MOST_LEVELS];
    let mut count = 0;
    for (level, first) in (1..=top).zip(&mut first_of_level) {
        *first = count;
        count += view_count * side(level) * side(level);
    }
    (top, first_of_level, count as usize)
}

/// A pass without attachments: every fragment goes into its texel's list, in whatever order.
fn append(graph: &mut Graph<'_>, inputs: &ListInputs<'_>, lists: &SceneLists, views: &[ListView]) {
    let ListInputs { data, geometry, .. } = *inputs;
    let SceneLists { resolution, view_count, .. } = *lists;
    let draw_views = draw_views(views, lists);
    let area = [resolution, resolution * view_count];
    let state = |attributes: Attributes| RasterState { depth: None, ..attributes.raster_state(data) };
    let solid = Append {
        geometry: geometry.clone(),
        photon_lists: lists.group(),
        pixels: lists.pixels.read_write(),
        node_count: lists.node_count.read_write(),
        nodes: lists.nodes.start(),
        push: lists.drawn(0),
    };
    let list = draw_list(data, Attributes::Depth, &draw_views, is_solid);
    let pass = graph.raster("caustics/photons/lists/draw", solid, state(Attributes::Depth));
    pass.unordered()
        .note("views", u64::from(view_count))
        .note("capacity", lists.nodes.count() as u64)
        .count("nodes", lists.node_count, 0)
        .area(area)
        .draw(list);
    if data.drawn.iter().all(is_solid) {
        graph.skip("caustics/photons/lists/draw-masked", "no surface cut out by its alpha");
        return;
    }
    let cut = |drawn: &DrawnInstance| !is_solid(drawn);
    let masked = AppendMasked {
        geometry: geometry.clone(),
        photon_lists: lists.group(),
        pixels: lists.pixels.read_write(),
        node_count: lists.node_count.read_write(),
        nodes: lists.nodes.read_write(),
        textures: data.texture_kinds(cut),
        push: lists.drawn(0),
    };
    let list = draw_list(data, Attributes::DepthMasked, &draw_views, cut);
    let pass = graph.raster("caustics/photons/lists/draw-masked", masked, state(Attributes::DepthMasked));
    pass.unordered().count("nodes", lists.node_count, 0).area(area).draw(list);
}

/// Which depths are occupied, for the march.
fn occupy(graph: &mut Graph<'_>, lists: &SceneLists) {
    let SceneLists { resolution, view_count, blocks, .. } = *lists;
    let threads = |level: u32| {
        let side = resolution.div_ceil(1 << (LEVEL_BITS * level));
        [view_count * side * side, 1, 1]
    };
    let finest = Occupancy {
        photon_lists: lists.group(),
        blocks: blocks.slices.start(),
        push: OccupancyPush { resolution, view_count },
    };
    graph.pass("caustics/photons/lists/blocks.1", finest).threads(threads(1));
    for level in 2..=blocks.top {
        let first = |level: u32| blocks.first_of_level[level as usize - 1];
        let push = CoarserPush { resolution, view_count, level, first: first(level), first_finer: first(level - 1) };
        let coarser = Coarser { blocks: blocks.slices.read_write(), push };
        graph.pass(&format!("caustics/photons/lists/blocks.{level}"), coarser).threads(threads(level));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_where_four_blocks_stand_side_by_side() {
        for (resolution, top) in [(16, 1), (64, 2), (100, 2), (128, 2), (256, 3), (1024, 4)] {
            assert_eq!(levels(resolution, 3).0, top, "{resolution}");
        }
        assert_eq!(levels(128, 3), (2, [0, 3 * 32 * 32, 0, 0], 3 * (32 * 32 + 8 * 8)));
    }
}
