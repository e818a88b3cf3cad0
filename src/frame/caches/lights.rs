//! Virtual area lights: the light views, reduced block by block (Reich 2015, section 4.3.1), without blocks that reflect nothing, in groups that share a visibility.

use ash::vk;

use crate::frame::light_set::LightSet;
use crate::frame::light_views::LightViews;
use crate::frame::view_layout::LaidOutView;
use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph};
use crate::shaders::caches::{GatherGroups, GatherGroupsPush, Reduce, ReducePush, Scan, ScanPush};
use crate::shaders::{groups, types};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// What is asked of the lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LightRule {
    /// The side of a square with as many lights as all views are reduced to, or nearly so.
    pub(crate) side: u32,
    /// Groups are of 4^lod lights.
    pub(crate) lod: u32,
    /// The area in the disc form is the paper's.
    pub(crate) paper: bool,
    /// 0: lights lie in the middle of their blocks; else at a place that is drawn by this number.
    pub(crate) drawn: u32,
    /// Of punctual lights alone, not of samples of emissive surfaces and of the sky.
    pub(crate) punctual: bool,
}

impl LightRule {
    /// The same rule for these lights: where all of them are punctual, those alone are all.
    pub(crate) fn told_apart(self, set: &LightSet) -> LightRule {
        let differs = set.views_of(true).len() < set.views_of(false).len();
        LightRule { punctual: self.punctual && differs, ..self }
    }
}

/// The lights of a frame.
pub(crate) struct AreaLights {
    pub(crate) group: groups::AreaLights,
    /// Groups at most; lights are at most 4^lod times as many.
    pub(crate) group_count: u32,
    /// Lights of a group at most.
    pub(crate) group_lights: u32,
    /// Two texels each (glsl/lib/vpl.glsl).
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) lights: BufferRef<[f32; 4]>,
    /// How many lights, how many groups.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) counts: BufferRef<u32>,
}

/// Declares the passes.
pub(crate) fn area_lights(graph: &mut Graph<'_>, set: &LightSet, views: &LightViews, rule: &LightRule) -> AreaLights {
    // Of a frame that has both lists each goes by a name of its own.
    let level = match (rule.punctual, rule.drawn > 0) {
        (true, _) => "caches/punctual-lights",
        (false, true) => "caches/drawn-lights",
        (false, false) => "caches/lights",
    };
    let slots = reduced(graph, set, views, rule, level);
    grouped(graph, level, slots, 1 << (2 * rule.lod))
}

/// Declares the pass that makes a slot of each block of the views' texels, two texels each (glsl/caches/slots.glsl), in squares of 4^lod of them at least; `level`: of the passes that they are for.
pub(super) fn reduced(
    graph: &mut Graph<'_>,
    set: &LightSet,
    views: &LightViews,
    rule: &LightRule,
    level: &str,
) -> BufferRef<[f32; 4]> {
    let wanted = set.views_of(rule.punctual);
    let side = block_side(wanted, rule.side);
    let (slot_views, slot_count) = slots_of(wanted, side, rule.lod);
    let slot_views = graph.upload(&format!("{level}.slot_views"), &slot_views, Dependence::LIGHTS);
    let slots = graph.buffer::<[f32; 4]>(&format!("{level}.slots"), 2 * slot_count as usize);
    let dropped = graph.buffer::<u32>(&format!("{level}.dropped"), 1);
    graph.fill_buffer(&format!("{level}/clear-dropped"), dropped, 0);
    let pass = Reduce {
        light_views: views.group.clone(),
        slot_views: slot_views.read(),
        slots: slots.write(),
        dropped_texels: dropped.read_write(),
        paper: u32::from(rule.paper),
        push: ReducePush {
            slot_count,
            view_count: slot_views.count() as u32,
            side: side.cast_signed(),
            drawn: rule.drawn,
        },
    };
    let pass = graph.pass(&format!("{level}/reduce"), pass).note("texels a light", u64::from(side * side));
    pass.count("dropped", dropped, 0).threads([slot_count, 1, 1]);

    slots
}

/// Declares the passes that drop slots without flux and make groups of what is left of each `group_lights` slots; `level`: of these passes.
pub(crate) fn grouped(graph: &mut Graph<'_>, level: &str, slots: BufferRef<[f32; 4]>, group_lights: u32) -> AreaLights {
    let slot_count = slots.count() / 2;
    let group_count = slot_count as u32 / group_lights;
    let offsets = graph.buffer::<[u32; 2]>(&format!("{level}.offsets"), group_count as usize + 1);
    let counts = graph.buffer::<u32>(&format!("{level}.light_counts"), 2);
    let pass = Scan {
        slots: slots.texels(FLOATS),
        offsets: offsets.write(),
        counts: counts.write(),
        push: ScanPush { group_count, group_slots: group_lights },
    };
    let pass = graph.pass(&format!("{level}/scan"), pass);
    pass.count("lights", counts, 0).count("groups", counts, 1).groups([1, 1, 1]);

    let lights = graph.buffer::<[f32; 4]>(&format!("{level}.lights"), 2 * slot_count);
    let lists = graph.buffer::<[u32; 4]>(&format!("{level}.light_groups"), 2 * group_count as usize);
    let pass = GatherGroups {
        slots: slots.texels(FLOATS),
        offsets: offsets.texels(vk::Format::R32G32_UINT),
        lights: lights.start(),
        groups: lists.start(),
        push: GatherGroupsPush { group_count, group_slots: group_lights },
    };
    graph.pass(&format!("{level}/groups"), pass).threads([group_count, 1, 1]);
    let group = groups::AreaLights {
        area_lights: lights.texels(FLOATS),
        area_light_groups: lists.texels(WORDS),
        area_light_counts: counts.texels(vk::Format::R32_UINT),
    };
    AreaLights { group, group_count, group_lights, lights, counts }
}

/// Columns and rows of blocks of a view.
fn blocks_of(view: &LaidOutView, side: u32) -> [u32; 2] {
    view.record.rect_size.map(|texels| texels.cast_unsigned().div_ceil(side))
}

/// The side of a block of texels, a power of two: the one with which the number of all blocks is nearest to `wanted`², as a ratio.
fn block_side(views: &[LaidOutView], wanted: u32) -> u32 {
    let wanted = f64::from(wanted).powi(2);
    let blocks = |side: u32| -> f64 {
        views.iter().map(|view| blocks_of(view, side).iter().map(|&count| f64::from(count)).product::<f64>()).sum()
    };
    let off = |side: u32| (blocks(side).max(1.0) / wanted).ln().abs();
    (0..12).map(|order| 1 << order).min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(1)
}

/// The first slot of each view, and how many slots there are; each view's are a multiple of 4^lod.
fn slots_of(views: &[LaidOutView], side: u32, lod: u32) -> (Vec<types::SlotView>, u32) {
    let mut next = 0;
    let place = |(index, view): (u32, &LaidOutView)| {
        let longest = blocks_of(view, side).into_iter().max().unwrap_or(1);
        let first = next;
        next += longest.next_power_of_two().max(1 << lod).pow(2);
        types::SlotView { first, view: index }
    };
    let places = (0..).zip(views).map(place).collect();
    (places, next)
}
