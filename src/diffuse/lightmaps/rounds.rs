//! Rounds of photons: while nothing changes, all are sent again along other ways, and the mean over rounds is kept. Only the paths of the last round are; of those before it
//! is known which surfaces each light reached, and the box around its paths. So a change begins the rounds of those surfaces anew that the light it touches ever reached.

use super::formats::{FLOATS4, WORD};
use super::texels::LightTexels;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::shaders::lightmaps::{Affected, AffectedPush, Bounds, BoundsPush, Restart, RestartPush};

/// What a frame does with photons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turn {
    /// Those whose way changed are sent again.
    Renew,
    /// All are, another way: a round joins.
    Join,
    /// They stand.
    Stand,
}

/// How many photons there are, and of what.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub(super) groups: u32,
    pub(super) groups_a_light: u32,
    /// Of surfaces.
    pub(super) sides: u32,
}

impl Counts {
    /// Of all kinds.
    fn lights(self) -> u32 {
        self.groups / self.groups_a_light
    }

    /// Words of what is kept of all rounds (glsl/lightmaps/rounds.glsl).
    pub(super) fn words(self) -> usize {
        (self.sides + 6 * self.lights() + self.groups) as usize
    }
}

/// Begins the rounds of surfaces anew that a change touches. `moved`: boxes around what moved, and how many.
pub(super) fn restart(
    graph: &mut Graph<'_>,
    texels: &LightTexels,
    counts: Counts,
    (past, stale, touched): (BufferRef<u32>, BufferRef<u32>, BufferRef<u32>),
    moved: Option<(BufferRef<[f32; 4]>, u32)>,
) {
    let boxes = || moved.map_or(TexelBuffer::absent(), |(boxes, _)| boxes.texels(FLOATS4));
    let box_count = moved.map_or(0, |(_, count)| count);
    let affected = graph.buffer::<u32>("lightmaps.affected", 2);
    graph.fill_buffer("diffuse/lightmaps/photons/clear-affected", affected, 0);
    let pass = Affected {
        stale: stale.texels(WORD),
        past: past.texels(WORD),
        boxes: boxes(),
        affected: affected.read_write(),
        push: AffectedPush {
            group_count: counts.groups,
            groups_a_light: counts.groups_a_light,
            side_count: counts.sides,
            box_count,
        },
    };
    graph.pass("diffuse/lightmaps/photons/affected", pass).threads([counts.groups, 1, 1]);
    let bounds = graph.buffer::<u32>("lightmaps.side_bounds", 6 * counts.sides as usize);
    if moved.is_some() {
        graph.fill_buffer("diffuse/lightmaps/photons/clear-bounds", bounds, 0);
        let push = BoundsPush { texel_count: texels.map.count };
        let pass = Bounds { lightmap: texels.group.clone(), bounds: bounds.read_write(), push };
        graph.pass("diffuse/lightmaps/photons/bounds", pass).threads(texels.threads());
    }
    let pass = Restart {
        affected: affected.texels(WORD),
        bounds: moved.map_or(TexelBuffer::absent(), |_| bounds.texels(WORD)),
        boxes: boxes(),
        past: past.read_write(),
        touched: touched.read_write(),
        push: RestartPush { side_count: counts.sides, light_count: counts.lights(), box_count },
    };
    let threads = [counts.sides.max(counts.lights()), 1, 1];
    graph.pass("diffuse/lightmaps/photons/restart", pass).threads(threads);
}
