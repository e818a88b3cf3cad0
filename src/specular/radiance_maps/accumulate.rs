//! Maps as means over frames (glsl/radiance_maps/accumulate.comp).

use ash::vk;

use super::choose::Maps;
use super::options::RadianceMapsOptions;
use crate::frame::caches::Caches;
use crate::graph::hash_of;
use crate::graph::kept::Advance;
use crate::method::FrameCx;
use crate::shaders::radiance_maps::{Accumulate, AccumulatePush};

const WORD: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Of each map, where it was made.
const PLACE_TEXELS: usize = 2;

/// Declares the pass, which changes maps in place. What was kept of other lights, surfaces or cells is forgotten.
pub(super) fn accumulate(cx: &mut FrameCx<'_, '_>, caches: &Caches, maps: &Maps, options: &RadianceMapsOptions) {
    let (graph, frame) = (&mut *cx.graph, cx.frame);
    let cascades = &caches.cascades;
    let about = (frame.set.key, frame.data.instance_key, cascades.cell.to_bits(), options.size);
    let depends = hash_of(&(about, options.fill_kind(), options.frames, frame.data.identity));
    let capacity = maps.capacity as usize;
    let nodes = cascades.count as usize * (cascades.resolution as usize).pow(3);
    let finest = (options.size * options.size) as usize;
    let slots = graph.history_buffer::<u32>("radiance_maps.kept_slots", nodes, depends, Advance::EveryFrame);
    let places = graph.history_buffer::<[f32; 4]>(
        "radiance_maps.kept_places",
        PLACE_TEXELS * capacity,
        depends,
        Advance::EveryFrame,
    );
    let texels =
        graph.history_buffer::<[f32; 4]>("radiance_maps.kept_texels", finest * capacity, depends, Advance::EveryFrame);
    graph.fill_buffer("specular/radiance-maps/clear-kept", slots.next, 0);
    let pass = Accumulate {
        light_caches: caches.group.clone(),
        surface: frame.surface.group.clone(),
        map_head: maps.head.texels(WORD),
        map_caches: maps.caches.texels(WORD),
        nodes: caches.nodes.texels(WORD),
        tables: maps.tables.texels(FLOATS),
        last_slots: slots.last.texels(WORD),
        last_places: places.last.texels(FLOATS),
        last_maps: texels.last.texels(FLOATS),
        maps: maps.texels.read_write(),
        next_slots: slots.next.modify(),
        next_places: places.next.start(),
        next_maps: texels.next.start(),
        map_side: options.size.cast_signed(),
        push: AccumulatePush { capacity: maps.capacity, most_frames: options.frames as f32 },
    };
    graph.pass("specular/radiance-maps/accumulate", pass).threads_indirect(maps.head, 0);
}
