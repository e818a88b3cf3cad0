//! The scene as rays meet it (glsl/lib/traced_scene.glsl): all instances flattened to triangles in render space, their corners'
//! attributes, a bounding volume hierarchy, textures as plain texels, and what next-event estimation draws lights from.

use std::sync::Arc;

use ash::vk;
use glam::{DMat3, DVec3, Vec3};

use super::emitters::{EmitterTable, emitter_table};
use super::texels::Texels;
use crate::frame::light_set::{punctual_light, shining_lights};
use crate::frame::scene_data::{material_record, texture_kinds};
use crate::frame::textures::texture_uses;
use crate::graph::bindings::TexelBuffer;
use crate::graph::{Dependence, Graph, hash_of};
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::scene::{Alpha, Bounds, Facts, Material, Primitive, Scene};
use crate::shaders::types;
use crate::vulkan::{Buffer, Device, VulkanError, buffer_with};

/// No vertex normals (TRIANGLE_FLAT).
const FLAT: u32 = 1 << 31;

/// A triangle of the scene in render space, counter-clockwise as seen from its front.
#[derive(Clone, Copy, Debug)]
pub(super) struct TracedTriangle {
    pub(super) corners: [Vec3; 3],
    pub(super) material: u32,
    flat: bool,
    /// Of the attributes.
    numbers: [u32; 3],
}

impl TracedTriangle {
    fn edges(&self) -> [Vec3; 2] {
        [self.corners[1] - self.corners[0], self.corners[2] - self.corners[0]]
    }

    /// m²
    pub(super) fn area(&self) -> f64 {
        let [edge1, edge2] = self.edges().map(Vec3::as_dvec3);
        0.5 * edge1.cross(edge2).length()
    }

    fn record(&self, light_density: f32) -> [[u32; 4]; 4] {
        let [edge1, edge2] = self.edges();
        let words = |vector: Vec3, last: u32| [vector.x.to_bits(), vector.y.to_bits(), vector.z.to_bits(), last];
        [
            words(self.corners[0], self.material | if self.flat { FLAT } else { 0 }),
            words(edge1, self.numbers[0]),
            words(edge2, self.numbers[1]),
            [self.numbers[2], light_density.to_bits(), 0, 0],
        ]
    }
}

/// Attributes of corners, one element a vertex of an instance, or a single one if no primitive has the attribute.
#[derive(Default)]
struct Corners {
    normals: Vec<[f32; 4]>,
    colors: Vec<[u8; 4]>,
    texcoords: Vec<[f32; 4]>,
    tangents: Vec<[f32; 4]>,
}

/// A scene on the device, ready for rays.
pub(crate) struct TracedScene {
    pub(crate) key: u64,
    pub(crate) origin: DVec3,
    /// Of the sphere around the scene, metres.
    pub(crate) radius: f64,
    pub(crate) facts: Facts,
    pub(crate) sky: [f32; 3],
    /// The kinds of textures that any material reads, as the shaders' bits.
    pub(crate) texture_kinds: u32,
    pub(crate) emissive_textures: bool,
    pub(crate) emitter_count: u32,
    /// Some light ends at a range, so that paths from it are none.
    pub(super) ranged_lights: bool,
    /// Of all triangles, m².
    pub(super) area: f64,
    /// What all lights but the sky send out, W (luminance).
    pub(super) power: f64,
    buffers: Vec<(&'static str, Arc<Buffer>, vk::Format)>,
}

/// The scene's buffers as passes bind them.
#[derive(Clone)]
pub(crate) struct TracedBindings {
    pub(crate) bvh_nodes: TexelBuffer,
    pub(crate) bvh_triangles: TexelBuffer,
    pub(crate) triangles: TexelBuffer,
    pub(crate) corner_normals: TexelBuffer,
    pub(crate) corner_colors: TexelBuffer,
    pub(crate) corner_texcoords: TexelBuffer,
    pub(crate) corner_tangents: TexelBuffer,
    pub(crate) materials: TexelBuffer,
    pub(crate) media: TexelBuffer,
    pub(crate) material_textures: TexelBuffer,
    pub(crate) texture_table: TexelBuffer,
    pub(crate) texels: TexelBuffer,
    pub(crate) emitters: TexelBuffer,
    pub(crate) lights: TexelBuffer,
}

const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const BYTES: vk::Format = vk::Format::R8G8B8A8_UNORM;

impl TracedScene {
    /// Flattens, sorts and uploads the scene as it is now.
    pub(crate) fn new(device: &Arc<Device>, scene: &Scene) -> Result<TracedScene, VulkanError> {
        let bounds = scene.bounds().unwrap_or(Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) });
        let (origin, radius) = (bounds.center(), bounds.radius().max(1e-9));
        let facts = scene.facts();
        let (triangles, corners) = flatten(scene, origin, &facts)?;
        let lights = shining_lights(scene);
        let EmitterTable { records: emitters, light_densities, power } =
            emitter_table(&triangles, scene.materials(), &lights, radius);
        let records: Vec<[[u32; 4]; 4]> =
            triangles.iter().zip(&light_densities).map(|(triangle, density)| triangle.record(*density)).collect();
        let masked = |material: u32| scene.materials()[material as usize].alpha != Alpha::Opaque;
        let bvh_triangles: Vec<BvhTriangle> = triangles
            .iter()
            .map(|triangle| BvhTriangle {
                corners: triangle.corners.map(|corner| corner.to_array()),
                flags: u32::from(masked(triangle.material)),
            })
            .collect();
        let bvh = Bvh::build(&bvh_triangles);
        let texels = Texels::new(scene.textures())?;
        let materials: Vec<types::Material> = scene.materials().iter().map(material_record).collect();
        let media: Vec<[f32; 4]> = scene.materials().iter().map(medium).collect();
        let uses: Vec<types::MaterialTextures> = scene
            .materials()
            .iter()
            .map(|material| texture_uses(material, |texture| u32::try_from(texture.texture.0).unwrap_or(0)))
            .collect();
        let light_records: Vec<types::Light> = lights.iter().map(|placed| punctual_light(placed, origin)).collect();
        let upload = |name: &'static str, bytes: &[u8], format: vk::Format| {
            let usage = vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
            Ok::<_, VulkanError>((name, buffer_with(device, name, bytes, usage)?, format))
        };
        let buffers = vec![
            upload("traced.bvh_nodes", bytemuck::cast_slice(&bvh.nodes), WORDS)?,
            upload("traced.bvh_triangles", bytemuck::cast_slice(&bvh.triangles), FLOATS)?,
            upload("traced.triangles", bytemuck::cast_slice(&records), WORDS)?,
            upload("traced.corner_normals", bytemuck::cast_slice(&corners.normals), FLOATS)?,
            upload("traced.corner_colors", bytemuck::cast_slice(&corners.colors), BYTES)?,
            upload("traced.corner_texcoords", bytemuck::cast_slice(&corners.texcoords), FLOATS)?,
            upload("traced.corner_tangents", bytemuck::cast_slice(&corners.tangents), FLOATS)?,
            upload("traced.materials", bytemuck::cast_slice(&materials), WORDS)?,
            upload("traced.media", bytemuck::cast_slice(&media), FLOATS)?,
            upload("traced.material_textures", bytemuck::cast_slice(&uses), WORDS)?,
            upload("traced.texture_table", bytemuck::cast_slice(&texels.table), WORDS)?,
            upload("traced.texels", bytemuck::cast_slice(&texels.texels), BYTES)?,
            upload("traced.emitters", bytemuck::cast_slice(&emitters), WORDS)?,
            upload("traced.lights", bytemuck::cast_slice(&light_records), WORDS)?,
        ];
        let revisions = scene.revisions();
        Ok(TracedScene {
            key: traced_key(scene),
            origin,
            radius,
            facts,
            sky: scene.sky(),
            texture_kinds: scene.materials().iter().fold(0, |kinds, material| kinds | texture_kinds(material)),
            emissive_textures: scene
                .materials()
                .iter()
                .any(|material| material.emits() && material.emissive_texture.is_some()),
            emitter_count: u32::try_from(emitters.len()).unwrap_or(0),
            ranged_lights: lights.iter().any(|light| light.range.is_some()),
            area: triangles.iter().map(TracedTriangle::area).sum(),
            power,
            buffers,
        })
        .inspect(|_| tracing::debug!("traced scene of revision {revisions:?}"))
    }

    /// Whether lights send out paths of their own: where something glossy may gather their light, and more than direct light is
    /// asked for. The sky alone does not: camera paths find it.
    pub(super) fn needs_light_paths(&self, bounces: Option<u32>) -> bool {
        self.facts.glossy && self.emitter_count > 0 && bounces != Some(0)
    }

    /// Device memory, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffers.iter().map(|(_, buffer, _)| buffer.bytes()).sum()
    }

    pub(crate) fn import(&self, graph: &mut Graph<'_>) -> TracedBindings {
        let mut bind = |name: &str| {
            let found = self.buffers.iter().find(|(known, ..)| *known == name);
            let (name, buffer, format) = found.expect("every buffer is made with the scene");
            graph.import_buffer::<u32>(name, buffer, self.key, Dependence::GEOMETRY).texels(*format)
        };
        TracedBindings {
            bvh_nodes: bind("traced.bvh_nodes"),
            bvh_triangles: bind("traced.bvh_triangles"),
            triangles: bind("traced.triangles"),
            corner_normals: bind("traced.corner_normals"),
            corner_colors: bind("traced.corner_colors"),
            corner_texcoords: bind("traced.corner_texcoords"),
            corner_tangents: bind("traced.corner_tangents"),
            materials: bind("traced.materials"),
            media: bind("traced.media"),
            material_textures: bind("traced.material_textures"),
            texture_table: bind("traced.texture_table"),
            texels: bind("traced.texels"),
            emitters: bind("traced.emitters"),
            lights: bind("traced.lights"),
        }
    }
}

/// Names a scene's content within this process, whatever the camera sees of it.
pub(crate) fn traced_key(scene: &Scene) -> u64 {
    let revisions = scene.revisions();
    hash_of(&(scene.identity(), revisions.geometry, revisions.materials, revisions.lights))
}

/// Absorption in 1/m, and 1 where the surface bounds a medium (KHR_materials_volume: x = −ln(color)/distance).
fn medium(material: &Material) -> [f32; 4] {
    let bounds_medium = material.transmission > 0.0 && material.thickness > 0.0;
    if !bounds_medium {
        return [0.0; 4];
    }
    // An opaque medium absorbs within a thousandth of its distance.
    let absorption =
        |color: f32| (-color.max(1e-30).ln() / material.attenuation_distance).min(1e3 / material.attenuation_distance);
    let [red, green, blue] = material.attenuation_color.map(absorption).map(|value| value.max(0.0));
    [red, green, blue, 1.0]
}

fn too_many(what: &str) -> VulkanError {
    VulkanError::TooLarge {
        what: "the scene".to_owned(),
        asked: format!("more {what} than rays can number"),
        limit: "2³¹".to_owned(),
    }
}

fn flatten(scene: &Scene, origin: DVec3, facts: &Facts) -> Result<(Vec<TracedTriangle>, Corners), VulkanError> {
    let mut triangles = Vec::new();
    let mut corners = Corners::default();
    for instance in scene.instances() {
        let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
        let first = u32::try_from(corners.normals.len()).map_err(|_| too_many("vertices"))?;
        u32::try_from(corners.normals.len() + primitive.positions.len())
            .ok()
            .filter(|&count| count < FLAT)
            .ok_or_else(|| too_many("vertices"))?;
        let world = instance.world;
        let positions: Vec<Vec3> = primitive
            .positions
            .iter()
            .map(|&position| (world.transform_point3(DVec3::from(position.map(f64::from))) - origin).as_vec3())
            .collect();
        corners.extend(primitive, world.matrix3, facts);
        let material = u32::try_from(primitive.material.0).unwrap_or(0);
        triangles.extend(primitive.indices.chunks_exact(3).map(|indices| {
            let order = if instance.flips_winding { [0, 2, 1] } else { [0, 1, 2] };
            TracedTriangle {
                corners: order.map(|corner| positions[indices[corner] as usize]),
                material,
                flat: primitive.normals.is_none(),
                numbers: order.map(|corner| first + indices[corner]),
            }
        }));
    }
    corners.complete();
    if triangles.len() >= FLAT as usize {
        return Err(too_many("triangles"));
    }
    Ok((triangles, corners))
}

impl Corners {
    /// Adds the vertices of an instance. Normals get the inverse transpose, which keeps them perpendicular, times any positive factor.
    fn extend(&mut self, primitive: &Primitive, world: DMat3, facts: &Facts) {
        let count = primitive.positions.len();
        let [a, b, c] = [world.x_axis, world.y_axis, world.z_axis];
        let cofactors = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
        let largest = cofactors.to_cols_array().into_iter().map(f64::abs).fold(f64::MIN_POSITIVE, f64::max);
        let side = if world.determinant() < 0.0 { -1.0 } else { 1.0 };
        let to_normals = cofactors * (side / largest);
        let vector = |value: [f32; 3]| DVec3::from(value.map(f64::from));
        match &primitive.normals {
            Some(normals) => {
                self.normals.extend(
                    normals.iter().map(|&normal| (to_normals * vector(normal)).as_vec3().extend(0.0).to_array()),
                );
            }
            None => self.normals.extend(std::iter::repeat_n([0.0, 0.0, 1.0, 0.0], count)),
        }
        if facts.vertex_colors {
            match &primitive.colors {
                Some(colors) => self.colors.extend(
                    colors.iter().map(|color| color.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8)),
                ),
                None => self.colors.extend(std::iter::repeat_n([255; 4], count)),
            }
        }
        if facts.textured {
            let set = |set: usize, vertex: usize| primitive.texcoords[set].as_ref().map_or([0.0; 2], |uv| uv[vertex]);
            self.texcoords.extend((0..count).map(|vertex| {
                let [[u0, v0], [u1, v1]] = [set(0, vertex), set(1, vertex)];
                [u0, v0, u1, v1]
            }));
        }
        if facts.normal_mapped {
            match &primitive.tangents {
                Some(tangents) => self.tangents.extend(tangents.iter().map(|&[x, y, z, sign]| {
                    let tangent = (world * vector([x, y, z])).normalize_or_zero().as_vec3();
                    tangent.extend(sign * side as f32).to_array()
                })),
                None => self.tangents.extend(std::iter::repeat_n([0.0; 4], count)),
            }
        }
    }

    /// An attribute that no primitive has is a single element.
    fn complete(&mut self) {
        if self.normals.is_empty() {
            self.normals.push([0.0, 0.0, 1.0, 0.0]);
        }
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
