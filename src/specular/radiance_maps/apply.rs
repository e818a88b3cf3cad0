//! What every pixel reflects, from the maps of the caches around it.

use ash::vk;

use super::choose::Maps;
use super::options::RadianceMapsOptions;
use crate::frame::caches::Caches;
use crate::graph::bindings::ImageRef;
use crate::method::FrameCx;
use crate::shaders::radiance_maps::{Apply, ApplyPush};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Declares the pass; returns the slot.
pub(super) fn apply(cx: &mut FrameCx<'_, '_>, caches: &Caches, maps: &Maps, options: &RadianceMapsOptions) -> ImageRef {
    let (scene_rays, rays) = cx.cache_rays();
    let weighs_by_rays = cx.frame.caches.weighs_by_rays;
    let (graph, surface) = (&mut *cx.graph, cx.frame.surface);
    let specular = graph.image("radiance_maps.specular", FLOATS, surface.size);
    let pass = Apply {
        light_caches: caches.group.clone(),
        surface: surface.group.clone(),
        scene_rays,
        map_slots: maps.slots.read(),
        maps: maps.texels.texels(FLOATS),
        tables: maps.tables.texels(FLOATS),
        reflected: specular.write(),
        horizons: maps.horizons.read(),
        weights: u32::from(weighs_by_rays),
        map_side: options.size.cast_signed(),
        lobe: options.lobe_kind(),
        follows_mirror: options.follows_mirror(),
        push: ApplyPush { rays, cache_capacity: caches.capacity, map_capacity: maps.capacity },
    };
    graph.pass("specular/radiance-maps/apply", pass).pixels(surface.size);
    specular
}
