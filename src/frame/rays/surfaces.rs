//! The surfaces as rays meet them: all instances flattened to triangles in render space, their corners' attributes, and the hierarchy of their boxes. It stands
//! while geometry and materials do, whatever shines on it.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use glam::DVec3;

use super::backs::backs;
use super::hierarchy::hierarchy;
use super::lightmap::{Lightmap, Taking, Texels};
use super::looks::Looks;
use super::motion::{Motion, Part, motion, parts};
use super::samples::SurfaceSamples;
use super::tessellation::Tessellation;
use super::triangles::{Corners, TracedTriangle, flatten};
use super::uploaded::{BYTES, FLOAT, FLOATS, Uploaded, WORDS};
use crate::graph::hash_of;
use crate::scene::{Bounds, Cutout, Extent, Facts, Scene};
use crate::vulkan::{Device, VulkanError};

/// What was made last, and of what.
type Held<K, T> = Mutex<Option<(K, Arc<T>)>>;

pub(crate) struct Surfaces {
    pub(super) key: u64,
    pub(crate) origin: DVec3,
    /// Of the box around what matters, in render space.
    pub(crate) middle_rs: DVec3,
    /// Half its diagonal, metres.
    pub(crate) radius: f64,
    /// Some surface is farther away from its middle.
    pub(crate) far_surfaces: bool,
    /// Some triangle is there at some of its points only.
    pub(crate) cutouts: bool,
    /// Rays that start as far from surfaces as rounding of the largest coordinate asks would leave out an eighth of the finer triangles: rounding is bounded
    /// triangle by triangle (glsl/lib/bvh.glsl).
    pub(super) wide: bool,
    pub(crate) triangle_count: u32,
    /// Of the hierarchy's leaves: large triangles stand there more than once, those without area not at all.
    pub(crate) leaf_triangle_count: u32,
    /// The size that all but a sixteenth of the triangles have, metres.
    pub(crate) fine_size: f64,
    /// Of the triangles that matter, m².
    pub(crate) area: f64,
    /// The same by the meshes: the same bits wherever they move.
    pub(crate) own_area: f64,
    /// How it came of what was before, if a part of the surfaces moved and nothing else happened.
    pub(crate) motion: Option<Motion>,
    /// Names the triangles' shapes: the same while things move and nothing else changes.
    pub(crate) shapes: u64,
    parts: Vec<Part>,
    /// By material.
    one_sided: Vec<bool>,
    /// As [`Surfaces::backs`] gives them, once they have been asked for.
    backs: OnceLock<Vec<u32>>,
    pub(super) triangles: Vec<TracedTriangle>,
    /// Of each triangle that matters, m², the same bits wherever it moves; 0 for others.
    areas: Vec<f32>,
    /// The last one that was asked for, with its spacing.
    tessellation: Held<f64, Tessellation>,
    /// Likewise, with how many of them there are and in clusters of how many.
    samples: Held<(u32, u32), SurfaceSamples>,
    /// Likewise, with how finely it is cut.
    lightmap: Held<Texels, Lightmap>,
    pub(super) own_areas: Uploaded,
    pub(super) nodes: Uploaded,
    pub(super) leaves: Uploaded,
    pub(super) colors: Uploaded,
    pub(super) texcoords: Uploaded,
    pub(super) tangents: Uploaded,
}

/// Names a scene's surfaces within this process.
pub(crate) fn surfaces_key(scene: &Scene) -> u64 {
    let revisions = scene.revisions();
    let place = scene.extent().origin.to_array().map(f64::to_bits);
    hash_of(&(scene.identity(), revisions.geometry, revisions.materials, place))
}

impl Surfaces {
    /// Flattens, sorts and uploads the surfaces as they are now.
    pub(super) fn new(
        device: &Arc<Device>,
        scene: &Scene,
        looks: &Looks,
        facts: &Facts,
        before: Option<&Surfaces>,
    ) -> Result<Surfaces, VulkanError> {
        let key = surfaces_key(scene);
        let Extent { origin, middle, .. } = scene.extent();
        let bulk = scene.bulk().unwrap_or(Bounds { min: middle - 1.0, max: middle + 1.0 });
        let (middle_rs, radius) = (bulk.center() - origin, bulk.radius().max(1e-30));
        let (triangles, corners) = flatten(scene, origin, facts)?;
        let matters = |triangle: &&TracedTriangle| triangle.nearest(middle_rs) <= radius;
        let fine = fine_size(triangles.iter().filter(matters).map(TracedTriangle::area));
        let least_offset = (radius / 131_072.0).min(fine / 64.0) as f32;
        let areas: Vec<f32> =
            triangles.iter().map(|triangle| if matters(&triangle) { triangle.own_area } else { 0.0 }).collect();
        let bvh = hierarchy(&triangles, &looks.cutouts, least_offset);
        let cut = |triangle: &TracedTriangle| looks.cutouts[triangle.material as usize] == Cutout::PerPoint;
        let parts = parts(scene);
        let motion = before.and_then(|before| before.motion_to(&parts, &triangles, &areas, [origin, middle_rs]));
        // What is kept of particles while things move goes by their numbers, and these by the sides that have some.
        let backs = before.filter(|_| motion.is_some()).map(|before| before.backs.clone());
        let lightmap = before.filter(|_| motion.is_some()).and_then(|before| held(&before.lightmap).clone());
        let Corners { colors, texcoords, tangents } = &corners;
        Ok(Surfaces {
            key,
            origin,
            middle_rs,
            radius,
            far_surfaces: triangles.iter().any(|triangle| triangle.farthest(middle_rs) > radius * (1.0 + 1e-6)),
            cutouts: triangles.iter().any(cut),
            wide: triangles.iter().any(|triangle| triangle.farthest(DVec3::ZERO) / 65536.0 > fine / 8.0),
            triangle_count: u32::try_from(triangles.len()).unwrap_or(0),
            leaf_triangle_count: u32::try_from(bvh.triangles.len() / 3).unwrap_or(0),
            fine_size: fine_size(areas.iter().map(|&area| f64::from(area))),
            own_area: areas.iter().map(|&area| f64::from(area)).sum(),
            area: triangles.iter().filter(matters).map(TracedTriangle::area).sum(),
            shapes: before.filter(|_| motion.is_some()).map_or(key, |before| before.shapes),
            motion,
            parts,
            one_sided: scene.materials().iter().map(|material| !material.double_sided).collect(),
            backs: backs.unwrap_or_default(),
            tessellation: Mutex::new(None),
            lightmap: Mutex::new(lightmap),
            samples: Mutex::new(None),
            own_areas: Uploaded::new(device, "traced.areas", &areas, FLOAT, key)?,
            areas,
            nodes: Uploaded::new(device, "traced.bvh_nodes", &bvh.nodes, WORDS, key)?,
            leaves: Uploaded::new(device, "traced.bvh_triangles", &bvh.triangles, FLOATS, key)?,
            colors: Uploaded::new(device, "traced.corner_colors", colors, BYTES, key)?,
            texcoords: Uploaded::new(device, "traced.corner_texcoords", texcoords, FLOATS, key)?,
            tangents: Uploaded::new(device, "traced.corner_tangents", tangents, FLOATS, key)?,
            triangles,
        })
    }

    /// A bit for each triangle of one-sided parts whose backs other surfaces see, in words; none where no back is. While things move, those seen at first.
    pub(crate) fn backs(&self) -> &[u32] {
        self.backs.get_or_init(|| {
            backs((&self.triangles, &self.areas), &self.parts, &self.one_sided, (self.middle_rs, self.radius))
        })
    }

    /// Of each instance of the scene, its triangles: the first, and the one after the last.
    pub(crate) fn instance_triangles(&self) -> Vec<[u32; 2]> {
        let number = |place: usize| u32::try_from(place).unwrap_or(u32::MAX);
        self.parts.iter().map(|part| [number(part.triangles().start), number(part.triangles().end)]).collect()
    }

    /// What moved since, if nothing else did that particles' places depend on.
    fn motion_to(
        &self,
        parts: &[Part],
        triangles: &[TracedTriangle],
        areas: &[f32],
        [origin, middle_rs]: [DVec3; 2],
    ) -> Option<Motion> {
        let stands = self.origin == origin && self.middle_rs == middle_rs && self.areas == areas;
        let (before, after) = ((&self.parts[..], &self.triangles[..]), (parts, triangles));
        if stands { motion(self.key, before, after) } else { None }
    }

    /// Points closer to each other than `spacing` metres; `sides`: of each material, those that take diffuse light. The last one stands.
    pub(super) fn tessellation(&self, spacing: f64, sides: &[u32]) -> Arc<Tessellation> {
        let mut held = held(&self.tessellation);
        match &*held {
            Some((known, tessellation)) if *known == spacing => tessellation.clone(),
            _ => {
                let made = Arc::new(Tessellation::new(&self.triangles, &self.areas, sides, spacing));
                *held = Some((spacing, made.clone()));
                made
            }
        }
    }

    /// Light maps, cut so finely; `sides` as above. The last ones stand, also while things move.
    pub(super) fn lightmap(&self, texels: Texels, sides: &[u32]) -> Arc<Lightmap> {
        let mut held = held(&self.lightmap);
        match &*held {
            Some((known, lightmap)) if *known == texels => lightmap.clone(),
            _ => {
                let taking = Taking { sides, backs: self.backs(), areas: &self.areas };
                let made = Arc::new(Lightmap::new(&self.triangles, &self.parts, &taking, texels));
                *held = Some((texels, made.clone()));
                made
            }
        }
    }

    /// As [`Surfaces::lightmap`], with texels of the `detail`-th part of the size; it is not kept.
    pub(super) fn finer_lightmap(&self, finer: (Texels, u32), sides: &[u32]) -> Lightmap {
        let taking = Taking { sides, backs: self.backs(), areas: &self.areas };
        Lightmap::finer(&self.triangles, &self.parts, &taking, finer)
    }

    /// So many points, in clusters; `sides`: of each material, those that take diffuse light. The last ones stand.
    pub(super) fn samples(&self, wanted: (u32, u32), sides: &[u32]) -> Arc<SurfaceSamples> {
        let mut held = self.samples.lock().unwrap_or_else(PoisonError::into_inner);
        match &*held {
            Some((known, samples)) if *known == wanted => samples.clone(),
            _ => {
                let backs = self.backs();
                let back_seen =
                    |number: usize| backs.get(number / 32).is_some_and(|word| word >> (number % 32) & 1 == 1);
                let sides_of = |number: usize| match sides[self.triangles[number].material as usize] {
                    1 if back_seen(number) => 2,
                    sides => sides,
                };
                let area = |number: usize| {
                    let area = f64::from(self.areas[number]) * f64::from(sides_of(number));
                    if area.is_finite() { area } else { 0.0 }
                };
                let mut surfaces: Vec<[f64; 2]> = (0..self.triangles.len()).map(|number| [area(number), 1.0]).collect();
                // The ground around a house has most of the area, and the house's rooms most of what matters.
                for part in &self.parts {
                    let of_part = &mut surfaces[part.triangles()];
                    let whole: f64 = of_part.iter().map(|[area, _]| area).sum();
                    of_part.iter_mut().for_each(|[_, density]| *density = whole.max(f64::MIN_POSITIVE).sqrt().recip());
                }
                let made = SurfaceSamples::new(&self.triangles, &surfaces, |number| sides_of(number) == 2, wanted);
                let made = Arc::new(made);
                *held = Some((wanted, made.clone()));
                made
            }
        }
    }

    /// Of the sides that take diffuse light, m².
    pub(super) fn diffuse_area(&self, sides: &[u32]) -> f64 {
        let areas = self.triangles.iter().zip(&self.areas);
        let areas = areas.map(|(triangle, &area)| f64::from(area) * f64::from(sides[triangle.material as usize]));
        areas.filter(|area| area.is_finite()).sum()
    }

    pub(super) fn bytes(&self) -> u64 {
        let all = [&self.own_areas, &self.nodes, &self.leaves, &self.colors, &self.texcoords, &self.tangents];
        all.iter().map(|list| list.bytes()).sum()
    }
}

fn held<T>(kept: &Mutex<T>) -> MutexGuard<'_, T> {
    kept.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The size that all but a sixteenth of the triangles have, metres.
fn fine_size(areas: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = areas.map(f64::sqrt).filter(|&size| size > 0.0).collect();
    let place = sizes.len() / 16;
    if sizes.is_empty() { f64::INFINITY } else { *sizes.select_nth_unstable_by(place, f64::total_cmp).1 }
}
