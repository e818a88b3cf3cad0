//! How much surface the pixels of a view show, and what it reflects diffusely.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::rays::{MOST_TRIANGLES, Rays};
use super::{CameraView, Projection, Scene};

/// Surfaces are seen no more askew than this: the cosine.
const LEAST_COSINE: f64 = 1e-3;

/// What the ray through a pixel's middle meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    /// What the pixel shows of it, m².
    pub(crate) area: f64,
    /// Of its diffuse lobe.
    pub(crate) albedo: [f32; 3],
}

/// A triangle, and what it is part of.
struct Part {
    corners: [DVec3; 3],
    instance: usize,
    triangle: usize,
}

impl Scene {
    /// Of each pixel, row by row from the top, what it shows; `None` where nothing is.
    pub(crate) fn seen_surfaces(&self, view: &CameraView, size: [u32; 2]) -> Vec<Option<Seen>> {
        let bounds = self.bounds();
        let (middle, radius) =
            bounds.map_or((DVec3::ZERO, 1.0), |bounds| (bounds.center(), bounds.radius().max(1e-30)));
        let parts = self.parts();
        let placed = |point: DVec3| ((point - middle) / radius).as_vec3();
        let rays = Rays::of(parts.iter().map(|part| part.corners.map(placed)));
        let pixels = 0..size[0] * size[1];
        let seen = pixels.into_par_iter().map(|pixel| {
            let (origin, direction, area) = ray_of(view, size, [pixel % size[0], pixel / size[0]]);
            let hit = rays.first(placed(origin), (direction / radius).as_vec3(), f32::INFINITY)?;
            let part = &parts[rays.number(&hit)];
            let distance = f64::from(hit.distance);
            let [a, b, c] = part.corners;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let slope = normal.dot(direction).abs().max(LEAST_COSINE * direction.length());
            let grows = if is_perspective(view) { distance * distance } else { 1.0 };
            let albedo = self.albedo_at(part, origin + distance * direction);
            Some(Seen { area: area * grows / slope, albedo })
        });
        seen.collect()
    }

    fn parts(&self) -> Vec<Part> {
        let count: u64 = self.instances().iter().map(|it| self.primitive(it).triangle_count() as u64).sum();
        let stride = count.div_ceil(MOST_TRIANGLES).max(1) as usize;
        let of_instance = |(instance, placed): (usize, &super::Instance)| {
            let world = placed.world;
            let triangles = self.primitive(placed).triangles().enumerate();
            let parts = triangles.map(move |(triangle, corners)| {
                let corners = corners.map(|corner| world.transform_point3(Vec3::from(corner).as_dvec3()));
                Part { corners, instance, triangle }
            });
            parts.collect::<Vec<Part>>()
        };
        self.instances().iter().enumerate().flat_map(of_instance).step_by(stride).collect()
    }

    fn albedo_at(&self, part: &Part, point: DVec3) -> [f32; 3] {
        let instance = &self.instances()[part.instance];
        let indices = &self.primitive(instance).indices[3 * part.triangle..3 * part.triangle + 3];
        let [a, b, c] = part.corners;
        let whole = (b - a).cross(c - a);
        let share = |from: DVec3, to: DVec3| (from - point).cross(to - point).dot(whole) / whole.length_squared();
        let weights = [share(b, c), share(c, a), share(a, b)].map(|weight| weight.clamp(0.0, 1.0) as f32);
        let look = self.appearance(instance).at([indices[0], indices[1], indices[2]], weights);
        look.unwrap_or_default().albedo
    }
}

fn is_perspective(view: &CameraView) -> bool {
    matches!(view.projection, Projection::Perspective { .. })
}

/// Where the ray through a pixel's middle starts, its direction, and the pixel's area on a plane at right angles to the view, in perspective at a distance of 1. A surface at t lengths of the
/// direction d with the normal n shows a t² / |n·d| of itself in perspective, else a / |n·d|.
fn ray_of(view: &CameraView, size: [u32; 2], pixel: [u32; 2]) -> (DVec3, DVec3, f64) {
    let [width, height] = size.map(f64::from);
    let aspect = width / height;
    let [right, up, back] = [view.world.matrix3.x_axis, view.world.matrix3.y_axis, view.world.matrix3.z_axis];
    let (half_width, half_height, near) = match view.projection {
        Projection::Perspective { vertical_fov, near, .. } => {
            let half = (vertical_fov * 0.5).tan();
            (half * aspect, half, near)
        }
        Projection::Orthographic { half_width, half_height, near, .. } => {
            let grow = (half_width / (half_height * aspect)).max(1.0);
            (half_height * aspect * grow, half_height * grow, near)
        }
    };
    let [x, y] = [0, 1].map(|axis| 2.0 * (f64::from(pixel[axis]) + 0.5) / f64::from(size[axis]) - 1.0);
    let across = x * half_width * right - y * half_height * up;
    let area = 4.0 * half_width * half_height / (width * height);
    let eye = view.world.translation;
    if is_perspective(view) { (eye, across - back, area) } else { (eye + across - near * back, -back, area) }
}
