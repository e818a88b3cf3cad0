//! Emissive surfaces as a bounded number of small cosine emitters, for methods that know only lights without area.
//!
//! All emissive triangles stand in a row, each as long as its power; the row is cut into equal intervals, and each emitter
//! stands for one interval: its power and area are exactly those of the pieces of triangles in it. It is placed in the
//! triangle at the interval's middle, where a texture or alpha lets it shine. The row is in the order of nodes, primitives and
//! triangles, so moving, turning or scaling the scene moves its emitters along.

use super::emission::TriangleEmission;
use super::emission_points::EmissionPoints;
use super::mesh::Instance;
use super::{NodeId, Scene};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// A small diffuse emitter that stands for part of the emissive surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterSample {
    /// Where it is, on the surface.
    pub position: DVec3,
    /// Unit normal of the surface's front side, towards which it emits.
    pub normal: DVec3,
    /// Whether it emits half its power towards the back as well.
    pub two_sided: bool,
    /// Emitted power in W, linear RGB, both sides together. Radiant intensity at angle θ is `power · cos θ / π` for a one-sided
    /// emitter and half of it on each side of a two-sided one.
    pub power: [f32; 3],
    /// Surface area in m² that it stands for, without what alpha cuts away or a texture leaves dark.
    pub area: f64,
    /// The node whose mesh holds the surface.
    pub node: NodeId,
}

/// An emissive triangle in world space.
struct Emitter<'a> {
    instance: &'a Instance,
    /// Number of the triangle in its primitive.
    triangle: usize,
    /// The corners, counter-clockwise as seen from the front.
    corners: [DVec3; 3],
    /// What shines of it, m².
    area: f64,
    two_sided: bool,
    power: [f64; 3],
    /// Where it shines, if not everywhere alike.
    uneven: Option<&'a TriangleEmission>,
}

impl Emitter<'_> {
    /// Length in the row: the luminance of its power.
    fn weight(&self) -> f64 {
        0.2126 * self.power[0] + 0.7152 * self.power[1] + 0.0722 * self.power[2]
    }

    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y)
    }

    fn point(&self, scene: &Scene, u: f64, v: f64) -> DVec3 {
        // Uniform in area (Osada et al. 2002).
        let [a, b, c] = self.corners;
        let Some(emission) = self.uneven else {
            let root = u.sqrt();
            return a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v);
        };
        let (primitive, material) = (scene.primitive(self.instance), scene.material_of(self.instance));
        let points = EmissionPoints::new(primitive, material, scene.textures(), true);
        let surface = points.of_triangle(&primitive.indices[3 * self.triangle..3 * self.triangle + 3]);
        let [b1, b2] = emission.place([u, v], |place| surface.radiance(place).is_some());
        let [b1, b2] = if self.instance.flips_winding { [b2, b1] } else { [b1, b2] };
        a * (1.0 - b1 - b2) + b * b1 + c * b2
    }
}

/// Where in its interval an emitter is placed: the middle, but for a hair, so that rounding cannot carry an emitter across
/// the border between two triangles of equal power.
const MIDDLE: f64 = 0.5 - 1e-6;

/// All emissive triangles in a row, each as long as its power, cut into `count` equal intervals.
struct Row<'a> {
    emitters: Vec<Emitter<'a>>,
    /// Where in the row each triangle ends.
    ends: Vec<f64>,
    /// Length of an interval.
    interval: f64,
}

impl Row<'_> {
    fn new(emitters: Vec<Emitter<'_>>, count: usize) -> Row<'_> {
        let running_sum = |sum: &mut f64, emitter: &Emitter<'_>| {
            *sum += emitter.weight();
            Some(*sum)
        };
        let ends: Vec<f64> = emitters.iter().scan(0.0, running_sum).collect();
        let interval = ends.last().copied().unwrap_or(0.0) / count as f64;
        Row { emitters, ends, interval }
    }

    /// The triangle at a place in the row.
    fn at(&self, place: f64) -> usize {
        self.ends.partition_point(|&end| end <= place).min(self.ends.len() - 1)
    }

    fn start(&self, index: usize) -> f64 {
        if index == 0 { 0.0 } else { self.ends[index - 1] }
    }

    /// Power and area of all pieces of triangles in an interval.
    fn flux(&self, sample: usize) -> ([f64; 3], f64) {
        let (low, high) = (self.interval * sample as f64, self.interval * (sample + 1) as f64);
        let (mut power, mut area) = ([0.0; 3], 0.0);
        for index in self.at(low)..=self.at(high) {
            let emitter = &self.emitters[index];
            let overlap = self.ends[index].min(high) - self.start(index).max(low);
            let share = overlap.max(0.0) / emitter.weight();
            power = std::array::from_fn(|channel| power[channel] + share * emitter.power[channel]);
            area += share * emitter.area;
        }
        (power, area)
    }

    /// The triangle at an interval's middle, and a point in it. Where several middles fall into one triangle, their places in
    /// the row and a radical inverse make a Hammersley set, which covers the triangle evenly.
    fn place(&self, scene: &Scene, sample: usize) -> (&Emitter<'_>, DVec3) {
        let place = (sample as f64 + MIDDLE) * self.interval;
        let index = self.at(place);
        let (start, length) = (self.start(index), self.emitters[index].weight());
        let rank = sample as f64 - (start / self.interval - MIDDLE).ceil().max(0.0);
        let neighbours = (length / self.interval).ceil().clamp(1.0, 1e9) as u32;
        let u = ((place - start) / length).clamp(0.0, 1.0);
        let v = radical_inverse(rank.max(0.0) as u32) + 0.5 / f64::from(neighbours.next_power_of_two());
        let emitter = &self.emitters[index];
        (emitter, emitter.point(scene, u, v.min(1.0)))
    }
}

impl Scene {
    /// Places `count` emitters on the emissive surfaces, by power. Their powers add up to the power that all emissive surfaces
    /// send out. Empty if nothing emits or `count` is 0. The same scene gives the same emitters.
    pub fn emitter_samples(&self, count: usize) -> Vec<EmitterSample> {
        let emissive: Vec<&Instance> = self.instances().iter().filter(|it| self.material_of(it).emits()).collect();
        let emitters: Vec<Vec<Emitter<'_>>> = emissive.par_iter().map(|it| emitters(self, it)).collect();
        let row = Row::new(emitters.into_iter().flatten().collect(), count);
        if !(row.interval > 0.0 && row.interval.is_finite()) {
            return Vec::new();
        }
        let sample = |sample| {
            let (power, area) = row.flux(sample);
            let (emitter, position) = row.place(self, sample);
            EmitterSample {
                position,
                normal: emitter.normal(),
                two_sided: emitter.two_sided,
                power: power.map(|channel| channel as f32),
                area,
                node: emitter.instance.node,
            }
        };
        (0..count).map(sample).collect()
    }
}

/// The emissive triangles of an instance that have area and power.
fn emitters<'a>(scene: &'a Scene, instance: &'a Instance) -> Vec<Emitter<'a>> {
    let (primitive, material, emission) =
        (scene.primitive(instance), scene.material_of(instance), scene.emission(instance));
    let sides = if material.double_sided { 2.0 } else { 1.0 };
    let all = primitive.triangles().enumerate().map(|(index, triangle)| {
        let mut corners = triangle.map(|corner| instance.world.transform_point3(Vec3::from(corner).as_dvec3()));
        if instance.flips_winding {
            corners.swap(1, 2);
        }
        let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length() * 0.5;
        let uneven = emission.of_triangle(index);
        let power = uneven
            .map_or(material.emissive, TriangleEmission::surely)
            .map(|channel| f64::from(channel) * area * PI * sides);
        let area = uneven.map_or(area, |emission| area * f64::from(emission.covered));
        Emitter { instance, triangle: index, corners, area, two_sided: material.double_sided, power, uneven }
    });
    all.filter(|emitter| emitter.weight() > 0.0 && emitter.weight().is_finite()).collect()
}

/// Van der Corput's sequence in base 2: 0, 1/2, 1/4, 3/4, …
fn radical_inverse(index: u32) -> f64 {
    f64::from(index.reverse_bits()) / 4_294_967_296.0
}
