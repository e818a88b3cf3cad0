//! Paths from the camera, pass by pass (glsl/path/): generate, then for each vertex intersect, surface, light, connect, scatter.
//!
//! With z_1 the first visible surface, each vertex adds one factor of
//!
//!   L = Σ_k ∫ L_e(z_{k+1}) Π_{i=1}^{k} f(z_i)·|cos| dω        W/(m²·sr)
//!
//! found by running into the light (surface) and by choosing a point of it (light, connect), weighted by the balance heuristic.

use super::paths::{Paths, Walk, light_paths};
use super::view::View;
use crate::frame::rays::TracedScene;
use crate::graph::bindings::BufferRef;
use crate::graph::{Graph, ReadBack};
use crate::shaders::{path as shaders, types};
use crate::slot::{PixelFilter, Slot};

/// Some samples of some pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wave {
    pub(super) first_block: u32,
    pub(super) block_count: u32,
    pub(super) sample_count: u32,
    pub(super) first_sample: u32,
    /// Of the half.
    pub(super) seed: u32,
}

impl Wave {
    pub(super) fn paths_per_sample(&self) -> u32 {
        64 * self.block_count
    }
}

/// The sums of a run of pixels: [`Slot::ALL`] after each other, in the order of paths.
pub(super) struct Sums(BufferRef<[f32; 4]>);

impl Sums {
    /// The sums so far.
    pub(super) fn declare(graph: &mut Graph<'_>, wave: &Wave) -> Sums {
        let sums = graph.buffer("path.sums", Slot::ALL.len() * wave.paths_per_sample() as usize);
        graph.keep_for_read_back(sums);
        Sums(sums)
    }

    /// Starts from zero. In the submission that adds first: what a submission leaves for a later one is lost if that one uses its
    /// memory in a new way.
    pub(super) fn clear(&self, graph: &mut Graph<'_>) {
        graph.fill_buffer("path/clear-sums", self.0, 0);
    }

    pub(super) fn read_back(&self, graph: &mut Graph<'_>) -> ReadBack {
        graph.read_back_buffer(self.0)
    }

    /// Adds the samples of a wave that has come to its end.
    pub(super) fn add(&self, graph: &mut Graph<'_>, paths: &Paths, wave: &Wave) {
        let dropped = graph.buffer::<u32>("path.dropped", 1);
        graph.fill_buffer("path/clear-dropped", dropped, 0);
        let resolve = shaders::Resolve {
            path_radiance: paths.radiance.read_write(),
            slot_sums: self.0.read_write(),
            dropped_samples: dropped.read_write(),
            push: shaders::ResolvePush {
                paths_per_sample: wave.paths_per_sample(),
                sample_count: wave.sample_count,
                path_count: paths.capacity,
                slot_count: Slot::ALL.len() as u32,
            },
        };
        graph.pass("path/resolve", resolve).count("dropped", dropped, 0).threads([wave.paths_per_sample(), 1, 1]);
        graph.want_buffer(self.0);
    }
}

/// Starts the wave's paths.
pub(super) fn generate(graph: &mut Graph<'_>, paths: &Paths, view: &View, wave: &Wave) {
    paths.clear_queues(graph, Walk::FromCamera);
    let generate = shaders::Generate {
        scene_rays: paths.rays.clone(),
        new_paths: paths.started(),
        camera: paths.camera.clone(),
        push: shaders::GeneratePush {
            wave: types::WavePixels { size: view.size, first_block: wave.first_block, block_count: wave.block_count },
            sample_count: wave.sample_count,
            first_sample: wave.first_sample,
            seed: wave.seed,
            box_filter: u32::from(view.filter == PixelFilter::Box),
        },
    };
    let threads = wave.paths_per_sample() * wave.sample_count;
    graph.pass("path/generate", generate).note("paths", u64::from(threads)).threads([threads, 1, 1]);
}

/// Takes the paths to their vertex number `depth`, counted from 0, and on from there.
pub(super) fn advance(graph: &mut Graph<'_>, paths: &Paths, scene: &TracedScene, view: &View, depth: u32) {
    paths.advance(graph, (scene, view), Walk::FromCamera, depth, |graph| find_light(graph, paths, scene, view, depth));
}

/// Next-event estimation, where a further bounce is allowed.
pub(super) fn find_light(graph: &mut Graph<'_>, paths: &Paths, scene: &TracedScene, view: &View, depth: u32) {
    if scene.emitter_count == 0 || view.camera_bounces().is_some_and(|bounces| depth > bounces) {
        return;
    }
    let light = shaders::Light {
        scene_rays: paths.rays.clone(),
        scene_lights: paths.lights.clone(),
        paths: paths.group(Walk::FromCamera, depth),
        connection_rays: paths.connection_rays.write(),
        connection_light: paths.connection_light.write(),
        connections: paths.connections.read_write(),
        lobes: paths.lobes.clone(),
        push: shaders::LightPush {
            emitter_count: scene.emitter_count,
            depth,
            light_paths: light_paths(scene, view),
            disc_area: (std::f64::consts::PI * scene.radius * scene.radius) as f32,
            middle: scene.middle_rs.as_vec3().to_array(),
        },
    };
    graph.pass("path/light", light).threads_indirect(paths.alive, 0);
    let connect = shaders::Connect {
        scene_rays: paths.rays.clone(),
        connections: paths.connected(),
        lobes: paths.lobes.clone(),
        path_radiance: paths.radiance.read_write(),
        push: shaders::ConnectPush { path_count: paths.capacity, reserved: 0 },
    };
    graph.pass("path/connect", connect).count("rays", paths.connections, 3).threads_indirect(paths.connections, 0);
}
