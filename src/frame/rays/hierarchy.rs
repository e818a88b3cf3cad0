//! The hierarchy of a scene's triangles.

use super::triangles::TracedTriangle;
use crate::scene::Cutout;
use crate::scene::bvh::{Bvh, BvhTriangle};

/// The hierarchy, as it is uploaded. `least_offset`: how far rays start from surfaces at least, metres.
pub(super) fn hierarchy(triangles: &[TracedTriangle], cutouts: &[Cutout], least_offset: f32) -> Bvh {
    let triangles: Vec<BvhTriangle> = triangles
        .iter()
        .map(|triangle| match cutouts[triangle.material as usize] {
            // What is not there has no area.
            Cutout::Nothing => BvhTriangle::default(),
            kind => BvhTriangle {
                corners: triangle.corners.map(|corner| corner.to_array()),
                flags: u32::from(kind == Cutout::PerPoint),
            },
        })
        .collect();
    let mut bvh = Bvh::build(&triangles);
    bvh.set_least_offset(least_offset);
    bvh
}
