//! Where a scene is and how far it reaches, so that no speck at a distance decides about either.
//!
//! Positions on the device are float32, and rounding grows with the distance from the origin. The **finest** place, of those of a scene's instances, is
//! the one around which rounding does the least harm: the sum over all instances of
//!
//! ```text
//! √s · (d/(K·δ) between 1/16 and 1)        K = 2¹⁴
//! ```
//!
//! is least there. d is the distance, δ the size of the instance's triangles, of which rounding at K·δ is a thousandth: beyond that, the
//! instance is lost whatever happens, and a sixteenth of it harms nothing. s is its own size: by number a few specks would outweigh a room, by area a ground what stands on it.
//!
//! The **middle** of the scene is the median of its surface, or the finest place if more than a few triangles would be lost otherwise. The
//! **reach** is the radius of what matters around it. What lies beyond fills next to nothing of the view from there: less than [`UNSEEN`], or
//! less than [`SLIGHT`] where besides nothing lies between, up to [`GAP`] times as far as all the rest. Whatever a light must hit to be right counts all
//! surfaces, near or far; what has a resolution to share out ends here.
//!
//! The **origin** is the finest place if that is the middle, else the centre of the box around what matters, rounded to a multiple of a power of two:
//! the coordinates of a scene that was made around its own zero stay what they are.

use super::mesh::{Bounds, Primitive};
use glam::{DAffine3, DVec3};
use std::collections::BTreeMap;

/// Over the size of a triangle: the distance at which float32 rounds by a thousandth of it, 2²⁴/10³.
const LOST: f64 = 16384.0;
/// Share of that distance at which nothing is lost yet.
const HARMLESS: f64 = 1.0 / 16.0;
/// Solid angle of what nobody misses, sr: a pixel in a thousand by a thousand.
const UNSEEN: f64 = 1e-6;
/// Solid angle of what is left out if it is far from everything else, sr.
const SLIGHT: f64 = 1e-3;
/// How much farther than the rest that is.
const GAP: f64 = 32.0;
/// Triangles, or a share of all, that must gain by a middle away from the median.
const GAIN: f64 = 8.0;
const GAIN_SHARE: f64 = 0.125;
/// Places that are compared, and things that they are judged by; of more, every n-th.
const CANDIDATES: usize = 64;
const JUDGES: usize = 4096;

/// Something with a surface: a triangle, or an instance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Thing {
    middle: DVec3,
    /// Of the sphere around the middle that holds it, m.
    radius: f64,
    /// m²
    area: f64,
    /// Size of its triangles, m.
    detail: f64,
}

/// A primitive in its own space: where its bulk is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Shape {
    /// What its vertices are measured from on the device: about the middle of its bulk, a multiple of a power of two, so that no
    /// vertex near it is rounded.
    pub(crate) center: DVec3,
    /// The box around its bulk.
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// m², 0 if there is no triangle.
    area: f64,
    detail: f64,
}

/// Where a scene is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    pub(crate) origin: DVec3,
    /// Of what matters, in the world as the origin.
    pub(crate) middle: DVec3,
    /// Half the diagonal of the box around what matters, m; above 0.
    pub(crate) radius: f64,
}

impl Shape {
    pub(super) fn of(primitive: &Primitive) -> Shape {
        let triangles: Vec<Thing> =
            primitive.triangles().map(|corners| Thing::of_triangle(corners.map(wide))).collect();
        let Bulk { middle, reach, .. } = Bulk::of(&triangles);
        let (mut low, mut high, mut area, mut count) = (DVec3::INFINITY, DVec3::NEG_INFINITY, 0.0, 0);
        for (corners, triangle) in primitive.triangles().zip(&triangles) {
            if triangle.nearest(middle) <= reach {
                (area, count) = (area + triangle.area, count + 1);
                for corner in corners {
                    (low, high) = (low.min(wide(corner)), high.max(wide(corner)));
                }
            }
        }
        if count == 0 {
            return Shape::default();
        }
        let center = on_grid((low + high) * 0.5, (high - low).length() * 0.5);
        Shape { center, low, high, area, detail: (area / f64::from(count)).sqrt() }
    }

    /// As an instance places it.
    pub(super) fn placed(&self, world: &DAffine3) -> Thing {
        let half = (self.high - self.low) * 0.5;
        let axes = [world.matrix3.x_axis * half.x, world.matrix3.y_axis * half.y, world.matrix3.z_axis * half.z];
        // The longest of the box's four diagonals.
        let diagonal = |y: f64, z: f64| (axes[0] + axes[1] * y + axes[2] * z).length();
        let radius = diagonal(1.0, 1.0).max(diagonal(-1.0, 1.0)).max(diagonal(1.0, -1.0)).max(diagonal(-1.0, -1.0));
        // What the transform makes of an area, over its directions.
        let [x, y, z] = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis];
        let scale2 = (y.cross(z).length() + z.cross(x).length() + x.cross(y).length()) / 3.0;
        Thing {
            middle: world.transform_point3(self.low + half),
            radius,
            area: self.area * scale2,
            detail: self.detail * scale2.sqrt(),
        }
    }
}

impl Thing {
    fn of_triangle(corners: [DVec3; 3]) -> Thing {
        let [a, b, c] = corners;
        let middle = (a + b + c) / 3.0;
        let radius = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
        let area = 0.5 * (b - a).cross(c - a).length();
        Thing { middle, radius, area, detail: area.sqrt() }
    }

    fn triangles(&self) -> f64 {
        if self.detail > 0.0 { self.area / (self.detail * self.detail) } else { 0.0 }
    }

    /// How much of it rounding around `origin` takes, 0 to 1.
    fn lost(&self, origin: DVec3) -> f64 {
        let reach = LOST * self.detail;
        let share = if reach > 0.0 { self.middle.distance(origin) / reach } else { 0.0 };
        ((share - HARMLESS) / (1.0 - HARMLESS)).clamp(0.0, 1.0)
    }

    /// Its distance from a point, at least.
    pub(super) fn nearest(&self, point: DVec3) -> f64 {
        (self.middle.distance(point) - self.radius).max(0.0)
    }
}

/// The nearest multiple of the largest power of two that is no more than `size`.
fn on_grid(point: DVec3, size: f64) -> DVec3 {
    let step = size.log2().floor().exp2();
    if step > 0.0 && step.is_finite() { (point / step).round() * step } else { point }
}

fn wide(corner: [f32; 3]) -> DVec3 {
    DVec3::from(corner.map(f64::from))
}

/// What rounding around `origin` does to the things.
fn harm(things: &[Thing], origin: DVec3) -> f64 {
    things.iter().map(|thing| thing.area.sqrt().sqrt() * thing.lost(origin)).sum()
}

/// How many triangles rounding around `origin` takes.
fn triangles_lost(things: &[Thing], origin: DVec3) -> f64 {
    things.iter().map(|thing| thing.triangles() * thing.lost(origin)).sum()
}

/// The middle of the thing around which rounding does the least harm.
fn finest_of(things: &[Thing]) -> DVec3 {
    best_of(things, harm)
}

/// The middle of the thing that the others, by their area, are nearest to.
fn median_of(things: &[Thing]) -> DVec3 {
    best_of(things, |things, point| things.iter().map(|thing| thing.area * thing.middle.distance(point)).sum())
}

/// The middle of the thing where `cost` is least.
fn best_of(things: &[Thing], cost: impl Fn(&[Thing], DVec3) -> f64) -> DVec3 {
    let sound: Vec<Thing> = things.iter().filter(|thing| thing.area > 0.0 && thing.area.is_finite()).copied().collect();
    let judges: Vec<Thing> = sound.iter().step_by(sound.len().div_ceil(JUDGES).max(1)).copied().collect();
    let candidates = judges.iter().step_by(judges.len().div_ceil(CANDIDATES).max(1));
    let judged = candidates.map(|thing| (cost(&judges, thing.middle), thing.middle));
    let best = judged.reduce(|best, next| if next.0 < best.0 { next } else { best });
    best.map_or_else(|| things.first().map_or(DVec3::ZERO, |thing| thing.middle), |(_, middle)| middle)
}

/// What lies in one octave of distances.
#[derive(Clone, Copy)]
struct Octave {
    nearest: f64,
    farthest: f64,
    /// sr, at most.
    solid_angle: f64,
}

/// How far from `origin` what matters reaches.
pub(super) fn reach_of(things: &[Thing], origin: DVec3) -> f64 {
    let mut octaves: BTreeMap<i32, Octave> = BTreeMap::new();
    for thing in things {
        let nearest = thing.nearest(origin);
        let (farthest, solid_angle) = (thing.middle.distance(origin) + thing.radius, thing.area / (nearest * nearest));
        let key = if nearest > 0.0 { nearest.log2().floor() as i32 } else { i32::MIN };
        let all = octaves.entry(key).or_insert(Octave { nearest, farthest: 0.0, solid_angle: 0.0 });
        all.nearest = all.nearest.min(nearest);
        all.farthest = all.farthest.max(farthest);
        all.solid_angle += if nearest > 0.0 { solid_angle } else { f64::INFINITY };
    }
    let octaves: Vec<Octave> = octaves.into_values().collect();
    let farthest = |octaves: &[Octave]| octaves.iter().map(|octave| octave.farthest).fold(0.0, f64::max);
    let ends = |&cut: &usize| {
        let beyond: f64 = octaves[cut..].iter().map(|octave| octave.solid_angle).sum();
        let apart = octaves[cut].nearest > GAP * farthest(&octaves[..cut]);
        beyond < UNSEEN || (apart && beyond < SLIGHT)
    };
    let cut = (1..octaves.len()).find(ends).unwrap_or(octaves.len());
    farthest(&octaves[..cut])
}

/// Where the bulk of some things is.
pub(super) struct Bulk {
    /// Away from the median of all surface, since many triangles are too fine for that.
    at_finest: bool,
    pub(super) middle: DVec3,
    pub(super) reach: f64,
}

impl Bulk {
    pub(super) fn of(things: &[Thing]) -> Bulk {
        let (finest, median) = (finest_of(things), median_of(things));
        let gain = triangles_lost(things, median) - triangles_lost(things, finest);
        let all: f64 = things.iter().map(Thing::triangles).sum();
        let at_finest = gain > GAIN.min(GAIN_SHARE * all);
        let middle = if at_finest { finest } else { median };
        Bulk { at_finest, middle, reach: reach_of(things, middle) }
    }

    /// The extent of a scene whose bulk has this box.
    pub(super) fn extent(&self, bounds: Option<Bounds>) -> Extent {
        let center = bounds.map_or(self.middle, |bounds| bounds.center());
        let sound = |radius: &f64| *radius > 0.0 && radius.is_finite();
        let radius = bounds.map(|bounds| bounds.radius()).filter(sound).unwrap_or(1.0);
        let best = if self.at_finest { self.middle } else { center };
        Extent { origin: on_grid(best, radius), middle: self.middle, radius }
    }
}
