//! What moved between two states of the same surfaces.

use std::ops::Range;

use glam::Vec3;

use super::triangles::TracedTriangle;
use crate::scene::{Instance, NodeId, Scene};

/// Boxes that are told apart, as in glsl/particles/touched_links.comp.
const MOST_BOXES: usize = 4;

/// Lowest and highest corner, in render space.
type Box3 = [Vec3; 2];

/// Instances that moved while all the others stood and nothing else about the surfaces changed.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    /// The key of the surfaces before.
    pub(crate) from: u64,
    /// Around what moved, as it was.
    pub(crate) before: Vec<Box3>,
    /// The same as it is.
    pub(crate) after: Vec<Box3>,
    /// A bit for each triangle that moved, in words.
    pub(crate) triangles: Vec<u32>,
}

/// An instance and its triangles among those of all.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    instance: Instance,
    triangles: Range<usize>,
    /// Of the scene's meshes: others have other triangles.
    meshes: u64,
}

impl Part {
    pub(super) fn triangles(&self) -> Range<usize> {
        self.triangles.clone()
    }

    /// Whether it is the same thing, wherever it stands.
    fn is(&self, other: &Part) -> bool {
        let Instance { node, mesh, primitive, world: _, flips_winding } = self.instance;
        let those = &other.instance;
        (node, mesh, primitive, flips_winding) == (those.node, those.mesh, those.primitive, those.flips_winding)
            && (&self.triangles, self.meshes) == (&other.triangles, other.meshes)
    }
}

/// The instances of a scene, in the order of its triangles.
pub(super) fn parts(scene: &Scene) -> Vec<Part> {
    let mut first = 0;
    let meshes = scene.revisions().meshes;
    let part = |instance: &Instance| {
        let count = scene.meshes()[instance.mesh.0].primitives[instance.primitive].triangle_count();
        first += count;
        Part { instance: *instance, triangles: first - count..first, meshes }
    };
    scene.instances().iter().map(part).collect()
}

/// The motion between two states, each its parts and their triangles; `None` if these are not the same ones, or if all of them moved.
pub(super) fn motion(
    from: u64,
    before: (&[Part], &[TracedTriangle]),
    after: (&[Part], &[TracedTriangle]),
) -> Option<Motion> {
    if before.0.len() != after.0.len() || !before.0.iter().zip(after.0).all(|(a, b)| a.is(b)) {
        return None;
    }
    let moved = before.0.iter().zip(after.0).filter(|(a, b)| a.instance.world != b.instance.world);
    // What a node places lies together.
    let mut moved_nodes: Vec<(NodeId, Range<usize>)> = Vec::new();
    for (Part { instance, triangles, meshes: _ }, _) in moved.filter(|(part, _)| !part.triangles.is_empty()) {
        match moved_nodes.last_mut().filter(|(node, range)| *node == instance.node && range.end == triangles.start) {
            Some((_, range)) => range.end = triangles.end,
            None => moved_nodes.push((instance.node, triangles.clone())),
        }
    }
    let moved: Vec<Range<usize>> = moved_nodes.into_iter().map(|(_, range)| range).collect();
    let count: usize = moved.iter().map(Range::len).sum();
    if count == 0 || count == after.1.len() {
        return None;
    }
    let mut triangles = vec![0; after.1.len().div_ceil(32)];
    for index in moved.iter().cloned().flatten() {
        triangles[index / 32] |= 1 << (index % 32);
    }
    let boxes = |state: &[TracedTriangle]| joined(moved.iter().map(|range| around(&state[range.clone()])));
    Some(Motion { from, before: boxes(before.1), after: boxes(after.1), triangles })
}

fn around(triangles: &[TracedTriangle]) -> Box3 {
    let corners = triangles.iter().flat_map(|triangle| triangle.corners);
    let [low, high] =
        corners.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], corner| [low.min(corner), high.max(corner)]);
    // Rays round.
    let slack = Vec3::splat(1e-5 * low.abs().max(high.abs()).max_element());
    [low - slack, high + slack]
}

fn union([a, b]: Box3, [c, d]: Box3) -> Box3 {
    [a.min(c), b.max(d)]
}

fn half_surface([low, high]: Box3) -> f32 {
    let size = high - low;
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// As few boxes around them as are told apart: taken one after the other, and whenever there is one too many, those two are joined whose surface grows least.
fn joined(boxes: impl Iterator<Item = Box3>) -> Vec<Box3> {
    let mut few: Vec<Box3> = Vec::with_capacity(MOST_BOXES + 1);
    for one in boxes {
        few.push(one);
        if few.len() > MOST_BOXES {
            let growth = |&(a, b): &(usize, usize)| {
                half_surface(union(few[a], few[b])) - half_surface(few[a]) - half_surface(few[b])
            };
            let pairs = (0..few.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
            let (a, b) = pairs.min_by(|a, b| growth(a).total_cmp(&growth(b))).expect("there are several");
            let taken = few.swap_remove(b);
            few[a] = union(few[a], taken);
        }
    }
    few
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_boxes_become_few_that_hold_them() {
        let boxes: Vec<Box3> = (0..40_u8)
            .map(|number| {
                let low = Vec3::new(f32::from(number % 8), f32::from(number / 8), 0.0);
                [low, low + 0.5]
            })
            .collect();
        let few = joined(boxes.iter().copied());
        assert!(few.len() == MOST_BOXES);
        for [low, high] in boxes {
            assert!(few.iter().any(|[a, b]| a.cmple(low).all() && b.cmpge(high).all()));
        }
    }
}
