//! Which meshes bound a solid: every edge is passed as often in the one direction as in the other, and fronts look outwards. Found without a list of edges: an edge adds a number made
//! of both its ends, which the edge in the other direction takes away, so that the sum is zero if and, but for one case in 2⁶⁴, only if all of them meet.

use std::hash::{DefaultHasher, Hash, Hasher};

use glam::DVec3;

use crate::scene::Primitive;

/// Sums over the triangles of a primitive; those of several tell whether together they bound something.
#[derive(Clone, Copy, Debug, Default)]
struct Hull {
    /// What the edges that meet no other one leave.
    open_edges: u64,
    /// Six times the volume behind the fronts; the same from every origin if no edge is open.
    volume: f64,
}

impl Hull {
    fn of(primitive: &Primitive) -> Hull {
        // Both zeros are one place.
        let bits = |position: [f32; 3]| position.map(|coordinate| (coordinate + 0.0).to_bits());
        let one_way = |ends: [[u32; 3]; 2]| {
            let mut hasher = DefaultHasher::new();
            ends.hash(&mut hasher);
            hasher.finish()
        };
        let mut hull = Hull::default();
        for corners in primitive.triangles() {
            let [a, b, c] = corners.map(bits);
            for [from, to] in [[a, b], [b, c], [c, a]] {
                hull.open_edges = hull.open_edges.wrapping_add(one_way([from, to])).wrapping_sub(one_way([to, from]));
            }
            let [a, b, c] = corners.map(|corner| DVec3::from(corner.map(f64::from)));
            hull.volume += a.dot(b.cross(c));
        }
        hull
    }

    fn and(self, other: Hull) -> Hull {
        Hull { open_edges: self.open_edges.wrapping_add(other.open_edges), volume: self.volume + other.volume }
    }

    fn is_solid(&self) -> bool {
        self.open_edges == 0 && self.volume > 0.0
    }
}

/// For each primitive of a mesh the box of the solid that it bounds, by itself or with all others. `boxes`: of the primitives.
pub(super) fn solids(primitives: &[Primitive], boxes: &[[[f32; 3]; 2]]) -> Vec<Option<[[f32; 3]; 2]>> {
    let hulls: Vec<Hull> = primitives.iter().map(Hull::of).collect();
    let whole = hulls.iter().copied().reduce(Hull::and).filter(Hull::is_solid);
    let joined = |[low, high]: [[f32; 3]; 2], other: &[[f32; 3]; 2]| {
        [[0, 1, 2].map(|axis| low[axis].min(other[0][axis])), [0, 1, 2].map(|axis| high[axis].max(other[1][axis]))]
    };
    let around = whole.map(|_| boxes.iter().fold([[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]], joined));
    hulls.iter().zip(boxes).map(|(hull, own)| around.or(hull.is_solid().then_some(*own))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron(faces: &[[u32; 3]]) -> Primitive {
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-0.0, 0.0, 0.0]];
        Primitive { positions, indices: faces.concat(), ..Primitive::default() }
    }

    fn is_solid(faces: &[[u32; 3]]) -> bool {
        Hull::of(&tetrahedron(faces)).is_solid()
    }

    const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [4, 3, 2], [1, 2, 3]];

    #[test]
    fn a_tetrahedron_is_solid_unless_a_face_is_missing_or_turned_or_all_are() {
        assert!(is_solid(&FACES), "vertices of the same place are one");
        assert!(!is_solid(&FACES[..3]));
        assert!(!is_solid(&[FACES[0], FACES[1], FACES[2], [1, 3, 2]]));
        assert!(!is_solid(&FACES.map(|[a, b, c]| [a, c, b])), "its fronts look inwards");
        let lines = [[1, 1, 2], [0, 4, 3]];
        assert!(is_solid(&[&FACES[..], &lines[..]].concat()), "triangles without area open nothing");
    }

    #[test]
    fn primitives_close_each_other() {
        let boxes = [[[0.0; 3], [1.0, 1.0, 0.0]], [[0.0; 3], [1.0; 3]]];
        let [open, rest, all] = [&FACES[..1], &FACES[1..], &FACES[..]].map(tetrahedron);
        assert_eq!(solids(&[open.clone(), rest], &boxes), [Some([[0.0; 3], [1.0; 3]]); 2]);
        assert_eq!(solids(&[open, all], &boxes), [None, Some(boxes[1])]);
    }
}
