//! The texels of a surface: the nodes of a lattice over its rectangle, from border to border, so that light is interpolated up to its edges. A node beside the
//! triangles lies on the point of these that is nearest to it.

use glam::DVec2;

use super::super::triangles::TracedTriangle;
use super::charts::Chart;

/// Nodes of borders lie this far inside, in texels: what stands on the edge is not met.
const INSET: f64 = 0.1;
/// A side shorter than this, in texels, has one node, in its middle.
const LEAST: f64 = 0.35;
/// Nodes farther from all triangles, in texels, are in no cell that shows some of the surface.
const FARTHEST: f64 = 1.5;

/// Cells along an axis at most: whoever asks for finer ones takes larger ones in the end.
const MOST_CELLS: f64 = 16_777_216.0;

/// Parts of a triangle on a texel's area, and along its edges at most.
const PARTS: f64 = 16.0;
const MOST_PARTS: f64 = 2048.0;

/// Cells along both axes, and their sizes.
#[derive(Clone, Copy)]
pub(super) struct Lattice {
    pub(super) cells: [u32; 2],
    /// m
    step: DVec2,
}

/// Where a node lies: its triangle, and the weights of corners 1 and 2.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) triangle: u32,
    pub(super) place: [f32; 2],
}

impl Lattice {
    pub(super) fn of(chart: &Chart, texel: f64) -> Lattice {
        let cells = chart.extent.to_array().map(|extent| {
            let count = extent / texel;
            if count < LEAST { 0 } else { (count - 1e-3).ceil().clamp(1.0, MOST_CELLS) as u32 }
        });
        let step = |axis: usize| match cells[axis] {
            0 => chart.extent[axis].max(1e-30),
            count => chart.extent[axis] / f64::from(count),
        };
        Lattice { cells, step: DVec2::new(step(0), step(1)) }
    }

    pub(super) fn size(&self) -> [u32; 2] {
        self.cells.map(|cells| cells + 1)
    }

    pub(super) fn node_count(&self) -> u64 {
        self.size().into_iter().map(u64::from).product()
    }

    /// The larger size of a cell, m.
    pub(super) fn texel(&self) -> f64 {
        self.step.max_element()
    }

    /// The corners of a triangle in texels.
    fn corners(&self, chart: &Chart, triangle: &TracedTriangle) -> [DVec2; 3] {
        triangle.corners.map(|corner| chart.place(corner.as_dvec3()) / self.step)
    }

    /// The same as they are looked up: along an axis with one node there is nothing to tell apart.
    pub(super) fn coordinates(&self, chart: &Chart, triangle: &TracedTriangle) -> [[f32; 2]; 3] {
        self.corners(chart, triangle)
            .map(|corner| [0, 1].map(|axis| if self.cells[axis] == 0 { 0.0 } else { corner[axis] as f32 }))
    }

    /// How much of the surface is nearest to each node, m²: small equal parts of each triangle go to the nodes that their middles are nearest to.
    pub(super) fn areas(&self, chart: &Chart, all: &[TracedTriangle]) -> Vec<f32> {
        let [width, height] = self.size();
        let mut areas = vec![0.0; (width * height) as usize];
        let cell = self.step.element_product();
        for &number in &chart.triangles {
            let triangle = &all[number as usize];
            let coordinates = self.coordinates(chart, triangle);
            let [a, b, c] = coordinates.map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)));
            let parts = (PARTS * triangle.area() / cell).sqrt().ceil().clamp(2.0, MOST_PARTS) as u32;
            let area = triangle.area() / f64::from(parts * parts);
            let mut take = |row: u32, column: u32, third: f64| {
                let place = (DVec2::new(f64::from(column), f64::from(row)) + third) / f64::from(parts);
                let at = a + (b - a) * place.x + (c - a) * place.y;
                let index = |axis: usize, count: u32| ((at[axis] + 0.5).max(0.0) as u32).min(count - 1);
                areas[(index(1, height) * width + index(0, width)) as usize] += area;
            };
            for row in 0..parts {
                for column in 0..parts - row {
                    take(row, column, 1.0 / 3.0);
                    if column + row + 1 < parts {
                        take(row, column, 2.0 / 3.0);
                    }
                }
            }
        }
        areas.into_iter().map(|area| area as f32).collect()
    }

    /// The nodes, row by row; `None` where no cell around shows any of the surface.
    pub(super) fn nodes(&self, chart: &Chart, all: &[TracedTriangle]) -> Vec<Option<Node>> {
        let [width, height] = self.size();
        let target = |x: u32, y: u32| {
            let along = |axis: usize, number: u32| match self.cells[axis] {
                0 => 0.5,
                count => f64::from(number).clamp(INSET, f64::from(count) - INSET),
            };
            DVec2::new(along(0, x), along(1, y))
        };
        let mut nearest = vec![(f64::INFINITY, None); (width * height) as usize];
        for &number in &chart.triangles {
            let corners = self.corners(chart, &all[number as usize]);
            let low = corners.into_iter().fold(DVec2::INFINITY, DVec2::min) - FARTHEST;
            let high = corners.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max) + FARTHEST;
            let range = |axis: usize, count: u32| {
                let end =
                    if self.cells[axis] == 0 { 1 } else { (high[axis].max(-1.0).floor() as i64 + 1).max(0) as u32 };
                (low[axis].ceil().max(0.0) as u32).min(count)..end.min(count)
            };
            for y in range(1, height) {
                for x in range(0, width) {
                    let point = target(x, y);
                    let place = nearest_place(corners, point);
                    let distance2 = point_at(corners, place).distance_squared(point);
                    let known = &mut nearest[(y * width + x) as usize];
                    if distance2 < known.0 {
                        let place = if distance2 > 1e-12 { nudged(corners, place) } else { place };
                        *known =
                            (distance2, Some(Node { triangle: number, place: place.to_array().map(|w| w as f32) }));
                    }
                }
            }
        }
        nearest.into_iter().map(|(distance2, node)| node.filter(|_| distance2 <= FARTHEST * FARTHEST)).collect()
    }
}

fn point_at([a, b, c]: [DVec2; 3], place: DVec2) -> DVec2 {
    a + (b - a) * place.x + (c - a) * place.y
}

/// Away from the triangle's edge, by the inset.
fn nudged(corners: [DVec2; 3], place: DVec2) -> DVec2 {
    let middle = DVec2::splat(1.0 / 3.0);
    let way = point_at(corners, middle).distance(point_at(corners, place));
    place.lerp(middle, (INSET / way.max(1e-9)).min(0.5))
}

/// The weights of corners 1 and 2 of the point of a triangle that is nearest to another one.
fn nearest_place([a, b, c]: [DVec2; 3], point: DVec2) -> DVec2 {
    let [ab, ac, ap] = [b - a, c - a, point - a];
    let area = ab.perp_dot(ac);
    if area.abs() > 1e-20 {
        let place = DVec2::new(ap.perp_dot(ac), ab.perp_dot(ap)) / area;
        if place.min_element() >= 0.0 && place.x + place.y <= 1.0 {
            return place;
        }
    }
    let on_edge = |from: DVec2, to: DVec2| {
        let way = to - from;
        ((point - from).dot(way) / way.length_squared().max(1e-30)).clamp(0.0, 1.0)
    };
    let [first, second, third] = [on_edge(a, b), on_edge(a, c), on_edge(b, c)];
    let edges = [DVec2::new(first, 0.0), DVec2::new(0.0, second), DVec2::new(1.0 - third, third)];
    let distance = |place: &DVec2| point_at([a, b, c], *place).distance_squared(point);
    edges.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_place_is_the_nearest() {
        let corners = [DVec2::new(0.3, 0.1), DVec2::new(4.0, 1.0), DVec2::new(-1.0, 3.0)];
        for number in 0..400 {
            let point = DVec2::new(f64::from(number % 20) - 8.0, f64::from(number / 20) - 8.0) * 0.7;
            let found = point_at(corners, nearest_place(corners, point)).distance(point);
            let steps = 0..=60;
            let tried = steps.clone().flat_map(|u| steps.clone().map(move |v| (u, v))).filter(|(u, v)| u + v <= 60);
            let distances =
                tried.map(|(u, v)| point_at(corners, DVec2::new(f64::from(u), f64::from(v)) / 60.0).distance(point));
            let least = distances.fold(f64::INFINITY, f64::min);
            assert!(found <= least + 1e-12 && found >= least - 0.1, "{point}: {found} {least}");
        }
    }
}
