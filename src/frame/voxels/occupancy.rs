//! One bit for each voxel: whether a surface touches it, or, of closed meshes that are filled, whether its centre lies within.

use ash::vk;

use super::chunks::Chunks;
use super::grid::VoxelGrid;
use super::settings::{VoxelSettings, Voxelisation};
use crate::frame::geometry::Geometry;
use crate::frame::scene_data::SceneData;
use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph};
use crate::shaders::{types, voxels};

/// glsl/voxels/lists.glsl
const COUNT_WORDS: usize = 12;
const COUNT_TRIANGLES: usize = 0;
const COUNT_TILES: usize = 4;
const COUNT_SOLID_TILES: usize = 8;

/// More room than a scene has triangles, for those that the grid's borders cut into several.
const CUT_TRIANGLES: usize = 64;
/// Room for tiles of triangles that take several.
const MORE_TILES: usize = 4096;
/// Groups that every device runs in a row.
const ROW_OF_GROUPS: usize = 65535;

/// Triangles in units of the grid, and what of them is worked off by one invocation each.
struct Lists {
    counts: BufferRef<u32>,
    triangles: BufferRef<types::PackedTriangle>,
    tiles: BufferRef<[u32; 2]>,
    solid_tiles: BufferRef<[u32; 2]>,
}

/// Bits of all voxels, 32 a word, and the triangles that they are made of.
pub(super) struct Occupancy {
    pub(super) bits: BufferRef<u32>,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read them back"))]
    pub(super) triangles: BufferRef<types::PackedTriangle>,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read them back"))]
    pub(super) counts: BufferRef<u32>,
}

/// Declares the passes.
pub(super) fn occupancy(
    graph: &mut Graph<'_>,
    (data, geometry): (&SceneData, &Geometry),
    grid: &VoxelGrid,
    settings: &VoxelSettings,
) -> Occupancy {
    let chunks = Chunks::of(data, grid, settings.solid);
    let voxelisation = settings.voxelisation.unwrap_or(Voxelisation::Compute);
    let lists = triangles(graph, geometry, grid, &chunks, voxelisation);
    let bits = graph.buffer::<u32>("voxels.bits", grid.voxel_count().div_ceil(32) as usize);
    graph.fill_buffer("voxels/clear", bits, 0);
    match voxelisation {
        Voxelisation::Compute => fill(graph, grid, &lists, bits),
        Voxelisation::Raster => draw(graph, grid, &lists, bits),
    }
    if chunks.any_solid {
        fill_solids(graph, grid, &lists, bits);
    } else if settings.solid {
        graph.skip("voxels/solid", "no closed mesh");
    }
    Occupancy { bits, triangles: lists.triangles, counts: lists.counts }
}

fn triangles(
    graph: &mut Graph<'_>,
    geometry: &Geometry,
    grid: &VoxelGrid,
    chunks: &Chunks,
    voxelisation: Voxelisation,
) -> Lists {
    let count = chunks.triangle_count as usize;
    let lists_tiles = voxelisation == Voxelisation::Compute;
    let most_solid = if chunks.any_solid { count + MORE_TILES } else { 1 };
    let lists = Lists {
        counts: graph.buffer("voxels.counts", COUNT_WORDS),
        triangles: graph.growing_buffer("voxels.triangles", count + CUT_TRIANGLES),
        tiles: graph.growing_buffer("voxels.tiles", if lists_tiles { count + MORE_TILES } else { 1 }),
        solid_tiles: graph.growing_buffer("voxels.solid_tiles", most_solid),
    };
    let capacity = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    graph.pass("voxels/start", voxels::Start { counts: lists.counts.write() }).threads([1, 1, 1]);
    let records = if chunks.records.is_empty() { &[[0; 4]][..] } else { &chunks.records };
    let pass = voxels::Triangles {
        geometry: geometry.clone(),
        chunks: graph.upload("voxels.chunks", records, Dependence::GEOMETRY).texels(vk::Format::R32G32B32A32_UINT),
        counts: lists.counts.read_write(),
        triangles: lists.triangles.start(),
        tiles: lists.tiles.start(),
        solid_tiles: lists.solid_tiles.start(),
        lists_tiles: u32::from(lists_tiles),
        lists_solid_tiles: u32::from(chunks.any_solid),
        push: voxels::TrianglesPush {
            grid: grid.record,
            chunk_count: capacity(chunks.records.len()),
            triangle_capacity: capacity(lists.triangles.count()),
            tile_capacity: capacity(lists.tiles.count()),
            solid_tile_capacity: capacity(lists.solid_tiles.count()),
        },
    };
    let groups = records.len();
    let rows = groups.div_ceil(ROW_OF_GROUPS);
    graph.pass("voxels/triangles", pass).unordered().count("triangles", lists.counts, COUNT_TRIANGLES).groups([
        capacity(groups.div_ceil(rows)),
        capacity(rows),
        1,
    ]);
    graph.grows(lists.triangles, lists.counts, COUNT_TRIANGLES);
    if lists_tiles {
        graph.grows(lists.tiles, lists.counts, COUNT_TILES);
    }
    if chunks.any_solid {
        graph.grows(lists.solid_tiles, lists.counts, COUNT_SOLID_TILES);
    }
    lists
}

fn fill(graph: &mut Graph<'_>, grid: &VoxelGrid, lists: &Lists, bits: BufferRef<u32>) {
    let pass = voxels::Fill {
        counts: lists.counts.texels(vk::Format::R32_UINT),
        triangles: lists.triangles.texels(vk::Format::R32G32B32A32_UINT),
        tiles: lists.tiles.texels(vk::Format::R32G32_UINT),
        bits: bits.read_write(),
        push: voxels::FillPush {
            grid: grid.record,
            triangle_capacity: lists.triangles.count() as u32,
            tile_capacity: lists.tiles.count() as u32,
        },
    };
    let pass = graph.pass("voxels/fill", pass).count("tiles", lists.counts, COUNT_TILES);
    pass.threads_indirect(lists.counts, COUNT_TILES + 1);
}

fn draw(graph: &mut Graph<'_>, grid: &VoxelGrid, lists: &Lists, bits: BufferRef<u32>) {
    let side = grid.dims().into_iter().max().unwrap_or(1);
    let pass = voxels::Draw {
        triangles: lists.triangles.texels(vk::Format::R32G32B32A32_UINT),
        bits: bits.read_write(),
        push: voxels::DrawPush { grid: grid.record, triangle_capacity: lists.triangles.count() as u32, side },
    };
    let state = crate::vulkan::RasterState { topology: vk::PrimitiveTopology::POINT_LIST, ..Default::default() };
    graph.raster("voxels/draw", pass, state).area([side; 2]).draw_indirect(lists.counts, COUNT_TRIANGLES, 1);
}

fn fill_solids(graph: &mut Graph<'_>, grid: &VoxelGrid, lists: &Lists, bits: BufferRef<u32>) {
    let crossings = graph.buffer::<u32>("voxels.crossings", grid.voxel_count().div_ceil(4) as usize);
    graph.fill_buffer("voxels/solid/clear", crossings, 0);
    let pass = voxels::Solid {
        counts: lists.counts.texels(vk::Format::R32_UINT),
        triangles: lists.triangles.texels(vk::Format::R32G32B32A32_UINT),
        solid_tiles: lists.solid_tiles.texels(vk::Format::R32G32_UINT),
        crossings: crossings.read_write(),
        push: voxels::SolidPush {
            grid: grid.record,
            triangle_capacity: lists.triangles.count() as u32,
            tile_capacity: lists.solid_tiles.count() as u32,
        },
    };
    let pass = graph.pass("voxels/solid/cross", pass).count("tiles", lists.counts, COUNT_SOLID_TILES);
    pass.threads_indirect(lists.counts, COUNT_SOLID_TILES + 1);
    let [_, rows, slices] = grid.dims();
    let pass = voxels::Inside {
        crossings: crossings.texels(vk::Format::R32_UINT),
        bits: bits.read_write(),
        push: voxels::InsidePush { grid: grid.record },
    };
    graph.pass("voxels/solid/inside", pass).threads([rows * slices, 1, 1]);
}
