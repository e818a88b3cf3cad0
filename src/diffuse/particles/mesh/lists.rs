//! Estimation lists: the area particles around each radiance particle, or around each that the picture shows. Where a part of the surfaces moved, all of them are made
//! anew: that takes little beside their links.

use super::super::formats::{WORD, WORDS4};
use super::super::geometry::ParticleSpace;
use super::found::Found;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::shaders::buckets::{Starts, StartsPush};
use crate::shaders::particles::{MeshFill, MeshFillPush, MeshList, MeshListPush};

/// Entries that a list has room for at first: twelve area particles lie within reach on a plane.
const ENTRIES: usize = 14;
/// Of as many as may be found one is: subtriangles that hang together share their corners.
const FOUND: usize = 4;
/// Entries for which there is room in any case.
const LEAST: usize = 1 << 20;
/// Groups along x.
const MOST_GROUPS: u32 = 32_768;

/// What lists are made of.
pub(super) struct Parts<'a> {
    pub(super) space: &'a ParticleSpace,
    pub(super) tessellation: &'a TexelBuffer,
    /// Radiance particles that are shown.
    pub(super) found: &'a Found,
}

/// Lists one after the other.
pub(super) struct EstimationLists {
    /// Whether all radiance particles have one, by their numbers, or those that were found, as they are listed.
    pub(super) of_all: bool,
    /// Of each list what mesh_slot.glsl says.
    pub(super) slots: BufferRef<[u32; 4]>,
    /// Where each begins.
    pub(super) starts: BufferRef<u32>,
    pub(super) entries: BufferRef<u32>,
}

impl EstimationLists {
    /// `all_count`: how many radiance particles there are if all have lists, otherwise 0.
    pub(super) fn declare(graph: &mut Graph<'_>, parts: &Parts<'_>, all_count: u32) -> EstimationLists {
        let &Parts { space, tessellation, found } = parts;
        let of_all = all_count > 0;
        let count = if of_all { all_count as usize } else { found.numbers.count() };
        let absent = TexelBuffer::absent;
        let (numbers, head) =
            if of_all { (absent(), absent()) } else { (found.numbers.texels(WORD), found.head.texels(WORD)) };
        let groups = all_count.div_ceil(64);
        let groups = [groups.min(MOST_GROUPS), groups.div_ceil(MOST_GROUPS), 1];

        let slots = graph.buffer::<[u32; 4]>("particles.estimation_slots", count);
        let lengths = graph.buffer::<u32>("particles.estimation_lengths", count);
        let counts = graph.buffer::<u32>("particles.estimation_counts", 4);
        graph.fill_buffer("diffuse/particles/lists/clear-lengths", lengths, 0);
        graph.fill_buffer("diffuse/particles/lists/clear-counts", counts, 0);
        let pass = MeshList {
            scene_rays: space.rays.clone(),
            particles: space.group.clone(),
            tessellation: tessellation.clone(),
            numbers: numbers.clone(),
            found: head.clone(),
            slots: slots.start(),
            lengths: lengths.modify(),
            counts: counts.read_write(),
            push: MeshListPush { all_count },
        };
        let pass = graph.pass("diffuse/particles/lists/candidates", pass).count("entries", counts, 0);
        let pass = pass.count("left out", counts, 1).count("widened", counts, 2).count("empty", counts, 3);
        if of_all {
            pass.groups(groups)
        } else {
            pass.threads_indirect(found.head, 0)
        }

        let starts = graph.buffer::<u32>("particles.estimation_starts", count + 1);
        let push = StartsPush { bucket_count: count as u32 };
        let pass = Starts { counts: lengths.texels(WORD), starts: starts.write(), push };
        graph.pass("diffuse/particles/lists/starts", pass).groups([1, 1, 1]);

        let all = ENTRIES * count;
        let least = if of_all { all } else { all.min(LEAST).max(all / FOUND) };
        let entries = graph.growing_buffer::<u32>("particles.estimation_entries", least);
        let pass = MeshFill {
            scene_rays: space.rays.clone(),
            particles: space.group.clone(),
            tessellation: tessellation.clone(),
            numbers,
            found: head,
            slots: slots.texels(WORDS4),
            starts: starts.texels(WORD),
            entries: entries.start(),
            push: MeshFillPush { all_count, capacity: entries.count() as u32 },
        };
        let pass = graph.pass("diffuse/particles/lists/fill", pass);
        if of_all {
            pass.groups(groups)
        } else {
            pass.threads_indirect(found.head, 0)
        }
        graph.grows(entries, counts, 0);
        EstimationLists { of_all, slots, starts, entries }
    }
}
