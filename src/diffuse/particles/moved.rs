//! What is done again where a part of the surfaces moved (glsl/particles/moved.glsl): links that end on, start from or are crossed by it, points and lists near it.
//! Everything else stands. Numbers of particles, and the directions of links, do not depend on where things are, so that the same comes of it as of the whole
//! work, up to links whose particle lies farther from where they end than two spacings.

use super::formats::{FLOATS4, WORD};
use super::place::Placed;
use crate::frame::rays::Motion;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::graph::{Dependence, Graph};
use crate::shaders::particles::{Again, AgainPush, Touched, TouchedPush};

/// Local size of the passes that do something again, as in glsl/particles/again.glsl.
const GROUP: u32 = 64;
/// Groups along x at most, likewise.
const MOST_GROUPS: u32 = 32_768;

/// Groups for so many numbers, in rows: devices need not take more than 65,535 along x. What of a row is beyond them has nothing to do.
pub(super) fn groups_of_list(count: u32) -> [u32; 3] {
    let groups = count.div_ceil(GROUP);
    [groups.min(MOST_GROUPS), groups.div_ceil(MOST_GROUPS), 1]
}

/// What moved, on the device.
pub(super) struct Moved {
    pub(super) triangles: BufferRef<u32>,
    pub(super) boxes: BufferRef<[f32; 4]>,
    pub(super) before_count: u32,
    pub(super) box_count: u32,
    /// Two bits of each particle.
    pub(super) touched: BufferRef<u32>,
}

/// A list of what is to be done again (glsl/particles/again.glsl).
#[derive(Clone, Copy)]
pub(super) struct AgainList {
    pub(super) head: BufferRef<u32>,
    pub(super) list: BufferRef<u32>,
}

impl Moved {
    pub(super) fn declare(graph: &mut Graph<'_>, motion: &Motion, placed: &Placed, particle_count: u32) -> Moved {
        let geometry = Dependence::GEOMETRY;
        let corners = motion.before.iter().chain(&motion.after).flatten();
        let corners: Vec<[f32; 4]> = corners.map(|corner| corner.extend(0.0).to_array()).collect();
        let triangles = graph.upload("particles.moved_triangles", &motion.triangles, geometry);
        let boxes = graph.upload("particles.moved_boxes", &corners, geometry);
        let [before_count, after_count] = [&motion.before, &motion.after].map(|boxes| boxes.len() as u32);
        let box_count = before_count + after_count;
        let touched = graph.buffer::<u32>("particles.touched", particle_count.div_ceil(16) as usize);
        let counts = graph.buffer::<u32>("particles.touched_counts", 3);
        graph.fill_buffer("diffuse/particles/moved/clear", touched, 0);
        graph.fill_buffer("diffuse/particles/moved/clear-counts", counts, 0);
        let pass = Touched {
            particles: placed.group.clone(),
            moved_triangles: triangles.texels(WORD),
            boxes: boxes.texels(FLOATS4),
            touched: touched.read_write(),
            counts: counts.read_write(),
            push: TouchedPush { particle_count, box_count },
        };
        let pass = graph.pass("diffuse/particles/moved/touched", pass);
        let pass = pass.count("moved", counts, 0).count("near", counts, 1).count("lists", counts, 2);
        pass.threads([particle_count, 1, 1]);
        Moved { triangles, boxes, before_count, box_count, touched }
    }
}

impl AgainList {
    /// Room for up to half of `count` numbers.
    pub(super) fn room(graph: &mut Graph<'_>, level: &str, count: u32) -> BufferRef<u32> {
        graph.buffer(&format!("particles.{level}_again"), count.div_ceil(2) as usize)
    }

    /// A list of numbers below `count`; `fill` declares the pass that fills it.
    pub(super) fn declare(
        graph: &mut Graph<'_>,
        (level, number): (&str, usize),
        list: BufferRef<u32>,
        count: u32,
        fill: impl FnOnce(&mut Graph<'_>, AgainList, u32),
    ) -> AgainList {
        let capacity = list.count() as u32;
        let head = graph.buffer::<u32>(&format!("particles.{level}_head.{number}"), 5);
        graph.fill_buffer(&format!("diffuse/particles/{level}/clear-touched.{number}"), head, 0);
        let again = AgainList { head, list };
        fill(graph, again, capacity);
        let pass = Again { head: head.read_write(), push: AgainPush { capacity, count, group_size: GROUP } };
        graph.pass(&format!("diffuse/particles/{level}/groups.{number}"), pass).groups([1, 1, 1]);
        again
    }

    /// Head and list, as a pass binds them.
    pub(super) fn bind(again: Option<AgainList>) -> [TexelBuffer; 2] {
        again.map_or_else(
            || [TexelBuffer::absent(), TexelBuffer::absent()],
            |AgainList { head, list }| [head.texels(WORD), list.texels(WORD)],
        )
    }
}
