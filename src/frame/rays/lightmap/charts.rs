//! Surfaces for light maps: connected triangles of one primitive whose normals are similar, each with a rectangle around it in a plane.

use std::collections::{HashMap, VecDeque};
use std::ops::Range;

use glam::{DVec2, DVec3};

use super::super::triangles::TracedTriangle;

/// Cosine between a surface's normals and that of the triangle it grew from: of triangles with vertex normals, and of flat ones.
const SMOOTH: f64 = 0.75;
const FLAT: f64 = 0.97;
/// Triangles whose edges are tried as directions of the rectangle.
const DIRECTIONS: usize = 32;

/// One surface.
pub(super) struct Chart {
    /// Numbers among all triangles.
    pub(super) triangles: Vec<u32>,
    /// 2: its back has light of its own.
    pub(super) sides: u32,
    axes: [DVec3; 2],
    low: DVec2,
    /// m
    pub(super) extent: DVec2,
}

impl Chart {
    fn new(triangles: Vec<u32>, all: &[TracedTriangle], sides: u32) -> Chart {
        let of = |number: &u32| &all[*number as usize];
        let normal: DVec3 = triangles.iter().map(|number| of(number).normal() * of(number).area()).sum();
        let normal = normal.normalize_or(of(&triangles[0]).normal());
        let corners = || triangles.iter().flat_map(|number| of(number).corners).map(glam::Vec3::as_dvec3);
        let fitted = |along: DVec3| {
            let u = (along - normal * along.dot(normal)).normalize_or_zero();
            let axes = [u, normal.cross(u)];
            let start = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            let (low, high) = corners()
                .map(|corner| placed(&axes, corner))
                .fold(start, |(low, high), place| (low.min(place), high.max(place)));
            (axes, low, high - low)
        };
        let mut best = fitted(normal.any_orthonormal_vector());
        for number in triangles.iter().take(DIRECTIONS) {
            let [a, b, c] = of(number).corners.map(glam::Vec3::as_dvec3);
            for edge in [b - a, c - b, a - c] {
                let found = fitted(edge);
                let smaller = found.2.element_product() < 0.999 * best.2.element_product();
                if found.0[0] != DVec3::ZERO && smaller {
                    best = found;
                }
            }
        }
        let (axes, low, extent) = best;
        Chart { triangles, sides, axes, low, extent }
    }

    /// A point in the rectangle, m.
    pub(super) fn place(&self, point: DVec3) -> DVec2 {
        placed(&self.axes, point) - self.low
    }
}

fn placed(axes: &[DVec3; 2], point: DVec3) -> DVec2 {
    DVec2::new(axes[0].dot(point), axes[1].dot(point))
}

/// The surfaces of a primitive. `sides` of a triangle that takes light: 1 or 2.
pub(super) fn charts(all: &[TracedTriangle], range: Range<usize>, sides: impl Fn(usize) -> u32) -> Vec<Chart> {
    let taking: Vec<u32> = range.filter(|&number| sides(number) > 0).map(|number| number as u32).collect();
    let edges = Edges::of(all, &taking);
    let mut order: Vec<usize> = (0..taking.len()).collect();
    let area = |place: &usize| all[taking[*place] as usize].area();
    order.sort_by(|a, b| area(b).total_cmp(&area(a)));
    let mut taken = vec![false; taking.len()];
    let mut found = Vec::new();
    for seed in order {
        if taken[seed] {
            continue;
        }
        taken[seed] = true;
        let normal = all[taking[seed] as usize].normal();
        let mut triangles = Vec::new();
        let mut waiting = VecDeque::from([seed]);
        while let Some(place) = waiting.pop_front() {
            triangles.push(taking[place]);
            for next in edges.beside(place) {
                let triangle = &all[taking[next] as usize];
                let least = if triangle.vertex_normal(0).is_some() { SMOOTH } else { FLAT };
                if !taken[next] && triangle.normal().dot(normal) > least {
                    taken[next] = true;
                    waiting.push_back(next);
                }
            }
        }
        let sides = sides(triangles[0] as usize);
        found.push(Chart::new(triangles, all, sides));
    }
    found
}

/// Which triangles share edges: corners at the same place are one.
struct Edges {
    /// Of each triangle.
    edges: Vec<[u32; 3]>,
    /// Of each edge the first of its triangles in `triangles`.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Edges {
    fn of(all: &[TracedTriangle], taking: &[u32]) -> Edges {
        let mut corners: HashMap<[u32; 3], u32> = HashMap::new();
        let mut numbers: HashMap<[u32; 2], u32> = HashMap::new();
        let mut counts: Vec<u32> = Vec::new();
        let edges: Vec<[u32; 3]> = taking
            .iter()
            .map(|number| {
                let vertices = all[*number as usize].corners.map(|corner| {
                    let count = corners.len() as u32;
                    // Zero has two signs.
                    *corners.entry((corner + glam::Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(count)
                });
                [[0, 1], [1, 2], [2, 0]].map(|ends| {
                    let [a, b] = ends.map(|end| vertices[end]);
                    let count = numbers.len() as u32;
                    let edge = *numbers.entry([a.min(b), a.max(b)]).or_insert(count);
                    counts.resize(numbers.len(), 0);
                    counts[edge as usize] += 1;
                    edge
                })
            })
            .collect();
        let mut starts = vec![0; counts.len() + 1];
        for (edge, count) in counts.iter().enumerate() {
            starts[edge + 1] = starts[edge] + count;
        }
        let mut free = starts.clone();
        let mut triangles = vec![0; 3 * taking.len()];
        for (place, own) in edges.iter().enumerate() {
            for edge in own {
                triangles[free[*edge as usize] as usize] = place as u32;
                free[*edge as usize] += 1;
            }
        }
        Edges { edges, starts, triangles }
    }

    fn beside(&self, place: usize) -> impl Iterator<Item = usize> + '_ {
        let of_edge = |edge: u32| {
            let [first, end] = [edge, edge + 1].map(|edge| self.starts[edge as usize] as usize);
            self.triangles[first..end].iter().map(|&place| place as usize)
        };
        self.edges[place].into_iter().flat_map(of_edge)
    }
}
