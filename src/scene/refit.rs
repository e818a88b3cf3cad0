//! The hierarchy of triangles that moved: the tree as it was built, with boxes around where they are now. It takes a hundredth of the time of a new tree, and is no worse
//! for rays as long as neighbours stay neighbours; where they do not, the boxes' areas say so, and a new tree is due.

use glam::{DVec3, Vec3};
use obvhs::cwbvh::node::CwBvhNode;

use super::bvh::{Bvh, BvhTriangle, can_be_hit};

/// Over the areas of the boxes as built, weighted by what they hold: beyond it rays pay more for the old tree than a new one costs.
const WORST: f64 = 1.5;
/// What testing a triangle costs, in tests of a box (as in the surface area heuristic that the tree was built by).
const TRIANGLE_COST: f64 = 0.3;
/// No side of a node's grid is shorter, metres: its step is a normal number.
const LEAST_EXTENT: f64 = 1e-20;

/// Lowest and highest corner.
#[derive(Clone, Copy)]
struct Box3 {
    low: DVec3,
    high: DVec3,
}

impl Box3 {
    const NOTHING: Box3 = Box3 { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn of(triangle: &BvhTriangle) -> Box3 {
        let [a, b, c] = triangle.corners.map(|corner| Vec3::from(corner).as_dvec3());
        Box3 { low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    fn union(self, other: Box3) -> Box3 {
        Box3 { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn half_area(self) -> f64 {
        let size = self.high - self.low;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// What a slot of a node holds.
enum Slot {
    Empty,
    /// Places in the tree's order of triangles.
    Triangles(std::ops::Range<usize>),
    Node(usize),
}

impl Bvh {
    /// The tree of `self`, as [`Bvh::build`] made it, around the same triangles where they are now. `None` if it is no tree for them: others can be hit, or boxes
    /// have grown so much that rays would pay for it.
    pub(crate) fn refitted(&self, triangles: &[BvhTriangle]) -> Option<Bvh> {
        let count = self.nodes.len() / 5;
        let moved = self.moved(triangles)?;
        let built: &[CwBvhNode] = bytemuck::cast_slice(&self.nodes[..5 * count]);
        let mut nodes = built.to_vec();
        let mut around: Vec<Option<Box3>> = vec![None; count];
        let (mut cost_built, mut cost) = (0.0, 0.0);
        // Children stand behind their parents.
        for index in (0..count).rev() {
            let node = &built[index];
            let mut boxes = [None; 8];
            let mut stands = true;
            for (slot, place) in boxes.iter_mut().enumerate() {
                let (now, weight) = match held_by(node, slot) {
                    Slot::Empty => continue,
                    Slot::Node(child) => (around[child], 1.0),
                    Slot::Triangles(places) => {
                        let weight = TRIANGLE_COST * places.len() as f64;
                        let whole = |place: usize| Box3::of(&triangles[self.number(place)]);
                        let grown = places.clone().any(|place| moved[place]);
                        (grown.then(|| places.map(whole).fold(Box3::NOTHING, Box3::union)), weight)
                    }
                };
                let then = box_of(node, slot);
                stands &= now.is_none();
                cost_built += weight * then.half_area();
                cost += weight * now.unwrap_or(then).half_area();
                *place = Some(now.unwrap_or(then));
            }
            if !stands {
                around[index] = Some(set_boxes(&mut nodes[index], &boxes));
            }
        }
        let texels = (0..moved.len()).flat_map(|place| match moved[place] {
            true => {
                let number = self.number(place);
                triangles[number].texels(number as u32)
            }
            false => [0, 1, 2].map(|corner| self.triangles[3 * place + corner]),
        });
        let fits = cost <= WORST * cost_built;
        fits.then(|| Bvh {
            triangles: texels.collect(),
            nodes: bytemuck::cast_slice(&nodes).iter().chain(self.nodes.last()).copied().collect(),
        })
    }

    /// Of each place in the order of leaves, whether its triangle is elsewhere now; `None` if it is not the same triangles that can be hit.
    fn moved(&self, triangles: &[BvhTriangle]) -> Option<Vec<bool>> {
        let mut held = vec![false; triangles.len()];
        let mut moved = Vec::with_capacity(self.triangles.len() / 3);
        for place in 0..self.triangles.len() / 3 {
            let number = self.number(place);
            let triangle = triangles.get(number)?;
            let new = !triangle.is_held_by(&self.triangles[3 * place..3 * place + 3]);
            if new && !can_be_hit(triangle) {
                return None;
            }
            held[number] = true;
            moved.push(new);
        }
        let others = triangles.iter().zip(held).filter(|(_, held)| !held);
        others.map(|(triangle, _)| triangle).all(|triangle| !can_be_hit(triangle)).then_some(moved)
    }

    /// The triangle at a place in the order of leaves.
    fn number(&self, place: usize) -> usize {
        self.triangles[3 * place][3].to_bits() as usize
    }
}

fn held_by(node: &CwBvhNode, slot: usize) -> Slot {
    let meta = node.child_meta[slot];
    if meta == 0 {
        Slot::Empty
    } else if node.imask >> slot & 1 == 1 {
        let before = node.imask & ((1 << slot) - 1);
        Slot::Node(node.child_base_idx as usize + before.count_ones() as usize)
    } else {
        let first = node.primitive_base_idx as usize + usize::from(meta & 31);
        Slot::Triangles(first..first + (meta >> 5).count_ones() as usize)
    }
}

/// A step of a node's grid along an axis, metres.
fn step(exponent: u8) -> f64 {
    f64::from(f32::from_bits(u32::from(exponent) << 23))
}

fn box_of(node: &CwBvhNode, slot: usize) -> Box3 {
    let steps = DVec3::from(node.e.map(step));
    let [low, high] = [
        [node.child_min_x[slot], node.child_min_y[slot], node.child_min_z[slot]],
        [node.child_max_x[slot], node.child_max_y[slot], node.child_max_z[slot]],
    ]
    .map(|bytes| node.p.as_dvec3() + DVec3::from(bytes.map(f64::from)) * steps);
    Box3 { low, high }
}

/// Gives a node a grid around the boxes of its slots, and its slots the smallest boxes of that grid that hold them. The box around all.
fn set_boxes(node: &mut CwBvhNode, boxes: &[Option<Box3>; 8]) -> Box3 {
    let whole = boxes.iter().flatten().copied().fold(Box3::NOTHING, Box3::union);
    // Corners are floats, and boxes of grids need not begin at one.
    let corner =
        whole.low.to_array().map(|low| if f64::from(low as f32) > low { (low as f32).next_down() } else { low as f32 });
    node.p = Vec3::from(corner);
    let corner = node.p.as_dvec3();
    let lists = [
        (&mut node.child_min_x, &mut node.child_max_x),
        (&mut node.child_min_y, &mut node.child_max_y),
        (&mut node.child_min_z, &mut node.child_max_z),
    ];
    for (axis, (lows, highs)) in lists.into_iter().enumerate() {
        let extent = (whole.high[axis] - corner[axis]).max(LEAST_EXTENT);
        let exponent = (1..=254).find(|&exponent| 255.0 * step(exponent) >= extent).unwrap_or(254);
        node.e[axis] = exponent;
        for (slot, held) in boxes.iter().enumerate() {
            let Some(held) = held else { continue };
            lows[slot] = ((held.low[axis] - corner[axis]) / step(exponent)).floor().clamp(0.0, 255.0) as u8;
            highs[slot] = ((held.high[axis] - corner[axis]) / step(exponent)).ceil().clamp(0.0, 255.0) as u8;
        }
    }
    whole
}
