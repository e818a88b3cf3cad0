//! The light in the maps, and their levels.

use ash::vk;

use super::choose::{Maps, choose, texel_count};
use super::options::{RadianceMapsFill, RadianceMapsOptions};
use super::search::search;
use crate::frame::caches::{AreaLights, CacheSight, Caches, LANES};
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::method::FrameCx;
use crate::shaders::radiance_maps::{Bound, BoundPush, Mips, MipsPush, Write, WriteCones, WriteConesPush, WritePush};

const WORD: vk::Format = vk::Format::R32_UINT;
const FLOAT: vk::Format = vk::Format::R32_SFLOAT;
/// Steps of an invocation's loops for each light at most, in parts that go to four texels.
const LIGHT_STEPS: u32 = 82;

/// Declares the passes.
pub(super) fn maps(
    cx: &mut FrameCx<'_, '_>,
    lights: &AreaLights,
    caches: &Caches,
    options: &RadianceMapsOptions,
) -> Maps {
    let maps = choose(cx, caches, options);
    let (head, capacity) = (maps.head, maps.capacity);
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
    let loop_steps = graph.traits().loop_steps;
    let (map_side, cached, fill) = (options.size.cast_signed(), u32::from(options.is_cached()), options.fill_kind());
    for chunk in lights.chunks(sight, LIGHT_STEPS * lights.group_lights, (LANES, loop_steps)) {
        let name = chunk.name("specular/radiance-maps/write");
        let (first_group, end_group, capacity) = (chunk.first_group, chunk.end_group, maps.capacity);
        let sums = if first_group == 0 { map_sums.start_then_read() } else { map_sums.read_write() };
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
