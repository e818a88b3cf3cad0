//! The light of all virtual area lights at all caches.

use super::options::{VolumesOptions, VolumesVisibility};
use crate::frame::caches::{AreaLights, Caches, SeenLights, SeenWanted};
use crate::graph::bindings::{BufferRef, ReadWriteBuffer};
use crate::method::FrameCx;
use crate::shaders::volumes::{Light, LightCones, LightConesPush, LightPush};

/// Invocations of a cache, which share the groups of lights.
const LANES: u32 = 64;
/// Steps of an invocation's loops for each light, and for a ray to a group of them.
const LIGHT_STEPS: u32 = 2;
const RAY_STEPS: u32 = 341;

/// Steps of a cone over voxels along one axis at most.
const CONE_STEPS: u32 = 3;

/// Numbers that a cache holds (glsl/volumes/light.comp).
fn numbers(bands: u32) -> usize {
    if bands == 3 { 28 } else { 12 }
}

/// Groups that one pass may take.
fn groups_at_once(lights: &AreaLights, options: &VolumesOptions, loop_steps: u32) -> u32 {
    let seen = match options.visibility {
        VolumesVisibility::None => 0,
        VolumesVisibility::Rays => RAY_STEPS,
        VolumesVisibility::Cones => CONE_STEPS * options.voxels,
    };
    let steps = LIGHT_STEPS * lights.group_lights + seen;
    LANES.saturating_mul(((loop_steps + 1) / steps).max(1)).min(i32::MAX.cast_unsigned())
}

/// Declares the passes; returns the numbers of all caches.
pub(super) fn light(
    cx: &mut FrameCx<'_, '_>,
    lights: &AreaLights,
    caches: &Caches,
    options: &VolumesOptions,
) -> BufferRef<f32> {
    let (scene, rays) = cx.cache_rays();
    let voxels = (options.visibility == VolumesVisibility::Cones).then(|| cx.voxels(&options.voxel_settings()));
    let graph = &mut *cx.graph;
    let light = graph.buffer::<f32>("volumes.light", numbers(options.bands) * caches.capacity as usize);
    // What rays found is kept where somebody else asks for it.
    let shares = options.visibility == VolumesVisibility::Rays && cx.frame.offers.get::<SeenWanted>().is_some();
    let seen_words = lights.group_count.div_ceil(32);
    let seen = shares.then(|| graph.buffer::<u32>("volumes.seen", (seen_words * caches.capacity) as usize));
    let most = groups_at_once(lights, options, graph.traits().loop_steps);
    for first in (0..lights.group_count.max(1)).step_by(most as usize) {
        let into = if first == 0 { light.start_then_read() } else { light.read_write() };
        let name = if first == 0 {
            "diffuse/volumes/light".to_owned()
        } else {
            format!("diffuse/volumes/light-{}", first / most + 1)
        };
        let (first_group, capacity) = (first.cast_signed(), caches.capacity);
        let end_group = first.saturating_add(most).min(lights.group_count).cast_signed();
        let (area_lights, light_caches) = (lights.group.clone(), caches.group.clone());
        if let Some(voxels) = &voxels {
            let push = LightConesPush { rays, first_group, end_group, capacity, seen_words };
            let pass = LightCones {
                voxels: voxels.group.clone(),
                area_lights,
                light_caches,
                light: into,
                seen: ReadWriteBuffer::absent(),
                bands: options.bands,
                keeps_seen: 0,
                push,
            };
            graph.pass(&name, pass).threads_indirect(caches.head, 0);
        } else {
            let pass = Light {
                scene_rays: scene.clone(),
                area_lights,
                light_caches,
                light: into,
                seen: seen.map_or(ReadWriteBuffer::absent(), |seen| match first {
                    0 => seen.start_then_read(),
                    _ => seen.read_write(),
                }),
                bands: options.bands,
                keeps_seen: u32::from(shares),
                traces: u32::from(options.visibility == VolumesVisibility::Rays),
                push: LightPush { rays, first_group, end_group, capacity, seen_words },
            };
            graph.pass(&name, pass).threads_indirect(caches.head, 0);
        }
    }
    if let Some(bits) = seen {
        cx.frame.offers.put(SeenLights { bits, words: seen_words });
    }
    light
}
