//! The light of all virtual area lights at all caches.

use super::options::{VolumesOptions, VolumesVisibility};
use super::rays::rays_of;
use crate::frame::caches::{AreaLights, Caches};
use crate::graph::bindings::BufferRef;
use crate::method::FrameCx;
use crate::shaders::volumes::{Light, LightPush};

/// Invocations of a cache, which share the groups of lights.
const LANES: u32 = 64;
/// Steps of an invocation's loops for each light, and for a ray to a group of them.
const LIGHT_STEPS: u32 = 2;
const RAY_STEPS: u32 = 341;

/// The kinds of glsl/volumes/visibility.glsl.
fn kind_of(visibility: VolumesVisibility) -> u32 {
    match visibility {
        VolumesVisibility::None => 0,
        VolumesVisibility::Rays => 1,
    }
}

/// Numbers that a cache holds (glsl/volumes/light.comp).
fn numbers(bands: u32) -> usize {
    if bands == 3 { 28 } else { 12 }
}

/// Groups that one pass may take.
fn groups_at_once(lights: &AreaLights, rays: bool, loop_steps: u32) -> u32 {
    let steps = LIGHT_STEPS * lights.group_lights + if rays { RAY_STEPS } else { 0 };
    LANES.saturating_mul(((loop_steps + 1) / steps).max(1)).min(i32::MAX.cast_unsigned())
}

/// Declares the passes; returns the numbers of all caches.
pub(super) fn light(
    cx: &mut FrameCx<'_, '_>,
    lights: &AreaLights,
    caches: &Caches,
    options: &VolumesOptions,
) -> BufferRef<f32> {
    let (scene, rays) = rays_of(cx);
    let graph = &mut *cx.graph;
    let light = graph.buffer::<f32>("volumes.light", numbers(options.bands) * caches.capacity as usize);
    let traces = options.visibility == VolumesVisibility::Rays;
    let most = groups_at_once(lights, traces, graph.traits().loop_steps);
    for first in (0..lights.group_count.max(1)).step_by(most as usize) {
        let pass = Light {
            scene_rays: scene.clone(),
            area_lights: lights.group.clone(),
            light_caches: caches.group.clone(),
            light: if first == 0 { light.start_then_read() } else { light.read_write() },
            bands: options.bands,
            visibility: kind_of(options.visibility),
            push: LightPush {
                rays,
                first_group: first.cast_signed(),
                end_group: first.saturating_add(most).min(lights.group_count).cast_signed(),
                capacity: caches.capacity,
            },
        };
        let name = if first == 0 {
            "diffuse/volumes/light".to_owned()
        } else {
            format!("diffuse/volumes/light-{}", first / most + 1)
        };
        graph.pass(&name, pass).threads_indirect(caches.head, 0);
    }
    light
}
