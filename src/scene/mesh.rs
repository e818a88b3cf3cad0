//! Triangle meshes in their own space, and their placement in the world.

use super::{MaterialId, MeshId, NodeId};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

/// A named group of primitives that nodes place together.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// One entry a material. Primitives that hold no triangles (points, lines) are not kept.
    pub primitives: Vec<Primitive>,
}

/// A triangle list with one material. All vertex arrays that are present have as many elements as `positions`.
#[derive(Clone, Debug, Default)]
pub struct Primitive {
    /// Object-space positions, finite, in metres after the node's transform.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals. `None` means flat shading: each triangle's own normal, which a shader has without vertex data.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Unit tangents along +u; `w` is ±1, the bitangent is `w · (normal × tangent)`. Loading keeps or makes them only where the
    /// material has a normal texture.
    pub tangents: Option<Vec<[f32; 4]>>,
    /// Texture coordinate sets 0 and 1; v grows downwards in the image.
    pub texcoords: [Option<Vec<[f32; 2]>>; 2],
    /// Linear RGBA that multiplies the base colour.
    pub colors: Option<Vec<[f32; 4]>>,
    /// Three indices a triangle, each below `positions.len()`. The front side sees them counter-clockwise.
    pub indices: Vec<u32>,
    /// The material of all triangles.
    pub material: MaterialId,
    /// Bytes of vertex and index data as the file stores them: what memory use is measured against. 0 if built in memory.
    pub source_bytes: u64,
}

/// Elements that a thread takes at once: enough to be worth its while, and few enough that a near cache holds them.
pub(crate) const CHUNK: usize = 1 << 13;

/// Whether the numbers of all vertices are finite: all at once, without a branch.
pub(crate) fn all_finite<const N: usize>(values: &[[f32; N]]) -> bool {
    !values.as_flattened().iter().fold(false, |any, axis| any | !axis.is_finite())
}

/// The largest of some indices.
pub(crate) fn largest_index(indices: &[u32]) -> u32 {
    indices.iter().fold(0, |largest, &index| largest.max(index))
}

/// The first vertex with a number that is not finite.
pub(crate) fn first_endless<const N: usize>(values: &[[f32; N]]) -> Option<usize> {
    let endless = |value: &[f32; N]| !value.iter().all(|axis| axis.is_finite());
    // Only a chunk that has such a number is searched.
    let in_chunk = |(index, chunk): (usize, &[[f32; N]])| {
        let found = if all_finite(chunk) { None } else { chunk.iter().position(endless) };
        found.map(|vertex| index * CHUNK + vertex)
    };
    values.par_chunks(CHUNK).enumerate().find_map_first(in_chunk)
}

impl Primitive {
    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// Bytes that its arrays occupy.
    pub fn bytes(&self) -> usize {
        let texcoords = self.texcoords.iter().flatten();
        size_of_val(&self.positions[..])
            + self.normals.as_ref().map_or(0, |values| size_of_val(&values[..]))
            + self.tangents.as_ref().map_or(0, |values| size_of_val(&values[..]))
            + texcoords.map(|values| size_of_val(&values[..])).sum::<usize>()
            + self.colors.as_ref().map_or(0, |values| size_of_val(&values[..]))
            + size_of_val(&self.indices[..])
    }

    /// The corner positions of every triangle, in index order.
    pub fn triangles(&self) -> impl Iterator<Item = [[f32; 3]; 3]> {
        self.indices
            .chunks_exact(3)
            .map(|corners| std::array::from_fn(|corner| self.positions[corners[corner] as usize]))
    }

    /// Says which vertex array has another length than the positions, if any has.
    pub(super) fn length_fault(&self) -> Option<String> {
        let count = self.positions.len();
        let lengths = [
            ("normals", self.normals.as_ref().map(Vec::len)),
            ("tangents", self.tangents.as_ref().map(Vec::len)),
            ("texture coordinates 0", self.texcoords[0].as_ref().map(Vec::len)),
            ("texture coordinates 1", self.texcoords[1].as_ref().map(Vec::len)),
            ("colours", self.colors.as_ref().map(Vec::len)),
        ];
        let other =
            lengths.into_iter().find_map(|(what, length)| Some((what, length.filter(|&length| length != count)?)));
        other.map(|(what, length)| format!("it has {count} positions but {length} {what}"))
    }

    /// Says what contradicts the description of the fields, if anything does.
    pub(super) fn fault(&self) -> Option<String> {
        self.count_fault().or_else(|| self.number_fault())
    }

    /// The same of how many there are of everything.
    pub(super) fn count_fault(&self) -> Option<String> {
        if self.indices.len().is_multiple_of(3) {
            return self.length_fault();
        }
        Some(format!("{} indices do not make whole triangles", self.indices.len()))
    }

    fn number_fault(&self) -> Option<String> {
        if let Some(vertex) = first_endless(&self.positions) {
            return Some(format!("the position of vertex {vertex} is not finite"));
        }
        let highest = self.indices.par_chunks(CHUNK).map(largest_index).max();
        let count = self.positions.len();
        highest
            .filter(|&index| index as usize >= count)
            .map(|index| format!("an index is {index}, past its {count} vertices"))
    }
}

/// One primitive of one mesh where one node places it: what is drawn and traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// The node that places it.
    pub node: NodeId,
    /// The mesh.
    pub mesh: MeshId,
    /// Index into the mesh's primitives.
    pub primitive: usize,
    /// Object space to world space.
    pub world: DAffine3,
    /// Whether the transform mirrors (its determinant is negative): front faces are then clockwise in world space.
    pub flips_winding: bool,
}

/// An axis-aligned box in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The smallest coordinates.
    pub min: DVec3,
    /// The largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The middle.
    pub fn center(&self) -> DVec3 {
        // Halved before they are added, so that no finite box overflows.
        self.min * 0.5 + self.max * 0.5
    }

    /// Edge lengths.
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// Half the diagonal: the radius of the sphere around the centre that holds the box.
    pub fn radius(&self) -> f64 {
        self.size().length() * 0.5
    }

    /// The smallest box that holds both.
    pub fn union(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }
}

/// The tight box around the corners that count of some placed triangles; `None` if there are none.
pub(super) fn bounds_of(primitive: &Primitive, world: &DAffine3, counts: impl Fn(&DVec3) -> bool) -> Option<Bounds> {
    let corners = primitive.indices.iter().map(|&index| {
        let [x, y, z] = primitive.positions[index as usize];
        world.transform_point3(DVec3::new(x.into(), y.into(), z.into()))
    });
    corners.filter(counts).map(|point| Bounds { min: point, max: point }).reduce(Bounds::union)
}
