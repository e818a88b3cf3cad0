//! All instances flattened to triangles in render space, with the attributes of their corners.

use glam::{DMat3, DVec3, Vec3};

use crate::frame::octahedral::pack_direction;
use crate::scene::bvh::BvhTriangle;
use crate::scene::{Facts, Primitive, Scene};
use crate::vulkan::VulkanError;

/// No vertex normals (TRIANGLE_FLAT).
const FLAT: u32 = 1 << 31;

/// A triangle of the scene in render space, counter-clockwise as seen from its front.
#[derive(Clone, Copy, Debug)]
pub(super) struct TracedTriangle {
    pub(super) corners: [Vec3; 3],
    pub(super) material: u32,
    /// Packed, at the corners; `None`: flat.
    normals: Option<[u32; 3]>,
    /// Its area by its mesh and how that is stretched, m²: the same bits wherever it moves.
    pub(super) own_area: f32,
}

impl TracedTriangle {
    /// Without vertex normals.
    #[cfg(test)]
    pub(super) fn flat(corners: [Vec3; 3], material: u32) -> TracedTriangle {
        let [edge1, edge2] = [corners[1] - corners[0], corners[2] - corners[0]];
        TracedTriangle { corners, material, normals: None, own_area: 0.5 * edge1.cross(edge2).length() }
    }

    fn edges(&self) -> [Vec3; 2] {
        [self.corners[1] - self.corners[0], self.corners[2] - self.corners[0]]
    }

    /// Packed, of one of its corners; `None`: it is flat.
    pub(super) fn vertex_normal(&self, corner: usize) -> Option<u32> {
        self.normals.map(|normals| normals[corner])
    }

    /// The largest of its corners' distances from a point, metres.
    pub(super) fn farthest(&self, point: DVec3) -> f64 {
        self.corners.iter().map(|corner| corner.as_dvec3().distance(point)).fold(0.0, f64::max)
    }

    /// Its distance from a point, at least, metres.
    pub(super) fn nearest(&self, point: DVec3) -> f64 {
        let middle = self.middle();
        let radius = self.corners.iter().map(|corner| corner.as_dvec3().distance(middle)).fold(0.0, f64::max);
        middle.distance(point) - radius
    }

    pub(super) fn middle(&self) -> DVec3 {
        self.corners.iter().map(|corner| corner.as_dvec3()).sum::<DVec3>() / 3.0
    }

    /// Of its front; zero if it has no area.
    pub(super) fn normal(&self) -> DVec3 {
        let [edge1, edge2] = self.edges().map(Vec3::as_dvec3);
        edge1.cross(edge2).normalize_or_zero()
    }

    /// m²
    pub(super) fn area(&self) -> f64 {
        let [edge1, edge2] = self.edges().map(Vec3::as_dvec3);
        0.5 * edge1.cross(edge2).length()
    }

    /// Distance of its plane from the origin along its normal, metres.
    fn plane(&self) -> f32 {
        BvhTriangle { corners: self.corners.map(|corner| corner.to_array()), flags: 0 }.plane()
    }

    /// `cells`: where on it points are drawn (`CellTables`).
    pub(super) fn record(&self, light_density: f32, cells: u32) -> [[u32; 4]; 4] {
        let [edge1, edge2] = self.edges();
        let words = |vector: Vec3, last: u32| [vector.x.to_bits(), vector.y.to_bits(), vector.z.to_bits(), last];
        let normals = self.normals.unwrap_or_default();
        [
            words(self.corners[0], self.material | if self.normals.is_none() { FLAT } else { 0 }),
            words(edge1, normals[0]),
            words(edge2, normals[1]),
            [normals[2], light_density.to_bits(), self.plane().to_bits(), cells],
        ]
    }
}

/// Attributes of corners, three elements a triangle, or a single one if no primitive has the attribute.
#[derive(Default)]
pub(super) struct Corners {
    pub(super) colors: Vec<[u8; 4]>,
    pub(super) texcoords: Vec<[f32; 4]>,
    pub(super) tangents: Vec<[f32; 4]>,
}

pub(super) fn flatten(
    scene: &Scene,
    origin: DVec3,
    facts: &Facts,
) -> Result<(Vec<TracedTriangle>, Corners), VulkanError> {
    let mut triangles = Vec::new();
    let mut corners = Corners::default();
    for instance in scene.instances() {
        let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
        let world = instance.world;
        let positions: Vec<Vec3> = primitive
            .positions
            .iter()
            .map(|&position| (world.transform_point3(DVec3::from(position.map(f64::from))) - origin).as_vec3())
            .collect();
        let normals = primitive.normals.as_ref().map(|normals| packed_normals(normals, world.matrix3));
        let order = if instance.flips_winding { [0, 2, 1] } else { [0, 1, 2] };
        let material = u32::try_from(primitive.material.0).unwrap_or(0);
        triangles.extend(primitive.indices.chunks_exact(3).map(|indices| {
            let vertices = order.map(|corner| indices[corner] as usize);
            let [a, b, c] =
                [0, 1, 2].map(|corner| DVec3::from(primitive.positions[indices[corner] as usize].map(f64::from)));
            TracedTriangle {
                corners: vertices.map(|vertex| positions[vertex]),
                material,
                normals: normals.as_ref().map(|normals| vertices.map(|vertex| normals[vertex])),
                own_area: (0.5 * (world.matrix3 * (b - a)).cross(world.matrix3 * (c - a)).length()) as f32,
            }
        }));
        corners.extend(primitive, order, world.matrix3, facts);
    }
    corners.complete();
    if triangles.len() >= (u32::MAX / 12) as usize {
        return Err(VulkanError::TooLarge {
            what: "the scene".to_owned(),
            asked: format!("{} triangles to trace rays against", triangles.len()),
            limit: (u32::MAX / 12).to_string(),
        });
    }
    Ok((triangles, corners))
}

/// Normals in render space: by the inverse transpose, which keeps them perpendicular, times any positive factor.
fn packed_normals(normals: &[[f32; 3]], world: DMat3) -> Vec<u32> {
    let [a, b, c] = [world.x_axis, world.y_axis, world.z_axis];
    let cofactors = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
    let largest = cofactors.to_cols_array().into_iter().map(f64::abs).fold(f64::MIN_POSITIVE, f64::max);
    let side = if world.determinant() < 0.0 { -1.0 } else { 1.0 };
    let to_render = cofactors * (side / largest);
    normals.iter().map(|normal| pack_direction((to_render * DVec3::from(normal.map(f64::from))).as_vec3())).collect()
}

impl Corners {
    /// Adds the corners of an instance's triangles, each triangle's in `order`.
    fn extend(&mut self, primitive: &Primitive, order: [usize; 3], world: DMat3, facts: &Facts) {
        let vertices =
            || primitive.indices.chunks_exact(3).flat_map(|indices| order.map(|corner| indices[corner] as usize));
        if facts.vertex_colors {
            let byte = |channel: f32| (channel.clamp(0.0, 1.0) * 255.0).round() as u8;
            self.colors.extend(
                vertices().map(|vertex| primitive.colors.as_ref().map_or([255; 4], |colors| colors[vertex].map(byte))),
            );
        }
        if facts.textured {
            let set = |set: usize, vertex: usize| primitive.texcoords[set].as_ref().map_or([0.0; 2], |uv| uv[vertex]);
            self.texcoords.extend(vertices().map(|vertex| {
                let [[u0, v0], [u1, v1]] = [set(0, vertex), set(1, vertex)];
                [u0, v0, u1, v1]
            }));
        }
        if facts.normal_mapped {
            let side = if world.determinant() < 0.0 { -1.0 } else { 1.0 };
            self.tangents.extend(vertices().map(|vertex| {
                let Some(tangents) = &primitive.tangents else { return [0.0; 4] };
                let [x, y, z, sign] = tangents[vertex].map(f64::from);
                (world * DVec3::new(x, y, z)).normalize_or_zero().extend(sign * side).as_vec4().to_array()
            }));
        }
    }

    /// An attribute that no primitive has is a single element.
    fn complete(&mut self) {
        if self.colors.is_empty() {
            self.colors.push([255; 4]);
        }
        if self.texcoords.is_empty() {
            self.texcoords.push([0.0; 4]);
        }
        if self.tangents.is_empty() {
            self.tangents.push([0.0; 4]);
        }
    }
}
