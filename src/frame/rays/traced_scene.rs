//! The scene as rays meet it (glsl/lib/traced_scene.glsl): all instances flattened to triangles in render space, their corners'
//! attributes, a bounding volume hierarchy, textures as plain texels, and what next-event estimation draws lights from.

use std::sync::Arc;

use ash::vk;
use glam::DVec3;

use super::emitters::{EmitterTable, emitter_table};
use super::sobol::sobol_points;
use super::targets::{Reach, TargetShares, Targets, targets};
use super::texels::Texels;
use super::triangles::{TracedTriangle, flatten};
use crate::frame::light_set::{punctual_light, shining_lights};
use crate::frame::materials::{material_record, texture_kinds};
use crate::frame::textures::texture_uses;
use crate::graph::bindings::TexelBuffer;
use crate::graph::{Dependence, Graph, hash_of};
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::scene::{Alpha, Bounds, Cutout, Extent, Facts, Material, Scene, cutout, has_specular_lobe};
use crate::shaders::groups::{LightTargets, SceneLights, SceneRays};
use crate::shaders::types;
use crate::vulkan::{Buffer, Device, VulkanError, buffer_with};

/// A scene on the device, ready for rays.
pub(crate) struct TracedScene {
    pub(crate) key: u64,
    /// Of what rays meet, whatever shines on it.
    pub(crate) surfaces_key: u64,
    /// Of the triangles' records, which hold what points of lights are drawn with.
    triangles_key: u64,
    pub(crate) origin: DVec3,
    /// Of the box around what matters, in render space.
    pub(crate) middle_rs: DVec3,
    /// Half its diagonal, metres.
    pub(crate) radius: f64,
    /// Some surface is farther away from its middle.
    pub(crate) far_surfaces: bool,
    pub(crate) facts: Facts,
    pub(crate) sky: [f32; 3],
    /// The kinds of textures that any material reads, as the shaders' bits.
    pub(crate) texture_kinds: u32,
    pub(crate) emissive_textures: bool,
    /// Some emissive surface is cut out by its alpha.
    emissive_cutouts: bool,
    /// Points of some emissive triangle are drawn cell by cell.
    emissive_cells: bool,
    /// Some triangle is there at some of its points only.
    pub(crate) cutouts: bool,
    pub(crate) emitter_count: u32,
    /// Some light ends at a range, so that paths from it are none.
    pub(crate) ranged_lights: bool,
    /// Rays that start as far from surfaces as rounding of the largest coordinate asks would leave out an eighth of the finer triangles: rounding is bounded
    /// triangle by triangle (glsl/lib/bvh.glsl).
    wide: bool,
    pub(crate) triangle_count: u32,
    /// The size that all but a sixteenth of the triangles have, metres.
    pub(crate) fine_size: f64,
    /// The largest share of light that some material with a diffuse lobe reflects, textures aside.
    pub(crate) greatest_albedo: f64,
    /// Of the triangles that matter, m².
    pub(crate) area: f64,
    pub(crate) punctual_count: u32,
    pub(crate) emissive_count: u32,
    /// From a triangle's density among all lights to that among emissive triangles.
    pub(crate) emissive_density_scale: f32,
    /// Of any emissive surface, in the brightest channel, W/(m² sr).
    pub(crate) greatest_radiance: f32,
    /// Whether lights may send out paths of their own.
    pub(crate) light_paths: bool,
    /// What all lights but the sky send out, W (luminance).
    pub(crate) power: f64,
    /// Where those paths are sent.
    pub(crate) target_shares: TargetShares,
    buffers: Vec<(&'static str, Arc<Buffer>, vk::Format)>,
}

const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const FLOAT: vk::Format = vk::Format::R32_SFLOAT;
/// What a dielectric with the usual index reflects of light from all around: 0.04 + 0.96/21.
const MEAN_FRESNEL: f64 = 0.0857;
const BYTES: vk::Format = vk::Format::R8G8B8A8_UNORM;
const HALVES: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

impl TracedScene {
    /// Flattens, sorts and uploads the scene as it is now.
    pub(crate) fn new(device: &Arc<Device>, scene: &Scene) -> Result<TracedScene, VulkanError> {
        let Extent { origin, middle, .. } = scene.extent();
        let bulk = scene.bulk().unwrap_or(Bounds { min: middle - 1.0, max: middle + 1.0 });
        let (middle_rs, radius) = (bulk.center() - origin, bulk.radius().max(1e-30));
        let facts = scene.facts();
        let (triangles, corners) = flatten(scene, origin, &facts)?;
        let lights = shining_lights(scene);
        let EmitterTable { records: emitters, light_densities, cells, power, triangle_records, triangle_power } =
            emitter_table(scene, &triangles, &lights, radius);
        let mut records: Vec<[u32; 4]> = (0..)
            .zip(triangles.iter().zip(&light_densities))
            .flat_map(|(index, (triangle, density))| triangle.record(*density, cells.of_triangle(index)))
            .collect();
        records.extend(&cells.records);
        let Targets { records: target_records, densities: target_densities, shares: target_shares } =
            targets(&triangles, scene.materials(), &lights, &emitters, Reach { origin, radius });
        let cutouts: Vec<Cutout> =
            scene.materials().iter().map(|material| cutout(material, scene.textures(), facts.vertex_colors)).collect();
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
        let mut bvh = Bvh::build(&bvh_triangles);
        let fine = fine_size(triangles.iter().filter(|triangle| triangle.nearest(middle_rs) <= radius));
        bvh.set_least_offset((radius / 131_072.0).min(fine / 64.0) as f32);
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
            upload("traced.targets", bytemuck::cast_slice(&target_records), WORDS)?,
            upload("traced.target_densities", bytemuck::cast_slice(&target_densities), FLOAT)?,
            upload("traced.sobol", bytemuck::cast_slice(&sobol_points()), WORDS)?,
        ];
        let revisions = scene.revisions();
        Ok(TracedScene {
            key: traced_key(scene),
            surfaces_key: surfaces_key(scene),
            triangles_key: hash_of(&(surfaces_key(scene), &records)),
            origin,
            middle_rs,
            radius,
            far_surfaces: triangles.iter().any(|triangle| triangle.farthest(middle_rs) > radius * (1.0 + 1e-6)),
            facts,
            sky: scene.sky(),
            texture_kinds: scene.materials().iter().fold(0, |kinds, material| kinds | texture_kinds(material)),
            emissive_textures: scene
                .materials()
                .iter()
                .any(|material| material.emits() && material.emissive_texture.is_some()),
            emissive_cutouts: scene
                .materials()
                .iter()
                .any(|material| material.emits() && material.alpha != Alpha::Opaque),
            emissive_cells: !cells.records.is_empty(),
            wide: triangles.iter().any(|triangle| triangle.farthest(DVec3::ZERO) / 65536.0 > fine / 8.0),
            cutouts: triangles.iter().any(|triangle| cutouts[triangle.material as usize] == Cutout::PerPoint),
            emitter_count: u32::try_from(emitters.len()).unwrap_or(0),
            ranged_lights: lights.iter().any(|light| light.range.is_some()),
            area: triangles
                .iter()
                .filter(|triangle| triangle.nearest(middle_rs) <= radius)
                .map(TracedTriangle::area)
                .sum(),
            triangle_count: u32::try_from(triangles.len()).unwrap_or(0),
            fine_size: fine,
            greatest_albedo: scene.materials().iter().map(reflected).fold(0.0, f64::max),
            punctual_count: u32::try_from(lights.len()).unwrap_or(0),
            emissive_count: u32::try_from(triangle_records.len()).unwrap_or(0),
            emissive_density_scale: if triangle_power > 0.0 { (power / triangle_power) as f32 } else { 1.0 },
            greatest_radiance: scene.materials().iter().flat_map(|material| material.emissive).fold(0.0, f32::max),
            light_paths: facts.glossy && !emitters.is_empty(),
            power,
            target_shares,
            buffers,
        })
        .inspect(|_| tracing::debug!("traced scene of revision {revisions:?}"))
    }

    /// Whether lights send out paths of their own: where something glossy may gather their light, and more than direct light is
    /// asked for. The sky alone does not: camera paths find it.
    pub(crate) fn needs_light_paths(&self, bounces: Option<u32>) -> bool {
        self.light_paths && bounces != Some(0)
    }

    /// Device memory, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffers.iter().map(|(_, buffer, _)| buffer.bytes()).sum()
    }

    fn bind(&self, graph: &mut Graph<'_>, name: &str, key: u64, dependence: Dependence) -> TexelBuffer {
        let found = self.buffers.iter().find(|(known, ..)| *known == name);
        let (name, buffer, format) = found.expect("every buffer is made with the scene");
        graph.import_buffer::<u32>(name, buffer, key, dependence).texels(*format)
    }

    /// What rays meet, as passes bind it.
    pub(crate) fn rays(&self, graph: &mut Graph<'_>) -> SceneRays {
        let (geometry, materials) = (Dependence::GEOMETRY, Dependence::MATERIALS);
        let mut bind = |name: &str, dependence| self.bind(graph, name, self.surfaces_key, dependence);
        SceneRays {
            bvh_nodes: bind("traced.bvh_nodes", geometry),
            bvh_triangles: bind("traced.bvh_triangles", geometry),
            corner_colors: bind("traced.corner_colors", geometry),
            corner_texcoords: bind("traced.corner_texcoords", geometry),
            corner_tangents: bind("traced.corner_tangents", geometry),
            materials: bind("traced.materials", materials),
            media: bind("traced.media", materials),
            material_textures: bind("traced.material_textures", materials),
            texture_table: bind("traced.texture_table", materials),
            texels: bind("traced.texels", materials),
            sobol: bind("traced.sobol", Dependence::NONE),
            // They hold the densities that lights are drawn with.
            triangles: self.bind(graph, "traced.triangles", self.triangles_key, geometry),
            alpha_masks: u32::from(self.cutouts),
            vertex_colors: u32::from(self.facts.vertex_colors),
            normal_maps: u32::from(self.facts.normal_mapped),
            textures: self.texture_kinds,
            emissive_cells: u32::from(self.emissive_cells),
            wide: u32::from(self.wide),
        }
    }

    /// Where light paths are sent.
    pub(crate) fn targets(&self, graph: &mut Graph<'_>) -> LightTargets {
        let lights = Dependence::GEOMETRY | Dependence::MATERIALS | Dependence::LIGHTS;
        let mut bind = |name: &str| self.bind(graph, name, self.key, lights);
        LightTargets { targets: bind("traced.targets"), target_densities: bind("traced.target_densities") }
    }

    /// What shines on it.
    pub(crate) fn lights(&self, graph: &mut Graph<'_>) -> SceneLights {
        let lights = Dependence::GEOMETRY | Dependence::MATERIALS | Dependence::LIGHTS;
        let mut bind = |name: &str| self.bind(graph, name, self.key, lights);
        SceneLights {
            emitters: bind("traced.emitters"),
            emissive_triangles: bind("traced.emissive"),
            punctual_lights: bind("traced.lights"),
            emissive_textures: u32::from(self.emissive_textures),
            emissive_cutouts: u32::from(self.emissive_cutouts),
        }
    }
}

/// What a material with a diffuse lobe reflects of light, in the brightest channel, without its textures; its specular layer reflects what it keeps from that lobe.
fn reflected(material: &Material) -> f64 {
    let [red, green, blue, _] = material.base_color;
    let lobe = (1.0 - material.metallic) * (1.0 - material.transmission) * if material.unlit { 0.0 } else { 1.0 };
    let diffuse = f64::from(red.max(green).max(blue) * lobe).clamp(0.0, 1.0);
    let layer = if has_specular_lobe(material) { MEAN_FRESNEL } else { 0.0 };
    if diffuse > 0.0 { diffuse + layer * (1.0 - diffuse) } else { 0.0 }
}

/// The size that all but a sixteenth of the triangles have, metres.
fn fine_size<'t>(triangles: impl Iterator<Item = &'t TracedTriangle>) -> f64 {
    let mut sizes: Vec<f64> = triangles.map(|triangle| triangle.area().sqrt()).filter(|&size| size > 0.0).collect();
    let place = sizes.len() / 16;
    if sizes.is_empty() { f64::INFINITY } else { *sizes.select_nth_unstable_by(place, f64::total_cmp).1 }
}

/// Names a scene's content within this process, whatever the camera sees of it.
pub(crate) fn traced_key(scene: &Scene) -> u64 {
    let revisions = scene.revisions();
    hash_of(&(surfaces_key(scene), revisions.lights))
}

/// The same of its surfaces alone.
pub(crate) fn surfaces_key(scene: &Scene) -> u64 {
    let revisions = scene.revisions();
    let place = scene.extent().origin.to_array().map(f64::to_bits);
    hash_of(&(scene.identity(), revisions.geometry, revisions.materials, place))
}
