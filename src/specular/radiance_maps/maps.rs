//! The maps: which caches have one, the light in them, their levels.

use ash::vk;

use super::options::{RadianceMapsFill, RadianceMapsOptions};
use super::search::search;
use super::tables::tables;
use crate::frame::caches::{AreaLights, CacheSight, Caches};
use crate::graph::Dependence;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::method::FrameCx;
use crate::shaders::radiance_maps::{
    Bound, BoundPush, Choose, ChoosePush, Mips, MipsPush, Write, WriteCones, WriteConesPush, WritePush,
};

const WORD: vk::Format = vk::Format::R32_UINT;
const FLOAT: vk::Format = vk::Format::R32_SFLOAT;
/// Maps that memory is held for at first, and texels.
const LEAST: usize = 1024;
const LEAST_TEXELS: usize = 1 << 21;
/// Invocations of a map, which share the groups of lights.
const LANES: u32 = 64;
/// Steps of an invocation's loops: for each light at most, in parts that go to four texels, for a ray to a group of them, and of a cone along one axis.
const LIGHT_STEPS: u32 = 82;
const RAY_STEPS: u32 = 341;
const CONE_STEPS: u32 = 3;

/// The maps of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Maps {
    /// Of each cache: the number of its map plus one; 0: it has none.
    pub(crate) slots: BufferRef<u32>,
    /// Of each cache: what its surfaces have in common (glsl/radiance_maps/horizon.glsl).
    pub(crate) horizons: BufferRef<u32>,
    /// Of each map: its cache.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) caches: BufferRef<u32>,
    /// Words 0 to 2: work groups of one map each; word 3: how many there are.
    pub(crate) head: BufferRef<u32>,
    /// What is known of texels, and lobes' albedos (`tables.rs`).
    pub(crate) tables: BufferRef<[f32; 4]>,
    /// Texels with all levels (glsl/radiance_maps/map.glsl).
    pub(crate) texels: BufferRef<[f32; 4]>,
    /// How many there is room for.
    pub(crate) capacity: u32,
}

/// Texels of a map with all its levels.
pub(super) fn texel_count(size: u32) -> u32 {
    (4 * size * size - 1) / 3
}

/// Declares the passes.
pub(super) fn maps(
    cx: &mut FrameCx<'_, '_>,
    lights: &AreaLights,
    caches: &Caches,
    options: &RadianceMapsOptions,
) -> Maps {
    let texels = texel_count(options.size) as usize;
    let least = LEAST.min(LEAST_TEXELS / texels);
    let (graph, surface) = (&mut *cx.graph, cx.frame.surface);
    let slots = graph.buffer::<u32>("radiance_maps.slots", caches.capacity as usize);
    graph.fill_buffer("specular/radiance-maps/clear-slots", slots, 0);
    let horizons = graph.buffer::<u32>("radiance_maps.horizons", 3 * caches.capacity as usize);
    graph.fill_buffer("specular/radiance-maps/clear-horizons", horizons, 0);
    let list = graph.growing_buffer::<u32>("radiance_maps.caches", least);
    let head = graph.buffer::<u32>("radiance_maps.head", 4);
    graph.fill_buffer("specular/radiance-maps/clear-head", head, 0);
    let capacity = list.count() as u32;
    let pass = Choose {
        surface: surface.group.clone(),
        light_caches: caches.group.clone(),
        slots: slots.read_write(),
        map_head: head.read_write(),
        map_caches: list.start(),
        horizons: horizons.read_write(),
        push: ChoosePush { cache_capacity: caches.capacity, capacity },
    };
    let pass = graph.pass("specular/radiance-maps/choose", pass).unordered();
    pass.count("maps", head, 3).pixels(surface.size);
    graph.grows(list, head, 3);

    let tables = graph.upload("radiance_maps.tables", &tables(options.size), Dependence::NONE);
    let maps = graph.buffer::<[f32; 4]>("radiance_maps.texels", texels * capacity as usize);
    let maps = Maps { slots, horizons, caches: list, head, tables, texels: maps, capacity };
    let (map_bounds, sums, maps_written) = if options.fill == RadianceMapsFill::Search {
        search(cx, lights, caches, &maps, options);
        (TexelBuffer::absent(), TexelBuffer::absent(), maps.texels.read_write())
    } else {
        let (bounds, sums) = write(cx, lights, caches, &maps, options);
        (bounds.texels(FLOAT), sums.texels(WORD), maps.texels.start_then_read())
    };
    let pass = Mips {
        fill: options.fill_kind(),
        map_side: options.size.cast_signed(),
        map_head: head.texels(WORD),
        map_bounds,
        sums,
        maps: maps_written,
        push: MipsPush { capacity },
    };
    cx.graph.pass("specular/radiance-maps/mips", pass).threads_indirect(head, 0);
    maps
}

/// Steps of an invocation's loops for what a cache sees of a group.
pub(super) fn sight_steps(sight: &CacheSight) -> u32 {
    match sight {
        CacheSight::Open => 0,
        CacheSight::Rays => RAY_STEPS,
        CacheSight::Cones(voxels) => CONE_STEPS * voxels.resolution,
    }
}

/// Groups of lights that one pass may take.
fn groups_at_once(lights: &AreaLights, sight: &CacheSight, loop_steps: u32) -> u32 {
    let steps = LIGHT_STEPS * lights.group_lights + sight_steps(sight);
    LANES.saturating_mul(((loop_steps + 1) / steps).max(1)).min(i32::MAX.cast_unsigned())
}

/// Declares the passes that write all lights to all maps; returns what bounds the light of each, and sums of it in whole numbers, three a texel.
fn write(
    cx: &mut FrameCx<'_, '_>,
    lights: &AreaLights,
    caches: &Caches,
    maps: &Maps,
    options: &RadianceMapsOptions,
) -> (BufferRef<f32>, BufferRef<u32>) {
    let sight = cx.frame.caches.sight;
    let (scene, rays) = cx.cache_rays();
    let voxels = match &sight {
        CacheSight::Cones(settings) => Some(cx.voxels(settings)),
        CacheSight::Open | CacheSight::Rays => None,
    };
    let surface = cx.frame.surface.group.clone();
    let graph = &mut *cx.graph;
    let bounds = graph.buffer::<f32>("radiance_maps.bounds", maps.capacity as usize);
    let pass = Bound {
        area_lights: lights.group.clone(),
        light_caches: caches.group.clone(),
        map_head: maps.head.texels(WORD),
        map_caches: maps.caches.texels(WORD),
        bounds: bounds.start(),
        push: BoundPush { capacity: maps.capacity },
    };
    graph.pass("specular/radiance-maps/bound", pass).threads_indirect(maps.head, 0);
    let texels = 3 * (texel_count(options.size) * maps.capacity) as usize;
    let map_sums = graph.buffer::<u32>("radiance_maps.sums", texels);
    let most = groups_at_once(lights, &sight, graph.traits().loop_steps);
    let (map_side, cached, fill) = (options.size.cast_signed(), u32::from(options.is_cached()), options.fill_kind());
    for first in (0..lights.group_count.max(1)).step_by(most as usize) {
        let name = if first == 0 {
            "specular/radiance-maps/write".to_owned()
        } else {
            format!("specular/radiance-maps/write-{}", first / most + 1)
        };
        let sums = if first == 0 { map_sums.start_then_read() } else { map_sums.read_write() };
        let (first_group, capacity) = (first.cast_signed(), maps.capacity);
        let end_group = first.saturating_add(most).min(lights.group_count).cast_signed();
        let (area_lights, light_caches, surface) = (lights.group.clone(), caches.group.clone(), surface.clone());
        let (map_head, map_caches, map_bounds) =
            (maps.head.texels(WORD), maps.caches.texels(WORD), bounds.texels(FLOAT));
        if let Some(voxels) = &voxels {
            let voxels = voxels.group.clone();
            let push = WriteConesPush { rays, first_group, end_group, capacity };
            let pass = WriteCones {
                voxels,
                area_lights,
                light_caches,
                surface,
                map_head,
                map_caches,
                map_bounds,
                sums,
                horizons: maps.horizons.read(),
                map_side,
                cached,
                fill,
                push,
            };
            graph.pass(&name, pass).threads_indirect(maps.head, 0);
        } else {
            let push = WritePush { rays, first_group, end_group, capacity };
            let pass = Write {
                scene_rays: scene.clone(),
                area_lights,
                light_caches,
                surface,
                map_head,
                map_caches,
                map_bounds,
                sums,
                horizons: maps.horizons.read(),
                traces: u32::from(sight == CacheSight::Rays),
                map_side,
                cached,
                fill,
                push,
            };
            graph.pass(&name, pass).threads_indirect(maps.head, 0);
        }
    }
    (bounds, map_sums)
}
