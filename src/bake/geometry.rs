//! The triangles of an instance by what they are made of: vertices are parted where surfaces meet, since each lies elsewhere in the atlas.

use std::collections::{BTreeMap, HashMap};

use glam::{DMat3, DVec3};

use super::BakeError;
use super::atlas::Atlas;
use super::light::Light;
use super::materials::{Look, unit};
use crate::frame::rays::TriangleChart;
use crate::scene::{Alpha, Instance, Primitive, Scene};

/// How far backs lie behind fronts, over the scene's radius: some viewers draw both.
const BEHIND: f64 = 1e-5;

/// The exponent of what is black.
const LEAST: i32 = -126;

/// A vertex of the baked file.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    /// In the primitive.
    source: u32,
    /// In the atlas.
    coordinates: [f32; 2],
    /// Of its triangles, by their area, towards the front; of vertices of backs alone.
    front: DVec3,
}

/// Triangles of one look.
#[derive(Default)]
pub(super) struct Group {
    vertices: Vec<Vertex>,
    pub(super) indices: Vec<u32>,
    /// Of a vertex of the primitive on a sheet.
    known: HashMap<(u32, Option<usize>), u32>,
}

/// What a primitive's vertices say, in the order of a group.
pub(super) struct Arrays {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Option<Vec<[f32; 3]>>,
    pub(super) texcoords: [Option<Vec<[f32; 2]>>; 2],
    pub(super) colors: Option<Vec<[f32; 4]>>,
}

/// Where things stand in the baked file.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) origin: DVec3,
    pub(super) radius: f64,
}

fn wide(values: [f32; 3]) -> DVec3 {
    DVec3::from(values.map(f64::from))
}

impl Group {
    fn add(&mut self, corners: [u32; 3], sheet: Option<usize>, coordinates: [[f32; 2]; 3], front: DVec3) {
        for corner in 0..3 {
            let vertices = &mut self.vertices;
            let index = *self.known.entry((corners[corner], sheet)).or_insert_with(|| {
                let (source, front) = (corners[corner], DVec3::ZERO);
                vertices.push(Vertex { source, coordinates: coordinates[corner], front });
                (vertices.len() - 1) as u32
            });
            self.vertices[index as usize].front += front;
            self.indices.push(index);
        }
    }
}

/// The triangles of an instance, by their looks.
pub(super) fn groups(
    scene: &Scene,
    instance: &Instance,
    charts: &[Option<TriangleChart>],
    atlas: &Atlas,
    light: &Light,
) -> BTreeMap<Look, Group> {
    let primitive = primitive_of(scene, instance);
    let material = &scene.materials()[primitive.material.0];
    // The thickness of glass is in the units of its mesh.
    let scale = if material.thickness > 0.0 { instance.world.matrix3.determinant().abs().cbrt() as f32 } else { 1.0 };
    let kept = |light| Look::Kept { id: primitive.material, scale: scale.to_bits(), light };
    let has_room = material.textures().all(|texture| texture.texcoord == 0);
    let cut_by = (material.alpha != Alpha::Opaque).then_some(primitive.material);
    let order = if instance.flips_winding { [0, 2, 1] } else { [0, 1, 2] };
    let mut groups: BTreeMap<Look, Group> = BTreeMap::new();
    for (indices, chart) in primitive.indices.chunks_exact(3).zip(charts) {
        let corners = order.map(|corner| indices[corner]);
        let [a, b, c] =
            corners.map(|corner| instance.world.transform_vector3(wide(primitive.positions[corner as usize])));
        let front = (b - a).cross(c - a);
        // Without an area it shows nothing.
        if front == DVec3::ZERO || !front.is_finite() {
            continue;
        }
        let Some(chart) = chart else {
            groups.entry(kept(None)).or_default().add(corners, None, [[0.0; 2]; 3], DVec3::ZERO);
            continue;
        };
        let keeps = light.kept[chart.surface as usize];
        // Light can be added where the second set of coordinates is free.
        if keeps && !has_room {
            groups.entry(kept(None)).or_default().add(corners, None, [[0.0; 2]; 3], DVec3::ZERO);
            continue;
        }
        for side in 0..2 {
            let Some(sheet) = atlas.sheet(chart.surface, side).filter(|_| chart.firsts[side].is_some()) else {
                continue;
            };
            let exponent = light.exponents[sheet];
            let look = if keeps { kept(Some(exponent.unwrap_or(LEAST))) } else { Look::Baked { exponent, cut_by } };
            let coordinates = chart.corners.map(|place| atlas.coordinates(sheet, place));
            let group = groups.entry(look).or_default();
            if side == 0 {
                group.add(corners, Some(sheet), coordinates, DVec3::ZERO);
            } else {
                let turned = [0, 2, 1];
                group.add(turned.map(|it| corners[it]), Some(sheet), turned.map(|it| coordinates[it]), front);
            }
        }
    }
    groups
}

pub(super) fn primitive_of<'a>(scene: &'a Scene, instance: &Instance) -> &'a Primitive {
    &scene.meshes()[instance.mesh.0].primitives[instance.primitive]
}

impl Group {
    /// What the file needs of the vertices.
    ///
    /// # Errors
    /// They lie beyond the range of floats.
    pub(super) fn arrays(
        &self,
        scene: &Scene,
        instance: &Instance,
        look: Look,
        place: Place,
    ) -> Result<Arrays, BakeError> {
        let primitive = primitive_of(scene, instance);
        let material = &scene.materials()[primitive.material.0];
        let positions = self.vertices.iter().map(|vertex| {
            let world = instance.world.transform_point3(wide(primitive.positions[vertex.source as usize]));
            let behind = vertex.front.normalize_or_zero() * (BEHIND * place.radius);
            (world - behind - place.origin).as_vec3().to_array()
        });
        let positions: Vec<[f32; 3]> = positions.collect();
        if !positions.as_flattened().iter().all(|at| at.is_finite()) {
            return Err(BakeError::Beyond { scene: scene.name.clone() });
        }
        let of = |set: usize| -> Option<Vec<[f32; 2]>> {
            let all = primitive.texcoords[set].as_ref()?;
            Some(self.vertices.iter().map(|vertex| finite(all[vertex.source as usize])).collect())
        };
        let colors = primitive.colors.as_ref().filter(|_| !matches!(look, Look::Baked { cut_by: None, .. }));
        let colors =
            colors.map(|all| self.vertices.iter().map(|vertex| all[vertex.source as usize].map(unit)).collect());
        Ok(match look {
            Look::Kept { light, .. } => {
                let used = |set: u32| material.textures().any(|texture| texture.texcoord == set);
                // Textures without coordinates are read at their zero, and the format wants a first set before a second one.
                let set = |set: usize| of(set).unwrap_or_else(|| vec![[0.0; 2]; self.vertices.len()]);
                let lit = light.map(|_| self.vertices.iter().map(|vertex| vertex.coordinates).collect());
                let second = lit.or_else(|| used(1).then(|| set(1)));
                let first = (used(0) || second.is_some()).then(|| set(0));
                Arrays { positions, normals: self.normals(primitive, instance), texcoords: [first, second], colors }
            }
            Look::Baked { cut_by, .. } => {
                let baked: Vec<[f32; 2]> = self.vertices.iter().map(|vertex| vertex.coordinates).collect();
                let cutting = material.base_color_texture.filter(|_| cut_by.is_some());
                let own = cutting.map(|texture| {
                    let all = of(texture.texcoord as usize).unwrap_or_else(|| vec![[0.0; 2]; baked.len()]);
                    all.into_iter().map(|at| finite(texture.apply(at))).collect()
                });
                let own = own.or_else(|| of(0)).unwrap_or_else(|| baked.clone());
                Arrays { positions, normals: None, texcoords: [Some(own), Some(baked)], colors }
            }
        })
    }

    /// By the inverse transpose.
    fn normals(&self, primitive: &Primitive, instance: &Instance) -> Option<Vec<[f32; 3]>> {
        let all = primitive.normals.as_ref()?;
        let [x, y, z] = [instance.world.matrix3.x_axis, instance.world.matrix3.y_axis, instance.world.matrix3.z_axis];
        let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        let side = if instance.flips_winding { -1.0 } else { 1.0 };
        let turned = |vertex: &Vertex| {
            let normal = cofactors * wide(all[vertex.source as usize]) * side;
            let normal = if vertex.front == DVec3::ZERO { normal } else { -normal };
            normal.normalize_or(DVec3::Y).as_vec3().normalize_or(glam::Vec3::Y).to_array()
        };
        Some(self.vertices.iter().map(turned).collect())
    }
}

fn finite(at: [f32; 2]) -> [f32; 2] {
    at.map(|it| if it.is_finite() { it } else { 0.0 })
}
