//! The scene as voxels, and what cones through them need (Reich 2015, 4.3.4 and 4.5.4): a shared part of the frame, made once for all that ask for it in the same way.
//!
//! Triangles are rounded to units of the grid and cut at its borders, then looked through column by column, each voxel by one exact test
//! ([`occupancy`]); bits become opacity, at once or over frames, with coarser levels ([`opacity`]).

mod chunks;
mod grid;
mod occupancy;
mod opacity;
mod settings;
#[cfg(test)]
mod tests;

use self::grid::VoxelGrid;
use self::occupancy::{Occupancy, occupancy};
pub(crate) use self::settings::{VoxelSettings, Voxelisation};
use crate::frame::geometry::Geometry;
use crate::frame::inputs::{FrameInputs, FrameTime};
use crate::frame::scene_data::SceneData;
use crate::graph::bindings::{ImageRef, TexelBuffer};
use crate::graph::{Dependence, Graph};
use crate::shaders::groups;
use crate::vulkan::SamplerKind;

/// The voxels of a frame.
pub(crate) struct Voxels {
    /// As passes bind them.
    pub(crate) group: groups::Voxels,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it"))]
    pub(crate) grid: VoxelGrid,
    /// Levels of opacity.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) opacity: ImageRef,
}

/// The voxels of the frame.
pub(crate) fn voxels(graph: &mut Graph<'_>, frame: &FrameInputs<'_>, settings: &VoxelSettings) -> Voxels {
    let grid = VoxelGrid::around(frame.data, settings.resolution);
    declare(graph, (frame.data, frame.geometry), frame.time, grid, settings).0
}

/// Declares the passes.
fn declare(
    graph: &mut Graph<'_>,
    (data, geometry): (&SceneData, &Geometry),
    time: FrameTime,
    grid: VoxelGrid,
    settings: &VoxelSettings,
) -> (Voxels, Occupancy) {
    let occupied = occupancy(graph, (data, geometry), &grid, settings);
    let adapts = settings.adaption > 0.0;
    let adapted = adapts.then(|| opacity::adapted(graph, (data, &grid), occupied.bits, (settings.adaption, time)));
    let opacity = opacity::levels(graph, &grid, occupied.bits, adapted);
    let distances = if settings.skip_empty { opacity::distances(graph, &grid, opacity) } else { TexelBuffer::absent() };
    let group = groups::Voxels {
        voxel_grid: graph.upload("voxels.grid", &[grid.record], Dependence::GEOMETRY).uniform(),
        voxel_opacity: opacity.sampled_with(SamplerKind::LinearClamp),
        voxel_distances: distances,
        voxels_seen_along_axes: u32::from(settings.directional),
        voxels_skip_empty: u32::from(settings.skip_empty),
        voxels_cone_width: settings.cone_width,
    };
    (Voxels { group, grid, opacity }, occupied)
}

/// The programs that make voxels with these settings, as a method lists them.
pub(crate) fn shaders(settings: &VoxelSettings) -> Vec<&'static str> {
    let drawn = settings.voxelisation == Some(Voxelisation::Raster);
    let all = [
        ("voxels/start", true),
        ("voxels/triangles", true),
        ("voxels/fill", !drawn),
        ("voxels/draw", drawn),
        ("voxels/solid", settings.solid),
        ("voxels/inside", settings.solid),
        ("voxels/adapt", settings.adaption > 0.0),
        ("voxels/opacity", true),
        ("voxels/coarser", true),
        ("voxels/filled_blocks", settings.skip_empty),
        ("voxels/distances", settings.skip_empty),
    ];
    all.into_iter().filter(|(_, runs)| *runs).map(|(name, _)| name).collect()
}
