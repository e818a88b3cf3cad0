//! The scene's triangles as groups take them.

use super::grid::VoxelGrid;
use crate::frame::scene_data::{DrawnInstance, SceneData};

/// Triangles of one chunk, at most: one an invocation of a group.
const CHUNK: u32 = 64;
/// Of the grid's extent along each axis: a closed mesh that spans more along all of them is a room, not a solid.
const ROOM: f32 = 0.8;

/// Chunks of triangles: instance, first triangle in it, how many, whether they bound a solid.
pub(super) struct Chunks {
    pub(super) records: Vec<[u32; 4]>,
    pub(super) triangle_count: u32,
    pub(super) any_solid: bool,
}

impl Chunks {
    /// `solid`: closed meshes are filled.
    pub(super) fn of(data: &SceneData, grid: &VoxelGrid, solid: bool) -> Chunks {
        let mut chunks = Chunks { records: Vec::new(), triangle_count: 0, any_solid: false };
        for (instance, drawn) in (0..).zip(&data.drawn) {
            let count = drawn.index_count / 3;
            let fills = solid && is_solid(drawn, grid);
            let starts = (0..count).step_by(CHUNK as usize);
            chunks.records.extend(starts.map(|first| [instance, first, CHUNK.min(count - first), u32::from(fills)]));
            chunks.triangle_count += count;
            chunks.any_solid |= fills && count > 0;
        }
        chunks
    }
}

/// Whether an instance bounds a solid that lies within the grid.
fn is_solid(drawn: &DrawnInstance, grid: &VoxelGrid) -> bool {
    let Some(solid) = drawn.solid.filter(|_| !drawn.masked) else { return false };
    let extent = |axis: usize| grid.record.dims[axis] as f32 * grid.record.size;
    let reach = |axis: usize| solid.half_axes_rs.iter().map(|half| half[axis].abs()).sum::<f32>();
    let lies_within = |axis: usize| {
        let from = solid.center_rs[axis] - reach(axis) - grid.record.origin_rs[axis];
        from >= 0.0 && from + 2.0 * reach(axis) <= extent(axis)
    };
    let is_room = (0..3).all(|axis| 2.0 * reach(axis) > ROOM * (extent(axis) - 3.0 * grid.record.size));
    (0..3).all(lies_within) && !is_room
}
