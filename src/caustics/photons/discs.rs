//! Splatting by drawing a disc a photon: the paper's. Where it blends floats, sums here are 64-bit integers in a buffer, added to by atomics of
//! the fragment shader: blending rounds in the order of photons, which is not the same twice.

use ash::vk;

use super::splat_tiles::{RECORDS, Splat, TileList};
use crate::frame::photons::records::{DRAW_WORD, STAGE_WORDS};
use crate::graph::Graph;
use crate::shaders::photon_splat::{Discs, DiscsPush};
use crate::vulkan::RasterState;

/// Declares the passes that fill `splat.result`.
pub(super) fn discs(graph: &mut Graph<'_>, splat: &Splat<'_>) {
    let landed = &splat.landed;
    let list = TileList::Ordinary;
    for range in splat.ranges(graph) {
        splat.clear_sums(graph, list, range);
        let pass = Discs {
            splat: splat.group(list),
            surface: splat.buffer.group.clone(),
            discs: splat.discs.texels(RECORDS),
            places: splat.places.texels(vk::Format::R32G32_UINT),
            sums: range.sums.read_write(),
            push: DiscsPush {
                image_size: splat.image_size,
                downscale: splat.downscale,
                tolerance: splat.tolerance,
                range: range.ends,
            },
        };
        let state = RasterState { topology: vk::PrimitiveTopology::TRIANGLE_LIST, ..RasterState::default() };
        let word = STAGE_WORDS * landed.stage + DRAW_WORD;
        let name = range.pass_name(list, "discs");
        graph.raster(&name, pass, state).area(splat.grid.size).draw_indirect(landed.counts, word, 1);
        splat.resolve(graph, list, range);
    }
}
