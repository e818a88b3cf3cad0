//! Paths from lights, pass by pass (glsl/particle/, glsl/path/): emit, then for each vertex intersect, surface, camera, splat, scatter.
//!
//! They find what camera paths find badly: light of small or far lights that mirrors, water and glass bring to diffuse surfaces. So most are
//! sent to glossy surfaces (`frame/rays/targets.rs`). Each vertex from the second on is connected to the camera through its diffuse lobe,
//! which is the slot `caustics` or `diffuse`; the balance heuristic shares every such path with the camera's (glsl/path/mis.glsl).
//! Scenes without glossy surfaces do without.

use super::paths::{Paths, Walk, camera_rays};
use super::sums::SlotSums;
use super::view::View;
use crate::frame::rays::{TargetShares, TracedScene};
use crate::graph::bindings::BufferRef;
use crate::graph::{Graph, ReadBack};
use crate::shaders::particle as shaders;
use crate::slot::Slot;
use crate::vulkan::VulkanError;

/// Words of a sum: low and high of red, green and blue.
const WORDS_PER_PIXEL: usize = 6;
/// Binary digits after the point of a splat in units of the scene's radiance.
const FRACTION_BITS: i32 = 36;

/// Some paths of one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swarm {
    pub(super) first_path: u32,
    pub(super) path_count: u32,
    /// Of the sample.
    pub(super) seed: u32,
}

/// Sums of what light paths send to the pixels, in 64-bit fixed point: the slots `diffuse` and `caustics` after each other.
pub(super) struct Splats {
    buffer: BufferRef<u32>,
    scale: f32,
}

impl Splats {
    /// # Errors
    /// An image that is too large for the device's buffers.
    pub(super) fn declare(
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        view: &View,
        limit: u32,
    ) -> Result<Splats, VulkanError> {
        let pixels = view.size[0] as usize * view.size[1] as usize;
        let words = 2 * WORDS_PER_PIXEL * pixels;
        if 4 * words as u64 > u64::from(limit) {
            return Err(VulkanError::TooLarge {
                what: "a path-traced image of a scene with glossy surfaces".to_owned(),
                asked: format!("{}x{} pixels", view.size[0], view.size[1]),
                limit: format!("{} pixels", u64::from(limit) / (8 * WORDS_PER_PIXEL as u64)),
            });
        }
        // Behind the sums: how many were left out, since they were no numbers.
        let buffer = graph.buffer("particle.splats", words + 2);
        graph.keep_for_read_back(buffer);
        Ok(Splats { buffer, scale: scale_of(scene) })
    }

    /// Starts from zero.
    pub(super) fn clear(&self, graph: &mut Graph<'_>) {
        graph.fill_buffer("particle/clear-splats", self.buffer, 0);
    }

    pub(super) fn want(&self, graph: &mut Graph<'_>) {
        graph.want_buffer(self.buffer);
    }

    pub(super) fn read_back(&self, graph: &mut Graph<'_>) -> ReadBack {
        graph.read_back_buffer(self.buffer)
    }
}

/// Adds splats that were read back to the sums of their slots.
pub(super) fn add_splats(sums: &mut SlotSums, bytes: &[u8], scene: &TracedScene) {
    let unit = 1.0 / f64::from(scale_of(scene));
    let words: Vec<u64> =
        bytes.chunks_exact(8).map(|word| u64::from_le_bytes(word.try_into().expect("8 bytes"))).collect();
    let pixels = words.len() / WORDS_PER_PIXEL;
    for (index, slot) in [Slot::Diffuse, Slot::Caustics].into_iter().enumerate() {
        let place = Slot::ALL.iter().position(|known| *known == slot).expect("a slot");
        for (pixel, sum) in sums.slots[place].iter_mut().enumerate() {
            let first = (index * pixels + pixel) * 3;
            for channel in 0..3 {
                sum[channel] = (f64::from(sum[channel]) + words[first + channel] as f64 * unit) as f32;
            }
        }
    }
}

/// Units of a splat in 1 W/(m² sr): what all lights send out, spread over the scene's sphere, is 2³⁶ of them.
pub(super) fn scale_of(scene: &TracedScene) -> f32 {
    let area = std::f64::consts::PI * scene.radius * scene.radius;
    let radiance = (scene.power / (std::f64::consts::PI * area)).clamp(1e-25, 1e25);
    2.0_f64.powi(FRACTION_BITS - radiance.log2().floor() as i32) as f32
}

/// Starts the swarm's paths.
pub(super) fn emit(graph: &mut Graph<'_>, paths: &Paths, scene: &TracedScene, view: &View, swarm: &Swarm) {
    paths.clear_queues(graph, Walk::FromLight);
    // Photons lie where light falls.
    let shares = if paths.variants.photons == 0 { scene.target_shares } else { TargetShares::default() };
    let emit = shaders::Emit {
        scene_rays: paths.rays.clone(),
        scene_lights: paths.lights.clone(),
        light_targets: paths.targets.clone(),
        new_paths: paths.started(),
        far_surfaces: u32::from(scene.far_surfaces),
        push: shaders::EmitPush {
            emitter_count: scene.emitter_count,
            first_path: swarm.first_path,
            path_count: swarm.path_count,
            seed: swarm.seed,
            light_paths: view.light_path_count() as f32,
            radius: scene.radius as f32,
            middle: scene.middle_rs.as_vec3().to_array(),
            target_count: shares.count,
            target_share: (1.0 - shares.anywhere) as f32,
        },
    };
    graph.pass("particle/emit", emit).note("paths", u64::from(swarm.path_count)).threads([swarm.path_count, 1, 1]);
}

/// Takes the paths to their vertex number `depth`, counted from 0, and on from there.
pub(super) fn advance(
    graph: &mut Graph<'_>,
    paths: &Paths,
    splats: &Splats,
    scene: &TracedScene,
    view: &View,
    depth: u32,
) {
    paths.advance(graph, (scene, view), Walk::FromLight, depth, |graph| {
        if depth > 0 {
            connect_to_camera(graph, paths, splats, view, depth);
        }
    });
}

fn connect_to_camera(graph: &mut Graph<'_>, paths: &Paths, splats: &Splats, view: &View, depth: u32) {
    let camera = shaders::Camera {
        scene_rays: paths.rays.clone(),
        paths: paths.group(Walk::FromLight, depth),
        camera: paths.camera.clone(),
        connection_rays: paths.connection_rays.write(),
        connection_light: paths.connection_light.write(),
        connections: paths.connections.read_write(),
        lobes: paths.lobes.clone(),
        push: shaders::CameraPush {
            rays: camera_rays(view),
            size: view.size,
            light_paths: view.light_path_count() as f32,
            reserved: 0,
        },
    };
    graph.pass("particle/camera", camera).threads_indirect(paths.alive, 0);
    let splat = shaders::Splat {
        scene_rays: paths.rays.clone(),
        connections: paths.connected(),
        splats: splats.buffer.read_write(),
        push: shaders::SplatPush { scale: splats.scale, reserved: 0 },
    };
    graph
        .pass("particle/splat", splat)
        .count("rays", paths.connections, 3)
        .count("dropped", splats.buffer, splats.buffer.count() - 2)
        .threads_indirect(paths.connections, 0);
}
