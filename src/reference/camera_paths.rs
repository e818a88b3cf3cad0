//! Paths from the camera, pass by pass (glsl/path/): generate, then for each vertex intersect, surface, light, connect, scatter.
//!
//! With z_1 the first visible surface, each pass adds one factor of
//!
//!   L = Σ_k ∫ L_e(z_{k+1}) Π_{i=1}^{k} f(z_i)·|cos| dω        W/(m²·sr)
//!
//! found by running into the light (surface) and by choosing a point of it (light, connect), weighted by the balance heuristic.

use ash::vk;

use super::PixelFilter;
use super::sobol::sobol_points;
use super::traced_scene::{TracedBindings, TracedScene};
use super::tracer::View;
use crate::graph::bindings::{BufferRef, TexelBuffer, Uniform};
use crate::graph::{Dependence, Graph, ReadBack};
use crate::renderer::Slot;
use crate::shaders::{path as shaders, types};

const WORD: vk::Format = vk::Format::R32_UINT;
const PAIR: vk::Format = vk::Format::R32G32_UINT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Words before the numbers of the paths in a queue.
const QUEUE_HEADER: usize = 4;

/// Some samples of some pixels, and how far their paths are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wave {
    pub(super) first_block: u32,
    pub(super) block_count: u32,
    pub(super) sample_count: u32,
    /// Paths that memory is held for.
    pub(super) path_capacity: u32,
    pub(super) first_sample: u32,
    pub(super) seed: u32,
    /// Whether the sums start anew.
    pub(super) clear_sums: bool,
    /// Vertices that the paths have behind them.
    pub(super) depth: u32,
}

impl Wave {
    pub(super) fn paths_per_sample(&self) -> u32 {
        64 * self.block_count
    }
}

/// What kernels are compiled for, from the scene's facts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variants {
    pub(super) specular: u32,
    pub(super) transmissive: u32,
    pub(super) light_paths: u32,
}

impl Variants {
    pub(super) fn of(scene: &TracedScene) -> Variants {
        Variants {
            specular: u32::from(scene.facts.specular),
            transmissive: u32::from(scene.facts.transmissive),
            light_paths: 0,
        }
    }
}

/// The buffers of a wave.
pub(super) struct CameraPaths {
    scene: TracedBindings,
    variants: Variants,
    camera: Uniform<types::Camera>,
    sobol: TexelBuffer,
    rays: BufferRef<[f32; 4]>,
    states: BufferRef<[f32; 4]>,
    flags: BufferRef<u32>,
    seeds: BufferRef<[u32; 2]>,
    hits: BufferRef<[f32; 4]>,
    vertices: BufferRef<[u32; 4]>,
    connection_rays: BufferRef<[f32; 4]>,
    connection_light: BufferRef<[f32; 4]>,
    active: [BufferRef<u32>; 2],
    alive: BufferRef<u32>,
    connections: BufferRef<u32>,
    radiance: BufferRef<[f32; 4]>,
    sums: BufferRef<[f32; 4]>,
    path_capacity: u32,
}

impl CameraPaths {
    pub(super) fn declare(graph: &mut Graph<'_>, scene: &TracedScene, view: &View, wave: &Wave) -> CameraPaths {
        let variants = Variants::of(scene);
        let paths = wave.path_capacity as usize;
        let lobes = 1 + variants.specular as usize;
        let vertex_texels = if variants.specular != 0 { 5 } else { 2 };
        let slots = Slot::ALL.len();
        let queue = QUEUE_HEADER + paths;
        let made = CameraPaths {
            scene: scene.import(graph),
            variants,
            camera: graph.upload("path.camera", &[view.camera], Dependence::CAMERA).uniform(),
            sobol: graph.upload("path.sobol", &sobol_points(), Dependence::NONE).texels(WORDS),
            rays: graph.buffer("path.rays", 2 * paths),
            states: graph.buffer("path.states", paths),
            flags: graph.buffer("path.flags", paths),
            seeds: graph.buffer("path.seeds", paths),
            hits: graph.buffer("path.hits", paths),
            vertices: graph.buffer("path.vertices", vertex_texels * paths),
            connection_rays: graph.buffer("path.connection_rays", 2 * paths),
            connection_light: graph.buffer("path.connection_light", lobes * paths),
            active: [graph.buffer("path.active.0", queue), graph.buffer("path.active.1", queue)],
            alive: graph.buffer("path.alive", queue),
            connections: graph.buffer("path.connections", queue),
            radiance: graph.buffer("path.radiance", slots * paths),
            sums: graph.buffer("path.sums", slots * wave.paths_per_sample() as usize),
            path_capacity: wave.path_capacity,
        };
        if wave.clear_sums {
            graph.fill_buffer("path/clear-radiance", made.radiance, 0);
            graph.fill_buffer("path/clear-sums", made.sums, 0);
        }
        made
    }

    fn clear_queues(&self, graph: &mut Graph<'_>, next: BufferRef<u32>) {
        let clear = shaders::Clear {
            active_paths: next.read_write(),
            alive_paths: self.alive.read_write(),
            connections: self.connections.read_write(),
        };
        graph.pass("path/clear", clear).groups([1, 1, 1]);
    }

    pub(super) fn generate(&mut self, graph: &mut Graph<'_>, view: &View, wave: &Wave) {
        self.clear_queues(graph, self.active[0]);
        let generate = shaders::Generate {
            camera: self.camera.clone(),
            sobol: self.sobol.clone(),
            path_rays: self.rays.write(),
            path_states: self.states.write(),
            path_flags: self.flags.write(),
            path_seeds: self.seeds.write(),
            active_paths: self.active[0].read_write(),
            push: shaders::GeneratePush {
                wave: types::WavePixels {
                    size: view.size,
                    first_block: wave.first_block,
                    block_count: wave.block_count,
                },
                sample_count: wave.sample_count,
                first_sample: wave.first_sample,
                seed: wave.seed,
                box_filter: u32::from(view.filter == PixelFilter::Box),
            },
        };
        let threads = wave.paths_per_sample() * wave.sample_count;
        graph.pass("path/generate", generate).note("paths", u64::from(threads)).threads([threads, 1, 1]);
    }

    /// Takes the wave's paths to their vertex number `depth`, counted from 0, and on from there.
    pub(super) fn advance(&mut self, graph: &mut Graph<'_>, scene: &TracedScene, view: &View, depth: u32) {
        let active = self.active[depth as usize % 2];
        let next = self.active[(depth as usize + 1) % 2];
        let variants = self.variants;
        let ends = view.bounces.is_some_and(|bounces| depth > bounces);
        let intersect = shaders::Intersect {
            active_paths: active.texels(WORD),
            path_rays: self.rays.texels(FLOATS),
            bvh_nodes: self.scene.bvh_nodes.clone(),
            bvh_triangles: self.scene.bvh_triangles.clone(),
            path_hits: self.hits.write(),
            triangles: self.scene.triangles.clone(),
            corner_colors: self.scene.corner_colors.clone(),
            corner_texcoords: self.scene.corner_texcoords.clone(),
            materials: self.scene.materials.clone(),
            material_textures: self.scene.material_textures.clone(),
            texture_table: self.scene.texture_table.clone(),
            texels: self.scene.texels.clone(),
            alpha_masks: u32::from(scene.facts.alpha_masked),
            vertex_colors: u32::from(scene.facts.vertex_colors),
        };
        graph.pass("path/intersect", intersect).count("rays", active, 3).threads_indirect(active, 0);
        self.clear_queues(graph, next);

        let pixels = view.size.map(|side| side as f32);
        let surface = shaders::Surface {
            active_paths: active.texels(WORD),
            path_rays: self.rays.texels(FLOATS),
            path_states: self.states.texels(FLOATS),
            path_flags: self.flags.texels(WORD),
            path_hits: self.hits.texels(FLOATS),
            triangles: self.scene.triangles.clone(),
            corner_normals: self.scene.corner_normals.clone(),
            corner_colors: self.scene.corner_colors.clone(),
            corner_texcoords: self.scene.corner_texcoords.clone(),
            corner_tangents: self.scene.corner_tangents.clone(),
            materials: self.scene.materials.clone(),
            media: self.scene.media.clone(),
            material_textures: self.scene.material_textures.clone(),
            texture_table: self.scene.texture_table.clone(),
            texels: self.scene.texels.clone(),
            camera: self.camera.clone(),
            vertices: self.vertices.write(),
            path_radiance: self.radiance.read_write(),
            alive_paths: self.alive.read_write(),
            specular_lobes: variants.specular,
            transmissive: variants.transmissive,
            from_light: 0,
            textures: scene.texture_kinds,
            pixel_footprint: u32::from(view.filter == PixelFilter::Center && scene.facts.textured),
            light_paths: variants.light_paths,
            vertex_colors: u32::from(scene.facts.vertex_colors),
            normal_maps: u32::from(scene.facts.normal_mapped),
            push: shaders::SurfacePush {
                sky: scene.sky,
                depth,
                rays: camera_rays(view),
                pixel_size: pixels.map(|side| 2.0 / side),
                light_paths: pixels[0] * pixels[1],
                path_count: self.path_capacity,
                ends: u32::from(ends),
            },
        };
        graph.pass("path/surface", surface).threads_indirect(active, 0);
        if ends {
            return;
        }
        if scene.emitter_count > 0 {
            self.connect(graph, scene, view, depth);
        }
        let scatter = shaders::Scatter {
            alive_paths: self.alive.texels(WORD),
            path_seeds: self.seeds.texels(PAIR),
            vertices: self.vertices.texels(WORDS),
            sobol: self.sobol.clone(),
            path_rays: self.rays.read_write(),
            path_states: self.states.read_write(),
            path_flags: self.flags.read_write(),
            active_paths: next.read_write(),
            bvh_nodes: self.scene.bvh_nodes.clone(),
            specular_lobes: variants.specular,
            transmissive: variants.transmissive,
            from_light: 0,
            light_paths: variants.light_paths,
            push: shaders::ScatterPush { depth, reserved: 0 },
        };
        graph.pass("path/scatter", scatter).count("paths on", next, 3).threads_indirect(self.alive, 0);
    }

    /// Next-event estimation.
    fn connect(&mut self, graph: &mut Graph<'_>, scene: &TracedScene, view: &View, depth: u32) {
        let variants = self.variants;
        let pixels = view.size.map(|side| side as f32);
        let light = shaders::Light {
            alive_paths: self.alive.texels(WORD),
            path_rays: self.rays.texels(FLOATS),
            path_states: self.states.texels(FLOATS),
            path_flags: self.flags.texels(WORD),
            path_seeds: self.seeds.texels(PAIR),
            vertices: self.vertices.texels(WORDS),
            sobol: self.sobol.clone(),
            emitters: self.scene.emitters.clone(),
            lights: self.scene.lights.clone(),
            triangles: self.scene.triangles.clone(),
            materials: self.scene.materials.clone(),
            corner_texcoords: self.scene.corner_texcoords.clone(),
            material_textures: self.scene.material_textures.clone(),
            texture_table: self.scene.texture_table.clone(),
            texels: self.scene.texels.clone(),
            connection_rays: self.connection_rays.write(),
            connection_light: self.connection_light.write(),
            connections: self.connections.read_write(),
            bvh_nodes: self.scene.bvh_nodes.clone(),
            specular_lobes: variants.specular,
            transmissive: variants.transmissive,
            light_paths: variants.light_paths,
            emissive_textures: u32::from(scene.emissive_textures),
            push: shaders::LightPush {
                emitter_count: scene.emitter_count,
                depth,
                light_paths: pixels[0] * pixels[1],
                disc_area: (std::f64::consts::PI * scene.radius * scene.radius) as f32,
            },
        };
        graph.pass("path/light", light).threads_indirect(self.alive, 0);
        let connect = shaders::Connect {
            connections: self.connections.texels(WORD),
            connection_rays: self.connection_rays.texels(FLOATS),
            connection_light: self.connection_light.texels(FLOATS),
            bvh_nodes: self.scene.bvh_nodes.clone(),
            bvh_triangles: self.scene.bvh_triangles.clone(),
            path_radiance: self.radiance.read_write(),
            triangles: self.scene.triangles.clone(),
            corner_colors: self.scene.corner_colors.clone(),
            corner_texcoords: self.scene.corner_texcoords.clone(),
            materials: self.scene.materials.clone(),
            material_textures: self.scene.material_textures.clone(),
            texture_table: self.scene.texture_table.clone(),
            texels: self.scene.texels.clone(),
            alpha_masks: u32::from(scene.facts.alpha_masked),
            vertex_colors: u32::from(scene.facts.vertex_colors),
            specular_lobes: variants.specular,
            push: shaders::ConnectPush { path_count: self.path_capacity, reserved: 0 },
        };
        graph.pass("path/connect", connect).count("rays", self.connections, 3).threads_indirect(self.connections, 0);
    }

    /// Adds the wave's samples up.
    pub(super) fn resolve(&mut self, graph: &mut Graph<'_>, wave: &Wave) {
        let resolve = shaders::Resolve {
            path_radiance: self.radiance.read_write(),
            slot_sums: self.sums.read_write(),
            push: shaders::ResolvePush {
                paths_per_sample: wave.paths_per_sample(),
                sample_count: wave.sample_count,
                path_count: self.path_capacity,
                slot_count: Slot::ALL.len() as u32,
            },
        };
        graph.pass("path/resolve", resolve).threads([wave.paths_per_sample(), 1, 1]);
    }

    pub(super) fn read_sums(&self, graph: &mut Graph<'_>) -> ReadBack {
        graph.read_back_buffer(self.sums)
    }

    /// Asks for all that the next submission goes on from.
    pub(super) fn want(&self, graph: &mut Graph<'_>) {
        graph.want_buffer(self.sums);
        graph.want_buffer(self.radiance);
        graph.want_buffer(self.rays);
        graph.want_buffer(self.states);
        graph.want_buffer(self.flags);
        graph.want_buffer(self.seeds);
        for active in self.active {
            graph.want_buffer(active);
        }
    }
}

/// Camera rays per solid angle on the axis, or per area across an orthographic view, for one sample of every pixel.
fn camera_rays(view: &View) -> types::CameraRays {
    let length = |axis: [f32; 3]| glam::Vec3::from(axis).length();
    let area = 4.0 * length(view.camera.right_scaled) * length(view.camera.down_scaled);
    let pixels = view.size[0] as f32 * view.size[1] as f32;
    types::CameraRays { density: pixels / area, orthographic: f32::from(view.camera.depth_range > 0.0) }
}
