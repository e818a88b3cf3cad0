//! Finer triangles on the same surfaces, to measure what grows with their number.

use std::collections::HashMap;

use glam::{Vec2, Vec3, Vec4};

use super::Scene;
use super::mesh::Primitive;

impl Scene {
    /// Cuts every triangle into four, at the middles of its edges; what there is to see stays the same. Vertices between others have the mean of
    /// what those have.
    pub fn split_triangles(&mut self) {
        let primitives = self.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives);
        let shapes = self.shapes.iter_mut().flatten();
        for ((primitive, shape), emission) in primitives.zip(shapes).zip(self.emissions.iter_mut().flatten()) {
            primitive.split();
            shape.take();
            emission.take();
        }
        self.extent.take();
        self.count_mesh();
        self.mesh_changes.fill(self.revisions.meshes);
    }
}

impl Primitive {
    fn split(&mut self) {
        let mut middles = HashMap::new();
        let mut indices = Vec::with_capacity(4 * self.indices.len());
        for corners in std::mem::take(&mut self.indices).chunks_exact(3) {
            let &[a, b, c] = corners else { continue };
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
                let edge = [from.min(to), from.max(to)];
                *middles.entry(edge).or_insert_with(|| self.add_middle(edge))
            });
            indices.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].as_flattened());
        }
        self.indices = indices;
    }

    /// Adds the vertex in the middle of two, whose number it returns.
    fn add_middle(&mut self, edge: [u32; 2]) -> u32 {
        let [from, to] = edge.map(|vertex| vertex as usize);
        let unit = |vectors: &[[f32; 3]]| {
            (Vec3::from(vectors[from]) + Vec3::from(vectors[to])).normalize_or(vectors[from].into())
        };
        if let Some(normals) = &mut self.normals {
            normals.push(unit(normals).into());
        }
        if let Some(tangents) = &mut self.tangents {
            let [one, other] = [from, to].map(|vertex| Vec4::from(tangents[vertex]));
            let direction = (one.truncate() + other.truncate()).normalize_or(one.truncate());
            tangents.push(direction.extend(one.w).into());
        }
        for texcoords in self.texcoords.iter_mut().flatten() {
            texcoords.push((0.5 * (Vec2::from(texcoords[from]) + Vec2::from(texcoords[to]))).into());
        }
        if let Some(colors) = &mut self.colors {
            colors.push((0.5 * (Vec4::from(colors[from]) + Vec4::from(colors[to]))).into());
        }
        self.positions.push((0.5 * (Vec3::from(self.positions[from]) + Vec3::from(self.positions[to]))).into());
        self.positions.len() as u32 - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(scene: &Scene) -> f64 {
        let triangles = scene.meshes().iter().flat_map(|mesh| &mesh.primitives).flat_map(Primitive::triangles);
        let doubled = triangles.map(|[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|corner| Vec3::from(corner).as_dvec3());
            (b - a).cross(c - a).length()
        });
        0.5 * doubled.sum::<f64>()
    }

    #[test]
    fn split_triangles_are_four_of_the_same_surface() {
        for name in ["cornell-point", "textured"] {
            let whole = Scene::open(name).expect("a built-in scene");
            let mut split = whole.clone();
            split.split_triangles();
            assert_eq!(split.facts().triangles, 4 * whole.facts().triangles, "{name}");
            assert!((area(&split) / area(&whole) - 1.0).abs() < 1e-6, "{name}");
            assert_ne!(split.revisions(), whole.revisions(), "{name}");
            for primitive in split.meshes().iter().flat_map(|mesh| &mesh.primitives) {
                assert_eq!(primitive.fault(), None, "{name}");
                let normals = primitive.normals.iter().flatten();
                assert!(normals.into_iter().all(|normal| (Vec3::from(*normal).length() - 1.0).abs() < 1e-3), "{name}");
            }
        }
    }

    #[test]
    fn neighbours_share_the_vertex_between_them() {
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let texcoords = [Some(vec![[0.0; 2], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]]), None];
        let mut square = Primitive { positions, texcoords, indices: vec![0, 1, 2, 0, 2, 3], ..Primitive::default() };
        square.split();
        // Four corners, four edges and the diagonal.
        assert_eq!((square.positions.len(), square.triangle_count()), (9, 8));
        assert_eq!(square.indices[..12], [0, 4, 6, 4, 1, 5, 6, 5, 2, 4, 5, 6]);
        assert_eq!((square.positions[6], square.texcoords[0].as_ref().expect("set")[6]), ([0.5, 0.5, 0.0], [2.0, 1.0]));
    }
}
