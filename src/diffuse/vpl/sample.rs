//! The virtual point lights of the first bounce: one for each of N cells of equal flux of the light views.

use ash::vk;

use super::options::VplOptions;
use crate::graph::Dependence;
use crate::graph::bindings::BufferRef;
use crate::method::FrameCx;
use crate::shaders::types::ViewShare;
use crate::shaders::vpl::{BlockFlux, BlockFluxPush, BlockSums, Share, SharePush, Vpls, VplsPush};

/// Side of a block of light-view texels (glsl/vpl/blocks.glsl); the atlas is a multiple of twice that.
const BLOCK_SIDE: u32 = 8;
const BLOCKS_PER_TILE: u32 = 4;

/// Declares the passes that make `options.count` VPLs of two texels each (glsl/lib/vpl.glsl).
pub(super) fn sample(cx: &mut FrameCx<'_, '_>, options: &VplOptions) -> BufferRef<[f32; 4]> {
    let (set, lights) = (cx.frame.set, cx.lights());
    let graph = &mut *cx.graph;
    let (tile_count, view_count) = (set.atlas.tiles.len() as u32, set.atlas.views.len() as u32);
    let vpl_count = options.count;
    let block_grid = set.atlas.size.map(|side| side.div_ceil(BLOCK_SIDE).max(1));
    let tiles = graph.upload("vpl.tiles", &set.atlas.tiles, Dependence::LIGHTS);
    let blocks = graph.image("vpl.blocks", vk::Format::R32G32B32A32_SFLOAT, block_grid);
    let sums = graph.image("vpl.sums", vk::Format::R32G32B32A32_SFLOAT, block_grid);
    let view_fluxes = graph.buffer::<[f32; 4]>("vpl.view_fluxes", view_count as usize);
    let shares = graph.buffer::<ViewShare>("vpl.shares", view_count as usize);
    let vpls = graph.buffer::<[f32; 4]>("vpl.vpls", 2 * vpl_count as usize);

    let dropped = graph.buffer::<u32>("vpl.dropped", 1);
    graph.fill_buffer("diffuse/vpl/vpls/clear-dropped", dropped, 0);
    let pass = BlockFlux {
        tiles: tiles.read(),
        light_views: lights.group.clone(),
        blocks: blocks.start(),
        dropped_texels: dropped.read_write(),
        push: BlockFluxPush { tile_count },
    };
    graph
        .pass("diffuse/vpl/vpls/block-flux", pass)
        .note("tiles", u64::from(tile_count))
        .count("dropped", dropped, 0)
        .threads([tile_count * BLOCKS_PER_TILE, 1, 1]);

    let pass = BlockSums {
        light_views: lights.group.clone(),
        blocks: blocks.sampled(),
        sums: sums.start_then_read(),
        view_fluxes: view_fluxes.write(),
    };
    graph.pass("diffuse/vpl/vpls/block-sums", pass).groups([view_count, 1, 1]);

    let pass = Share {
        view_fluxes: view_fluxes.read(),
        shares: shares.write_then_read(),
        push: SharePush { view_count, vpl_count },
    };
    graph.pass("diffuse/vpl/vpls/share", pass).note("views", u64::from(view_count)).groups([1, 1, 1]);

    let pass = Vpls {
        light_views: lights.group.clone(),
        sums: sums.sampled(),
        shares: shares.read(),
        vpls: vpls.write(),
        push: VplsPush { view_count, vpl_count },
    };
    graph.pass("diffuse/vpl/vpls/place", pass).note("VPLs", u64::from(vpl_count)).threads([vpl_count, 1, 1]);
    vpls
}

/// Number of VPLs in a buffer of two texels each.
pub(super) fn vpl_count(vpls: BufferRef<[f32; 4]>) -> u32 {
    (vpls.count() / 2) as u32
}
