//! The bounding volume hierarchy that shaders trace rays through (`glsl/lib/bvh.glsl`), as two lists of texels.
//!
//! Eight-wide nodes with quantised boxes: Ylitie, Karras & Laine, *Efficient Incoherent Ray Traversal on GPUs Through Compressed
//! Wide BVHs*, 2017, as `obvhs` builds them: PLOC++ with pre-split large triangles and reinsertion, collapsed by surface area.
//! A node takes five texels of four words:
//!
//! | texel | words |
//! |---|---|
//! | 0 | lowest corner x, y, z (f32); biased exponents of the grid's steps along x, y, z and a bit for each slot with a node, a byte each |
//! | 1 | first child node; first triangle; a byte for each of the eight slots (below) |
//! | 2, 3, 4 | along x, y, z: eight lower bounds, eight upper bounds, a byte each, in steps from the corner |
//!
//! A slot's byte: 0 is empty; `001` and 24 + the slot is a node; else the top three bits have a 1 for each triangle, and the
//! lower five say where they start.

use glam::{DVec3, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::splits::split_aabbs_preset;
use obvhs::triangle::Triangle;

#[cfg(test)]
use super::Scene;

/// Levels of the deepest tree that the shader's stack holds: its `BVH_STACK_SIZE`.
const DEEPEST: usize = 32;
/// Levels of the deepest binary tree that is collapsed; that recurses.
const DEEPEST_BINARY: usize = 512;
/// Triangles with a coordinate beyond this, in metres, are left out: squares of areas would overflow.
const FARTHEST: f32 = 1e15;
/// Over a triangle's size: a thousand times what rounding makes of a hit that is not grazing.
const DOUBTFUL: f32 = 1.0 / 256.0;
const TRIANGLES_A_LEAF: u32 = 3;
/// Share of the nodes that the optimiser tries to place better. More costs seconds and gains nothing measurable.
const REINSERTED: f32 = 0.1;

/// A triangle to trace rays against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BvhTriangle {
    /// In render space, metres.
    pub(crate) corners: [[f32; 3]; 3],
    /// Bit 0: hits count only where the shader's `accepts_hit` says so (alpha masks).
    pub(crate) flags: u32,
}

impl BvhTriangle {
    /// n·x of its points, m, with the normal n = (b − a)×(c − a) of length 1 that its corners have in doubles.
    pub(crate) fn plane(&self) -> f32 {
        let [a, b, c] = self.corners.map(|corner| Vec3::from(corner).as_dvec3());
        (b - a).cross(c - a).normalize_or(DVec3::Z).dot(a) as f32
    }

    /// Exponent bits of a float: how near one of its ends a ray may meet the triangle, metres, before rounding of the corners is worth a look. A share of
    /// its size, since what is seen from farther away than that is also met farther away.
    fn doubtful(&self) -> u32 {
        let [a, b, c] = self.corners.map(Vec3::from);
        let size = (b - a).abs().max((c - a).abs()).max_element();
        (size * DOUBTFUL).to_bits() & 0x7F80_0000
    }

    /// As it stands in [`Bvh::triangles`]; `number`: its index in the list.
    pub(super) fn texels(&self, number: u32) -> [[f32; 4]; 3] {
        let words = [number, self.flags | self.doubtful(), self.plane().to_bits()];
        [0, 1, 2].map(|corner| {
            let [x, y, z] = self.corners[corner];
            [x, y, z, f32::from_bits(words[corner])]
        })
    }

    /// Whether it is, to the bit, what these texels hold.
    pub(super) fn is_held_by(&self, texels: &[[f32; 4]]) -> bool {
        let corners = self.corners.iter().zip(texels).all(|(corner, texel)| corner[..] == texel[..3]);
        corners && texels[1][3].to_bits() & 0x807F_FFFF == self.flags
    }
}

/// The hierarchy as the shader reads it.
#[derive(Clone)]
pub(crate) struct Bvh {
    /// For a `usamplerBuffer` of format rgba32ui, five texels a node, and one whose first word says how far rays start from surfaces at least. The root is node 0; there is always one.
    pub(crate) nodes: Vec<[u32; 4]>,
    /// For a `samplerBuffer` of format rgba32f, three texels a triangle in the order of the leaves: corners 0, 1, 2, with the bits
    /// of the triangle's index in the list, of its flags with [`BvhTriangle::doubtful`], and the distance of its plane from the origin as their
    /// fourth components. A split triangle stands there more
    /// than once. Never empty.
    pub(crate) triangles: Vec<[f32; 4]>,
}

impl Bvh {
    /// The hierarchy of a list of triangles. Triangles without area and those that are not finite are left out. Equal lists give
    /// equal bits.
    pub(crate) fn build(triangles: &[BvhTriangle]) -> Bvh {
        Bvh::build_within(triangles, DEEPEST)
    }

    /// The same with a tree of medians if the better one has more than `deepest` levels.
    pub(crate) fn build_within(triangles: &[BvhTriangle], deepest: usize) -> Bvh {
        let (numbers, sound): (Vec<u32>, Vec<Triangle>) = (0..)
            .zip(triangles)
            .filter(|(_, triangle)| can_be_hit(triangle))
            .map(|(number, triangle)| {
                let [v0, v1, v2] = triangle.corners.map(Vec3A::from);
                (number, Triangle { v0, v1, v2 })
            })
            .unzip();
        if sound.is_empty() {
            return Bvh { nodes: vec![[0; 4]; 6], triangles: vec![[0.0; 4]; 3] };
        }
        let tree = wide(&sound, deepest);
        let texels = tree.primitive_indices.iter().flat_map(|&place| {
            let number = numbers[place as usize];
            triangles[number as usize].texels(number)
        });
        let mut bvh = Bvh { triangles: texels.collect(), nodes: bytemuck::cast_slice(&tree.nodes).to_vec() };
        let corners = || triangles.iter().filter(|triangle| can_be_hit(triangle)).flat_map(|triangle| triangle.corners);
        let [low, high] = [f32::min as fn(f32, f32) -> f32, f32::max].map(|join| {
            corners().map(Vec3::from).reduce(|a, b| Vec3::from_array([0, 1, 2].map(|axis| join(a[axis], b[axis]))))
        });
        let extent = low.zip(high).map_or(0.0, |(low, high)| (high - low).max_element());
        bvh.nodes.push([(extent / (1 << 17) as f32).to_bits(), 0, 0, 0]);
        bvh
    }

    /// Sets how far rays start from surfaces at least, metres.
    pub(crate) fn set_least_offset(&mut self, least: f32) {
        if let Some(last) = self.nodes.last_mut() {
            *last = [least.to_bits(), 0, 0, 0];
        }
    }

    /// All triangles of a scene, in the order of its instances and their indices, around `origin`, in metres.
    ///
    /// Corners keep the order of the indices, also where an instance mirrors its mesh. `flags` gives those of an instance.
    #[cfg(test)]
    pub(crate) fn triangles_of(
        scene: &Scene,
        origin: DVec3,
        flags: impl Fn(&super::Instance) -> u32,
    ) -> Vec<BvhTriangle> {
        let of_instance = |instance: &super::Instance| {
            let flags = flags(instance);
            let world = instance.world;
            scene
                .primitive(instance)
                .triangles()
                .map(move |triangle| {
                    let place = |corner| (world.transform_point3(Vec3::from(corner).as_dvec3()) - origin).as_vec3();
                    BvhTriangle { corners: triangle.map(|corner| place(corner).to_array()), flags }
                })
                .collect::<Vec<_>>()
        };
        scene.instances().iter().flat_map(of_instance).collect()
    }
}

/// Whether it has an area, and lies where areas can be reckoned with.
pub(crate) fn can_be_hit(triangle: &BvhTriangle) -> bool {
    let [a, b, c] = triangle.corners.map(|corner| Vec3::from(corner).as_dvec3());
    let in_reach = triangle.corners.iter().flatten().all(|axis| axis.abs() <= FARTHEST);
    in_reach && (b - a).cross(c - a) != DVec3::ZERO
}

fn wide(triangles: &[Triangle], deepest: usize) -> CwBvh {
    let (boxes, numbers) = split_boxes(triangles);
    let mut tree = PlocBuilder::with_capacity(boxes.len()).build(
        PlocSearchDistance::Medium,
        &boxes,
        numbers.clone(),
        SortPrecision::U64,
        3,
    );
    tree.uses_spatial_splits = true;
    ReinsertionOptimizer::default().run(&mut tree, REINSERTED, None);
    if binary_depth(&tree.nodes) <= DEEPEST_BINARY {
        let wide = bvh2_to_cwbvh(&tree, TRIANGLES_A_LEAF, true, false);
        if depth(&wide) <= deepest {
            return wide;
        }
    }
    bvh2_to_cwbvh(&balanced(&boxes, &numbers), TRIANGLES_A_LEAF, true, false)
}

/// Boxes of the triangles, several for large slanted ones, with the number of the triangle that each belongs to.
fn split_boxes(triangles: &[Triangle]) -> (Vec<Aabb>, Vec<u32>) {
    let whole: Vec<Aabb> =
        triangles.iter().map(|triangle| Aabb::from_points(&[triangle.v0, triangle.v1, triangle.v2])).collect();
    let areas = || whole.iter().map(Aabb::half_area);
    let mean = areas().sum::<f32>() / whole.len() as f32;
    let mut boxes = whole.clone();
    let mut numbers: Vec<u32> = (0..).take(whole.len()).collect();
    split_aabbs_preset(&mut boxes, &mut numbers, triangles, mean, areas().fold(0.0, f32::max));
    for (part, &number) in boxes.iter_mut().zip(&numbers) {
        // Clipping rounds: the parts must not leave a gap.
        let whole = &whole[number as usize];
        let rounding = 1e-6 * whole.min.abs().max(whole.max.abs());
        part.min = (part.min - rounding).max(whole.min);
        part.max = (part.max + rounding).min(whole.max);
    }
    (boxes, numbers)
}

fn binary_depth(nodes: &[Bvh2Node]) -> usize {
    let mut deepest = 0;
    let mut waiting = vec![(0, 1)];
    while let Some((node, depth)) = waiting.pop() {
        deepest = deepest.max(depth);
        let node = &nodes[node];
        if node.prim_count == 0 {
            let child = node.first_index as usize;
            waiting.extend([(child, depth + 1), (child + 1, depth + 1)]);
        }
    }
    deepest
}

fn depth(tree: &CwBvh) -> usize {
    let mut deepest = 0;
    let mut waiting = vec![(0, 1)];
    while let Some((node, depth)) = waiting.pop() {
        deepest = deepest.max(depth);
        let node = &tree.nodes[node];
        let first = node.child_base_idx as usize;
        waiting.extend((0..node.imask.count_ones() as usize).map(|child| (first + child, depth + 1)));
    }
    deepest
}

/// A tree of the least depth, cut at medians: what is left where sizes differ by so many orders of magnitude that the better tree
/// becomes a chain.
fn balanced(boxes: &[Aabb], numbers: &[u32]) -> Bvh2 {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let mut tree = Bvh2 { primitive_indices: numbers.to_vec(), uses_spatial_splits: true, ..Bvh2::zeroed(0) };
    tree.nodes = vec![Bvh2Node::default()];
    let mut waiting = vec![(0, 0..boxes.len())];
    while let Some((node, range)) = waiting.pop() {
        let here = &mut order[range.clone()];
        let bounds = here.iter().fold(Aabb::INVALID, |bounds, &place| bounds.union(&boxes[place]));
        if let [place] = here {
            tree.nodes[node] = Bvh2Node::new(bounds, 1, *place as u32);
            continue;
        }
        let axis = bounds.largest_axis();
        let middle = here.len() / 2;
        let center = |place: &usize| boxes[*place].min[axis] + boxes[*place].max[axis];
        here.select_nth_unstable_by(middle, |a, b| center(a).total_cmp(&center(b)).then(a.cmp(b)));
        let child = tree.nodes.len();
        tree.nodes[node] = Bvh2Node::new(bounds, 0, child as u32);
        tree.nodes.extend([Bvh2Node::default(); 2]);
        let middle = range.start + middle;
        waiting.extend([(child, range.start..middle), (child + 1, middle..range.end)]);
    }
    tree
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(at: f32, size: f32) -> BvhTriangle {
        BvhTriangle { corners: [[at, 0.0, 0.0], [at + size, 0.0, size], [at, size, 0.0]], flags: 0 }
    }

    #[test]
    fn equal_lists_give_equal_bits() {
        let triangles: Vec<BvhTriangle> =
            (0..2000_u16).map(|index| triangle(f32::from(index % 61 * 37), f32::from(index % 50))).collect();
        let [a, b] = [Bvh::build(&triangles), Bvh::build(&triangles)];
        let bits = |bvh: &Bvh| bytemuck::pod_collect_to_vec::<[f32; 4], u32>(&bvh.triangles);
        assert!(a.nodes == b.nodes && bits(&a) == bits(&b));
    }

    #[test]
    fn no_tree_is_deeper_than_the_stack() {
        // Each triangle half as large and half as far as the one before, and many in one place.
        let shrinking = (0..80).map(|power| triangle(2_f32.powi(40 - power), 2_f32.powi(39 - power)));
        let triangles: Vec<BvhTriangle> = shrinking.chain([triangle(3.0, 1.0); 1500]).collect();
        for deepest in [DEEPEST, 0] {
            let sound: Vec<Triangle> = triangles
                .iter()
                .map(|triangle| {
                    let [v0, v1, v2] = triangle.corners.map(Vec3A::from);
                    Triangle { v0, v1, v2 }
                })
                .collect();
            let tree = wide(&sound, deepest);
            assert!(depth(&tree) <= DEEPEST);
            let numbers: std::collections::HashSet<u32> = tree.primitive_indices.iter().copied().collect();
            assert_eq!(numbers.len(), sound.len(), "every triangle is in a leaf");
        }
    }
}
