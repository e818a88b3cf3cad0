//! The scene as rays meet it (glsl/lib/traced_scene.glsl): surfaces, what they are made of, and what next-event estimation draws lights from. Each stands
//! while what it is made of does: a moved light makes no hierarchy, a moved thing no textures.

use std::sync::Arc;

use super::emitters::{EmitterTable, emitter_table, extent_of, luminance};
use super::lightmap::{Lightmap, Texels};
use super::looks::Looks;
use super::samples::SurfaceSamples;
use super::surfaces::{Surfaces, surfaces_key};
use super::targets::{Reach, TargetShares, targets};
use super::tessellation::Tessellation;
use super::uploaded::{FLOAT, Uploaded, WORDS};
use crate::frame::light_set::{punctual_light, shining_lights};
use crate::graph::bindings::TexelBuffer;
use crate::graph::{Dependence, Graph, hash_of};
use crate::scene::{Alpha, Facts, Material, Scene};
use crate::shaders::groups::{LightTargets, SceneLights, SceneRays};
use crate::shaders::types;
use crate::vulkan::{Device, VulkanError};

/// A scene on the device, ready for rays. What is asked of its surfaces, they answer.
pub(crate) struct TracedScene {
    pub(crate) key: u64,
    /// [`Scene::identity`]
    scene: u64,
    pub(super) surfaces: Arc<Surfaces>,
    pub(super) looks: Arc<Looks>,
    pub(crate) facts: Facts,
    pub(crate) sky: [f32; 3],
    pub(crate) emissive_textures: bool,
    /// Some emissive surface is cut out by its alpha.
    emissive_cutouts: bool,
    /// Points of some emissive triangle are drawn cell by cell.
    emissive_cells: bool,
    pub(crate) emitter_count: u32,
    /// Some light ends at a range, so that paths from it are none.
    pub(crate) ranged_lights: bool,
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
    /// What emissive surfaces do.
    pub(crate) emissive_power: f64,
    /// All punctual lights, black ones too, in the scene's order.
    pub(crate) lamps: Vec<Lamp>,
    /// Where those paths are sent.
    pub(crate) target_shares: TargetShares,
    /// Triangles, with the densities that points of lights are drawn with.
    pub(super) triangles: Uploaded,
    emitters: Uploaded,
    pub(super) emissive: Uploaded,
    pub(super) lights: Uploaded,
    targets: Uploaded,
    target_densities: Uploaded,
    /// Of the densities that points of emissive surfaces are drawn with.
    densities_key: u64,
}

/// A punctual light.
pub(crate) struct Lamp {
    pub(crate) light: types::Light,
    /// What an intensity times this is power.
    pub(crate) extent: f64,
}

impl Lamp {
    /// Of its intensity.
    pub(crate) fn luminance(&self) -> f64 {
        luminance(self.light.intensity)
    }
}

impl std::ops::Deref for TracedScene {
    type Target = Surfaces;

    fn deref(&self) -> &Surfaces {
        &self.surfaces
    }
}

/// Names a scene's content within this process, whatever the camera sees of it.
pub(crate) fn traced_key(scene: &Scene) -> u64 {
    hash_of(&(surfaces_key(scene), scene.revisions().lights))
}

impl TracedScene {
    /// The scene as it is now.
    pub(crate) fn new(device: &Arc<Device>, scene: &Scene) -> Result<TracedScene, VulkanError> {
        TracedScene::update(device, scene, None)
    }

    /// The same, with what still holds of `held`.
    pub(crate) fn update(
        device: &Arc<Device>,
        scene: &Scene,
        held: Option<&TracedScene>,
    ) -> Result<TracedScene, VulkanError> {
        let facts = scene.facts();
        let key = Looks::key(scene, &facts);
        let looks = match held.filter(|held| held.looks.key == key) {
            Some(held) => held.looks.clone(),
            None => Arc::new(Looks::update(device, scene, &facts, held.map(|held| &*held.looks))?),
        };
        let held_surfaces = held.map(|held| &held.surfaces);
        let surfaces = match held_surfaces.filter(|held| held.key == surfaces_key(scene)) {
            Some(held) => held.clone(),
            None => {
                let alike = held.is_some_and(|held| Arc::ptr_eq(&held.looks, &looks));
                let held = (held_surfaces.map(|held| &**held), alike);
                Arc::new(Surfaces::update(device, scene, &looks, &facts, held)?)
            }
        };
        let (triangles, origin, radius) = (&surfaces.triangles, surfaces.origin, surfaces.radius);
        let shining = shining_lights(scene);
        let table = emitter_table(scene, triangles, &shining, radius);
        let reach = Reach { origin, radius };
        let found = targets(triangles, scene.materials(), &shining, &table.records, reach);
        let lights: Vec<types::Light> = shining.iter().map(|placed| punctual_light(placed, origin)).collect();
        let held = held.map(|held| &held.triangles);
        let emits = |wanted: &dyn Fn(&Material) -> bool| {
            scene.materials().iter().any(|material| material.emits() && wanted(material))
        };
        let name = |content: &[u32]| hash_of(&(origin.to_array().map(f64::to_bits), content));
        let upload = |list: &'static str, words: &[[u32; 4]]| {
            Uploaded::new(device, list, words, WORDS, name(bytemuck::cast_slice(words)))
        };
        let densities: &[u32] = bytemuck::cast_slice(&found.densities);
        Ok(TracedScene {
            key: traced_key(scene),
            scene: scene.identity(),
            facts,
            sky: scene.sky(),
            emissive_textures: emits(&|material| material.emissive_texture.is_some()),
            emissive_cutouts: emits(&|material| material.alpha != Alpha::Opaque),
            emissive_cells: !table.cells.records.is_empty(),
            emitter_count: u32::try_from(table.records.len()).unwrap_or(0),
            ranged_lights: shining.iter().any(|light| light.range.is_some()),
            punctual_count: u32::try_from(shining.len()).unwrap_or(0),
            emissive_count: u32::try_from(table.triangle_records.len()).unwrap_or(0),
            emissive_density_scale: table.density_scale(),
            greatest_radiance: scene.materials().iter().flat_map(|material| material.emissive).fold(0.0, f32::max),
            light_paths: facts.glossy && !table.records.is_empty(),
            power: table.power,
            emissive_power: table.triangle_power,
            lamps: scene
                .placed_lights()
                .iter()
                .map(|placed| Lamp { light: punctual_light(placed, origin), extent: extent_of(placed, radius) })
                .collect(),
            target_shares: found.shares,
            triangles: records(device, &surfaces, &table, held)?,
            emitters: upload("traced.emitters", &table.records)?,
            emissive: upload("traced.emissive", &table.triangle_records)?,
            lights: {
                let words: &[u32] = bytemuck::cast_slice(&lights);
                Uploaded::new(device, "traced.lights", words, WORDS, name(words))?
            },
            targets: upload("traced.targets", &found.records)?,
            target_densities: Uploaded::new(device, "traced.target_densities", densities, FLOAT, name(densities))?,
            densities_key: hash_of(&bytemuck::cast_slice::<f32, u32>(&table.light_densities)),
            surfaces,
            looks,
        })
        .inspect(|_| tracing::debug!("traced scene of revision {:?}", scene.revisions()))
    }

    /// Whether it was made of `scene`, at any time.
    pub(crate) fn is_of(&self, scene: &Scene) -> bool {
        self.scene == scene.identity()
    }

    /// Of what rays meet, whatever shines on it.
    pub(crate) fn surfaces_key(&self) -> u64 {
        self.surfaces.key
    }

    /// The largest share of light that some material with a diffuse lobe reflects, textures aside.
    pub(crate) fn greatest_albedo(&self) -> f64 {
        self.looks.greatest_albedo
    }

    /// Whether lights send out paths of their own: where something glossy may gather their light, and more than direct light is
    /// asked for. The sky alone does not: camera paths find it.
    pub(crate) fn needs_light_paths(&self, bounces: Option<u32>) -> bool {
        self.light_paths && bounces != Some(0)
    }

    /// Device memory, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let own =
            [&self.triangles, &self.emitters, &self.emissive, &self.lights, &self.targets, &self.target_densities];
        self.surfaces.bytes() + self.looks.bytes() + own.iter().map(|list| list.bytes()).sum::<u64>()
    }

    /// What rays meet, as passes bind it.
    pub(crate) fn rays(&self, graph: &mut Graph<'_>) -> SceneRays {
        let (surfaces, looks) = (&*self.surfaces, &*self.looks);
        let (geometry, materials) = (Dependence::GEOMETRY, Dependence::MATERIALS);
        let [bvh_nodes, bvh_triangles] = surfaces.hierarchy().map(|list| list.texels(graph, geometry));
        SceneRays {
            bvh_nodes,
            bvh_triangles,
            corner_colors: surfaces.colors.texels(graph, geometry),
            corner_texcoords: surfaces.texcoords.texels(graph, geometry),
            corner_tangents: surfaces.tangents.texels(graph, geometry),
            materials: looks.materials.texels(graph, materials),
            media: looks.media.texels(graph, materials),
            material_textures: looks.uses.texels(graph, materials),
            texture_table: looks.table.texels(graph, materials),
            texels: looks.texels.texels(graph, materials),
            sobol: looks.sobol.texels(graph, Dependence::NONE),
            triangles: self.triangles.texels(graph, geometry),
            alpha_masks: u32::from(surfaces.cutouts),
            vertex_colors: u32::from(self.facts.vertex_colors),
            normal_maps: u32::from(self.facts.normal_mapped),
            textures: looks.texture_kinds,
            emissive_cells: u32::from(self.emissive_cells),
            wide: u32::from(surfaces.wide),
        }
    }

    /// The area of each triangle that matters, as it stands wherever the triangle moves.
    pub(crate) fn own_areas(&self, graph: &mut Graph<'_>) -> TexelBuffer {
        self.surfaces.own_areas.texels(graph, Dependence::GEOMETRY)
    }

    /// Points of all diffuse surface, closer to each other than `spacing` metres.
    pub(crate) fn tessellation(&self, spacing: f64) -> Arc<Tessellation> {
        self.surfaces.tessellation(spacing, &self.looks.diffuse_sides)
    }

    /// Light maps of all diffuse surfaces, cut so finely.
    pub(crate) fn lightmap(&self, texels: Texels) -> Arc<Lightmap> {
        self.surfaces.lightmap(texels, &self.looks.diffuse_sides)
    }

    /// The same surfaces with texels of the `detail`-th part of the size.
    pub(crate) fn finer_lightmap(&self, texels: Texels, detail: u32) -> Arc<Lightmap> {
        Arc::new(self.surfaces.finer_lightmap((texels, detail), &self.looks.diffuse_sides))
    }

    /// So many points spread evenly over all diffuse surface, in clusters of so many neighbours.
    pub(crate) fn surface_samples(&self, count: u32, cluster: u32) -> Arc<SurfaceSamples> {
        self.surfaces.samples((count, cluster), &self.looks.diffuse_sides)
    }

    /// The area of all sides with a diffuse lobe, m².
    pub(crate) fn diffuse_area(&self) -> f64 {
        self.surfaces.diffuse_area(&self.looks.diffuse_sides)
    }

    /// Names what emissive surfaces send out, wherever they stand.
    pub(crate) fn emission_key(&self) -> u64 {
        let scales = [self.emissive_density_scale, self.greatest_radiance].map(f32::to_bits);
        hash_of(&(self.looks.key, self.emissive.key, self.densities_key, scales))
    }

    /// Where light paths are sent.
    pub(crate) fn targets(&self, graph: &mut Graph<'_>) -> LightTargets {
        let lights = Dependence::GEOMETRY | Dependence::MATERIALS | Dependence::LIGHTS;
        let [targets, target_densities] =
            [&self.targets, &self.target_densities].map(|list| list.texels(graph, lights));
        LightTargets { targets, target_densities }
    }

    /// What shines on it.
    pub(crate) fn lights(&self, graph: &mut Graph<'_>) -> SceneLights {
        let lights = Dependence::GEOMETRY | Dependence::MATERIALS | Dependence::LIGHTS;
        let [emitters, emissive_triangles, punctual_lights] =
            [&self.emitters, &self.emissive, &self.lights].map(|list| list.texels(graph, lights));
        SceneLights {
            emitters,
            emissive_triangles,
            punctual_lights,
            emissive_textures: u32::from(self.emissive_textures),
            emissive_cutouts: u32::from(self.emissive_cutouts),
        }
    }
}

/// The triangles' records; those that are `held` if they are the same.
fn records(
    device: &Arc<Device>,
    surfaces: &Surfaces,
    table: &EmitterTable,
    held: Option<&Uploaded>,
) -> Result<Uploaded, VulkanError> {
    let EmitterTable { light_densities, cells, .. } = table;
    let densities: &[u32] = bytemuck::cast_slice(light_densities);
    // Where on its triangles a surface shines follows from geometry and materials.
    let key = hash_of(&(surfaces.key, densities));
    if let Some(held) = held.filter(|held| held.key == key) {
        return Ok(held.clone());
    }
    let records = (0..)
        .zip(surfaces.triangles.iter().zip(light_densities))
        .flat_map(|(index, (triangle, density))| triangle.record(*density, cells.of_triangle(index)));
    let records: Vec<[u32; 4]> = records.chain(cells.records.iter().copied()).collect();
    Uploaded::new(device, "traced.triangles", &records, WORDS, key)
}
