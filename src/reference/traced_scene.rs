//! The scene as rays meet it (glsl/lib/traced_scene.glsl): all instances flattened to triangles in render space, their corners'
//! attributes, a bounding volume hierarchy, textures as plain texels, and what next-event estimation draws lights from.

use std::sync::Arc;

use ash::vk;
use glam::{DMat3, DVec3, Vec3};

use super::emitters::{EmitterTable, emitter_table};
use super::sobol::sobol_points;
use super::texels::Texels;
use crate::frame::light_set::{punctual_light, shining_lights};
use crate::frame::octahedral::pack_direction;
use crate::frame::scene_data::{material_record, texture_kinds};
use crate::frame::textures::texture_uses;
use crate::graph::bindings::TexelBuffer;
use crate::graph::{Dependence, Graph, hash_of};
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::scene::{Alpha, Bounds, Facts, Material, Primitive, Scene, Texture};
use crate::shaders::types;
use crate::vulkan::{Buffer, Device, VulkanError, buffer_with};

/// No vertex normals (TRIANGLE_FLAT).
const FLAT: u32 = 1 << 31;

/// A triangle of the scene in render space, counter-clockwise as seen from its front.
#[derive(Clone, Copy, Debug)]
pub(super) struct TracedTriangle {
    pub(super) corners: [Vec3; 3],
    pub(super) material: u32,
    /// Packed, at the corners; `None`: flat.
    normals: Option<[u32; 3]>,
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
        let normals = self.normals.unwrap_or_default();
        [
            words(self.corners[0], self.material | if self.normals.is_none() { FLAT } else { 0 }),
            words(edge1, normals[0]),
            words(edge2, normals[1]),
            [normals[2], light_density.to_bits(), 0, 0],
        ]
    }
}

/// Attributes of corners, three elements a triangle, or a single one if no primitive has the attribute.
#[derive(Default)]
struct Corners {
    colors: Vec<[u8; 4]>,
    texcoords: Vec<[f32; 4]>,
    tangents: Vec<[f32; 4]>,
}

/// A scene on the device, ready for rays.
pub(crate) struct TracedScene {
    pub(crate) key: u64,
    /// Of what rays meet, whatever shines on it.
    pub(crate) surfaces_key: u64,
    pub(crate) origin: DVec3,
    /// Of the sphere around the scene, metres.
    pub(crate) radius: f64,
    pub(crate) facts: Facts,
    pub(crate) sky: [f32; 3],
    /// The kinds of textures that any material reads, as the shaders' bits.
    pub(crate) texture_kinds: u32,
    pub(crate) emissive_textures: bool,
    /// Some triangle is there at some of its points only.
    pub(super) cutouts: bool,
    pub(crate) emitter_count: u32,
    /// Some light ends at a range, so that paths from it are none.
    pub(super) ranged_lights: bool,
    /// Of all triangles, m².
    pub(super) area: f64,
    pub(crate) punctual_count: u32,
    pub(crate) emissive_count: u32,
    /// From a triangle's density among all lights to that among emissive triangles.
    pub(crate) emissive_density_scale: f32,
    /// Whether lights may send out paths of their own.
    pub(super) light_paths: bool,
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
    pub(crate) corner_colors: TexelBuffer,
    pub(crate) corner_texcoords: TexelBuffer,
    pub(crate) corner_tangents: TexelBuffer,
    pub(crate) materials: TexelBuffer,
    pub(crate) media: TexelBuffer,
    pub(crate) material_textures: TexelBuffer,
    pub(crate) texture_table: TexelBuffer,
    pub(crate) texels: TexelBuffer,
    pub(crate) emitters: TexelBuffer,
    /// Emissive triangles alone.
    pub(crate) emissive: TexelBuffer,
    pub(crate) lights: TexelBuffer,
    pub(crate) sobol: TexelBuffer,
}

const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const BYTES: vk::Format = vk::Format::R8G8B8A8_UNORM;
const HALVES: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

impl TracedScene {
    /// Flattens, sorts and uploads the scene as it is now.
    pub(crate) fn new(device: &Arc<Device>, scene: &Scene) -> Result<TracedScene, VulkanError> {
        let bounds = scene.bounds().unwrap_or(Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) });
        let (origin, radius) = (bounds.center(), bounds.radius().max(1e-9));
        let facts = scene.facts();
        let (triangles, corners) = flatten(scene, origin, &facts)?;
        let lights = shining_lights(scene);
        let EmitterTable { records: emitters, light_densities, power, triangle_records, triangle_power } =
            emitter_table(&triangles, scene.materials(), &lights, radius);
        let records: Vec<[[u32; 4]; 4]> =
            triangles.iter().zip(&light_densities).map(|(triangle, density)| triangle.record(*density)).collect();
        let cutouts: Vec<Cutout> =
            scene.materials().iter().map(|material| cutout(material, scene.textures(), &facts)).collect();
        let bvh_triangles: Vec<BvhTriangle> = triangles
            .iter()
            .map(|triangle| match cutouts[triangle.material as usize] {
                // What is not there has no area.
                Cutout::Nothing => BvhTriangle::default(),
                kind => BvhTriangle {
                    corners: triangle.corners.map(|corner| corner.to_array()),
                    flags: u32::from(kind == Cutout::PerPoint),
                },
            })
            .collect();
        let bvh = Bvh::build(&bvh_triangles);
        let texels = Texels::new(scene.textures())?;
        let materials: Vec<types::Material> = scene.materials().iter().map(material_record).collect();
        let media: Vec<[f32; 4]> = scene.materials().iter().map(Material::medium).collect();
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
            upload("traced.corner_colors", bytemuck::cast_slice(&corners.colors), BYTES)?,
            upload("traced.corner_texcoords", bytemuck::cast_slice(&corners.texcoords), FLOATS)?,
            upload("traced.corner_tangents", bytemuck::cast_slice(&corners.tangents), FLOATS)?,
            upload("traced.materials", bytemuck::cast_slice(&materials), WORDS)?,
            upload("traced.media", bytemuck::cast_slice(&media), FLOATS)?,
            upload("traced.material_textures", bytemuck::cast_slice(&uses), WORDS)?,
            upload("traced.texture_table", bytemuck::cast_slice(&texels.table), WORDS)?,
            upload("traced.texels", bytemuck::cast_slice(&texels.texels), HALVES)?,
            upload("traced.emitters", bytemuck::cast_slice(&emitters), WORDS)?,
            upload("traced.emissive", bytemuck::cast_slice(&triangle_records), WORDS)?,
            upload("traced.lights", bytemuck::cast_slice(&light_records), WORDS)?,
            upload("traced.sobol", bytemuck::cast_slice(&sobol_points()), WORDS)?,
        ];
        let revisions = scene.revisions();
        Ok(TracedScene {
            key: traced_key(scene),
            surfaces_key: surfaces_key(scene),
            origin,
            radius,
            facts,
            sky: scene.sky(),
            texture_kinds: scene.materials().iter().fold(0, |kinds, material| kinds | texture_kinds(material)),
            emissive_textures: scene
                .materials()
                .iter()
                .any(|material| material.emits() && material.emissive_texture.is_some()),
            cutouts: triangles.iter().any(|triangle| cutouts[triangle.material as usize] == Cutout::PerPoint),
            emitter_count: u32::try_from(emitters.len()).unwrap_or(0),
            ranged_lights: lights.iter().any(|light| light.range.is_some()),
            area: triangles.iter().map(TracedTriangle::area).sum(),
            punctual_count: u32::try_from(lights.len()).unwrap_or(0),
            emissive_count: u32::try_from(triangle_records.len()).unwrap_or(0),
            emissive_density_scale: if triangle_power > 0.0 { (power / triangle_power) as f32 } else { 1.0 },
            light_paths: facts.glossy && !emitters.is_empty(),
            power,
            buffers,
        })
        .inspect(|_| tracing::debug!("traced scene of revision {revisions:?}"))
    }

    /// Whether lights send out paths of their own: where something glossy may gather their light, and more than direct light is
    /// asked for. The sky alone does not: camera paths find it.
    pub(super) fn needs_light_paths(&self, bounces: Option<u32>) -> bool {
        self.light_paths && bounces != Some(0)
    }

    /// Device memory, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffers.iter().map(|(_, buffer, _)| buffer.bytes()).sum()
    }

    pub(crate) fn import(&self, graph: &mut Graph<'_>) -> TracedBindings {
        let mut bind = |name: &str, dependence: Dependence| {
            let found = self.buffers.iter().find(|(known, ..)| *known == name);
            let (name, buffer, format) = found.expect("every buffer is made with the scene");
            graph.import_buffer::<u32>(name, buffer, self.key, dependence).texels(*format)
        };
        let (geometry, materials) = (Dependence::GEOMETRY, Dependence::MATERIALS);
        let lights = geometry | materials | Dependence::LIGHTS;
        TracedBindings {
            bvh_nodes: bind("traced.bvh_nodes", geometry),
            bvh_triangles: bind("traced.bvh_triangles", geometry),
            triangles: bind("traced.triangles", geometry),
            corner_colors: bind("traced.corner_colors", geometry),
            corner_texcoords: bind("traced.corner_texcoords", geometry),
            corner_tangents: bind("traced.corner_tangents", geometry),
            materials: bind("traced.materials", materials),
            media: bind("traced.media", materials),
            material_textures: bind("traced.material_textures", materials),
            texture_table: bind("traced.texture_table", materials),
            texels: bind("traced.texels", materials),
            emitters: bind("traced.emitters", lights),
            emissive: bind("traced.emissive", lights),
            lights: bind("traced.lights", lights),
            sobol: bind("traced.sobol", Dependence::NONE),
        }
    }
}

/// Names a scene's content within this process, whatever the camera sees of it.
pub(crate) fn traced_key(scene: &Scene) -> u64 {
    let revisions = scene.revisions();
    hash_of(&(scene.identity(), revisions.geometry, revisions.materials, revisions.lights))
}

/// The same of its surfaces alone.
pub(crate) fn surfaces_key(scene: &Scene) -> u64 {
    let revisions = scene.revisions();
    hash_of(&(scene.identity(), revisions.geometry, revisions.materials))
}

/// What its alpha leaves of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cutout {
    Everything,
    Nothing,
    /// A texture or vertex colours decide.
    PerPoint,
}

fn cutout(material: &Material, textures: &[Texture], facts: &Facts) -> Cutout {
    let Alpha::Mask { cutoff } = material.alpha else { return Cutout::Everything };
    let (mut least, mut most) = (material.base_color[3], material.base_color[3]);
    if let Some(texture) = material.base_color_texture {
        let alphas = || textures[texture.texture.0].rgba8.chunks_exact(4).map(|texel| f32::from(texel[3]) / 255.0);
        least *= alphas().fold(1.0, f32::min);
        most *= alphas().fold(0.0, f32::max);
    }
    if facts.vertex_colors {
        least = 0.0;
    }
    match (least >= cutoff, most < cutoff) {
        (true, _) => Cutout::Everything,
        (_, true) => Cutout::Nothing,
        _ => Cutout::PerPoint,
    }
}

fn flatten(scene: &Scene, origin: DVec3, facts: &Facts) -> Result<(Vec<TracedTriangle>, Corners), VulkanError> {
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
            TracedTriangle {
                corners: vertices.map(|vertex| positions[vertex]),
                material,
                normals: normals.as_ref().map(|normals| vertices.map(|vertex| normals[vertex])),
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
