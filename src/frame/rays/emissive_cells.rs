//! Where on an emissive triangle points are drawn, if not evenly: alias tables over its cells, behind the triangles in their buffer
//! (glsl/lib/emissive_cells.glsl). Instances of a primitive share them.

use std::collections::HashMap;

use super::alias_table::alias_table;
use crate::scene::EmissiveCells;
use crate::scene::triangle_cells::{Cell, cells};

/// Cells of a scene at most (16 bytes each); triangles beyond are drawn from evenly.
const MOST: usize = 1 << 20;

/// The tables of all triangles.
#[derive(Default)]
pub(super) struct CellTables {
    /// One texel a cell: threshold, the other cell's number, density over the mean density, column | row << 16 | upper << 31.
    pub(super) records: Vec<[u32; 4]>,
    /// First record and cells an edge of those triangles that have any.
    places: HashMap<usize, [u32; 2]>,
    /// Where the cells of one triangle of a primitive are already; mirrored instances have their own.
    known: HashMap<(*const EmissiveCells, bool), [u32; 2]>,
}

impl CellTables {
    /// Draws points of a triangle by its cells. `mirrored`: its corners 1 and 2 are exchanged.
    pub(super) fn add(&mut self, triangle: usize, held: &EmissiveCells, mirrored: bool) {
        let known = self.known.get(&(std::ptr::from_ref(held), mirrored)).copied();
        let Some(place) = known.or_else(|| self.table_of(held, mirrored)) else { return };
        self.places.insert(triangle, place);
    }

    fn table_of(&mut self, held: &EmissiveCells, mirrored: bool) -> Option<[u32; 2]> {
        if self.records.len() + held.density.len() > MOST {
            return None;
        }
        let source = |cell: Cell| if mirrored { cell.mirrored() } else { cell };
        let density: Vec<f64> =
            cells(held.side).map(|cell| f64::from(held.density[source(cell).number(held.side)])).collect();
        let total: f64 = density.iter().sum();
        let place = [u32::try_from(self.records.len()).ok()?, held.side];
        let places = alias_table(&density, total).into_iter().zip(cells(held.side));
        let mean = total / density.len() as f64;
        self.records.extend(places.zip(&density).map(|(((threshold, alias), cell), density)| {
            let coordinates = cell.column | cell.row << 16 | u32::from(cell.upper) << 31;
            [threshold.to_bits(), alias, ((density / mean) as f32).to_bits(), coordinates]
        }));
        self.known.insert((std::ptr::from_ref(held), mirrored), place);
        Some(place)
    }

    /// Cells an edge of a triangle's table, seven bits, and records from its first to the end of all, 25 bits; 0 if it has none.
    pub(super) fn of_triangle(&self, triangle: usize) -> u32 {
        let all = u32::try_from(self.records.len()).unwrap_or(0);
        self.places.get(&triangle).map_or(0, |[first, side]| side << 25 | (all - first))
    }
}
