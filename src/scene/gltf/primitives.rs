//! Meshes: every primitive becomes an indexed triangle list with checked attributes.

use super::accessor::Integers;
use super::document::{self, get};
use super::loader::Loader;
use crate::scene::{Mesh, MeshId, Primitive, tangents};
use rayon::prelude::*;
use std::collections::{BTreeSet, HashMap};

/// A mesh before its materials are known: for each primitive that is kept, its data and the file's material.
pub(super) struct RawMesh {
    name: String,
    pub(super) primitives: Vec<(Primitive, Option<usize>)>,
}

/// A primitive that cannot be shown, or the fault of one that cannot be read.
enum Dropped {
    Skipped(String),
    Fault(String),
}

impl From<String> for Dropped {
    fn from(fault: String) -> Self {
        Dropped::Fault(fault)
    }
}

impl Loader<'_> {
    /// Reads the meshes with these indices, all primitives in parallel.
    pub(super) fn read_meshes(&mut self, indices: &BTreeSet<usize>) -> Result<Vec<RawMesh>, String> {
        let mut meshes = Vec::new();
        let mut jobs = Vec::new();
        let mut morphed = 0;
        for &index in indices {
            let mesh = get(&self.document.meshes, index, "mesh")?;
            let name = mesh.name.clone().unwrap_or_default();
            for number in 0..mesh.primitives.len() {
                let primitive = get(&mesh.primitives, number, "primitive")
                    .map_err(|fault| format!("mesh {index} {name:?}: {fault}"))?;
                morphed += usize::from(primitive.targets.as_array().is_some_and(|targets| !targets.is_empty()));
                jobs.push((meshes.len(), format!("mesh {index} {name:?}, primitive {number}"), primitive));
            }
            meshes.push(RawMesh { name, primitives: Vec::new() });
        }
        if morphed > 0 {
            self.warn(format!("morph targets are not supported: {morphed} primitives keep their base shape"));
        }
        let results: Vec<_> = jobs
            .par_iter()
            .map(|(mesh, label, primitive)| (*mesh, label, primitive.material, self.read(primitive)))
            .collect();
        let mut without_triangles = Vec::new();
        for (mesh, label, material, result) in results {
            match result {
                Ok(primitive) => meshes[mesh].primitives.push((primitive, material)),
                Err(Dropped::Skipped(reason)) => without_triangles.push(format!("{label} ({reason})")),
                Err(Dropped::Fault(fault)) => return Err(format!("{label}: {fault}")),
            }
        }
        if let Some(first) = without_triangles.first() {
            self.warn(format!("{} primitives are left out; the first is {first}", without_triangles.len()));
        }
        Ok(meshes)
    }

    /// Gives the primitives their materials, and tangents where those have normal textures.
    pub(super) fn add_meshes(
        &mut self,
        indices: &BTreeSet<usize>,
        meshes: Vec<RawMesh>,
        materials: &HashMap<Option<usize>, crate::scene::MaterialId>,
    ) -> Result<HashMap<usize, MeshId>, String> {
        let mut ids = HashMap::new();
        for (&index, raw) in indices.iter().zip(meshes) {
            let scene_materials = self.scene.materials();
            let primitives = raw.primitives.into_par_iter().map(|(mut primitive, material)| {
                primitive.material = materials[&material];
                match scene_materials[primitive.material.0].normal_texture {
                    Some(texture) => tangents::complete(&mut primitive, texture),
                    None => primitive.tangents = None,
                }
                primitive
            });
            let mesh = Mesh { name: raw.name, primitives: primitives.collect() };
            ids.insert(index, self.scene.add_mesh(mesh).map_err(|error| format!("mesh {index}: {error}"))?);
        }
        Ok(ids)
    }

    fn read(&self, primitive: &document::Primitive) -> Result<Primitive, Dropped> {
        let attributes = &primitive.attributes;
        if !(4..=6).contains(&primitive.mode) {
            return Err(Dropped::Skipped("it is made of points or lines".into()));
        }
        let Some(position_accessor) = attributes.positions else {
            return Err(Dropped::Skipped("it has no positions".into()));
        };
        let accessors = &self.accessors;
        let positions = accessors.vectors::<3>(position_accessor, Integers::AsDeclared)?;
        let order = match primitive.indices {
            Some(indices) => accessors.indices(indices)?,
            None => {
                (0..u32::try_from(positions.len()).map_err(|_| "it has more than 2³² vertices".to_owned())?).collect()
            }
        };
        if let Some(index) = order.iter().find(|&&index| index as usize >= positions.len()) {
            return Err(format!("an index is {index}, past its {} vertices", positions.len()).into());
        }
        let texcoords = |accessor: Option<usize>| {
            accessor.map(|accessor| accessors.vectors::<2>(accessor, Integers::AsDeclared)).transpose()
        };
        let mut result = Primitive {
            normals: attributes
                .normals
                .map(|accessor| accessors.vectors::<3>(accessor, Integers::Normalized))
                .transpose()?,
            tangents: attributes
                .tangents
                .map(|accessor| accessors.vectors::<4>(accessor, Integers::Normalized))
                .transpose()?,
            texcoords: [texcoords(attributes.texcoords_0)?, texcoords(attributes.texcoords_1)?],
            colors: attributes.colors.map(|accessor| self.colors(accessor)).transpose()?,
            indices: triangle_list(order, primitive.mode),
            positions,
            ..Primitive::default()
        };
        let sources = [
            Some(position_accessor),
            attributes.normals,
            attributes.tangents,
            attributes.texcoords_0,
            attributes.texcoords_1,
            attributes.colors,
            primitive.indices,
        ];
        result.source_bytes = sources
            .into_iter()
            .flatten()
            .fold(0, |sum: u64, accessor| sum.saturating_add(accessors.stored_bytes(accessor)));
        if let Some(fault) = result.length_fault() {
            return Err(fault.into());
        }
        drop_unused_vertices(&mut result);
        accessors.keep(result.bytes())?;
        if !result.positions.iter().flatten().all(|axis| axis.is_finite()) {
            return Err(Dropped::Skipped("a position is not finite".into()));
        }
        tangents::repair_normals(&mut result);
        Ok(result)
    }

    /// COLOR_0 as RGBA; RGB is opaque.
    fn colors(&self, accessor: usize) -> Result<Vec<[f32; 4]>, String> {
        let mut colors = match self.accessors.width(accessor)? {
            3 => self
                .accessors
                .vectors::<3>(accessor, Integers::Normalized)?
                .into_iter()
                .map(|[r, g, b]| [r, g, b, 1.0])
                .collect(),
            _ => self.accessors.vectors::<4>(accessor, Integers::Normalized)?,
        };
        // A colour that is not a number would spread through every sum that it enters.
        colors
            .iter_mut()
            .flatten()
            .for_each(|channel| *channel = if channel.is_finite() { channel.clamp(0.0, 1.0) } else { 1.0 });
        Ok(colors)
    }
}

/// Corners in drawing order to a triangle list (glTF 2.0, 3.7.2.1). Incomplete triangles at the end are dropped, and so are
/// the triangles without area that join the parts of a strip.
fn triangle_list(order: Vec<u32>, mode: u64) -> Vec<u32> {
    let triangles: Vec<[u32; 3]> = match mode {
        5 => {
            let corners = order.windows(3).enumerate();
            corners
                .map(|(number, at)| if number % 2 == 0 { [at[0], at[1], at[2]] } else { [at[0], at[2], at[1]] })
                .collect()
        }
        6 => order.get(1..).unwrap_or_default().windows(2).map(|at| [at[0], at[1], order[0]]).collect(),
        _ => {
            let mut order = order;
            order.truncate(order.len() / 3 * 3);
            return order;
        }
    };
    triangles.into_iter().filter(|[a, b, c]| a != b && b != c && c != a).flatten().collect()
}

/// Keeps only the vertices that a triangle uses, in their order: files may share one large vertex array among many primitives.
fn drop_unused_vertices(primitive: &mut Primitive) {
    let mut used = vec![false; primitive.positions.len()];
    primitive.indices.iter().for_each(|&index| used[index as usize] = true);
    if used.iter().all(|&used| used) {
        return;
    }
    let kept_before = |kept: &mut u32, &used: &bool| {
        let index = *kept;
        *kept += u32::from(used);
        Some(index)
    };
    let new_indices: Vec<u32> = used.iter().scan(0, kept_before).collect();
    primitive.indices.iter_mut().for_each(|index| *index = new_indices[*index as usize]);
    fn keep<T>(values: &mut Vec<T>, used: &[bool]) {
        let mut used = used.iter();
        values.retain(|_| used.next().copied().unwrap_or(false));
        values.shrink_to_fit();
    }
    keep(&mut primitive.positions, &used);
    primitive.normals.iter_mut().for_each(|values| keep(values, &used));
    primitive.tangents.iter_mut().for_each(|values| keep(values, &used));
    primitive.texcoords.iter_mut().flatten().for_each(|values| keep(values, &used));
    primitive.colors.iter_mut().for_each(|values| keep(values, &used));
}
