//! Points all over the surfaces, closer to each other than a spacing: the vertices of a tessellation of every triangle with a diffuse lobe
//! (glsl/particles/mesh_tessellation.glsl finds them by formula). Nothing is stored of a point, and of a triangle its cuts and the numbers that its points
//! begin with.
//!
//! A triangle is cut into 2^k rows that run along its shortest edge, its two others into as many parts: the corner A between these is row 0, the edge BC row
//! 2^k. Row r has ⌈r/2^(k−c)⌉ parts, so that BC has 2^c. k follows from the longest edge, c from the shortest: slender triangles get one row of
//! slender quads, not a square of the long edge's parts. All numbers of parts along edges are powers of two, so that of two triangles at an edge the one with
//! fewer parts uses points of the other.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::triangles::TracedTriangle;
use super::uploaded::WORDS;
use crate::graph::bindings::TexelBuffer;
use crate::graph::{Dependence, Graph, hash_of};

/// Parts of an edge at most, as a power of two.
const MOST_LEVEL: u32 = 12;
/// Points at most, but for those at corners: the longest triangles are cut less finely until there are no more.
const MOST_POINTS: u64 = 1 << 22;
/// Subtriangles on an area of a square of the spacing at most. Triangles whose least angle's sine is above ¼ stay below it.
const MOST_PER_SQUARE: f64 = 32.0;
/// Cosine between normals of flat triangles that share points.
const SAME_PLANE: f32 = 0.9999;
/// Words of a triangle's record.
const RECORD: usize = 12;
/// First word of the record of a triangle without points.
const NONE: u32 = u32::MAX;

/// The tessellation of all triangles.
pub(crate) struct Tessellation {
    /// Points; those of the two sides of a surface are two.
    pub(crate) point_count: u32,
    /// Subtriangles, side by side.
    pub(crate) subtriangle_count: u32,
    /// Triangles that are cut less finely than the spacing asks.
    pub(crate) coarser: u32,
    records: Arc<[u8]>,
    key: u64,
}

/// How a triangle is cut: rows and parts of the last row, as powers of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Cuts {
    rows: u32,
    across: u32,
}

impl Cuts {
    fn of(lengths: [f64; 3], area: f64, spacing: f64) -> Cuts {
        let level =
            |length: f64| (0..MOST_LEVEL).find(|level| length <= spacing * f64::from(1 << level)).unwrap_or(MOST_LEVEL);
        let rows = level(lengths[0].max(lengths[1]).max(lengths[2]));
        let most = MOST_PER_SQUARE * area / (spacing * spacing);
        let fits = |across: &u32| f64::from(1 << rows) * f64::from(1 << across) <= most;
        let across = level(lengths[0].min(lengths[1]).min(lengths[2]));
        Cuts { rows, across: (1..=across).rev().find(fits).unwrap_or(0) }
    }

    fn at_most(self, level: u32) -> Cuts {
        Cuts { rows: self.rows.min(level), across: self.across.min(level) }
    }

    /// Parts of the rows 1 to `row`.
    fn parts_until(self, row: u64) -> u64 {
        let shift = self.rows - self.across;
        let (whole, rest) = (row >> shift, row & ((1 << shift) - 1));
        ((whole * (whole + 1) / 2) << shift) + rest * (whole + 1)
    }

    fn row_count(self) -> u64 {
        1 << self.rows
    }

    fn inner_points(self) -> u64 {
        self.parts_until(self.row_count() - 1) - (self.row_count() - 1)
    }

    fn all_points(self) -> u64 {
        self.parts_until(self.row_count()) + self.row_count() + 1
    }

    fn subtriangles(self) -> u64 {
        self.parts_until(self.row_count() - 1) + self.parts_until(self.row_count())
    }
}

/// Corners of several triangles at one place with one normal, for surfaces of as many sides.
#[derive(Default)]
struct SharedCorners {
    /// The first one with this place, number of sides and vertex normal.
    first: HashMap<([u32; 3], u32, Option<u32>), u32>,
    /// Of each the plane, and the next one of flat triangles in another plane.
    all: Vec<(Vec3, Option<u32>)>,
}

impl SharedCorners {
    fn number(&mut self, place: Vec3, sides: u32, vertex_normal: Option<u32>, face: Vec3) -> u32 {
        // Zero has two signs.
        let key = ((place + Vec3::ZERO).to_array().map(f32::to_bits), sides, vertex_normal);
        let mut last = None;
        let mut next = self.first.get(&key).copied();
        while let Some(number) = next {
            let (normal, after) = self.all[number as usize];
            if vertex_normal.is_some() || normal.dot(face) > SAME_PLANE {
                return number;
            }
            (last, next) = (next, after);
        }
        let number = self.all.len() as u32;
        match last {
            Some(last) => self.all[last as usize].1 = Some(number),
            None => {
                self.first.insert(key, number);
            }
        }
        self.all.push((face, None));
        number
    }
}

/// A triangle that has points.
struct Cut {
    cuts: Cuts,
    sides: u32,
    /// The corner A among the triangle's own.
    apex: u32,
    /// Shared corners A, B, C.
    corners: [u32; 3],
    /// Edges AB, AC, BC.
    edges: [u32; 3],
}

/// Where points of corners and edges begin.
#[derive(Clone, Copy)]
struct Edge {
    level: u32,
    first: Option<u32>,
}

impl Tessellation {
    /// `sides`: of each material, those that have a diffuse lobe; triangles whose entry of `areas` is 0 have no points.
    pub(super) fn new(triangles: &[TracedTriangle], areas: &[f32], sides: &[u32], spacing: f64) -> Tessellation {
        let taking = |triangle: &TracedTriangle, area: f32| {
            if area > 0.0 && area.is_finite() { sides[triangle.material as usize] } else { 0 }
        };
        let shapes: Vec<Option<(Cuts, u32, u32)>> = triangles
            .iter()
            .zip(areas)
            .map(|(triangle, &area)| {
                let sides = taking(triangle, area);
                (sides > 0).then(|| {
                    let lengths = lengths(triangle);
                    let shortest = (0..3).min_by(|&a, &b| lengths[a].total_cmp(&lengths[b])).unwrap_or(0);
                    (Cuts::of(lengths, f64::from(area), spacing), sides, shortest as u32)
                })
            })
            .collect();
        let most = most_level(shapes.iter().flatten().map(|&(cuts, sides, _)| (cuts, sides)));
        let is_coarser = |(triangle, shape): &(&TracedTriangle, &Option<(Cuts, u32, u32)>)| {
            let fits = |length: f64, level: u32| length <= spacing * f64::from(1 << level.min(most));
            let lengths = lengths(triangle);
            let [least, longest] =
                [lengths.into_iter().fold(f64::INFINITY, f64::min), lengths.into_iter().fold(0.0, f64::max)];
            shape.is_some_and(|(cuts, ..)| !fits(longest, cuts.rows) || !fits(least, cuts.across))
        };
        let coarser = triangles.iter().zip(&shapes).filter(is_coarser).count();

        let mut corners = SharedCorners::default();
        let mut numbers: HashMap<[u32; 2], u32> = HashMap::new();
        let mut edges: Vec<Edge> = Vec::new();
        let cut = |(triangle, shape): (&TracedTriangle, &Option<(Cuts, u32, u32)>)| {
            let (cuts, sides, apex) = (*shape)?;
            let cuts = cuts.at_most(most);
            let face = triangle.normal().as_vec3();
            let corner = |offset: u32| {
                let own = ((apex + offset) % 3) as usize;
                corners.number(triangle.corners[own], sides, triangle.vertex_normal(own), face)
            };
            let corners = [0, 1, 2].map(corner);
            let [a, b, c] = corners;
            let edge = |(ends, level): ([u32; 2], u32)| {
                let [from, to] = ends;
                let number = *numbers.entry([from.min(to), from.max(to)]).or_insert_with(|| {
                    edges.push(Edge { level: 0, first: None });
                    edges.len() as u32 - 1
                });
                let known = &mut edges[number as usize];
                known.level = known.level.max(level);
                number
            };
            let edges = [([a, b], cuts.rows), ([a, c], cuts.rows), ([b, c], cuts.across)].map(edge);
            Some(Cut { cuts, sides, apex, corners, edges })
        };
        let cut: Vec<Option<Cut>> = triangles.iter().zip(&shapes).map(cut).collect();
        let mut numbered = Numbered { corners: vec![None; corners.all.len()], edges, points: 0, subtriangles: 0 };
        let mut words: Vec<[u32; RECORD]> = cut.iter().map(|cut| numbered.record(cut.as_ref())).collect();
        words.push(numbered.record(None));
        let records: Arc<[u8]> = bytemuck::cast_slice::<[u32; RECORD], u8>(&words).into();
        Tessellation {
            point_count: numbered.points,
            subtriangle_count: numbered.subtriangles,
            coarser: coarser as u32,
            key: hash_of(&("tessellation", &records)),
            records,
        }
    }

    /// The records, as kernels read them.
    pub(crate) fn texels(&self, graph: &mut Graph<'_>) -> TexelBuffer {
        let records = self.records.clone();
        graph.upload_shared::<u32>("traced.tessellation", records, self.key, Dependence::GEOMETRY).texels(WORDS)
    }
}

/// Numbers given so far.
struct Numbered {
    corners: Vec<Option<u32>>,
    edges: Vec<Edge>,
    points: u32,
    subtriangles: u32,
}

impl Numbered {
    /// The next triangle's record, as glsl/particles/mesh_tessellation.glsl reads it. Its points follow each other: of corners and edges that no triangle before
    /// it has, in the order of A, B, C, AB, AC, BC, then the inner ones, row by row.
    fn record(&mut self, cut: Option<&Cut>) -> [u32; RECORD] {
        let (first, first_subtriangle) = (self.points, self.subtriangles);
        let Some(&Cut { cuts, sides, apex, corners, edges }) = cut else {
            return [NONE, 0, 0, 0, 0, 0, 0, first, first_subtriangle, 0, 0, 0];
        };
        let Numbered { corners: known, edges: known_edges, points, .. } = self;
        let mut take = |count: u64| {
            let taken = *points;
            *points += sides * count as u32;
            taken
        };
        let mut packed = cuts.rows | cuts.across << 4 | apex << 29 | (sides - 1) << 31;
        let corner_points = [0, 1, 2].map(|place: usize| {
            let known = &mut known[corners[place] as usize];
            packed |= u32::from(known.is_none()) << (23 + place);
            *known.get_or_insert_with(|| take(1))
        });
        let [a, b, c] = corners;
        let backwards = [a > b, a > c, b > c];
        let edge_points = [0, 1, 2].map(|place: usize| {
            let edge = &mut known_edges[edges[place] as usize];
            let bits = edge.level << (8 + 4 * place) | u32::from(backwards[place]) << (20 + place);
            packed |= bits | u32::from(edge.first.is_none()) << (26 + place);
            *edge.first.get_or_insert_with(|| take((1 << edge.level) - 1))
        });
        take(cuts.inner_points());
        self.subtriangles += sides * cuts.subtriangles() as u32;
        let [ca, cb, cc] = corner_points;
        let [ab, ac, bc] = edge_points;
        [ca, cb, cc, ab, ac, bc, packed, first, first_subtriangle, 0, 0, 0]
    }
}

/// Of the edges opposite to corners 0, 1, 2.
fn lengths(triangle: &TracedTriangle) -> [f64; 3] {
    let [a, b, c] = triangle.corners.map(|corner| corner.as_dvec3());
    [(b, c), (c, a), (a, b)].map(|(from, to): (DVec3, DVec3)| from.distance(to))
}

/// The largest level at which all triangles together have no more than so many points.
fn most_level(shapes: impl Iterator<Item = (Cuts, u32)>) -> u32 {
    let mut kinds: HashMap<(u32, u32), u64> = HashMap::new();
    for (Cuts { rows, across }, sides) in shapes {
        *kinds.entry((rows, across)).or_default() += u64::from(sides);
    }
    let total = |level: &u32| {
        let points = |(&(rows, across), count): (_, &u64)| count * Cuts { rows, across }.at_most(*level).all_points();
        kinds.iter().map(points).sum::<u64>() <= MOST_POINTS
    };
    (1..=MOST_LEVEL).rev().find(total).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATERIAL_SIDES: [u32; 3] = [1, 2, 0];

    fn tessellated(triangles: &[TracedTriangle], spacing: f64) -> Tessellation {
        let areas: Vec<f32> = triangles.iter().map(|triangle| triangle.own_area).collect();
        Tessellation::new(triangles, &areas, &MATERIAL_SIDES, spacing)
    }

    /// A square grid of quads of 1 m, each of two triangles.
    fn grid(side: u8, material: u32) -> Vec<TracedTriangle> {
        let corner = |x: u8, z: u8| Vec3::new(f32::from(x), 0.0, f32::from(z));
        let cells = (0..side).flat_map(|x| (0..side).map(move |z| (x, z)));
        let halves = cells.flat_map(|(x, z)| {
            let [a, b, c, d] = [corner(x, z), corner(x, z + 1), corner(x + 1, z + 1), corner(x + 1, z)];
            [[a, b, c], [a, c, d]]
        });
        halves.map(|corners| TracedTriangle::flat(corners, material)).collect()
    }

    #[test]
    fn neighbours_share_their_points() {
        // Spacings at which diagonals of √2 m have as many parts as edges of 1 m.
        for (spacing, parts) in [(2.0, 1), (0.36, 4), (0.18, 8)] {
            for side in [1, 2, 5_u8] {
                let line = u32::from(side) * parts + 1;
                let cells = 2 * u32::from(side).pow(2) * parts.pow(2);
                let found = tessellated(&grid(side, 0), spacing);
                assert_eq!((found.point_count, found.subtriangle_count), (line * line, cells), "{spacing} {side}");
                let both = tessellated(&grid(side, 1), spacing);
                assert_eq!((both.point_count, both.subtriangle_count), (2 * line * line, 2 * cells));
                assert_eq!((found.coarser, both.coarser), (0, 0));
                let none = tessellated(&grid(side, 2), spacing);
                assert_eq!((none.point_count, none.subtriangle_count), (0, 0));
            }
        }
    }

    #[test]
    fn sharp_edges_share_nothing() {
        let corners = [Vec3::ZERO, Vec3::Z, Vec3::X, Vec3::Y];
        let [a, b, c, d] = corners;
        let folded = [[a, b, c], [b, a, d]].map(|corners| TracedTriangle::flat(corners, 0));
        assert_eq!(tessellated(&folded, 2.0).point_count, 6);
        let level = [[a, b, c], [b, a, -c]].map(|corners| TracedTriangle::flat(corners, 0));
        assert_eq!(tessellated(&level, 2.0).point_count, 4);
    }

    /// The edge of 4 m has 4 parts on one side; on the other side, that of a shorter triangle, 8.
    #[test]
    fn of_unequal_neighbours_the_finer_one_decides() {
        let [a, b] = [Vec3::ZERO, Vec3::new(0.0, 0.0, 4.0)];
        let (near, far) = (Vec3::new(1.0, 0.0, 2.0), Vec3::new(-7.5, 0.0, 2.0));
        let both = [[a, b, near], [b, a, far]].map(|corners| TracedTriangle::flat(corners, 0));
        let cuts = |number: usize| Cuts::of(lengths(&both[number]), f64::from(both[number].own_area), 1.0);
        assert_eq!((cuts(0), cuts(1)), (Cuts { rows: 2, across: 2 }, Cuts { rows: 3, across: 2 }));
        let alone: u64 = [0, 1].map(|number| cuts(number).all_points()).iter().sum();
        assert_eq!(u64::from(tessellated(&both, 1.0).point_count), alone - 5);
    }

    #[test]
    fn points_grow_with_area_and_length_alone() {
        let triangle = |corners: [[f32; 3]; 3]| TracedTriangle::flat(corners.map(Vec3::from), 0);
        let skirting = triangle([[0.0; 3], [10.0, 0.0, 0.0], [10.0, 0.01, 0.0]]);
        let flattened = triangle([[0.0; 3], [10.0, 0.0, 0.0], [5.0, 0.01, 0.0]]);
        for (what, sliver) in [("skirting", skirting), ("flattened", flattened)] {
            let found = tessellated(&[sliver], 0.05);
            assert!((200..1200).contains(&found.point_count), "{what}: {}", found.point_count);
        }
        let degenerate = triangle([[0.0; 3], [10.0, 0.0, 0.0], [5.0, 0.0, 0.0]]);
        assert_eq!(tessellated(&[degenerate], 0.05).point_count, 0);
    }

    #[test]
    fn what_is_huge_is_cut_less_finely_and_says_so() {
        let mut triangles = grid(4, 0);
        let alone = tessellated(&triangles, 0.1);
        let far = |x: f32, z: f32| Vec3::new(x, -1.0, z) * 1000.0;
        triangles.push(TracedTriangle::flat([far(0.0, 0.0), far(0.0, 1.0), far(1.0, 1.0)], 0));
        let found = tessellated(&triangles, 0.1);
        assert_eq!((alone.coarser, found.coarser), (0, 1));
        let added = found.point_count - alone.point_count;
        assert!((1 << 19..1 << 22).contains(&added), "{added}");
    }
}
