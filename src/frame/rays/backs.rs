//! Which backs of one-sided surfaces other surfaces see: those of open meshes, shelves, sheets. Nobody sees the insides of closed meshes, but for surfaces that are
//! inside of them as well: whoever sees more backs than anything else is taken to be there, and does not count.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::motion::Part;
use super::triangles::TracedTriangle;
use crate::scene::rays::{MOST_TRIANGLES, Rays};

/// Points on fronts, and rays from each.
const POINTS: usize = 2048;
const RAYS: usize = 16;
/// Rays that have to meet the backs of a part: of gaps and cracks fewer do.
const LEAST: u32 = 8;
/// Rays start this far from their surface, over the scene's radius.
const LIFT: f32 = 1e-4;

/// A bit for each triangle of a part whose back is seen and which is of a one-sided material, in words; none where no back is. `areas`: of the triangles, 0 for those
/// that do not matter.
pub(super) fn backs(
    (triangles, areas): (&[TracedTriangle], &[f32]),
    parts: &[Part],
    one_sided: &[bool],
    (middle, radius): (DVec3, f64),
) -> Vec<u32> {
    let is_one_sided = |number: usize| one_sided[triangles[number].material as usize];
    if !(0..triangles.len()).any(is_one_sided) {
        return Vec::new();
    }
    let stride = triangles.len().div_ceil(MOST_TRIANGLES as usize).max(1);
    let place = |corner: Vec3| ((corner.as_dvec3() - middle) / radius).as_vec3();
    let rays = Rays::of(triangles.iter().step_by(stride).map(|triangle| triangle.corners.map(place)));
    let sums: Vec<f64> = areas
        .iter()
        .scan(0.0, |sum, &area| {
            *sum += f64::from(area);
            Some(*sum)
        })
        .collect();
    let met = (0..POINTS).into_par_iter().flat_map_iter(|point| {
        let at = (point as f64 + 0.5) / POINTS as f64 * sums.last().copied().unwrap_or_default();
        let number = sums.partition_point(|&end| end < at).min(sums.len() - 1);
        // Double-sided ones have particles on both sides.
        let side = if point % 2 == 0 || is_one_sided(number) { 1.0 } else { -1.0 };
        let normal = side * triangles[number].normal().as_vec3();
        let origin = place(point_of(&triangles[number], point)) + LIFT * normal;
        let hits = (0..RAYS).filter_map(|ray| rays.first(origin, direction(point, ray, normal), f32::INFINITY));
        let numbers = hits.filter(|hit| !hit.front).map(|hit| stride * rays.number(&hit));
        let numbers: Vec<usize> = numbers.filter(|&number| is_one_sided(number)).collect();
        if 2 * numbers.len() > RAYS { Vec::new() } else { numbers }
    });
    let mut counts = vec![0; parts.len()];
    for number in met.collect::<Vec<usize>>() {
        counts[parts.partition_point(|part| part.triangles().end <= number)] += 1;
    }
    let mut words = Vec::new();
    for (part, _) in parts.iter().zip(counts).filter(|(_, count)| *count >= LEAST) {
        words.resize(triangles.len().div_ceil(32), 0);
        let seen = part.triangles().filter(|&number| is_one_sided(number));
        seen.for_each(|number| words[number / 32] |= 1 << (number % 32));
    }
    words
}

/// One of a sequence that fills the triangle.
fn point_of(triangle: &TracedTriangle, point: usize) -> Vec3 {
    let [u, v] = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step: f64| (point as f64 * step).fract() as f32);
    let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
    let [a, b, c] = triangle.corners;
    a + (b - a) * u + (c - a) * v
}

/// Around the normal, by the cosine: a spiral, turned from point to point.
fn direction(point: usize, ray: usize, normal: Vec3) -> Vec3 {
    let radius = ((ray as f32 + 0.5) / RAYS as f32).sqrt();
    let turns = (point as f64 * 0.754_877_666_246_693 + ray as f64 * 0.618_033_988_749_895).fract();
    let (sine, cosine) = (std::f64::consts::TAU * turns).sin_cos();
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    radius * (cosine as f32 * tangent + sine as f32 * bitangent) + (1.0 - radius * radius).sqrt() * normal
}
