//! The camera as shaders see it: reverse-Z, without a far plane when perspective.

use glam::{DVec3, Mat4, Vec3, Vec4};

use crate::scene::{CameraView, Projection};
use crate::shaders::types;

/// The camera of a frame of `size` pixels, in render space.
pub(crate) fn camera(view: &CameraView, size: [u32; 2], origin: DVec3) -> types::Camera {
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let [right, up, back] = [view.world.matrix3.x_axis, view.world.matrix3.y_axis, view.world.matrix3.z_axis];
    let position = (view.world.translation - origin).as_vec3();
    let forward = (-back).as_vec3();
    let (half_width, half_height, near, depth_range) = match view.projection {
        Projection::Perspective { vertical_fov, near, .. } => {
            let half_height = (vertical_fov * 0.5).tan();
            (half_height * aspect, half_height, near, 0.0)
        }
        Projection::Orthographic { half_width, half_height, near, far } => {
            // The picture's shape decides; nothing that the camera shows is cut off.
            let grow = (half_width / (half_height * aspect)).max(1.0);
            (half_height * aspect * grow, half_height * grow, near, far - near)
        }
    };
    let right_scaled = (right * half_width).as_vec3();
    let down_scaled = (-up * half_height).as_vec3();
    types::Camera {
        view_projection: view_projection(
            position,
            [right_scaled, down_scaled, forward],
            near as f32,
            depth_range as f32,
        )
        .to_cols_array_2d(),
        position_rs: position.to_array(),
        near: near as f32,
        forward: forward.to_array(),
        depth_range: depth_range as f32,
        right_scaled: right_scaled.to_array(),
        down_scaled: down_scaled.to_array(),
    }
}

/// Render space to clip space, reverse-Z, y down. `right` and `down` reach from the middle of the image to its edges, at
/// distance 1 when perspective (`depth_range` 0), in metres when orthographic; `forward` is a unit vector.
pub(crate) fn view_projection(position: Vec3, [right, down, forward]: [Vec3; 3], near: f32, depth_range: f32) -> Mat4 {
    let row = |axis: Vec3| axis.extend(-axis.dot(position));
    let x = row(right / right.length_squared());
    let y = row(down / down.length_squared());
    let along = row(forward);
    let (z, w) = if depth_range > 0.0 {
        ((Vec4::W * (near + depth_range) - along) / depth_range, Vec4::W)
    } else {
        (Vec4::W * near, along)
    };
    Mat4::from_cols(x, y, z, w).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;

    fn project(camera: &types::Camera, point: Vec3) -> Vec3 {
        Mat4::from_cols_array_2d(&camera.view_projection).project_point3(point)
    }

    #[test]
    fn perspective_depth_is_reversed_and_the_picture_upright() {
        let projection = Projection::Perspective { vertical_fov: std::f64::consts::FRAC_PI_2, aspect: None, near: 0.5 };
        let view = CameraView { world: DAffine3::IDENTITY, projection, name: String::new(), automatic: false };
        let camera = camera(&view, [200, 100], DVec3::ZERO);
        assert!(project(&camera, Vec3::new(0.0, 0.0, -0.5)).abs_diff_eq(Vec3::new(0.0, 0.0, 1.0), 1e-6), "near plane");
        assert!(
            project(&camera, Vec3::new(4.0, 2.0, -2.0)).abs_diff_eq(Vec3::new(1.0, -1.0, 0.25), 1e-6),
            "upper right corner"
        );
    }

    #[test]
    fn orthographic_depth_is_reversed() {
        let projection = Projection::Orthographic { half_width: 2.0, half_height: 1.0, near: 1.0, far: 5.0 };
        let view = CameraView { world: DAffine3::IDENTITY, projection, name: String::new(), automatic: false };
        let camera = camera(&view, [200, 100], DVec3::ZERO);
        assert!(project(&camera, Vec3::new(2.0, 1.0, -1.0)).abs_diff_eq(Vec3::new(1.0, -1.0, 1.0), 1e-6));
        assert!(project(&camera, Vec3::new(0.0, 0.0, -5.0)).abs_diff_eq(Vec3::ZERO, 1e-6));
    }
}
