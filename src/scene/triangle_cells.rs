//! A triangle cut into equal cells by lines parallel to its edges.
//!
//! Places are the weights (b₁, b₂) of corners 1 and 2. With n cells an edge, column i = ⌊n·b₁⌋ and row j = ⌊n·b₂⌋ hold a lower cell and,
//! where the fractions add up to more than 1, an upper one, which is upside down. Cell (i, j, upper) has the number
//! j·(2n − j) + 2i + upper (glsl/lib/emissive_cells.glsl).

/// One cell of a triangle with `side` cells an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    pub(crate) column: u32,
    pub(crate) row: u32,
    pub(crate) upper: bool,
}

impl Cell {
    pub(crate) fn number(self, side: u32) -> usize {
        (self.row * (2 * side - self.row) + 2 * self.column + u32::from(self.upper)) as usize
    }

    /// The cell of the triangle with corners 1 and 2 exchanged.
    pub(crate) fn mirrored(self) -> Cell {
        Cell { column: self.row, row: self.column, upper: self.upper }
    }

    /// The point of the whole triangle at weights of corners 1 and 2 of the cell.
    pub(crate) fn place(self, side: u32, [p, q]: [f64; 2]) -> [f64; 2] {
        let [p, q] = if self.upper { [1.0 - p, 1.0 - q] } else { [p, q] };
        [(f64::from(self.column) + p) / f64::from(side), (f64::from(self.row) + q) / f64::from(side)]
    }

    /// The weights of corners 1 and 2 between which it lies.
    pub(crate) fn corners(self, side: u32) -> [[f64; 2]; 3] {
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|corner| self.place(side, corner))
    }
}

/// All cells of a triangle, by number.
pub(crate) fn cells(side: u32) -> impl Iterator<Item = Cell> {
    (0..side).flat_map(move |row| {
        (0..2 * (side - row) - 1).map(move |place| Cell { column: place / 2, row, upper: place % 2 == 1 })
    })
}

/// The middles of the cells of a triangle cut into `side` an edge.
pub(crate) fn middles(side: u32) -> impl Iterator<Item = [f64; 2]> {
    cells(side).map(move |cell| cell.place(side, [1.0 / 3.0; 2]))
}

/// Cells in strips away from corner 0, in a strip from edge to edge: the order in which Osada et al. (2002) fill a triangle.
pub(crate) fn strip(index: u32) -> impl Iterator<Item = Cell> + Clone {
    (0..2 * index + 1).map(move |place| {
        let (row, upper) = (place / 2, place % 2 == 1);
        Cell { column: index - row - u32::from(upper), row, upper }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_numbered_in_order_and_hold_their_points() {
        for side in [1, 2, 5, 64] {
            let mut count = 0;
            for (number, cell) in cells(side).enumerate() {
                assert_eq!(cell.number(side), number);
                let [x, y] = cell.place(side, [0.25, 0.3]).map(|place| place * f64::from(side));
                let found = Cell { column: x as u32, row: y as u32, upper: x.fract() + y.fract() > 1.0 };
                assert_eq!(found, cell);
                count += 1;
            }
            assert_eq!(count, side * side);
            let mut strips: Vec<usize> = (0..side).flat_map(strip).map(|cell| cell.number(side)).collect();
            strips.sort_unstable();
            assert!(strips.into_iter().eq(0..(side * side) as usize));
        }
    }

    #[test]
    fn a_mirrored_triangle_has_mirrored_cells() {
        for cell in cells(7) {
            let [x, y] = cell.place(7, [0.2, 0.5]);
            assert_eq!(cell.mirrored().place(7, [0.5, 0.2]), [y, x]);
        }
    }
}
