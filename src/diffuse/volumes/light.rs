//! The light of all virtual area lights at all caches.

use super::options::{VolumesOptions, VolumesVal, VolumesVisibility};
use super::renewal::{Renewal, renewal};
use crate::frame::caches::{AreaLights, CacheSight, Caches, Chunk, LANES, nodes};
use crate::frame::voxels::Voxels;
use crate::graph::bindings::{BufferRef, ReadBuffer, TexelBuffer};
use crate::graph::{Graph, hash_of};
use crate::method::FrameCx;
use crate::shaders::groups::{LightCaches, SceneRays};
use crate::shaders::types::CacheRays;
use crate::shaders::volumes::{Light, LightCones, LightConesPush, LightPush};

/// Invocations of a cache, which share the groups of lights, and caches of a work group (glsl/volumes/light.glsl).
const TURNS: u32 = 8;
const GROUP_CACHES: u32 = 8;
/// Steps of an invocation's loops before and after all groups of a cache; where 64 neighbouring groups are taken together, for their nodes and to draw one among their lights.
const OTHER_STEPS: u32 = 80;
const DRAW_STEPS: u32 = 128;

/// Lights that passes of one name take.
struct List<'l> {
    name: &'static str,
    lights: &'l AreaLights,
    /// Present if groups are taken together.
    nodes: Option<BufferRef<[f32; 4]>>,
}

/// What all passes read.
struct Inputs<'a> {
    caches: &'a Caches,
    options: &'a VolumesOptions,
    scene: SceneRays,
    rays: CacheRays,
    voxels: Option<&'a Voxels>,
    light: BufferRef<f32>,
    /// Of rays or cones, pass by pass.
    sent: BufferRef<u32>,
    /// Present if some caches alone are lit.
    due: Option<BufferRef<u32>>,
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
    let lists = [("diffuse/volumes/light", views), ("diffuse/volumes/light-samples", samples)];
    let lists = lists.into_iter().filter_map(|(name, lights)| Some((name, lights?)));
    let listed: Vec<List<'_>> = lists
        .map(|(name, lights)| {
            let together = options.aperture > 0.0;
            let nodes = together.then(|| nodes(cx.graph, &format!("{name}-nodes"), lights));
            List { name, lights, nodes }
        })
        .collect();
    let renewal = if options.update > 1 && options.cascades > 1 && !listed.is_empty() {
        let now = now(cx, caches, voxels.as_deref(), &listed);
        Some(renewal(cx, caches, now, options))
    } else {
        None
    };
    let (light, due) = match renewal {
        Some(Renewal { light, due }) => (light, Some(due)),
        None => (cx.graph.buffer("volumes.light", options.numbers() * caches.capacity as usize), None),
    };
    let graph = &mut *cx.graph;
    if listed.is_empty() {
        graph.fill_buffer("diffuse/volumes/clear-light", light, 0);
        return light;
    }
    let (sight, loop_steps) = (options.cache_settings().sight, graph.traits().loop_steps);
    let of_list = |list: &'_ List<'_>| {
        let steps = 1 + list.lights.group_lights;
        // Together all invocations take one cache after the other.
        let (steps, lanes, loop_steps) = match list.nodes {
            Some(_) => (steps + DRAW_STEPS, LANES, loop_steps / GROUP_CACHES),
            None => (steps, TURNS, loop_steps),
        };
        list.lights.chunks(sight, steps, (lanes, loop_steps.saturating_sub(OTHER_STEPS))).collect::<Vec<Chunk>>()
    };
    let chunks: Vec<(&List<'_>, Chunk)> =
        listed.iter().flat_map(|list| of_list(list).into_iter().map(move |chunk| (list, chunk))).collect();
    let sent = graph.buffer::<u32>("volumes.sent", chunks.len());
    graph.fill_buffer("diffuse/volumes/clear-sent", sent, 0);
    let inputs = Inputs { caches, options, scene, rays, voxels: voxels.as_deref(), light, sent, due };
    for (number, (list, chunk)) in chunks.into_iter().enumerate() {
        pass(graph, &inputs, list, chunk, number as u32);
    }
    light
}

/// Names all that the light of caches depends on.
fn now(cx: &FrameCx<'_, '_>, caches: &Caches, voxels: Option<&Voxels>, lists: &[List<'_>]) -> u64 {
    let of_lights = |list: &List<'_>| cx.graph.key_of(list.lights.lights);
    let lights: Vec<u64> = lists.iter().map(of_lights).collect();
    let voxels = voxels.map(|voxels| cx.graph.key_of_image(voxels.opacity));
    let scene = cx.rays().map(|scene| scene.key);
    hash_of(&(lights, voxels, scene, cx.graph.key_of(caches.positions)))
}

fn pass(graph: &mut Graph<'_>, inputs: &Inputs<'_>, list: &List<'_>, chunk: Chunk, number: u32) {
    let &Inputs { caches, options, rays, light, sent, due, .. } = inputs;
    let paper = options.val == VolumesVal::Paper;
    // The paper's lights come from all around: nobody looks for horizons then.
    let cache_horizons = if paper { TexelBuffer::absent() } else { caches.group.cache_horizons.clone() };
    let light_caches = LightCaches { cache_horizons, ..caches.group.clone() };
    let (area_lights, name) = (list.lights.group.clone(), chunk.name(list.name));
    let (first_group, end_group, capacity) = (chunk.first_group, chunk.end_group, caches.capacity);
    let group_count = list.lights.group_count.cast_signed();
    let aperture = (options.aperture.to_radians() * 0.5).sin() as f32;
    let adds = number > 0;
    let into = if adds || due.is_some() { light.read_write() } else { light.start_then_read() };
    let listed = due.map_or(ReadBuffer::absent(), BufferRef::read);
    let nodes = |nodes: BufferRef<[f32; 4]>| nodes.texels(ash::vk::Format::R32G32B32A32_SFLOAT);
    let light_nodes = list.nodes.map_or(TexelBuffer::absent(), nodes);
    let (is_listed, together) = (u32::from(due.is_some()), u32::from(list.nodes.is_some()));
    let (arguments, adds) = (due.unwrap_or(caches.head), u32::from(adds));
    if let Some(voxels) = inputs.voxels {
        let pass = LightCones {
            voxels: voxels.group.clone(),
            area_lights,
            light_caches,
            light: into,
            sent: sent.read_write(),
            due: listed,
            light_nodes,
            bands: options.bands,
            chroma: options.chroma_bands(),
            paper: u32::from(paper),
            listed: is_listed,
            together,
            push: LightConesPush { rays, first_group, end_group, capacity, adds, group_count, aperture, number },
        };
        graph.pass(&name, pass).count("cones", sent, number as usize).threads_indirect(arguments, 0);
        return;
    }
    let traces = options.cache_settings().sight == CacheSight::Rays;
    let pass = Light {
        scene_rays: inputs.scene.clone(),
        area_lights,
        light_caches,
        light: into,
        sent: sent.read_write(),
        due: listed,
        light_nodes,
        bands: options.bands,
        chroma: options.chroma_bands(),
        paper: u32::from(paper),
        listed: is_listed,
        together,
        traces: u32::from(traces),
        push: LightPush { rays, first_group, end_group, capacity, adds, group_count, aperture, number },
    };
    let pass = graph.pass(&name, pass);
    let pass = if traces { pass.count("rays", sent, number as usize) } else { pass };
    pass.threads_indirect(arguments, 0);
}
