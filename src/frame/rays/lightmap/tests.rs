//! Surfaces and their texels.

use glam::Vec3;

use super::charts::charts;
use super::lattice::Lattice;
use super::*;

/// A fan of flat triangles around corners, in their order.
fn quad(corners: [Vec3; 4]) -> [TracedTriangle; 2] {
    let [a, b, c, d] = corners;
    [TracedTriangle::flat([a, b, c], 0), TracedTriangle::flat([a, c, d], 0)]
}

fn floor(width: f32, depth: f32) -> [TracedTriangle; 2] {
    quad([Vec3::ZERO, Vec3::new(0.0, 0.0, depth), Vec3::new(width, 0.0, depth), Vec3::new(width, 0.0, 0.0)])
}

#[test]
fn surfaces_end_at_creases_and_gaps() {
    let mut all = floor(2.0, 1.0).to_vec();
    all.extend(quad([Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), Vec3::new(2.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)]));
    all.extend(
        floor(2.0, 1.0)
            .map(|triangle| TracedTriangle::flat(triangle.corners.map(|corner| corner + Vec3::new(2.5, 0.0, 0.0)), 0)),
    );
    let found = charts(&all, 0..6, |_| 1);
    let mut triangles: Vec<Vec<u32>> = found.iter().map(|chart| chart.triangles.clone()).collect();
    triangles.iter_mut().for_each(|chart| chart.sort_unstable());
    triangles.sort();
    assert_eq!(triangles, [[0, 1], [2, 3], [4, 5]]);
}

/// The rectangle lies along the sides, not along the diagonal, and its texels reach from border to border.
#[test]
fn a_rectangle_is_covered_from_border_to_border() {
    let all = floor(2.0, 1.0);
    let chart = &charts(&all, 0..2, |_| 1)[0];
    assert!((chart.extent.element_product() - 2.0).abs() < 1e-6, "{}", chart.extent);
    let lattice = Lattice::of(chart, 0.25);
    let mut cells = lattice.cells;
    cells.sort_unstable();
    assert_eq!(cells, [4, 8]);
    let nodes = lattice.nodes(chart, &all);
    assert_eq!(nodes.len(), 45);
    for (number, node) in nodes.iter().enumerate() {
        let node = node.expect("on the rectangle");
        let corners = lattice.coordinates(chart, &all[node.triangle as usize]);
        let [u, v] = node.place;
        let at = [0, 1].map(|axis| {
            corners[0][axis] + u * (corners[1][axis] - corners[0][axis]) + v * (corners[2][axis] - corners[0][axis])
        });
        let expected = [number % lattice.size()[0] as usize, number / lattice.size()[0] as usize];
        for axis in 0..2 {
            assert!((at[axis] - expected[axis] as f32).abs() < 0.11, "{number}: {at:?}");
        }
    }
}

/// Of a triangle whose rectangle is half empty, and of a rectangle: areas add up, and inner texels have that of a cell.
#[test]
fn areas_are_those_of_the_surface() {
    let all = [floor(2.0, 1.0).to_vec(), floor(1.0, 1.0)[..1].to_vec()];
    for (all, expected) in all.iter().zip([2.0_f32, 0.5]) {
        let chart = &charts(all, 0..all.len(), |_| 1)[0];
        let lattice = Lattice::of(chart, 0.25);
        let areas = lattice.areas(chart, all);
        let sum: f32 = areas.iter().sum();
        assert!((sum / expected - 1.0).abs() < 1e-4, "{sum}");
        let cell = 0.25 * 0.25;
        let largest = areas.iter().copied().fold(0.0, f32::max);
        assert!((largest / cell - 1.0).abs() < 0.2, "{largest} {cell}");
    }
}

#[test]
fn what_is_smaller_than_a_texel_has_one() {
    let all = floor(0.02, 0.01);
    let chart = &charts(&all, 0..2, |_| 1)[0];
    let lattice = Lattice::of(chart, 1.0);
    assert_eq!(lattice.size(), [1, 1]);
    let node = lattice.nodes(chart, &all)[0].expect("in its middle");
    let [a, b, c] = all[node.triangle as usize].corners;
    let place = a + (b - a) * node.place[0] + (c - a) * node.place[1];
    assert!(place.distance(Vec3::new(0.01, 0.0, 0.005)) < 1e-4, "{place}");
    assert_eq!(lattice.coordinates(chart, &all[0]), [[0.0; 2]; 3]);
}

#[test]
fn both_sides_have_texels_where_both_are_seen() {
    let all = floor(2.0, 1.0);
    let parts: Vec<Part> = Vec::new();
    let of = |sides: &[u32], backs: &[u32], areas: &[f32]| {
        let taking = Taking { sides, backs, areas };
        (0..2).map(|number| taking.sides(&all, number)).collect::<Vec<u32>>()
    };
    assert_eq!(of(&[1], &[], &[1.0, 1.0]), [1, 1]);
    assert_eq!(of(&[1], &[0b10], &[1.0, 1.0]), [1, 2]);
    assert_eq!(of(&[2], &[0b11], &[1.0, 0.0]), [2, 0]);
    assert_eq!(of(&[0], &[0b11], &[1.0, 1.0]), [0, 0]);
    let taking = Taking { sides: &[1], backs: &[], areas: &[1.0, 1.0] };
    assert_eq!(Lightmap::new(&all, &parts, &taking, Texels { size: 0.0, count: 100, most: 1000 }).count, 0);
}

/// However fine texels are asked for, there are no more than there may be.
#[test]
fn texels_are_no_more_than_there_may_be() {
    let all = floor(200.0, 100.0);
    let found = charts(&all, 0..2, |_| 2);
    for (size, count) in [(1e-9, 1), (1e-5, 1), (0.5, 1), (0.0, 1_000_000), (0.0, 4000)] {
        for most in [500, 4_194_304] {
            let texels = Texels { size, count, most };
            let lattices = found.iter().zip(sizes(&found, &all, texels));
            let made: u64 = lattices.map(|(chart, size)| 2 * Lattice::of(chart, size).node_count()).sum();
            assert!(made <= u64::from(most), "{texels:?}: {made}");
            assert!(made > u64::from(most) / 4 || made > u64::from(count) / 2, "{texels:?}: {made}");
        }
    }
}
