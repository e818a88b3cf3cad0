//! The light of all virtual area lights at all caches.

use super::options::{VolumesOptions, VolumesVal, VolumesVisibility};
use crate::frame::caches::{AreaLights, Caches};
use crate::graph::bindings::BufferRef;
use crate::method::FrameCx;
use crate::shaders::volumes::{Light, LightCones, LightConesPush, LightPush};

/// Invocations of a cache, which share the groups of lights (glsl/volumes/light.glsl).
const TURNS: u32 = 8;
/// Steps of an invocation's loops for a ray to a group of lights, and before and after all groups.
const RAY_STEPS: u32 = 341;
const OTHER_STEPS: u32 = 64;

/// Steps of a cone over voxels along one axis at most.
const CONE_STEPS: u32 = 3;

/// Numbers that a cache holds (glsl/volumes/light.glsl).
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
    let steps = 1 + lights.group_lights + seen;
    TURNS.saturating_mul(((loop_steps - OTHER_STEPS) / steps).max(1)).min(i32::MAX.cast_unsigned())
}

/// Some groups of lights, which one pass takes.
struct Step<'l> {
    number: u32,
    name: String,
    lights: &'l AreaLights,
    first_group: i32,
    end_group: i32,
}

fn steps_of<'l>(lights: &[(&str, &'l AreaLights)], loop_steps: u32, options: &VolumesOptions) -> Vec<Step<'l>> {
    let chunks = |&(name, lights): &(&str, &'l AreaLights)| {
        let most = groups_at_once(lights, options, loop_steps);
        let name = name.to_owned();
        (0..lights.group_count.max(1)).step_by(most as usize).map(move |first| {
            let name = if first == 0 { name.clone() } else { format!("{name}-{}", first / most + 1) };
            let end_group = first.saturating_add(most).min(lights.group_count).cast_signed();
            Step { name, lights, first_group: first.cast_signed(), end_group, number: 0 }
        })
    };
    (0..).zip(lights.iter().flat_map(chunks)).map(|(number, step)| Step { number, ..step }).collect()
}

/// Declares the passes; returns the numbers of all caches. `views`: lights of light views, `samples`: of samples of the surfaces.
pub(super) fn light(
    cx: &mut FrameCx<'_, '_>,
    (views, samples): (Option<&AreaLights>, Option<&AreaLights>),
    caches: &Caches,
    options: &VolumesOptions,
) -> BufferRef<f32> {
    let (scene, rays) = cx.cache_rays();
    let voxels = (options.visibility == VolumesVisibility::Cones).then(|| cx.voxels(&options.voxel_settings()));
    let graph = &mut *cx.graph;
    let light = graph.buffer::<f32>("volumes.light", numbers(options.bands) * caches.capacity as usize);
    let lists = [("diffuse/volumes/light", views), ("diffuse/volumes/light-samples", samples)];
    let lists: Vec<_> = lists.into_iter().filter_map(|(name, lights)| Some((name, lights?))).collect();
    if lists.is_empty() {
        graph.fill_buffer("diffuse/volumes/clear-light", light, 0);
    }
    for step in steps_of(&lists, graph.traits().loop_steps, options) {
        let (first_group, end_group) = (step.first_group, step.end_group);
        let adds = step.number > 0;
        let into = if adds { light.read_write() } else { light.start_then_read() };
        let (area_lights, light_caches) = (step.lights.group.clone(), caches.group.clone());
        let (adds, capacity) = (u32::from(adds), caches.capacity);
        if let Some(voxels) = &voxels {
            let pass = LightCones {
                voxels: voxels.group.clone(),
                area_lights,
                light_caches,
                light: into,
                bands: options.bands,
                paper: u32::from(options.val == VolumesVal::Paper),
                push: LightConesPush { rays, first_group, end_group, capacity, adds },
            };
            graph.pass(&step.name, pass).threads_indirect(caches.head, 0);
        } else {
            let pass = Light {
                scene_rays: scene.clone(),
                area_lights,
                light_caches,
                light: into,
                bands: options.bands,
                paper: u32::from(options.val == VolumesVal::Paper),
                traces: u32::from(options.visibility == VolumesVisibility::Rays),
                push: LightPush { rays, first_group, end_group, capacity, adds },
            };
            graph.pass(&step.name, pass).threads_indirect(caches.head, 0);
        }
    }
    light
}
