//! The `direct` slot against closed forms: one light above a plane, where L = albedo/π · E · cos; and a room, where every
//! pixel's light is also traced on the host.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::{DAffine3, DMat3, DVec3};

use super::probe::{probe, slot};
use super::scenes::{add_light, builtin, floor, lambert, place, quad, request, settings, view};
use super::session::Session;
use crate::renderer::{Settings, Slot};
use crate::scene::{CameraView, LightKind, Scene};

/// The bound.
const TOLERANCE: f64 = 0.001;
const SIZE: [u32; 2] = [96, 72];

fn direct_only() -> Settings {
    settings(&[("lights.resolution", "256")])
}

/// A plane through the origin, and the radiance that leaves a point of it.
struct Plane<'e> {
    normal: DVec3,
    half: f64,
    expected: &'e dyn Fn(DVec3) -> DVec3,
}

/// Largest relative error over all pixels that see the plane well inside its border.
fn worst_error(session: &Session, scene: &Scene, camera: &CameraView, plane: &Plane<'_>) -> f64 {
    let request = request(SIZE, camera.clone(), &[]);
    let frame =
        probe(session, scene, &direct_only(), &request, |graph, declared| vec![slot(graph, declared, Slot::Direct)]);
    let (mut worst, mut seen) = (0.0_f64, 0);
    for (index, found) in (0..).zip(frame.colors(0)) {
        let ray = frame.ray(index % SIZE[0], index / SIZE[0], SIZE);
        let eye = frame.eye() + frame.origin;
        let along = -eye.dot(plane.normal) / ray.dot(plane.normal);
        let point = eye + ray * along;
        if along <= 0.0 || point.abs().max_element() > 0.98 * plane.half {
            continue;
        }
        let expected = (plane.expected)(point);
        let error = ((found - expected) / expected).abs().max_element();
        assert!(error < 1.0, "{found} in place of {expected} at {point}");
        (worst, seen) = (worst.max(error), seen + 1);
    }
    assert!(seen > 1000, "only {seen} pixels show the plane");
    worst
}

fn assert_plane(session: &Session, what: &str, scene: &Scene, camera: &CameraView, plane: &Plane<'_>) {
    let worst = worst_error(session, scene, camera, plane);
    println!("direct light of {what}: largest relative error {worst:.2e}");
    assert!(worst <= TOLERANCE, "{what}: {worst:.2e}");
}

#[test]
fn the_built_in_plane_shows_cosine_over_squared_distance() {
    let session = Session::open();
    let scene = builtin("plane");
    let light = scene.placed_lights()[0].position;
    let expected = |point: DVec3| {
        let to_light = light - point;
        DVec3::splat(to_light.normalize().y / to_light.length_squared())
    };
    let plane = Plane { normal: DVec3::Y, half: 1e3, expected: &expected };
    let camera = scene.camera_view(None).expect("its camera");
    let bounds = scene.bounds().expect("it has a plane");
    let plane = Plane { half: bounds.max.x.min(bounds.max.z), ..plane };
    assert_plane(&session, "the built-in plane", &scene, &camera, &plane);
}

/// Point and spot stand obliquely over a floor that is itself turned.
#[test]
fn point_and_spot_light_a_turned_plane() {
    let session = Session::open();
    let turn = DMat3::from_rotation_z(0.35) * DMat3::from_rotation_x(-0.6);
    let normal = turn * DVec3::Y;
    let position = turn * DVec3::new(1.5, 1.2, -0.8);
    let (inner, outer) = (0.3_f64, 1.2_f64);
    let axis = (turn * DVec3::new(0.2, 0.0, 0.1) - position).normalize();
    let albedo = DVec3::new(0.5, 0.25, 0.75);
    let intensity = DVec3::new(4.0, 9.0, 2.0);
    for spot in [false, true] {
        let mut scene = Scene::empty("turned floor");
        let material = scene.add_material(lambert([0.5, 0.25, 0.75])).expect("a sound material");
        let corners = [[-2.0, 0.0, -2.0], [-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0]];
        place(&mut scene, vec![quad(corners, material)], DAffine3::from_mat3(turn));
        let kind = if spot {
            LightKind::Spot { inner_angle: inner as f32, outer_angle: outer as f32 }
        } else {
            LightKind::Point
        };
        add_light(&mut scene, kind, position, axis, intensity.as_vec3().to_array());
        let expected = |point: DVec3| {
            let to_light = position - point;
            let cosine = to_light.normalize().dot(normal);
            let edge = (-to_light.normalize().dot(axis) - outer.cos()) / (inner.cos() - outer.cos());
            let falloff = if spot { edge.clamp(0.0, 1.0).powi(2) } else { 1.0 };
            // Where next to nothing arrives, a share of it is no measure.
            (albedo * FRAC_1_PI * intensity * (falloff * cosine / to_light.length_squared())).max(DVec3::splat(1e-9))
        };
        let camera = view(turn * DVec3::new(0.3, 2.4, 0.5), DVec3::ZERO);
        let plane = Plane { normal, half: if spot { 0.9 } else { 1.0 }, expected: &expected };
        assert_plane(&session, if spot { "an oblique spot" } else { "an oblique point" }, &scene, &camera, &plane);
    }
}

/// No pixel is in shadow, at whatever elevation the sun stands: no acne.
#[test]
fn a_sun_of_any_elevation_lights_a_whole_plane() {
    let session = Session::open();
    let camera = view(DVec3::new(0.2, 1.7, 1.1), DVec3::ZERO);
    let mut worst: (f64, f64) = (0.0, 0.0);
    for elevation in [2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 14.0, 20.0, 28.0, 37.0, 45.0, 56.0, 68.0, 79.0, 88.0, 90.0_f64] {
        let mut scene = floor(2.0, lambert([0.8; 3]));
        let (height, azimuth) = (elevation.to_radians(), 0.7 + elevation);
        let to_sun = DVec3::new(height.cos() * azimuth.cos(), height.sin(), height.cos() * azimuth.sin());
        add_light(&mut scene, LightKind::Directional, DVec3::ZERO, -to_sun, [PI as f32; 3]);
        let expected = |_: DVec3| DVec3::splat(0.8 * height.sin());
        let plane = Plane { normal: DVec3::Y, half: 2.0, expected: &expected };
        let error = worst_error(&session, &scene, &camera, &plane);
        if error > worst.0 {
            worst = (error, elevation);
        }
        assert!(error <= TOLERANCE, "at {elevation}°: {error:.2e}");
    }
    println!("direct light of a sun: largest relative error {:.2e}, at {}°", worst.0, worst.1);
}

/// Whether something stands between two points, both kept clear by a thousandth of their distance.
fn is_blocked(triangles: &[[DVec3; 3]], from: DVec3, to: DVec3) -> bool {
    let direction = to - from;
    triangles.iter().any(|[a, b, c]| {
        let (edge1, edge2) = (*b - *a, *c - *a);
        let p = direction.cross(edge2);
        let determinant = edge1.dot(p);
        if determinant.abs() < 1e-14 {
            return false;
        }
        let s = (from - *a) / determinant;
        let (u, q) = (s.dot(p), s.cross(edge1));
        let v = direction.dot(q);
        let t = edge2.dot(q);
        u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (1e-3..1.0 - 1e-3).contains(&t)
    })
}

fn triangles_of(scene: &Scene) -> Vec<[DVec3; 3]> {
    let of_instance = |instance: &crate::scene::Instance| {
        let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
        let world = instance.world;
        let corner = move |point: [f32; 3]| world.transform_point3(DVec3::from(point.map(f64::from)));
        primitive.triangles().map(|triangle| triangle.map(corner)).collect::<Vec<_>>()
    };
    scene.instances().iter().flat_map(of_instance).collect()
}

/// Shadows where the host's rays find them: away from their filtered borders, light is all there or not at all.
#[test]
fn a_room_has_its_shadows_where_rays_find_them() {
    let session = Session::open();
    for name in ["cornell-point", "cornell-spot", "two-rooms"] {
        let scene = builtin(name);
        let triangles = triangles_of(&scene);
        let light = scene.placed_lights()[0].position;
        let request = request(SIZE, scene.camera_view(None).expect("its camera"), &[]);
        let frame = probe(&session, &scene, &settings(&[]), &request, |graph, declared| {
            let buffer = &declared.gbuffer;
            vec![graph.read_back(buffer.depth), graph.read_back(buffer.surface), slot(graph, declared, Slot::Direct)]
        });
        let pixels = frame.pixels([0, 1], SIZE);
        let found = frame.colors(2);
        let blocked: Vec<Option<bool>> = pixels
            .iter()
            .map(|pixel| {
                let pixel = pixel.as_ref()?;
                let point = pixel.position_rs + frame.origin;
                Some(
                    is_blocked(&triangles, point + pixel.normal * 1e-4, light) || pixel.normal.dot(light - point) < 0.0,
                )
            })
            .collect();
        let (mut agree, mut lit, mut dark, mut wrong) = (0, 0, 0, 0);
        for (index, pixel) in (0..).zip(&pixels) {
            let (x, y) = (index % SIZE[0], index / SIZE[0]);
            let Some(pixel) = pixel else { continue };
            if !(2..SIZE[0] - 2).contains(&x) || !(2..SIZE[1] - 2).contains(&y) {
                continue;
            }
            let around = (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (dx, dy)));
            let same = |(dx, dy): (i32, i32)| {
                let place = (y.cast_signed() + dy) * SIZE[0].cast_signed() + x.cast_signed() + dx;
                blocked[place as usize] == blocked[index as usize]
            };
            if !around.into_iter().all(same) {
                continue;
            }
            let to_light = light - frame.origin - pixel.position_rs;
            let placed = &frame.set.lights[0];
            let axis = DVec3::from(placed.direction.map(f64::from));
            let edge = -to_light.normalize().dot(axis) * f64::from(placed.spot_scale) + f64::from(placed.spot_offset);
            let falloff = if placed.kind == 1 { edge.clamp(0.0, 1.0).powi(2) } else { 1.0 };
            let cosine = to_light.normalize().dot(pixel.normal).max(0.0);
            let intensity = DVec3::from(placed.intensity.map(f64::from));
            let full = pixel.albedo * intensity * (FRAC_1_PI * falloff * cosine / to_light.length_squared());
            let expected = if blocked[index as usize] == Some(true) { DVec3::ZERO } else { full };
            if blocked[index as usize] == Some(true) {
                dark += 1
            } else {
                lit += 1
            }
            let tolerance = (full * TOLERANCE).max(DVec3::splat(1e-6));
            if (found[index as usize] - expected).abs().cmple(tolerance).all() { agree += 1 } else { wrong += 1 }
        }
        println!("{name}: {agree} of {} pixels as traced ({lit} lit, {dark} dark), {wrong} not", lit + dark);
        assert!(lit > 200 && f64::from(agree) >= 0.985 * f64::from(lit + dark), "{name}: {wrong} pixels differ");
    }
}
