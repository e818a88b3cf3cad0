//! The grid of cells that photons are binned in, and the tiles of samples over it.

use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph};

/// Samples to a side of a tile.
const TILE_SIDE: u32 = 16;

/// The grid of cells (glsl/photon_splat/levels.glsl).
pub(super) struct Grid {
    /// Samples.
    pub(super) size: [u32; 2],
    pub(super) levels: BufferRef<[u32; 4]>,
    pub(super) level_count: i32,
    pub(super) row_count: u32,
    pub(super) cell_count: u32,
}

impl Grid {
    pub(super) fn upload(graph: &mut Graph<'_>, size: [u32; 2]) -> Grid {
        let (mut levels, mut row_count, mut cell_count) = (Vec::new(), 0, 0);
        for log2 in 1_u32.. {
            let [columns, rows] = size.map(|side| side.div_ceil(1 << log2));
            levels.push([columns, rows, cell_count, 0]);
            row_count += rows;
            cell_count += rows * (columns + 1);
            if columns * rows == 1 {
                break;
            }
        }
        let level_count = i32::try_from(levels.len()).unwrap_or(i32::MAX);
        let levels = graph.upload("photons.splat_levels", &levels, Dependence::NONE);
        Grid { size, levels, level_count, row_count, cell_count }
    }

    pub(super) fn tiles(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(TILE_SIDE))
    }

    pub(super) fn tile_count(&self) -> usize {
        let [columns, rows] = self.tiles();
        columns as usize * rows as usize
    }
}
