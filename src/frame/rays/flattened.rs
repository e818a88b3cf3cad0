//! All instances flattened to triangles in render space, and their corners' attributes on the device: what stands while meshes and their places do, whatever surfaces are made of.

use std::sync::Arc;

use glam::DVec3;

use super::triangles::{Corners, TracedTriangle, flatten};
use super::uploaded::{BYTES, FLOAT, FLOATS, Uploaded};
use crate::graph::hash_of;
use crate::scene::{Bounds, Extent, Facts, Scene};
use crate::vulkan::{Device, VulkanError};

pub(crate) struct Flattened {
    /// Names the triangles and their attributes within this process.
    pub(super) key: u64,
    pub(crate) origin: DVec3,
    /// Of the box around what matters, in render space.
    pub(crate) middle_rs: DVec3,
    /// Half its diagonal, metres.
    pub(crate) radius: f64,
    /// Some surface is farther away from its middle.
    pub(crate) far_surfaces: bool,
    /// Rays that start as far from surfaces as rounding of the largest coordinate asks would leave out an eighth of the finer triangles: rounding is bounded
    /// triangle by triangle (glsl/lib/bvh.glsl).
    pub(super) wide: bool,
    pub(crate) triangle_count: u32,
    /// The size that all but a sixteenth of the triangles have, metres.
    pub(crate) fine_size: f64,
    /// Of the triangles that matter, m².
    pub(crate) area: f64,
    /// The same by the meshes: the same bits wherever they move.
    pub(crate) own_area: f64,
    /// How far rays start from surfaces at least, metres.
    pub(super) least_offset: f32,
    pub(super) triangles: Vec<TracedTriangle>,
    /// Of each triangle that matters, m², the same bits wherever it moves; 0 for others.
    pub(super) areas: Vec<f32>,
    pub(super) own_areas: Uploaded,
    pub(super) colors: Uploaded,
    pub(super) texcoords: Uploaded,
    pub(super) tangents: Uploaded,
}

impl Flattened {
    /// Those of a scene as they are now; `held` if it is that.
    pub(super) fn update(
        device: &Arc<Device>,
        scene: &Scene,
        facts: &Facts,
        held: Option<&Arc<Flattened>>,
    ) -> Result<Arc<Flattened>, VulkanError> {
        let Extent { origin, middle, .. } = scene.extent();
        let bulk = scene.bulk().unwrap_or(Bounds { min: middle - 1.0, max: middle + 1.0 });
        let (middle_rs, radius) = (bulk.center() - origin, bulk.radius().max(1e-30));
        let places = [origin, middle_rs].map(|place| place.to_array().map(f64::to_bits));
        let attributes = [facts.vertex_colors, facts.textured, facts.normal_mapped];
        let key = hash_of(&(scene.identity(), scene.revisions().geometry, places, radius.to_bits(), attributes));
        if let Some(held) = held.filter(|held| held.key == key) {
            return Ok(held.clone());
        }
        let (triangles, corners) = flatten(scene, origin, facts)?;
        let matters = |triangle: &&TracedTriangle| triangle.nearest(middle_rs) <= radius;
        let fine = fine_size(triangles.iter().filter(matters).map(TracedTriangle::area));
        let areas: Vec<f32> =
            triangles.iter().map(|triangle| if matters(&triangle) { triangle.own_area } else { 0.0 }).collect();
        let Corners { colors, texcoords, tangents } = &corners;
        Ok(Arc::new(Flattened {
            key,
            origin,
            middle_rs,
            radius,
            far_surfaces: triangles.iter().any(|triangle| triangle.farthest(middle_rs) > radius * (1.0 + 1e-6)),
            wide: triangles.iter().any(|triangle| triangle.farthest(DVec3::ZERO) / 65536.0 > fine / 8.0),
            triangle_count: u32::try_from(triangles.len()).unwrap_or(0),
            fine_size: fine_size(areas.iter().map(|&area| f64::from(area))),
            own_area: areas.iter().map(|&area| f64::from(area)).sum(),
            area: triangles.iter().filter(matters).map(TracedTriangle::area).sum(),
            least_offset: (radius / 131_072.0).min(fine / 64.0) as f32,
            own_areas: Uploaded::new(device, "traced.areas", &areas, FLOAT, key)?,
            areas,
            colors: Uploaded::new(device, "traced.corner_colors", colors, BYTES, key)?,
            texcoords: Uploaded::new(device, "traced.corner_texcoords", texcoords, FLOATS, key)?,
            tangents: Uploaded::new(device, "traced.corner_tangents", tangents, FLOATS, key)?,
            triangles,
        }))
    }

    pub(super) fn bytes(&self) -> u64 {
        [&self.own_areas, &self.colors, &self.texcoords, &self.tangents].iter().map(|list| list.bytes()).sum()
    }
}

/// The size that all but a sixteenth of the triangles have, metres.
fn fine_size(areas: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = areas.map(f64::sqrt).filter(|&size| size > 0.0).collect();
    let place = sizes.len() / 16;
    if sizes.is_empty() { f64::INFINITY } else { *sizes.select_nth_unstable_by(place, f64::total_cmp).1 }
}
