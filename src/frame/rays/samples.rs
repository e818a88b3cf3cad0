//! Points spread evenly over all diffuse surface, in clusters of neighbours that face about the same way (glsl/bounces/samples.glsl).
//!
//! Point i of n lies where the areas of the triangles, one after the other and each times the density there, add up to (i + s)/n of all, 0 < s < 1, and within a triangle on the points of the R₂ sequence
//! (Roberts 2018). Clusters come of halving along the longest side of the box around what is left, among points whose normals have the same largest
//! component and which stand for about as much area: those of a room's floor and of the ground outside are not of one cluster.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::triangles::TracedTriangle;
use crate::frame::octahedral::pack_direction;
use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph, hash_of};

/// Where the first sample lies, in steps: with a half many would lie just where triangles end, and rounding decide which one they are on.
const START: f64 = 0.381_966_011_250_105;

/// Samples of a scene's surfaces, on the host.
pub(crate) struct SurfaceSamples {
    /// Samples, and places that stay empty since a cluster has fewer than the others.
    pub(crate) slot_count: u32,
    records: Arc<[u8]>,
    key: u64,
}

/// One sample.
#[derive(Clone, Copy, Debug)]
struct Sample {
    number: u32,
    position: Vec3,
    normal: Vec3,
    triangle: u32,
    /// Weights of corners 1 and 2.
    place: [f32; 2],
    /// That it stands for, m².
    area: f32,
}

impl Sample {
    /// The largest component of its normal, and its sign.
    fn facing(&self) -> usize {
        let axis = self.normal.abs().max_position();
        2 * axis + usize::from(self.normal[axis] < 0.0)
    }

    fn record(&self) -> [[u32; 4]; 2] {
        let [x, y, z] = self.position.to_array().map(f32::to_bits);
        let [u, v] = self.place.map(f32::to_bits);
        [[x, y, z, self.area.to_bits()], [pack_direction(self.normal), self.triangle, u, v]]
    }
}

impl SurfaceSamples {
    /// `surfaces`: of each triangle the area of all of its sides that count, m², and how densely samples lie on it beside others; `both`: whether its sides are two.
    pub(super) fn new(
        triangles: &[TracedTriangle],
        surfaces: &[[f64; 2]],
        both: impl Fn(usize) -> bool,
        (count, cluster): (u32, u32),
    ) -> SurfaceSamples {
        let samples = spread(triangles, surfaces, both, count);
        let mean = surfaces.iter().map(|[area, _]| area).sum::<f64>() / f64::from(count.max(1));
        let mut alike: BTreeMap<(i32, usize), Vec<Sample>> = BTreeMap::new();
        for sample in samples {
            let size = (f64::from(sample.area) / mean).log2().round() as i32;
            alike.entry((size, sample.facing())).or_default().push(sample);
        }
        let size = cluster as usize;
        let mut records = Vec::new();
        for samples in alike.values_mut() {
            halve(samples, size);
            records.extend(samples.iter().flat_map(|sample| sample.record()));
            records.resize(records.len().next_multiple_of(2 * size), [0; 4]);
        }
        let records: Arc<[u8]> = bytemuck::cast_slice::<_, u8>(&records).into();
        SurfaceSamples { slot_count: (records.len() / 32) as u32, key: hash_of(&records), records }
    }

    /// Two texels each (glsl/bounces/samples.glsl).
    pub(crate) fn upload(&self, graph: &mut Graph<'_>) -> BufferRef<[u32; 4]> {
        let surfaces = Dependence::GEOMETRY | Dependence::MATERIALS;
        graph.upload_shared("samples", self.records.clone(), self.key, surfaces)
    }
}

fn spread(
    triangles: &[TracedTriangle],
    surfaces: &[[f64; 2]],
    both: impl Fn(usize) -> bool,
    count: u32,
) -> Vec<Sample> {
    let step = surfaces.iter().map(|[area, density]| area * density).sum::<f64>() / f64::from(count.max(1));
    let mut samples = Vec::with_capacity(count as usize);
    let mut before = 0.0;
    for (triangle, &[area, density]) in surfaces.iter().enumerate().filter(|(_, [area, _])| *area > 0.0) {
        let sides: &[f64] = if both(triangle) { &[1.0, -1.0] } else { &[1.0] };
        for &side in sides {
            let end = before + area * density / sides.len() as f64;
            let first = samples.len();
            while samples.len() < count as usize && (samples.len() as f64 + START) * step < end {
                let place = r2(triangle, side, samples.len() - first);
                let sample = sample_of(&triangles[triangle], triangle, (samples.len() as u32, side, place));
                samples.push(Sample { area: (step / density) as f32, ..sample });
            }
            before = end;
        }
    }
    samples
}

fn sample_of(triangle: &TracedTriangle, index: usize, (number, side, place): (u32, f64, [f64; 2])) -> Sample {
    let [a, b, c] = triangle.corners.map(|corner| corner.as_dvec3());
    let position: DVec3 = a + (b - a) * place[0] + (c - a) * place[1];
    Sample {
        number,
        position: position.as_vec3(),
        normal: (triangle.normal() * side).as_vec3(),
        triangle: index as u32,
        place: place.map(|weight| weight as f32),
        area: 0.0,
    }
}

/// The k-th point of a triangle's side. Area-preserving from the square, neighbours stay neighbours (Heitz 2019).
fn r2(triangle: usize, side: f64, k: usize) -> [f64; 2] {
    let start = triangle as f64 * 0.618_033_988_749_895 + if side < 0.0 { 0.25 } else { 0.5 };
    let [x, y] = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step: f64| (start + k as f64 * step).fract());
    if y > x { [0.5 * x, y - 0.5 * x] } else { [x - 0.5 * y, 0.5 * y] }
}

/// Orders points so that each `size` of them, one after the other, lie close to each other.
fn halve(samples: &mut [Sample], size: usize) {
    if samples.len() <= size {
        return;
    }
    let low = samples.iter().map(|sample| sample.position).fold(Vec3::INFINITY, Vec3::min);
    let high = samples.iter().map(|sample| sample.position).fold(Vec3::NEG_INFINITY, Vec3::max);
    let axis = (high - low).max_position();
    samples.sort_unstable_by(|a, b| a.position[axis].total_cmp(&b.position[axis]).then(a.number.cmp(&b.number)));
    let (left, right) = samples.split_at_mut(size * (samples.len().div_ceil(size) / 2));
    halve(left, size);
    halve(right, size);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(corner: Vec3, edges: [Vec3; 2]) -> [TracedTriangle; 2] {
        let [a, b, c, d] = [corner, corner + edges[0], corner + edges[0] + edges[1], corner + edges[1]];
        [TracedTriangle::flat([a, b, c], 0), TracedTriangle::flat([a, c, d], 0)]
    }

    /// A floor of 4 m², of which both sides count, and a wall of 2 m².
    fn samples(count: u32, cluster: u32) -> Vec<Sample> {
        let floor = square(Vec3::ZERO, [Vec3::Z * 2.0, Vec3::X * 2.0]);
        let wall = square(Vec3::ZERO, [Vec3::X * 2.0, Vec3::Y]);
        let triangles = [floor, wall].concat();
        let surfaces = [4.0, 4.0, 1.0, 1.0].map(|area| [area, 1.0]);
        let made = SurfaceSamples::new(&triangles, &surfaces, |triangle| triangle < 2, (count, cluster));
        let words: &[u32] = bytemuck::cast_slice(&made.records);
        assert_eq!((words.len(), made.slot_count % cluster), (8 * made.slot_count as usize, 0));
        let of_cluster = words.chunks_exact(8 * cluster as usize);
        assert!(of_cluster.clone().all(|words| words[3] != 0), "the first of each cluster is there");
        let area: f64 = words.chunks_exact(8).map(|words| f64::from(f32::from_bits(words[3]))).sum();
        assert!((area - 10.0).abs() < 1e-5, "{area} m²");
        spread(&triangles, &surfaces, |triangle| triangle < 2, count)
    }

    #[test]
    fn samples_lie_evenly_on_all_sides() {
        let samples = samples(1000, 4);
        assert_eq!(samples.len(), 1000);
        for (normal, expected) in [(Vec3::Y, 400), (Vec3::NEG_Y, 400), (Vec3::Z, 200)] {
            let of_side: Vec<_> = samples.iter().filter(|sample| sample.normal.dot(normal) > 0.99).collect();
            assert_eq!(of_side.len(), expected, "{normal}");
            // Eighths of each side's first 2 m x 1 m.
            for eighth in 0..8 {
                let (column, row) = (eighth % 4, eighth / 4);
                let inside = |sample: &&&Sample| {
                    let across = if normal == Vec3::Z { sample.position.y } else { sample.position.z };
                    (sample.position.x * 2.0) as usize == column && (across * 2.0) as usize == row
                };
                let found = of_side.iter().filter(inside).count();
                assert!((19..=31).contains(&found), "{normal}, part {eighth}: {found} of 25");
            }
        }
    }

    #[test]
    fn where_samples_are_dense_each_stands_for_less() {
        let triangles = [square(Vec3::ZERO, [Vec3::Z, Vec3::X]), square(Vec3::Y, [Vec3::Z, Vec3::X])].concat();
        let surfaces = [[0.5, 1.0], [0.5, 1.0], [0.5, 4.0], [0.5, 4.0]];
        let samples = spread(&triangles, &surfaces, |_| false, 500);
        for (height, count, area) in [(0.0, 100, 1.0), (1.0, 400, 1.0)] {
            let of_square = samples.iter().filter(|sample| sample.position.y == height);
            assert_eq!(of_square.clone().count(), count);
            let sum: f32 = of_square.map(|sample| sample.area).sum();
            assert!((sum - area).abs() < 1e-4, "{sum} m²");
        }
    }

    #[test]
    fn clusters_are_of_neighbours() {
        for cluster in [4, 16] {
            let mut samples = samples(1000, cluster);
            samples.retain(|sample| sample.normal.y > 0.5);
            halve(&mut samples, cluster as usize);
            let radius = |members: &[Sample]| {
                let middle = members.iter().map(|member| member.position).sum::<Vec3>() / members.len() as f32;
                members.iter().map(|member| member.position.distance(middle)).fold(0.0, f32::max)
            };
            // A square of the cluster's area, 4 m²/400 for each.
            let side = (cluster as f32 * 0.01).sqrt();
            let worst = samples.chunks(cluster as usize).map(radius).fold(0.0, f32::max);
            assert!(worst < 1.6 * side, "{worst} m, squares of {side} m");
        }
    }
}
