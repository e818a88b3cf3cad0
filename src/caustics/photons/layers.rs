//! The nearest surfaces of each texel by depth peeling (Krüger et al. 2006), as lists of at most as many nodes. What lies behind them is not
//! there, and photons that should land on it pass through.

use ash::vk;

use super::list_views::ListView;
use super::scene_lists::{ListInputs, SceneLists, draw_views, is_solid};
use crate::frame::geometry::{Attributes, DrawView, draw_list};
use crate::frame::scene_data::DrawnInstance;
use crate::graph::bindings::ImageRef;
use crate::graph::{ClearColor, Graph};
use crate::shaders::photon_lists::{Layer, LayerPush, Peel, PeelMasked};

/// Bits of the float that is infinitely far: no surface follows.
const FARTHEST: u32 = 0x7F80_0000;

/// Declares `count` passes of peeling.
pub(super) fn peel(graph: &mut Graph<'_>, inputs: &ListInputs<'_>, lists: &SceneLists, views: &[ListView], count: u32) {
    let SceneLists { resolution, view_count, .. } = *lists;
    let size = [resolution, resolution * view_count];
    let depth = graph.image("photons.layers.depth", vk::Format::D32_SFLOAT, size);
    let layers = ["photons.layers.even", "photons.layers.odd"]
        .map(|name| graph.image(name, vk::Format::R32G32B32A32_UINT, size));
    let draw_views = draw_views(views, lists);
    let peeling = Peeling { inputs, lists, draw_views: &draw_views, depth };
    // The first layer follows the eye.
    graph.clear_image("caustics/photons/lists/layers-clear", layers[1], ClearColor::Uint([0; 4]));
    if inputs.data.drawn.iter().all(is_solid) {
        graph.skip("caustics/photons/lists/layers-masked", "no surface cut out by its alpha");
    }
    // The pool starts empty, so that what it held does not matter.
    graph.fill_buffer("caustics/photons/lists/layers-clear-nodes", lists.nodes, 0);
    for number in 0..count {
        let (layer, previous) = (layers[number as usize % 2], layers[(number as usize + 1) % 2]);
        peeling.draw(graph, number, layer, previous);
        let pixel_count = resolution * resolution * view_count;
        let pass = Layer {
            layer: layer.sampled(),
            pixels: lists.pixels.read_write(),
            node_count: lists.node_count.read_write(),
            nodes: lists.nodes.read_write(),
            push: LayerPush { number, pixel_count },
        };
        graph
            .pass(&format!("caustics/photons/lists/layers-append.{number}"), pass)
            .unordered()
            .count("nodes", lists.node_count, 0)
            .threads([pixel_count, 1, 1]);
    }
}

struct Peeling<'a> {
    inputs: &'a ListInputs<'a>,
    lists: &'a SceneLists,
    draw_views: &'a [DrawView],
    depth: ImageRef,
}

impl Peeling<'_> {
    fn draw(&self, graph: &mut Graph<'_>, number: u32, layer: ImageRef, previous: ImageRef) {
        let ListInputs { data, geometry, .. } = *self.inputs;
        let solid = Peel {
            geometry: geometry.clone(),
            photon_lists: self.lists.group(),
            previous: previous.sampled(),
            push: self.lists.drawn(0),
        };
        let list = draw_list(data, Attributes::Depth, self.draw_views, is_solid);
        let name = format!("caustics/photons/lists/layers.{number}");
        graph
            .raster(&name, solid, Attributes::Depth.raster_state(data))
            .note("views", u64::from(self.lists.view_count))
            .depth(self.depth, Some(0.0))
            .color(layer, Some(ClearColor::Uint([FARTHEST, 0, 0, 0])))
            .draw(list);
        let cut = |drawn: &DrawnInstance| !is_solid(drawn);
        if !data.drawn.iter().any(cut) {
            return;
        }
        let masked = PeelMasked {
            geometry: geometry.clone(),
            photon_lists: self.lists.group(),
            previous: previous.sampled(),
            textures: data.texture_kinds(cut),
            push: self.lists.drawn(0),
        };
        let list = draw_list(data, Attributes::DepthMasked, self.draw_views, cut);
        graph
            .raster(
                &format!("caustics/photons/lists/layers-masked.{number}"),
                masked,
                Attributes::DepthMasked.raster_state(data),
            )
            .depth(self.depth, None)
            .color(layer, None)
            .draw(list);
    }
}
