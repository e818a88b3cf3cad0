//! The surfaces as rays meet them: triangles, the hierarchy of their boxes, and what is made of both. It stands while geometry and materials do, whatever shines on it.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::backs::backs;
use super::flattened::Flattened;
use super::hierarchy::Hierarchy;
use super::lightmap::{Lightmap, Taking, Texels};
use super::looks::Looks;
use super::motion::{Motion, Part, motion, parts};
use super::samples::SurfaceSamples;
use super::tessellation::Tessellation;
use super::triangles::TracedTriangle;
use super::uploaded::Uploaded;
use crate::graph::hash_of;
use crate::scene::{Cutout, Facts, Scene};
use crate::vulkan::{Device, VulkanError};

/// What was made last, and of what.
type Held<K, T> = Mutex<Option<(K, Arc<T>)>>;

pub(crate) struct Surfaces {
    pub(super) key: u64,
    flattened: Arc<Flattened>,
    hierarchy: Arc<Hierarchy>,
    /// Some triangle is there at some of its points only.
    pub(crate) cutouts: bool,
    /// Of the hierarchy's leaves: large triangles stand there more than once, those without area not at all.
    pub(crate) leaf_triangle_count: u32,
    /// How it came of what was before, if a part of the surfaces moved and nothing else happened.
    pub(crate) motion: Option<Motion>,
    /// Names the triangles' shapes: the same while things move and nothing else changes.
    pub(crate) shapes: u64,
    parts: Vec<Part>,
    /// By material.
    one_sided: Vec<bool>,
    /// As [`Surfaces::backs`] gives them, once they have been asked for.
    backs: OnceLock<Vec<u32>>,
    /// The last one that was asked for, with its spacing.
    tessellation: Held<f64, Tessellation>,
    /// Likewise, with how many of them there are and in clusters of how many.
    samples: Held<(u32, u32), SurfaceSamples>,
    /// Likewise, with how finely it is cut.
    lightmap: Held<Texels, Lightmap>,
}

impl std::ops::Deref for Surfaces {
    type Target = Flattened;

    fn deref(&self) -> &Flattened {
        &self.flattened
    }
}

/// Names a scene's surfaces within this process.
pub(crate) fn surfaces_key(scene: &Scene) -> u64 {
    let revisions = scene.revisions();
    let place = scene.extent().origin.to_array().map(f64::to_bits);
    hash_of(&(scene.identity(), revisions.geometry, revisions.materials, place))
}

impl Surfaces {
    /// Flattens, sorts and uploads the surfaces as they are now, but for what still holds of `held`; `alike`: that is of the same materials.
    pub(super) fn update(
        device: &Arc<Device>,
        scene: &Scene,
        looks: &Looks,
        facts: &Facts,
        (held, alike): (Option<&Surfaces>, bool),
    ) -> Result<Surfaces, VulkanError> {
        let key = surfaces_key(scene);
        let flattened = Flattened::update(device, scene, facts, held.map(|held| &held.flattened))?;
        let hierarchy = Hierarchy::update(device, &flattened, &looks.cutouts, held.map(|held| &held.hierarchy))?;
        let cut = |triangle: &TracedTriangle| looks.cutouts[triangle.material as usize] == Cutout::PerPoint;
        let parts = parts(scene);
        // Other materials make other particles.
        let before = held.filter(|_| alike);
        let motion = before.and_then(|before| before.motion_to(&parts, &flattened));
        // What is kept of particles while things move goes by their numbers, and these by the sides that have some.
        let backs = before.filter(|_| motion.is_some()).map(|before| before.backs.clone());
        let lightmap = before.filter(|_| motion.is_some()).and_then(|before| kept(&before.lightmap).clone());
        Ok(Surfaces {
            key,
            cutouts: flattened.triangles.iter().any(cut),
            leaf_triangle_count: hierarchy.leaf_triangle_count,
            shapes: before.filter(|_| motion.is_some()).map_or(key, |before| before.shapes),
            motion,
            parts,
            one_sided: scene.materials().iter().map(|material| !material.double_sided).collect(),
            backs: backs.unwrap_or_default(),
            tessellation: Mutex::new(None),
            lightmap: Mutex::new(lightmap),
            samples: Mutex::new(None),
            flattened,
            hierarchy,
        })
    }

    /// The nodes of the hierarchy and the triangles in its leaves.
    pub(super) fn hierarchy(&self) -> [&Uploaded; 2] {
        [&self.hierarchy.nodes, &self.hierarchy.leaves]
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
    fn motion_to(&self, parts: &[Part], now: &Flattened) -> Option<Motion> {
        let stands = self.origin == now.origin && self.middle_rs == now.middle_rs && self.areas == now.areas;
        let (before, after) = ((&self.parts[..], &self.triangles[..]), (parts, &now.triangles[..]));
        if stands { motion(self.key, before, after) } else { None }
    }

    /// Points closer to each other than `spacing` metres; `sides`: of each material, those that take diffuse light. The last one stands.
    pub(super) fn tessellation(&self, spacing: f64, sides: &[u32]) -> Arc<Tessellation> {
        let mut held = kept(&self.tessellation);
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
        let mut held = kept(&self.lightmap);
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
        let mut held = kept(&self.samples);
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
        self.flattened.bytes() + self.hierarchy.bytes()
    }
}

fn kept<T>(kept: &Mutex<T>) -> MutexGuard<'_, T> {
    kept.lock().unwrap_or_else(PoisonError::into_inner)
}
