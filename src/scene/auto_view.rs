//! A sensible view of a scene that has no camera.
//!
//! Buildings are seen from inside, everything else from outside.
//!
//! A scene is a building if a fair share of its surface is level floor, somebody could stand inside it (`indoor_view`), and no
//! view from outside shows most of what is seen from there: a box with an open front is looked into through it. What cannot be
//! stood in, such as the cavities of an engine or a helmet, has hardly any level floor. How much of a scene is visible from
//! outside says nothing: the outer walls of a level in its landscape are most of its surface.
//!
//! Views from outside frame the whole scene. They are tried in turn, and the first is taken that shows mostly front faces: an
//! object, or a box seen through its open side. If every side shows backs, the scene is an interior, and the view stands inside
//! it after all.

use super::Scene;
use super::camera::{CameraView, Projection};
use super::indoor_view::{self, Stand};
use super::mesh::Bounds;
use super::rays::{Rays, SurfacePoint};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Rays along each side of the trial pictures.
const SIZE: usize = 32;
/// Share of front faces among the rays that meet anything.
const ENOUGH_FRONTS: f64 = 0.75;
/// Least share of all surfaces that is level floor in a building. Measured: 0.12 to 0.29 in halls, rooms and game levels, at most
/// 0.06 in a helmet, an engine, a teapot and a statue.
const ENOUGH_FLOOR: f64 = 0.09;
/// A place inside that shows less than this share of all surfaces is not worth it.
const ENOUGH_INSIDE: f64 = 0.02;
/// If one outside view shows this share of what a place inside shows, there is no need to go in.
const SHOWN_OUTSIDE: f64 = 0.8;
/// Points on surfaces that stand for all of them.
const POINTS: usize = 1024;
const OUTSIDE_FOV_DEGREES: f64 = 45.0;
const INSIDE_FOV_DEGREES: f64 = 60.0;
/// How much farther away than where it just fits.
const MARGIN: f64 = 1.08;

/// Directions from the scene towards the eye, with the picture's up direction: from above one front corner, then from the sides.
const OUTSIDE: [(DVec3, DVec3); 7] = [
    (DVec3::new(0.55, 0.4, 0.9), DVec3::Y),
    (DVec3::Z, DVec3::Y),
    (DVec3::NEG_Z, DVec3::Y),
    (DVec3::X, DVec3::Y),
    (DVec3::NEG_X, DVec3::Y),
    (DVec3::Y, DVec3::NEG_Z),
    (DVec3::NEG_Y, DVec3::Z),
];

/// The view of [`Scene::camera_view`] for a scene without cameras.
pub(super) fn find(scene: &Scene) -> CameraView {
    let bounds = scene.bulk().unwrap_or(Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE });
    let radius = if bounds.radius() > 0.0 { bounds.radius() } else { 1.0 };
    let rays = Rays::new(scene, &bounds, radius);
    let points = rays.surface_points(POINTS);
    let candidates: Vec<CameraView> =
        OUTSIDE.iter().map(|&(towards_eye, up)| outside(&bounds, radius, towards_eye, up)).collect();
    let stand =
        || indoor_view::find(&rays, &points, (bounds.size() * 0.5 / radius).as_vec3(), radius, inside_tangent());
    let floors = points.iter().filter(|point| point.is_floor()).count() as f64;
    let building = || stand().filter(|stand| is_hidden(&rays, &points, stand, &candidates, &bounds, radius));
    let standing = |stand: Stand| {
        let eye = bounds.center() + stand.eye.as_dvec3() * radius;
        let target = eye + stand.forward.as_dvec3() * radius;
        CameraView::look_at(eye, target, DVec3::Y, perspective(INSIDE_FOV_DEGREES, radius * 1e-3))
    };
    let suits = |view: &&CameraView| share_of_fronts(&rays, view, &bounds, radius) >= ENOUGH_FRONTS;
    // Most objects suit the first view; only otherwise are the rest worth tracing.
    let mut view = (floors > ENOUGH_FLOOR * points.len() as f64)
        .then(building)
        .flatten()
        .map(standing)
        .or_else(|| candidates[..1].iter().find(suits).cloned())
        .or_else(|| candidates[1..].par_iter().find_first(suits).cloned())
        .or_else(|| stand().map(standing))
        .unwrap_or_else(|| inside(&bounds, radius));
    view.name = "automatic".to_owned();
    view.automatic = true;
    view
}

fn inside_tangent() -> f32 {
    (INSIDE_FOV_DEGREES.to_radians() * 0.5).tan() as f32
}

fn perspective(degrees: f64, near: f64) -> Projection {
    Projection::Perspective { vertical_fov: degrees.to_radians(), aspect: None, near }
}

/// Looks at the middle from so far that all corners of the bounds are in a square picture.
fn outside(bounds: &Bounds, radius: f64, towards_eye: DVec3, up: DVec3) -> CameraView {
    let (center, half) = (bounds.center(), bounds.size() * 0.5);
    let frame =
        CameraView::look_at(center + towards_eye, center, up, perspective(OUTSIDE_FOV_DEGREES, 1.0)).world.matrix3;
    let tangent = (OUTSIDE_FOV_DEGREES.to_radians() * 0.5).tan();
    let corners = (0..8)
        .map(|corner| half * DVec3::from(std::array::from_fn(|axis| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 })));
    let distance = corners.fold(radius * 1e-3, |distance, corner| {
        let seen = frame.transpose() * corner;
        distance.max(seen.x.abs().max(seen.y.abs()) / tangent + seen.z)
    });
    let eye = center + frame.z_axis * distance * MARGIN;
    CameraView::look_at(eye, center, up, perspective(OUTSIDE_FOV_DEGREES, radius * 1e-3))
}

/// For interiors without a floor to stand on: looks along the longer horizontal axis from near its positive end, a little below the middle of the room.
fn inside(bounds: &Bounds, radius: f64) -> CameraView {
    let size = bounds.size();
    // A square room is seen along z, whatever the rounding of its sizes.
    let along_x = size.x > size.z * 1.001;
    let axis = if along_x { DVec3::X * size.x } else { DVec3::Z * size.z };
    let middle = bounds.center() - DVec3::Y * 0.1 * size.y;
    CameraView::look_at(middle + axis * 0.35, middle - axis, DVec3::Y, perspective(INSIDE_FOV_DEGREES, radius * 1e-3))
}

/// Whether a place inside is worth standing at: it shows a good deal of the scene, and no outside view shows most of that too.
fn is_hidden(
    rays: &Rays,
    points: &[SurfacePoint],
    stand: &Stand,
    outside: &[CameraView],
    bounds: &Bounds,
    radius: f64,
) -> bool {
    let seen: Vec<&SurfacePoint> = points.par_iter().filter(|point| rays.sees(stand.eye, point)).collect();
    let share = |view: &CameraView| {
        let eye = relative_eye(view, bounds, radius);
        seen.iter().filter(|point| rays.sees(eye, point)).count() as f64 / seen.len().max(1) as f64
    };
    let shares: Vec<f64> = outside.par_iter().map(share).collect();
    seen.len() as f64 > ENOUGH_INSIDE * points.len() as f64 && shares.iter().all(|&share| share < SHOWN_OUTSIDE)
}

fn relative_eye(view: &CameraView, bounds: &Bounds, radius: f64) -> Vec3 {
    ((view.world.translation - bounds.center()) / radius).as_vec3()
}

/// Among the pixels in which an outside view shows a surface, the share that shows its front. 0 if it shows none.
fn share_of_fronts(rays: &Rays, view: &CameraView, bounds: &Bounds, radius: f64) -> f64 {
    let eye = relative_eye(view, bounds, radius);
    let frame = view.world.matrix3.as_mat3();
    let tangent = (OUTSIDE_FOV_DEGREES.to_radians() * 0.5).tan() as f32;
    let (mut covered, mut fronts) = (0, 0);
    for pixel in 0..SIZE * SIZE {
        let [x, y] = [pixel % SIZE, pixel / SIZE].map(|at| ((at as f32 + 0.5) / SIZE as f32 * 2.0 - 1.0) * tangent);
        if let Some(hit) = rays.first(eye, frame * Vec3::new(x, y, -1.0), f32::INFINITY) {
            covered += 1;
            fronts += usize::from(hit.front);
        }
    }
    if covered == 0 { 0.0 } else { fronts as f64 / covered as f64 }
}
