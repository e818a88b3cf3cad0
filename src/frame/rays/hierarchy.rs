//! The hierarchy of a scene's triangles on the device.

use std::sync::Arc;

use super::flattened::Flattened;
use super::uploaded::{FLOATS, Uploaded, WORDS};
use crate::graph::hash_of;
use crate::scene::Cutout;
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::vulkan::{Device, VulkanError};

pub(super) struct Hierarchy {
    /// Names the triangles, and which of them alpha cuts.
    key: u64,
    pub(super) nodes: Uploaded,
    pub(super) leaves: Uploaded,
    /// Triangles in `leaves`.
    pub(super) leaf_triangle_count: u32,
    /// As it was built, to be put around what moves. Kept once something moved: a scene that stands does not pay for it.
    built: Option<Arc<Bvh>>,
}

impl Hierarchy {
    /// Of the triangles as they are now, of materials with these `cutouts`; `held` if it is that, else its tree if that still fits, else a new tree.
    pub(super) fn update(
        device: &Arc<Device>,
        flattened: &Flattened,
        cutouts: &[Cutout],
        held: Option<&Arc<Hierarchy>>,
    ) -> Result<Arc<Hierarchy>, VulkanError> {
        let key = hash_of(&(flattened.key, cutouts));
        if let Some(held) = held.filter(|held| held.key == key) {
            return Ok(held.clone());
        }
        let triangles: Vec<BvhTriangle> = flattened
            .triangles
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
        let refitted = held.and_then(|held| held.built.as_ref()).and_then(|built| {
            let refitted = built.refitted(&triangles)?;
            Some((refitted, Some(built.clone())))
        });
        let (mut bvh, built) = refitted.unwrap_or_else(|| {
            let bvh = Bvh::build(&triangles);
            let kept = held.is_some().then(|| Arc::new(bvh.clone()));
            (bvh, kept)
        });
        bvh.set_least_offset(flattened.least_offset);
        Ok(Arc::new(Hierarchy {
            key,
            nodes: Uploaded::new(device, "traced.bvh_nodes", &bvh.nodes, WORDS, key)?,
            leaves: Uploaded::new(device, "traced.bvh_triangles", &bvh.triangles, FLOATS, key)?,
            leaf_triangle_count: u32::try_from(bvh.triangles.len() / 3).unwrap_or(0),
            built,
        }))
    }

    pub(super) fn bytes(&self) -> u64 {
        self.nodes.bytes() + self.leaves.bytes()
    }
}
