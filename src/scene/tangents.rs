//! Normals and tangents that a file leaves out or gets wrong.

use super::TextureRef;
use super::mesh::{CHUNK, Primitive};
use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Coordinates beyond this overflow when MikkTSpace multiplies them; such a primitive gets arbitrary tangents.
const LARGEST_COORDINATE: f32 = 1e12;

/// Whether all normals are as long as 1, as near as rounding brings it: most of a file are, and where all of some thousands are, they stay as they came.
pub(crate) fn all_unit(normals: &[[f32; 3]]) -> bool {
    let is_unit = |normal: &[f32; 3]| (Vec3::from(*normal).length_squared() - 1.0).abs() <= 4.0 * f32::EPSILON;
    normals.iter().fold(true, |all, normal| all & is_unit(normal))
}

/// Makes every normal a unit vector. One that has no direction becomes the normal of a triangle that uses it.
pub(super) fn repair_normals(primitive: &mut Primitive) {
    let Some(mut normals) = primitive.normals.take() else {
        return;
    };
    let repair = |normal: &mut [f32; 3]| {
        let unit = Vec3::from(*normal).try_normalize();
        *normal = unit.unwrap_or(Vec3::ZERO).to_array();
        unit.is_none()
    };
    let repair_chunk = |chunk: &mut [[f32; 3]]| {
        !all_unit(chunk) && chunk.iter_mut().fold(false, |directionless, normal| directionless | repair(normal))
    };
    if normals.par_chunks_mut(CHUNK).map(repair_chunk).reduce(|| false, |one, other| one | other) {
        for (corners, triangle) in primitive.indices.chunks_exact(3).zip(primitive.triangles()) {
            for &corner in corners {
                let normal = &mut normals[corner as usize];
                if *normal == [0.0; 3] {
                    *normal = face_normal(triangle).unwrap_or(Vec3::ZERO).to_array();
                }
            }
        }
        normals.iter_mut().filter(|normal| **normal == [0.0; 3]).for_each(|normal| *normal = [0.0, 0.0, 1.0]);
    }
    primitive.normals = Some(normals);
}

/// Gives a primitive whose material has a normal texture what is needed to use it: unit tangents for the texture's
/// coordinates, made by MikkTSpace unless the file has usable ones, and normals. Without the texture's coordinate set there
/// is nothing to make them from, and it gets none.
pub(super) fn complete(primitive: &mut Primitive, texture: TextureRef) {
    if primitive.texcoords[texture.texcoord as usize].is_none() {
        primitive.tangents = None;
        return;
    }
    if let Some(tangents) = primitive.tangents.as_mut().filter(|_| primitive.normals.is_some()) {
        let usable = tangents.iter_mut().all(|tangent| {
            let unit = Vec3::from_slice(&tangent[..3]).try_normalize();
            *tangent = unit.unwrap_or(Vec3::ZERO).extend(if tangent[3] < 0.0 { -1.0 } else { 1.0 }).to_array();
            unit.is_some()
        });
        if usable {
            return;
        }
    }
    if primitive.normals.is_none() {
        make_flat(primitive);
    }
    generate(primitive, texture);
}

/// Gives each triangle vertices of its own, with the triangle's normal.
fn make_flat(primitive: &mut Primitive) {
    primitive.normals = Some(vec![[0.0; 3]; primitive.positions.len()]);
    let corners: Vec<u32> = primitive.indices.clone();
    gather(primitive, &corners);
    primitive.indices = (0..corners.len() as u32).collect();
    let normals = primitive.triangles().flat_map(|triangle| [face_normal(triangle).unwrap_or(Vec3::Z).to_array(); 3]);
    primitive.normals = Some(normals.collect());
}

/// MikkTSpace gives each corner of each triangle a tangent; corners of a vertex whose tangents agree are one vertex again.
fn generate(primitive: &mut Primitive, texture: TextureRef) {
    let corner_count = primitive.indices.len();
    let mut corners = Corners { primitive, texture, tangents: vec![[0.0; 4]; corner_count] };
    let coordinates = corners
        .primitive
        .positions
        .iter()
        .flatten()
        .chain(corners.primitive.texcoords.iter().flatten().flatten().flatten());
    if coordinates.into_iter().all(|coordinate| coordinate.abs() < LARGEST_COORDINATE)
        && generate_tangents(&mut corners).is_err()
    {
        corners.tangents.fill([0.0; 4]);
    }
    let tangents = corners.tangents;

    const NONE: u32 = u32::MAX;
    // The new vertices of each old vertex, as linked lists: most hold one, and none of this hashes.
    let mut first = vec![NONE; primitive.positions.len()];
    let (mut next, mut sources, mut new_tangents): (Vec<u32>, Vec<u32>, Vec<[f32; 4]>) = Default::default();
    for (corner, tangent) in tangents.into_iter().enumerate() {
        let source = primitive.indices[corner];
        let mut vertex = first[source as usize];
        while vertex != NONE && new_tangents[vertex as usize] != tangent {
            vertex = next[vertex as usize];
        }
        if vertex == NONE {
            vertex = sources.len() as u32;
            next.push(std::mem::replace(&mut first[source as usize], vertex));
            sources.push(source);
            new_tangents.push(tangent);
        }
        primitive.indices[corner] = vertex;
    }
    gather(primitive, &sources);
    // A corner without a tangent, for instance where the texture coordinates have no area, gets any that is perpendicular.
    if let Some(normals) = &primitive.normals {
        for (tangent, normal) in new_tangents.iter_mut().zip(normals) {
            if *tangent == [0.0; 4] {
                *tangent = Vec3::from(*normal).any_orthonormal_vector().extend(1.0).to_array();
            }
        }
    }
    primitive.tangents = Some(new_tangents);
}

/// Replaces the vertices by copies of the vertices `sources`. Tangents are dropped.
fn gather(primitive: &mut Primitive, sources: &[u32]) {
    fn pick<T: Copy>(values: &mut Vec<T>, sources: &[u32]) {
        *values = sources.iter().map(|&source| values[source as usize]).collect();
    }
    pick(&mut primitive.positions, sources);
    primitive.normals.iter_mut().for_each(|values| pick(values, sources));
    primitive.texcoords.iter_mut().flatten().for_each(|values| pick(values, sources));
    primitive.colors.iter_mut().for_each(|values| pick(values, sources));
    primitive.tangents = None;
}

/// Unit normal of the side that sees the corners counter-clockwise; `None` for a triangle without area.
fn face_normal(triangle: [[f32; 3]; 3]) -> Option<Vec3> {
    // In f64, since the product of two short edges underflows in f32.
    let [a, b, c] = triangle.map(|corner| Vec3::from(corner).as_dvec3());
    (b - a).cross(c - a).try_normalize().map(|normal| normal.as_vec3())
}

struct Corners<'a> {
    primitive: &'a Primitive,
    texture: TextureRef,
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.primitive.indices[face * 3 + corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.primitive.triangle_count()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.primitive.positions[self.vertex(face, corner)]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.primitive.normals.as_ref().map_or([0.0, 0.0, 1.0], |normals| normals[self.vertex(face, corner)])
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let set = self.primitive.texcoords[self.texture.texcoord as usize].as_ref();
        let coordinates = set.map_or([0.0; 2], |set| set[self.vertex(face, corner)]);
        // Tangents follow the coordinates with which the texture is read, hence after its transform. MikkTSpace takes v
        // upwards, glTF downwards.
        let [u, v] = self.texture.apply(coordinates);
        Vec2::new(u, 1.0 - v).to_array()
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, corner: usize) {
        let Some(tangent) = tangent else { return };
        // The sign as it comes belongs to v upwards as flipped above, which is what glTF's bitangent means.
        let encoded = tangent.tangent_encoded();
        if encoded.iter().all(|value| value.is_finite()) {
            self.tangents[face * 3 + corner] = encoded;
        }
    }
}
