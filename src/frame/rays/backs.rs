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
/// Rays of one point that count: one that lies on the edge of what stands on the part may see into it by rounding alone.
const A_POINT: u32 = 2;
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
        let numbers = if 2 * numbers.len() > RAYS { Vec::new() } else { numbers };
        numbers.into_iter().map(move |number| (point, number))
    });
    let met: Vec<(usize, usize)> = met.collect();
    let met =
        met.into_iter().map(|(point, number)| (point, parts.partition_point(|part| part.triangles().end <= number)));
    let seen = seen_parts(met, parts.len());
    let mut words = Vec::new();
    for (part, _) in parts.iter().zip(seen).filter(|(_, seen)| *seen) {
        words.resize(triangles.len().div_ceil(32), 0);
        let seen = part.triangles().filter(|&number| is_one_sided(number));
        seen.for_each(|number| words[number / 32] |= 1 << (number % 32));
    }
    words
}

/// Which of so many parts are seen, by the points and parts of rays that met backs, point by point.
fn seen_parts(met: impl Iterator<Item = (usize, usize)>, part_count: usize) -> Vec<bool> {
    let mut counts = vec![0; part_count];
    // The last point that met each, and how many of its rays did.
    let mut own = vec![(usize::MAX, 0); part_count];
    for (point, part) in met {
        let (last, rays) = &mut own[part];
        *rays = if *last == point { *rays + 1 } else { 1 };
        *last = point;
        counts[part] += u32::from(*rays <= A_POINT);
    }
    counts.into_iter().map(|count| count >= LEAST).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_single_point_says_that_a_back_is_seen() {
        let rays = |points: usize, each: usize| (0..points).flat_map(move |point| (0..each).map(move |_| (point, 1)));
        assert_eq!(seen_parts(rays(1, 8), 2), [false, false]);
        assert_eq!(seen_parts(rays(3, 8), 2), [false, false]);
        assert_eq!(seen_parts(rays(4, 2), 2), [false, true]);
        assert_eq!(seen_parts(rays(8, 1), 2), [false, true]);
        assert_eq!(seen_parts(rays(7, 1), 2), [false, false]);
    }
}
