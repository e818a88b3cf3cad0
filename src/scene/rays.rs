//! Rays against all triangles of a scene: what an automatic view sees, and which backs of surfaces others see.
//!
//! The triangles are sorted along a Morton curve and cut into equal runs, the leaves of a complete binary tree whose nodes are
//! numbered as in a heap. Such a tree is built in some ten milliseconds for 260,000 triangles, which matters more here than the
//! fastest ray: a view takes only some 20,000 of them.
//!
//! Lengths are relative to the scene's radius, and its middle is the origin.

use super::Scene;
use super::mesh::Bounds;
use glam::Vec3;
use rayon::prelude::*;

/// Of larger scenes every k-th triangle is kept, so that neither time nor memory grow without bound.
pub(crate) const MOST_TRIANGLES: u64 = 1 << 21;
/// Bits of a sort key: the triangle's index below, then a Morton code of three axes, then its class of size.
const INDEX_BITS: u32 = 22;
const AXIS_BITS: u32 = 13;
const LEAF_TRIANGLES: usize = 4;
/// A hit this far before a point hides it, as a share of its distance.
const POINT_TOLERANCE: f32 = 1e-3;

/// The corners of a triangle, counter-clockwise as seen from the front.
#[derive(Clone, Copy)]
struct Triangle([Vec3; 3]);

/// What a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    /// In lengths of the ray's direction.
    pub(super) distance: f32,
    /// The place of the triangle among those of the tree.
    place: usize,
    /// Whether it is the front of the surface, by winding alone: the walls of a room are often double-sided, but their fronts
    /// look inwards all the same.
    pub(crate) front: bool,
}

/// A point of a surface, drawn by area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SurfacePoint {
    position: Vec3,
    /// Perpendicular to the front, of any length.
    normal: Vec3,
}

/// The triangles of a scene, ready for rays.
pub(crate) struct Rays {
    triangles: Vec<Triangle>,
    /// Of each, its number among those that were given.
    numbers: Vec<u32>,
    /// Smallest and largest corner of each node; the children of node `n` are `2n` and `2n + 1`, the root is 1.
    boxes: Vec<[Vec3; 2]>,
    leaves: usize,
}

impl Triangle {
    fn bounds(&self) -> [Vec3; 2] {
        let [a, b, c] = self.0;
        [a.min(b).min(c), a.max(b).max(c)]
    }

    fn cross(&self) -> Vec3 {
        let [a, b, c] = self.0;
        (b - a).cross(c - a)
    }

    /// Large triangles are kept apart from small ones, whose boxes they would swell.
    fn sort_key(&self, index: usize) -> u64 {
        let [low, high] = self.bounds();
        let extent = (high - low).max_element();
        let class = [0.02, 0.08, 0.3].iter().filter(|&&limit| extent > limit).count() as u64;
        let cells = (1u64 << AXIS_BITS) as f32;
        let cell = ((low + high) * 0.25 + 0.5) * cells;
        let code = cell.to_array().into_iter().enumerate().fold(0, |code, (axis, at)| {
            let at = at.clamp(0.0, cells - 1.0) as u64;
            (0..AXIS_BITS).fold(code, |code, bit| code | (at >> bit & 1) << (3 * bit + axis as u32))
        });
        (class << (3 * AXIS_BITS) | code) << INDEX_BITS | index as u64
    }

    fn hit(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        let [a, b, c] = self.0;
        let (ab, ac, from) = (b - a, c - a, origin - a);
        let across = direction.cross(ac);
        let determinant = ab.dot(across);
        let u = from.dot(across) / determinant;
        let around = from.cross(ab);
        let v = direction.dot(around) / determinant;
        let distance = ac.dot(around) / determinant;
        // A determinant of 0 leaves no number that passes.
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance.is_finite();
        inside.then_some(Hit { distance, place: 0, front: determinant > 0.0 })
    }
}

impl Rays {
    /// The triangles of `scene`, whose bounds have this centre and radius.
    pub(super) fn new(scene: &Scene, bounds: &Bounds, radius: f64) -> Rays {
        Rays::among(&triangles(scene, bounds, radius))
    }

    /// Triangles by their corners, around the origin and no farther from it than 2; as many as sort keys can number.
    pub(crate) fn of(corners: impl Iterator<Item = [Vec3; 3]>) -> Rays {
        let triangles: Vec<Triangle> = corners.map(Triangle).collect();
        Rays::among(&triangles)
    }

    fn among(unsorted: &[Triangle]) -> Rays {
        let mut keys: Vec<u64> =
            unsorted.par_iter().enumerate().map(|(index, triangle)| triangle.sort_key(index)).collect();
        keys.par_sort_unstable();
        let index = |key: u64| (key & ((1 << INDEX_BITS) - 1)) as usize;
        let triangles: Vec<Triangle> = keys.par_iter().map(|&key| unsorted[index(key)]).collect();
        let numbers = keys.par_iter().map(|&key| index(key) as u32).collect();
        let leaves = triangles.len().div_ceil(LEAF_TRIANGLES).next_power_of_two();
        let mut rays =
            Rays { triangles, numbers, boxes: vec![[Vec3::INFINITY, Vec3::NEG_INFINITY]; 2 * leaves], leaves };
        let join = |a: [Vec3; 2], b: [Vec3; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        for leaf in 0..leaves {
            let bounds = rays.leaf(leaf).iter().map(Triangle::bounds).reduce(join);
            rays.boxes[leaves + leaf] = bounds.unwrap_or([Vec3::INFINITY, Vec3::NEG_INFINITY]);
        }
        for node in (1..leaves).rev() {
            rays.boxes[node] = join(rays.boxes[2 * node], rays.boxes[2 * node + 1]);
        }
        rays
    }

    fn leaf(&self, leaf: usize) -> &[Triangle] {
        &self.triangles[self.start(leaf)..self.start(leaf + 1)]
    }

    fn start(&self, leaf: usize) -> usize {
        leaf * self.triangles.len() / self.leaves
    }

    /// The number of the triangle that was hit.
    pub(crate) fn number(&self, hit: &Hit) -> usize {
        self.numbers[hit.place] as usize
    }

    /// The first surface that a ray meets nearer than `limit` lengths of its direction.
    pub(crate) fn first(&self, origin: Vec3, direction: Vec3, limit: f32) -> Option<Hit> {
        let inverse = direction.recip();
        let enters = |node: usize, limit: f32| {
            let [low, high] = self.boxes[node].map(|corner| (corner - origin) * inverse);
            let near = low.min(high).max_element().max(0.0);
            (near <= low.max(high).min_element().min(limit) * 1.000_001).then_some(near)
        };
        let mut nearest: Option<Hit> = None;
        let reach = |nearest: &Option<Hit>| nearest.map_or(limit, |hit| hit.distance);
        // Each level leaves at most one node waiting, and there are fewer than 32 levels.
        let mut waiting = [(0usize, 0.0f32); 32];
        let mut count = 0;
        let mut current = enters(1, limit).map(|_| 1);
        loop {
            while let Some(node) = current.take() {
                if node >= self.leaves {
                    let start = self.start(node - self.leaves);
                    for (place, triangle) in (start..).zip(self.leaf(node - self.leaves)) {
                        let hit = triangle.hit(origin, direction).filter(|hit| hit.distance < reach(&nearest));
                        nearest = hit.map(|hit| Hit { place, ..hit }).or(nearest);
                    }
                    break;
                }
                let (left, right) = (2 * node, 2 * node + 1);
                current = match (enters(left, reach(&nearest)), enters(right, reach(&nearest))) {
                    (Some(near), Some(far)) => {
                        let (first, later) = if near <= far { (left, (right, far)) } else { (right, (left, near)) };
                        waiting[count] = later;
                        count += 1;
                        Some(first)
                    }
                    (Some(_), None) => Some(left),
                    (None, Some(_)) => Some(right),
                    (None, None) => None,
                };
            }
            while current.is_none() && count > 0 {
                count -= 1;
                let (node, near) = waiting[count];
                current = (near < reach(&nearest)).then_some(node);
            }
            if current.is_none() {
                return nearest;
            }
        }
    }

    /// Whether nothing hides the front of `point` from `eye`.
    pub(super) fn sees(&self, eye: Vec3, point: &SurfacePoint) -> bool {
        let way = point.position - eye;
        way.dot(point.normal) < 0.0 && self.first(eye, way, 1.0 - POINT_TOLERANCE).is_none()
    }

    /// `count` points spread over all surfaces by area, in a fixed order; none if there is no area.
    pub(super) fn surface_points(&self, count: usize) -> Vec<SurfacePoint> {
        let mut sum = 0.0;
        let sums: Vec<f64> = self
            .triangles
            .iter()
            .map(|triangle| {
                sum += f64::from(triangle.cross().length());
                sum
            })
            .collect();
        if !(sum > 0.0 && sum.is_finite()) {
            return Vec::new();
        }
        let point = |number: usize| {
            let at = (number as f64 + 0.5) / count as f64 * sum;
            let index = sums.partition_point(|&end| end < at).min(sums.len() - 1);
            let triangle = &self.triangles[index];
            // A sequence that fills the unit square evenly, folded into the triangle below its diagonal.
            let [mut u, mut v] = [0.754_877_67, 0.569_840_29].map(|step: f64| (number as f64 * step).fract() as f32);
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let [a, b, c] = triangle.0;
            SurfacePoint { position: a + (b - a) * u + (c - a) * v, normal: triangle.cross() }
        };
        (0..count).map(point).collect()
    }
}

impl SurfacePoint {
    /// Whether it belongs to a level floor: its front looks up, within 8°.
    pub(super) fn is_floor(&self) -> bool {
        self.normal.normalize_or_zero().y > 0.99
    }

    /// Where it is.
    pub(super) fn position(&self) -> Vec3 {
        self.position
    }
}

fn triangles(scene: &Scene, bounds: &Bounds, radius: f64) -> Vec<Triangle> {
    let center = bounds.center();
    let count: u64 = scene.instances().iter().map(|it| scene.primitive(it).triangle_count() as u64).sum();
    let stride = count.div_ceil(MOST_TRIANGLES).max(1) as usize;
    let all = scene.instances().par_iter().flat_map_iter(|it| {
        scene.primitive(it).triangles().step_by(stride).map(move |triangle| {
            let world = triangle.map(|corner| it.world.transform_point3(Vec3::from(corner).as_dvec3()));
            let mut corners = world.map(|corner| ((corner - center) / radius).as_vec3());
            if it.flips_winding {
                corners.swap(1, 2);
            }
            Triangle(corners)
        })
    });
    all.collect()
}
