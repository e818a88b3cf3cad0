//! Which caches are lit anew in a frame: those far away take turns, and the others keep the light that they had (glsl/volumes/carry.comp). Counts of frames decide, never time, so that the
//! same frames have the same bits. A frame without a past lights all caches; and once nothing has changed for as long as the turns take, all light is that of a picture alone and nothing runs.

use ash::vk;

use super::options::VolumesOptions;
use crate::frame::caches::Caches;
use crate::graph::bindings::BufferRef;
use crate::graph::hash_of;
use crate::graph::kept::Advance;
use crate::method::FrameCx;
use crate::shaders::volumes::{Carry, CarryPush};

const WORD: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Words before the list of caches.
const HEAD_WORDS: usize = 4;

/// What is left to do.
pub(super) struct Renewal {
    /// The numbers of all caches, those that are not due taken over.
    pub(super) light: BufferRef<f32>,
    /// Words 0 to 2: work groups of eight caches; word 3: how many are due; then which.
    pub(super) due: BufferRef<u32>,
}

/// Declares the passes. `now`: names all that the light of caches depends on in this frame.
pub(super) fn renewal(cx: &mut FrameCx<'_, '_>, caches: &Caches, now: u64, options: &VolumesOptions) -> Renewal {
    let cascades = &caches.cascades;
    let period = options.update.min(1 << (options.cascades - 1));
    let (place, capacity) = (cx.frame.data.origin.to_array().map(f64::to_bits), caches.capacity as usize);
    let graph = &mut *cx.graph;
    // How long nothing has changed, and whether that is what all caches were lit by at once.
    let (turn, frames) = graph.state_buffer::<u32>("volumes.turn", 1, now, Advance::EveryFrame);
    let (whole, wholes) = graph.state_buffer::<u32>("volumes.whole", 1, now, Advance::EveryFrame);
    let stands = wholes > 0 || frames >= period;
    let word = hash_of(&(now, frames)) as u32;
    if !stands {
        graph.fill_buffer("diffuse/volumes/turn", turn, word);
        graph.want_buffer(turn);
    }

    let grid = (place, cascades.anchor_rs.map(f32::to_bits), cascades.cell.to_bits());
    let depends = hash_of(&(cx.frame.data.identity, grid, options.bands, options.chroma_bands()));
    let advance = if stands { Advance::OnChange } else { Advance::EveryFrame };
    let words = options.cascades as usize * (options.resolution as usize).pow(3);
    let table = graph.history_buffer::<u32>("volumes.table", words, depends, advance);
    let places = graph.history_buffer::<[f32; 4]>("volumes.places", capacity, depends, advance);
    let light = graph.history_buffer::<f32>("volumes.kept", options.numbers() * capacity, depends, advance);
    // Without a past all are due, and in the next frame none: both frames declare the same work.
    let lights_all = light.age == 0 || table.age == 0 || places.age == 0;
    if lights_all {
        graph.fill_buffer("diffuse/volumes/whole", whole, word);
        graph.want_buffer(whole);
    }
    let moves = !(stands || lights_all);
    let due = graph.buffer::<u32>("volumes.due", HEAD_WORDS + capacity);
    graph.fill_buffer("diffuse/volumes/clear-due", due, 0);
    graph.fill_buffer("diffuse/volumes/clear-table", table.next, 0);
    let pass = Carry {
        light_caches: caches.group.clone(),
        nodes: caches.nodes.texels(WORD),
        last_table: table.last.texels(WORD),
        last_places: places.last.texels(FLOATS),
        last_light: light.last.texels(FLOATS),
        table: table.next.modify(),
        places: places.next.start(),
        light: light.next.start(),
        due: due.read_write(),
        chroma: options.chroma_bands(),
        bands: options.bands,
        push: CarryPush {
            capacity: caches.capacity,
            frame: if moves { light.age } else { 0 },
            period: if moves { period } else { 0 },
        },
    };
    let pass = graph.pass("diffuse/volumes/carry", pass).unordered();
    pass.count("lit anew", due, 3).threads([caches.capacity, 1, 1]);
    Renewal { light: light.next, due }
}
