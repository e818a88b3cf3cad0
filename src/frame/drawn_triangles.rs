//! Which triangles are drawn: those that have an area. A rasteriser may count pixels as covered by one that has none, and interpolate over it
//! what is no number (glsl/geometry/interpolated.glsl).

use glam::DVec3;

use crate::scene::Primitive;

/// Height over length below which a triangle is a line: the resolution of the coordinates that it is given in.
const LEAST_HEIGHT: f64 = f32::EPSILON as f64;

/// The indices of the triangles that have an area.
pub(super) fn drawn_indices(primitive: &Primitive) -> Vec<u32> {
    let corner = |index: u32| DVec3::from(primitive.positions[index as usize].map(f64::from));
    let has_area = |indices: &&[u32]| {
        let [a, b, c] = [0, 1, 2].map(|place| corner(indices[place]));
        let [ab, ac, bc] = [b - a, c - a, c - b];
        let longest = ab.length_squared().max(ac.length_squared()).max(bc.length_squared());
        ab.cross(ac).length() > LEAST_HEIGHT * longest
    };
    primitive.indices.chunks_exact(3).filter(has_area).flatten().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_lines_are_not_drawn() {
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1e-6, 0.0], [1.0, 1e-8, 0.0]];
        let indices = vec![0, 0, 0, 0, 1, 2, 0, 3, 2, 0, 4, 2];
        let primitive = Primitive { positions, indices, ..Primitive::default() };
        assert_eq!(drawn_indices(&primitive), [0, 3, 2]);
    }

    #[test]
    fn the_size_of_a_triangle_does_not_matter() {
        for size in [1e-30_f32, 1e-6, 1e15] {
            let positions = vec![[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0]];
            let primitive = Primitive { positions, indices: vec![0, 1, 2], ..Primitive::default() };
            assert_eq!(drawn_indices(&primitive).len(), 3, "{size}");
        }
    }
}
