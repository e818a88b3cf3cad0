//! Emissive surfaces as a bounded number of small cosine emitters, for methods that know only lights without area.
//!
//! All emissive triangles stand in a row, each as long as its power; the row is cut into equal intervals, and each emitter
//! stands for one interval: its power and area are exactly those of the pieces of triangles in it. It is placed in the
//! triangle at the interval's middle. The row is in the order of nodes, primitives and triangles, so moving, turning or
//! scaling the scene moves its emitters along.

use super::mesh::{Instance, Primitive};
use super::{Material, NodeId, Scene};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Barycentric coordinates at which an emissive texture is read to estimate its mean over a triangle: the centroid, the
/// corners and the middles of the edges, those drawn inwards.
const TEXTURE_POINTS: [[f32; 3]; 7] = [
    [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
    [0.8, 0.1, 0.1],
    [0.1, 0.8, 0.1],
    [0.1, 0.1, 0.8],
    [0.45, 0.45, 0.1],
    [0.45, 0.1, 0.45],
    [0.1, 0.45, 0.45],
];

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
    /// Surface area in m² that it stands for.
    pub area: f64,
    /// The node whose mesh holds the surface.
    pub node: NodeId,
}

/// An emissive triangle in world space.
struct Emitter {
    node: NodeId,
    /// The corners, counter-clockwise as seen from the front.
    corners: [DVec3; 3],
    area: f64,
    two_sided: bool,
    power: [f64; 3],
}

impl Emitter {
    /// Length in the row: the luminance of its power.
    fn weight(&self) -> f64 {
        0.2126 * self.power[0] + 0.7152 * self.power[1] + 0.0722 * self.power[2]
    }

    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y)
    }

    fn point(&self, u: f64, v: f64) -> DVec3 {
        // Uniform in area (Osada et al. 2002).
        let [a, b, c] = self.corners;
        let root = u.sqrt();
        a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v)
    }
}

/// Where in its interval an emitter is placed: the middle, but for a hair, so that rounding cannot carry an emitter across
/// the border between two triangles of equal power.
const MIDDLE: f64 = 0.5 - 1e-6;

/// All emissive triangles in a row, each as long as its power, cut into `count` equal intervals.
struct Row {
    emitters: Vec<Emitter>,
    /// Where in the row each triangle ends.
    ends: Vec<f64>,
    /// Length of an interval.
    interval: f64,
}

impl Row {
    fn new(emitters: Vec<Emitter>, count: usize) -> Row {
        let running_sum = |sum: &mut f64, emitter: &Emitter| {
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
    fn place(&self, sample: usize) -> (&Emitter, DVec3) {
        let place = (sample as f64 + MIDDLE) * self.interval;
        let index = self.at(place);
        let (start, length) = (self.start(index), self.emitters[index].weight());
        let rank = sample as f64 - (start / self.interval - MIDDLE).ceil().max(0.0);
        let neighbours = (length / self.interval).ceil().clamp(1.0, 1e9) as u32;
        let u = ((place - start) / length).clamp(0.0, 1.0);
        let v = radical_inverse(rank.max(0.0) as u32) + 0.5 / f64::from(neighbours.next_power_of_two());
        let emitter = &self.emitters[index];
        (emitter, emitter.point(u, v.min(1.0)))
    }
}

impl Scene {
    /// Places `count` emitters on the emissive surfaces, by power. Their powers add up to the power that all emissive surfaces
    /// send out. Empty if nothing emits or `count` is 0. The same scene gives the same emitters.
    pub fn emitter_samples(&self, count: usize) -> Vec<EmitterSample> {
        let emissive: Vec<&Instance> = self.instances().iter().filter(|it| self.material_of(it).emits()).collect();
        let emitters: Vec<Vec<Emitter>> =
            emissive.par_iter().map(|it| emitters(self, it, self.primitive(it), self.material_of(it))).collect();
        let row = Row::new(emitters.into_iter().flatten().collect(), count);
        if !(row.interval > 0.0 && row.interval.is_finite()) {
            return Vec::new();
        }
        let sample = |sample| {
            let (power, area) = row.flux(sample);
            let (emitter, position) = row.place(sample);
            EmitterSample {
                position,
                normal: emitter.normal(),
                two_sided: emitter.two_sided,
                power: power.map(|channel| channel as f32),
                area,
                node: emitter.node,
            }
        };
        (0..count).map(sample).collect()
    }
}

/// The emissive triangles of an instance that have area and power.
fn emitters(scene: &Scene, instance: &Instance, primitive: &Primitive, material: &Material) -> Vec<Emitter> {
    let texture = material.emissive_texture.and_then(|reference| {
        let coordinates = primitive.texcoords[reference.texcoord as usize].as_ref()?;
        Some((reference, coordinates, &scene.textures()[reference.texture.0]))
    });
    let sides = if material.double_sided { 2.0 } else { 1.0 };
    let all = primitive.indices.chunks_exact(3).zip(primitive.triangles()).map(|(vertices, triangle)| {
        let mut corners = triangle.map(|corner| instance.world.transform_point3(Vec3::from(corner).as_dvec3()));
        if instance.flips_winding {
            corners.swap(1, 2);
        }
        let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length() * 0.5;
        let mut radiance = material.emissive;
        if let Some((reference, coordinates, texture)) = texture {
            let corner_coordinates: [[f32; 2]; 3] =
                std::array::from_fn(|corner| reference.apply(coordinates[vertices[corner] as usize]));
            let sum = TEXTURE_POINTS.iter().fold(Vec3::ZERO, |sum, weights| {
                let point =
                    [0, 1].map(|axis| (0..3).map(|corner| weights[corner] * corner_coordinates[corner][axis]).sum());
                sum + Vec3::from_slice(&texture.texel(point)[..3])
            });
            radiance = (Vec3::from(radiance) * sum / TEXTURE_POINTS.len() as f32).to_array();
        }
        let power = radiance.map(|channel| f64::from(channel) * area * PI * sides);
        Emitter { node: instance.node, corners, area, two_sided: material.double_sided, power }
    });
    all.filter(|emitter| emitter.weight() > 0.0 && emitter.weight().is_finite()).collect()
}

/// Van der Corput's sequence in base 2: 0, 1/2, 1/4, 3/4, …
fn radical_inverse(index: u32) -> f64 {
    f64::from(index.reverse_bits()) / 4_294_967_296.0
}
