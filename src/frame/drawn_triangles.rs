//! What is drawn of a primitive: the triangles that have an area. A rasteriser may count pixels as covered by one that has none, and interpolate
//! over it what is no number (glsl/geometry/interpolated.glsl).
//!
//! Fragments have to know their triangle. `gl_PrimitiveID` would say it, but takes the feature `geometryShader`, which not every device has. So
//! each triangle has a first vertex of its own, and of its own number: what a vertex shader hands on `flat` is that of the first.

use glam::DVec3;

use crate::scene::Primitive;

/// Height over length below which a triangle is a line: the resolution of the coordinates that it is given in.
const LEAST_HEIGHT: f64 = f32::EPSILON as f64;

/// A primitive as it is uploaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct DrawnTriangles {
    /// The primitive's vertex that each uploaded one is a copy of.
    pub(super) vertices: Vec<u32>,
    /// Three uploaded vertices a triangle; the first of triangle i is vertex i.
    pub(super) indices: Vec<u32>,
}

impl DrawnTriangles {
    pub(super) fn of(primitive: &Primitive) -> DrawnTriangles {
        let corner = |index: u32| DVec3::from(primitive.positions[index as usize].map(f64::from));
        let has_area = |indices: &&[u32; 3]| {
            let [a, b, c] = indices.map(corner);
            let [ab, ac, bc] = [b - a, c - a, c - b];
            let longest = ab.length_squared().max(ac.length_squared()).max(bc.length_squared());
            ab.cross(ac).length() > LEAST_HEIGHT * longest
        };
        let triangles: Vec<[u32; 3]> = primitive.indices.as_chunks().0.iter().filter(has_area).copied().collect();
        let mut vertices: Vec<u32> = triangles.iter().map(|corners| corners[0]).collect();
        let mut uploaded: Vec<Option<u32>> = vec![None; primitive.positions.len()];
        for (number, vertex) in (0..).zip(&vertices) {
            uploaded[*vertex as usize].get_or_insert(number);
        }
        let mut place = |vertex: u32| {
            *uploaded[vertex as usize].get_or_insert_with(|| {
                vertices.push(vertex);
                vertices.len() as u32 - 1
            })
        };
        let indices = (0..).zip(&triangles).flat_map(|(number, &[_, b, c])| [number, place(b), place(c)]).collect();
        DrawnTriangles { vertices, indices }
    }

    /// An attribute of the uploaded vertices.
    pub(super) fn of_vertices<'a, T: Copy>(&'a self, values: &'a [T]) -> impl Iterator<Item = T> + 'a {
        self.vertices.iter().map(|vertex| values[*vertex as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The triangles that are drawn, by the primitive's own vertices.
    fn drawn(positions: Vec<[f32; 3]>, indices: Vec<u32>) -> Vec<u32> {
        let triangles = DrawnTriangles::of(&Primitive { positions, indices, ..Primitive::default() });
        triangles.indices.iter().map(|index| triangles.vertices[*index as usize]).collect()
    }

    #[test]
    fn points_and_lines_are_not_drawn() {
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1e-6, 0.0], [1.0, 1e-8, 0.0]];
        assert_eq!(drawn(positions, vec![0, 0, 0, 0, 1, 2, 0, 3, 2, 0, 4, 2]), [0, 3, 2]);
    }

    #[test]
    fn the_size_of_a_triangle_does_not_matter() {
        for size in [1e-30_f32, 1e-6, 1e15] {
            let positions = vec![[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0]];
            assert_eq!(drawn(positions, vec![0, 1, 2]).len(), 3, "{size}");
        }
    }

    #[test]
    fn the_first_vertex_of_a_triangle_is_its_own_and_of_its_number() {
        // A fan, whose triangles share their first corner, and a triangle that begins where another one ends.
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [9.0; 3]];
        let indices = vec![0, 1, 2, 0, 2, 3, 0, 3, 4, 2, 4, 0];
        let triangles = DrawnTriangles::of(&Primitive {
            positions: positions.clone(),
            indices: indices.clone(),
            ..Primitive::default()
        });
        assert_eq!(triangles.indices.iter().step_by(3).copied().collect::<Vec<u32>>(), [0, 1, 2, 3]);
        assert_eq!(
            triangles.vertices.len(),
            4 + 3,
            "copies of the shared corner alone, and no vertex that nobody uses"
        );
        assert_eq!(drawn(positions, indices.clone()), indices);
    }
}
