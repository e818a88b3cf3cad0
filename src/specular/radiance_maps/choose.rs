//! Which caches have a map: those around surfaces with a specular lobe.

use super::options::RadianceMapsOptions;
use super::tables::tables;
use crate::frame::caches::Caches;
use crate::graph::Dependence;
use crate::graph::bindings::BufferRef;
use crate::method::FrameCx;
use crate::shaders::radiance_maps::{Choose, ChoosePush};

/// Maps that memory is held for at first, and texels.
const LEAST: usize = 1024;
const LEAST_TEXELS: usize = 1 << 21;

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

/// Declares the pass that gives maps to caches, and what they need before any light.
pub(super) fn choose(cx: &mut FrameCx<'_, '_>, caches: &Caches, options: &RadianceMapsOptions) -> Maps {
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
    Maps { slots, horizons, caches: list, head, tables, texels: maps, capacity }
}
