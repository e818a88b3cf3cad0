//! Which objects get a map: instances with a specular lobe, the largest on the screen first.

use glam::{Mat4, Vec3, Vec4};

use crate::frame::inputs::FrameInputs;
use crate::frame::instances::OrientedBox;
use crate::frame::rays::TracedScene;

/// An object with a map.
#[derive(Clone, Debug)]
pub(super) struct Object {
    pub(super) body: OrientedBox,
    /// Those that rays meet of it, from the first to before the last.
    pub(super) triangles: [u32; 2],
}

/// At most `most` objects in view, in the scene's order.
pub(super) fn choose(frame: &FrameInputs<'_>, scene: &TracedScene, most: u32) -> Vec<Object> {
    let view_projection = Mat4::from_cols_array_2d(&frame.camera.view_projection);
    let mut found: Vec<(f32, usize, OrientedBox)> = Vec::new();
    for (number, drawn) in frame.data.drawn.iter().enumerate() {
        let body = drawn.bulk.filter(|_| drawn.specular && drawn.index_count > 0);
        let share = body.map_or(0.0, |body| share_of_screen(&view_projection, &body));
        found.extend(body.filter(|_| share > 0.0).map(|body| (share, number, body)));
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    found.truncate(most as usize);
    // So that the same objects have the same maps, whichever of them is larger.
    found.sort_by_key(|&(_, number, _)| number);
    let triangles = scene.instance_triangles();
    found.into_iter().map(|(_, number, body)| Object { body, triangles: triangles[number] }).collect()
}

/// Of the rectangle around a box; 1 if it reaches behind the camera, 0 if none of it is in view.
fn share_of_screen(view_projection: &Mat4, body: &OrientedBox) -> f32 {
    let [x, y, z] = body.half_axes_rs.map(Vec3::from);
    let corner = |number: u8| {
        let side = |bit: u8| if number >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let place = Vec3::from(body.center_rs) + side(0) * x + side(1) * y + side(2) * z;
        *view_projection * place.extend(1.0)
    };
    let corners: [Vec4; 8] = std::array::from_fn(|number| corner(number as u8));
    let beyond = |outside: &dyn Fn(&Vec4) -> bool| corners.iter().all(outside);
    if beyond(&|c| c.x > c.w) || beyond(&|c| c.x < -c.w) || beyond(&|c| c.y > c.w) || beyond(&|c| c.y < -c.w) {
        return 0.0;
    }
    // Reversed depth: 1 at the near plane.
    if beyond(&|c| c.z > c.w) {
        return 0.0;
    }
    if corners.iter().any(|c| c.z > c.w) {
        return 1.0;
    }
    let span = |axis: usize| {
        let places = corners.map(|c| (c[axis] / c.w).clamp(-1.0, 1.0));
        places.iter().copied().fold(-1.0, f32::max) - places.iter().copied().fold(1.0, f32::min)
    };
    // What is seen edge-on, or from very far, has an area too.
    span(0).max(1e-6) * span(1).max(1e-6) / 4.0
}

impl Object {
    /// As glsl/cubemap/objects.glsl has it.
    pub(super) fn record(&self, number: u32, shift: Vec3) -> [[u32; 4]; 5] {
        let [x, y, z] = self.body.half_axes_rs.map(Vec3::from);
        let middle = Vec3::from(self.body.center_rs) + shift;
        // A box without a thickness has a direction for it.
        let along = |axis: Vec3, others: [Vec3; 2]| {
            let across = others[0].cross(others[1]);
            let direction = axis.try_normalize().or(across.try_normalize()).unwrap_or(Vec3::ZERO);
            direction.extend(axis.length()).to_array().map(f32::to_bits)
        };
        let [first, end] = self.triangles;
        let [a, b, c] = middle.to_array().map(f32::to_bits);
        [[a, b, c, first], along(x, [y, z]), along(y, [z, x]), along(z, [x, y]), [end, number, 0, 0]]
    }

    fn volume(&self) -> f32 {
        self.body.half_axes_rs.iter().map(|&axis| Vec3::from(axis).length()).product()
    }
}

/// The records of all, smaller ones first: of boxes that a point lies in, the first one counts. Before them, the objects' numbers in that order.
pub(super) fn records(objects: &[Object], shift: Vec3) -> (Vec<usize>, Vec<[u32; 4]>) {
    let mut order: Vec<usize> = (0..objects.len()).collect();
    order.sort_by(|&a, &b| objects[a].volume().total_cmp(&objects[b].volume()).then(a.cmp(&b)));
    let number = |place: usize| u32::try_from(place).unwrap_or(u32::MAX);
    let records = order.iter().flat_map(|&place| objects[place].record(number(place), shift)).collect();
    (order, records)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::camera::view_projection;

    fn body(center: [f32; 3], half: f32) -> OrientedBox {
        let axes = [[half, 0.0, 0.0], [0.0, half, 0.0], [0.0, 0.0, half]];
        OrientedBox { center_rs: center, half_axes_rs: axes }
    }

    #[test]
    fn nearer_and_larger_boxes_take_more_of_the_screen() {
        let seen = view_projection(Vec3::ZERO, [Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z], 0.1, 0.0);
        let share = |center, half| share_of_screen(&seen, &body(center, half));
        // Its front is a square of side 2 at distance 9, the screen one of 18.
        assert!((share([0.0, 0.0, -10.0], 1.0) - (2.0_f32 / 18.0).powi(2)).abs() < 1e-6);
        assert!(share([0.0, 0.0, -20.0], 1.0) < share([3.0, 0.0, -10.0], 1.0));
        assert_eq!(share([0.0, 0.0, 10.0], 1.0), 0.0, "behind the camera");
        assert_eq!(share([30.0, 0.0, -10.0], 1.0), 0.0, "beside the picture");
        assert_eq!(share([0.0, 0.0, 0.0], 1.0), 1.0, "around the camera");
    }

    #[test]
    fn a_flat_box_has_three_directions() {
        let flat =
            OrientedBox { center_rs: [1.0, 2.0, 3.0], half_axes_rs: [[2.0, 0.0, 0.0], [0.0; 3], [0.0, 0.0, 4.0]] };
        let record = Object { body: flat, triangles: [7, 9] }.record(3, Vec3::X);
        let floats = |row: usize| record[row].map(f32::from_bits);
        assert_eq!((floats(0)[..3].to_vec(), record[0][3]), (vec![2.0, 2.0, 3.0], 7));
        assert_eq!(floats(1), [1.0, 0.0, 0.0, 2.0]);
        assert_eq!(floats(2).map(f32::abs), [0.0, 1.0, 0.0, 0.0]);
        assert_eq!(record[4], [9, 3, 0, 0]);
    }
}
