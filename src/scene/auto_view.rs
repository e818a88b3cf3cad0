//! A sensible view of a scene that has no camera.
//!
//! Views from outside that frame the whole scene are tried in turn. Each is drawn in 64×64 pixels with a depth buffer, and taken
//! if most of what it shows are front faces: an object, or a box seen through its open side. If every side shows backs, the
//! scene is an interior, and the view stands inside it. Only the winding counts: the walls of a room are often double-sided, but
//! their fronts look inwards all the same.

use super::Scene;
use super::camera::{CameraView, Projection};
use super::mesh::Bounds;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Pixels along each side of the trial pictures.
const SIZE: usize = 64;
/// Share of front faces among the pixels that show anything.
const ENOUGH_FRONTS: f64 = 0.75;
/// At most about this many triangles are drawn; of larger scenes every k-th.
const MOST_TRIANGLES: u64 = 300_000;
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

/// A triangle relative to the scene's middle, in units of its radius, counter-clockwise as seen from the front.
struct Triangle([Vec3; 3]);

/// The view of [`Scene::camera_view`] for a scene without cameras.
pub(super) fn find(scene: &Scene) -> CameraView {
    let bounds = scene.bounds().unwrap_or(Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE });
    let radius = if bounds.radius() > 0.0 { bounds.radius() } else { 1.0 };
    let triangles = triangles(scene, bounds.center(), radius);
    let candidates: Vec<CameraView> =
        OUTSIDE.iter().map(|&(towards_eye, up)| outside(&bounds, radius, towards_eye, up)).collect();
    let suits = |view: &&CameraView| share_of_fronts(&triangles, view, bounds.center(), radius) >= ENOUGH_FRONTS;
    // Most objects suit the first view; only otherwise are the rest worth drawing.
    let (first, rest) = candidates.split_at(1);
    let suited = first.iter().find(suits).or_else(|| rest.par_iter().find_first(suits));
    let mut view = suited.cloned().unwrap_or_else(|| inside(&bounds, radius));
    view.name = "automatic".to_owned();
    view.automatic = true;
    view
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

/// Looks along the longer horizontal axis from near its positive end, a little below the middle of the room.
fn inside(bounds: &Bounds, radius: f64) -> CameraView {
    let size = bounds.size();
    // A square room is seen along z, whatever the rounding of its sizes.
    let along_x = size.x > size.z * 1.001;
    let axis = if along_x { DVec3::X * size.x } else { DVec3::Z * size.z };
    let middle = bounds.center() - DVec3::Y * 0.1 * size.y;
    CameraView::look_at(middle + axis * 0.35, middle - axis, DVec3::Y, perspective(INSIDE_FOV_DEGREES, radius * 1e-3))
}

fn triangles(scene: &Scene, center: DVec3, radius: f64) -> Vec<Triangle> {
    let count: u64 = scene.instances().iter().map(|it| scene.primitive(it).triangle_count() as u64).sum();
    let stride = count.div_ceil(MOST_TRIANGLES).max(1) as usize;
    let all = scene.instances().par_iter().flat_map_iter(|it| {
        scene.primitive(it).triangles().step_by(stride).map(move |triangle| {
            let world = triangle.map(|corner| it.world.transform_point3(Vec3::from(corner).as_dvec3()));
            let mut corners = world.map(|corner| ((corner - center) / radius).as_vec3());
            if it.flips_winding {
                corners.swap(1, 2);
            }
            Triangle(corners)
        })
    });
    all.collect()
}

/// Among the pixels in which `view` shows a triangle, the share that shows a front face. 0 if it shows none.
fn share_of_fronts(triangles: &[Triangle], view: &CameraView, center: DVec3, radius: f64) -> f64 {
    let to_view = view.world.matrix3.transpose().as_mat3();
    let eye = ((view.world.translation - center) / radius).as_vec3();
    let scale = SIZE as f32 * 0.5 / ((OUTSIDE_FOV_DEGREES * 0.5).to_radians().tan() as f32);
    // Nearest 1/distance so far, and whether a front face showed it.
    let mut pixels = vec![(0.0f32, false); SIZE * SIZE];
    for Triangle(corners) in triangles {
        let seen = corners.map(|corner| to_view * (corner - eye));
        if seen.iter().any(|corner| corner.z > -1e-4) {
            continue;
        }
        let [a, b, c] = seen.map(|corner| {
            let inverse_depth = -1.0 / corner.z;
            Vec3::new(corner.x * inverse_depth * scale, -corner.y * inverse_depth * scale, inverse_depth)
                + Vec3::new(SIZE as f32 * 0.5, SIZE as f32 * 0.5, 0.0)
        });
        // Twice the signed area in the picture; y points down, so front faces are negative.
        let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        let front = area < 0.0;
        let mut show = |x: usize, y: usize, inverse_depth: f32| {
            let pixel = &mut pixels[y * SIZE + x];
            if inverse_depth > pixel.0 {
                *pixel = (inverse_depth, front);
            }
        };
        // The pixels whose centres lie between two coordinates. Truncation is cheaper than rounding, and this runs for every
        // triangle of the scene.
        let range = |low: f32, high: f32| {
            let [first, end] = [low, high].map(|at| (at + 0.5).clamp(0.0, SIZE as f32) as usize);
            first..end
        };
        let columns = range(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let rows = range(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        for y in rows {
            for x in columns.clone() {
                let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
                let weight_b = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
                let weight_c = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
                if weight_b >= 0.0 && weight_c >= 0.0 && weight_b + weight_c <= 1.0 {
                    show(x, y, a.z + weight_b * (b.z - a.z) + weight_c * (c.z - a.z));
                }
            }
        }
    }
    let covered = pixels.iter().filter(|pixel| pixel.0 > 0.0).count();
    let fronts = pixels.iter().filter(|pixel| pixel.0 > 0.0 && pixel.1).count();
    if covered == 0 { 0.0 } else { fronts as f64 / covered as f64 }
}
