//! The test of a triangle against a box by all thirteen separating axes, both sides of each, in whole numbers of 64 bits.

type Point = [i64; 3];

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

fn dot(a: Point, b: Point) -> i64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Whether a triangle touches the closed box from `low`, of this size.
pub(super) fn touches(corners: [Point; 3], low: Point, size: i64) -> bool {
    let [a, b, c] = corners;
    let edges = [minus(b, a), minus(c, b), minus(a, c)];
    let axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let crosses = edges.iter().flat_map(|&edge| axes.map(|axis| cross(edge, axis)));
    axes.into_iter().chain(crosses).chain([cross(edges[0], edges[1])]).all(|along| {
        let of_corners = corners.map(|corner| dot(along, corner));
        let from = dot(along, low) + (0..3).map(|axis| size * along[axis].min(0)).sum::<i64>();
        let to = dot(along, low) + (0..3).map(|axis| size * along[axis].max(0)).sum::<i64>();
        of_corners.into_iter().max() >= Some(from) && of_corners.into_iter().min() <= Some(to)
    })
}

/// One for each voxel that one of the triangles touches.
pub(super) fn voxels_of(triangles: &[[Point; 3]], dims: [usize; 3], units: i64) -> Vec<bool> {
    let mut bits = vec![false; dims.iter().product()];
    for corners in triangles {
        let span = |axis: usize| {
            let of_axis = corners.map(|corner| corner[axis] / units);
            of_axis.into_iter().min().unwrap_or(0)..=of_axis.into_iter().max().unwrap_or(0)
        };
        for (z, y, x) in span(2).flat_map(|z| span(1).flat_map(move |y| span(0).map(move |x| (z, y, x)))) {
            if touches(*corners, [x * units, y * units, z * units], units) {
                bits[(z as usize * dims[1] + y as usize) * dims[0] + x as usize] = true;
            }
        }
    }
    bits
}
