//! Maps whose texels look for the lights that they show (glsl/radiance_maps/search.glsl).

use ash::vk;

use super::choose::Maps;
use super::options::RadianceMapsOptions;
use crate::frame::caches::{AreaLights, CacheSight, Caches, LANES};
use crate::method::FrameCx;
use crate::shaders::radiance_maps::{Search, SearchCones, SearchConesPush, SearchPush};

const WORD: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// What one pass takes: groups of lights, and texels of all maps.
struct Part {
    groups: u32,
    texels: u32,
}

/// As much as an invocation may take if all of its texels show all lights.
fn part(lights: &AreaLights, sight: CacheSight, size: u32, loop_steps: u32) -> Part {
    let of_texel = LANES * (1 + lights.group_lights) + 1;
    let before = lights.group_lights + sight.steps() + 1;
    let own = (size * size).div_ceil(LANES);
    let own = own.min(((loop_steps.saturating_sub(before)) / of_texel).max(1));
    let groups = LANES.saturating_mul((loop_steps / (before + own * of_texel)).max(1));
    Part { groups: groups.min(i32::MAX.cast_unsigned()), texels: own * LANES }
}

/// Declares the passes.
pub(super) fn search(
    cx: &mut FrameCx<'_, '_>,
    lights: &AreaLights,
    caches: &Caches,
    maps: &Maps,
    options: &RadianceMapsOptions,
) {
    let sight = cx.frame.caches.sight;
    let (scene, rays) = cx.cache_rays();
    let voxels = match &sight {
        CacheSight::Cones(settings) => Some(cx.voxels(settings)),
        CacheSight::Open | CacheSight::Rays => None,
    };
    let surface = cx.frame.surface.group.clone();
    let graph = &mut *cx.graph;
    let most = part(lights, sight, options.size, graph.traits().loop_steps);
    let texel_count = options.size * options.size;
    let firsts = |end: u32, step: u32| (0..end.max(1)).step_by(step as usize);
    let parts = firsts(texel_count, most.texels)
        .flat_map(|texel| firsts(lights.group_count, most.groups).map(move |group| (texel, group)));
    for (number, (texel, group)) in (1..).zip(parts) {
        let name = match number {
            1 => "specular/radiance-maps/search".to_owned(),
            _ => format!("specular/radiance-maps/search-{number}"),
        };
        let [first_group, first_texel] = [group, texel].map(u32::cast_signed);
        let end_group = group.saturating_add(most.groups).min(lights.group_count).cast_signed();
        let end_texel = (texel + most.texels).min(texel_count).cast_signed();
        let texels = if number == 1 { maps.texels.start_then_read() } else { maps.texels.read_write() };
        let (area_lights, light_caches, surface) = (lights.group.clone(), caches.group.clone(), surface.clone());
        let (map_head, map_caches, tables) =
            (maps.head.texels(WORD), maps.caches.texels(WORD), maps.tables.texels(FLOATS));
        let (map_side, capacity, horizons) = (options.size.cast_signed(), maps.capacity, maps.horizons.read());
        if let Some(voxels) = &voxels {
            let voxels = voxels.group.clone();
            let push = SearchConesPush { rays, first_group, end_group, first_texel, end_texel, capacity };
            let pass = SearchCones {
                voxels,
                area_lights,
                light_caches,
                surface,
                map_head,
                map_caches,
                tables,
                maps: texels,
                horizons,
                map_side,
                push,
            };
            graph.pass(&name, pass).threads_indirect(maps.head, 0);
        } else {
            let push = SearchPush { rays, first_group, end_group, first_texel, end_texel, capacity };
            let pass = Search {
                scene_rays: scene.clone(),
                area_lights,
                light_caches,
                surface,
                map_head,
                map_caches,
                tables,
                maps: texels,
                horizons,
                traces: u32::from(sight == CacheSight::Rays),
                map_side,
                push,
            };
            graph.pass(&name, pass).threads_indirect(maps.head, 0);
        }
    }
}
