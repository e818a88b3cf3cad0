//! The flux of light views: in a closed white box every texel's flux lands on a wall, so the texels of a light must add
//! up to what it sends.

use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DVec3};

use super::probe::{light_flux, probe};
use super::scenes::{add_light, closed_box, lambert, place, quad, request, settings, view};
use super::session::Session;
use crate::renderer::FrameRequest;
use crate::scene::{LightKind, Material, Scene};

/// The bound for all lights.
const TOLERANCE: f64 = 0.005;

fn inside_view() -> FrameRequest {
    request([8, 8], view(DVec3::new(0.9, 0.8, 0.7), DVec3::ZERO), &[])
}

/// What each light's texels reflect in the scene, W.
fn measure(session: &Session, scene: &Scene) -> Vec<DVec3> {
    let frame =
        probe(session, scene, &settings(&[]), &inside_view(), |graph, declared| vec![light_flux(graph, declared)]);
    frame.flux_of_lights(0)
}

fn assert_flux(what: &str, found: DVec3, expected: DVec3) {
    let error = ((found - expected) / expected).abs().max_element();
    println!("flux of {what}: {:.6} W, relative error {error:.2e}", found.x);
    assert!(error <= TOLERANCE, "{what}: {found} W of {expected} W, {error:.2e} apart");
}

/// ∫ I·attenuation dω by Simpson's rule over the cosine.
pub(super) fn spot_power(inner: f64, outer: f64) -> f64 {
    let (low, high) = (outer.cos(), 1.0);
    let attenuation = |cosine: f64| ((cosine - low) / (inner.cos() - low).max(0.001)).clamp(0.0, 1.0).powi(2);
    let steps = 200_000;
    let width = (high - low) / f64::from(steps);
    let at = |step: i32| {
        let weight = if step == 0 || step == steps { 1.0 } else { f64::from(2 + 2 * (step % 2)) };
        weight * attenuation(low + width * f64::from(step))
    };
    2.0 * PI * width / 3.0 * (0..=steps).map(at).sum::<f64>()
}

fn white_box() -> Scene {
    closed_box(1.0, lambert([1.0; 3]))
}

#[test]
fn a_spot_sends_its_power() {
    let session = Session::open();
    let intensity = [3.0, 0.5, 7.0];
    for degrees in [15_f64, 30.0, 45.0, 60.0, 75.0, 85.0] {
        for (edge, share) in [("smooth", 0.5), ("sharp", 0.999)] {
            let outer = degrees.to_radians() as f32;
            let inner = (degrees * share).to_radians() as f32;
            let mut scene = white_box();
            let kind = LightKind::Spot { inner_angle: inner, outer_angle: outer };
            let (position, direction) = (DVec3::new(0.2, 0.3, -0.1), DVec3::new(0.5, -1.0, 0.3));
            add_light(&mut scene, kind, position, direction, intensity);
            let power = spot_power(f64::from(inner), f64::from(outer));
            let expected = DVec3::from(intensity.map(f64::from)) * power;
            assert_flux(&format!("a {edge} spot of {degrees}°"), measure(&session, &scene)[0], expected);
        }
    }
}

#[test]
fn a_point_sends_its_power() {
    let session = Session::open();
    for position in [DVec3::ZERO, DVec3::new(0.9, -0.95, 0.5)] {
        let mut scene = white_box();
        add_light(&mut scene, LightKind::Point, position, DVec3::new(0.3, -0.8, 0.1), [2.0, 1.0, 0.25]);
        let expected = 4.0 * PI * DVec3::new(2.0, 1.0, 0.25);
        assert_flux(&format!("a point at {position}"), measure(&session, &scene)[0], expected);
    }
}

/// The area of a box with edges of 2 m as seen along a unit vector, m².
fn projected_area(direction: DVec3) -> f64 {
    4.0 * direction.abs().element_sum()
}

#[test]
fn a_directional_light_sends_what_the_scene_catches() {
    let session = Session::open();
    for direction in [DVec3::NEG_Y, DVec3::new(1.0, -1.0, 0.0), DVec3::new(0.3, -0.5, 0.8), DVec3::new(0.02, -1.0, 0.9)]
    {
        let mut scene = white_box();
        add_light(&mut scene, LightKind::Directional, DVec3::ZERO, direction, [5.0, 2.0, 1.0]);
        let expected = DVec3::new(5.0, 2.0, 1.0) * projected_area(direction.normalize());
        assert_flux(&format!("a sun along {direction}"), measure(&session, &scene)[0], expected);
    }
}

/// A panel of 0.8 m x 0.6 m and 2 W/(m² sr) in the middle of the box.
fn panel(double_sided: bool) -> Scene {
    let mut scene = white_box();
    let material = Material { emissive: [2.0, 4.0, 1.0], double_sided, ..lambert([1.0; 3]) };
    let material = scene.add_material(material).expect("a sound material");
    let corners = [[-0.4, 0.0, -0.3], [-0.4, 0.0, 0.3], [0.4, 0.0, 0.3], [0.4, 0.0, -0.3]];
    let turned = DAffine3::from_mat3_translation(DMat3::from_rotation_x(0.4), DVec3::new(0.1, 0.2, -0.1));
    place(&mut scene, vec![quad(corners, material)], turned);
    scene
}

#[test]
fn emitter_samples_send_the_power_of_their_surface() {
    let session = Session::open();
    for double_sided in [false, true] {
        let fluxes = measure(&session, &panel(double_sided));
        let sides = if double_sided { 2.0 } else { 1.0 };
        assert_eq!(fluxes.len(), if double_sided { 16 } else { 8 });
        let expected = DVec3::new(2.0, 4.0, 1.0) * (PI * 0.48 * sides);
        assert_flux(&format!("a panel of {sides} sides"), fluxes.into_iter().sum(), expected);
    }
}

#[test]
fn a_sky_sends_what_the_scene_catches() {
    let session = Session::open();
    let mut scene = white_box();
    let radiance = DVec3::new(0.5, 0.75, 1.5);
    scene.set_sky([0.5, 0.75, 1.5]);
    let frame =
        probe(&session, &scene, &settings(&[("lights.resolution", "256")]), &inside_view(), |graph, declared| {
            vec![light_flux(graph, declared)]
        });
    let fluxes = frame.flux_of_lights(0);
    for (index, (light, found)) in frame.set.lights.iter().zip(&fluxes).enumerate() {
        let direction = DVec3::from(light.direction.map(f64::from));
        let expected = radiance * (4.0 * PI / 16.0) * projected_area(direction);
        assert_flux(&format!("sky sample {index}"), *found, expected);
    }
    // A convex body catches πL a square metre of its surface; 16 directions estimate that mean.
    let all: DVec3 = fluxes.into_iter().sum();
    let error = (all.x / (PI * 0.5 * 24.0) - 1.0).abs();
    println!("flux of the whole sky: relative error {error:.2e}");
    assert!(error < 0.02, "{all}");
}

/// Light through the open side of a box goes past everything: it must not be counted.
#[test]
fn light_that_meets_nothing_reflects_nothing() {
    let session = Session::open();
    let mut scene = Scene::empty("floor");
    let white = scene.add_material(lambert([1.0; 3])).expect("a sound material");
    let corners = [[-1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, -1.0, -1.0]];
    place(&mut scene, vec![quad(corners, white)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [3.0; 3]);
    let sixth = DVec3::splat(3.0 * 4.0 * PI / 6.0);
    assert_flux("a point above a face of its cube", measure(&session, &scene)[0], sixth);
}
