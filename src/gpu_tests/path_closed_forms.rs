//! Traced paths against closed forms of diffuse light: the furnace, parallel squares, lights above a plane.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::{DAffine3, DVec3};

use super::path_probe::{Ask, Tracer, assert_near, down, mean};
use super::scenes::{add_light, builtin, closed_box, floor, lambert, place, quad, view};
use super::session::Session;
use crate::renderer::Slot;
use crate::scene::{CameraView, LightKind, Material, Scene};
use crate::slot::PixelFilter;

fn inside() -> CameraView {
    view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO)
}

/// Emission e and albedo ρ everywhere: e·Σ ρⁿ, one power of the albedo a scattering.
#[test]
fn a_furnace_shows_a_geometric_series() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let emission = DVec3::new(1.0, 2.0, 0.5);
    for albedo in [0.2, 0.5, 0.8] {
        let material = Material { emissive: emission.as_vec3().to_array(), ..lambert([albedo as f32; 3]) };
        let scene = closed_box(1.0, material);
        // Roulette ends most paths where little is reflected.
        let ask = Ask::new([16, 16], (320.0 / albedo) as u32, inside());
        let all = tracer.trace(&scene, &ask);
        assert_near(&format!("furnace of albedo {albedo}"), mean(&all.image()), emission / (1.0 - albedo), 0.005);
        assert_near("its emission", all.mean(Slot::Emission), emission, 1e-6);
        assert_near("its direct light", all.mean(Slot::Direct), emission * albedo, 0.005);
        for slot in [Slot::Caustics, Slot::Specular] {
            assert_eq!(all.mean(slot), DVec3::ZERO, "{slot}");
        }
        for bounces in [0, 1, 2] {
            let some = tracer.trace(&scene, &Ask { bounces: Some(bounces), ..ask.clone() });
            let expected = (2..2 + bounces).map(|power| albedo.powi(power.cast_signed())).sum::<f64>() * emission;
            if bounces == 0 {
                assert_eq!(some.mean(Slot::Diffuse), DVec3::ZERO);
            } else {
                let what = format!("its light of at most {bounces} bounces");
                let sure = 4.0 * some.error(Slot::Diffuse) / expected.max_element();
                assert_near(&what, some.mean(Slot::Diffuse), expected, sure.max(0.005));
            }
        }
    }
}

/// Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11, for squares of side `side` at distance 1.
fn form_factor(side: f64) -> f64 {
    let (squared, root) = (side * side, (1.0 + side * side).sqrt());
    let logarithm = ((1.0 + squared).powi(2) / (1.0 + 2.0 * squared)).sqrt().ln();
    2.0 / (PI * squared) * (logarithm + 2.0 * side * root * (side / root).atan() - 2.0 * side * side.atan())
}

/// An emissive square above a diffuse one: the receiver's mean is ρ·L·F.
#[test]
fn parallel_squares_exchange_light_by_their_form_factor() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    assert!((form_factor(1.0) - 0.199_825).abs() < 1e-6);
    for side in [0.25, 1.0, 4.0] {
        let half = 0.5 * side as f32;
        let mut scene = floor(half, lambert([0.5, 0.8, 0.2]));
        let glowing = Material { emissive: [3.0, 1.0, 2.0], ..lambert([0.0; 3]) };
        let glowing = scene.add_material(glowing).expect("a sound material");
        let corners = [[-half, 1.0, -half], [half, 1.0, -half], [half, 1.0, half], [-half, 1.0, half]];
        place(&mut scene, vec![quad(corners, glowing)], DAffine3::IDENTITY);
        let ask = Ask::new([16, 16], 64, down(DVec3::new(0.0, 0.5, 0.0), 0.5 * side));
        let traced = tracer.trace(&scene, &ask);
        let expected = DVec3::new(1.5, 0.8, 0.4) * form_factor(side);
        assert_near(&format!("squares of side {side} at distance 1"), traced.mean(Slot::Direct), expected, 0.005);
        for slot in [Slot::Emission, Slot::Diffuse, Slot::Caustics, Slot::Specular] {
            assert_eq!(traced.mean(slot), DVec3::ZERO, "a black emitter reflects nothing: {slot}");
        }
        let turned_away = tracer.trace(&turn_over(&scene), &ask);
        assert_eq!(turned_away.mean(Slot::Direct), DVec3::ZERO, "an emitter's back is dark");
    }
}

/// The scene with its second mesh's faces the other way round.
fn turn_over(scene: &Scene) -> Scene {
    let mut turned = Scene::empty("turned over");
    for material in scene.materials() {
        turned.add_material(material.clone()).expect("a sound material");
    }
    let [receiver, emitter] = [0, 1].map(|mesh| scene.meshes()[mesh].primitives[0].clone());
    let emitter = crate::scene::Primitive { indices: vec![0, 2, 1, 0, 3, 2], ..emitter };
    place(&mut turned, vec![receiver, emitter], DAffine3::IDENTITY);
    turned
}

/// Every pixel's centre: no noise, so one sample tells.
fn assert_plane(tracer: &mut Tracer, what: &str, scene: &Scene, half: f64, expected: impl Fn(DVec3) -> DVec3) {
    const SIDE: u32 = 32;
    let ask = Ask { filter: PixelFilter::Center, ..Ask::new([SIDE; 2], 1, down(DVec3::new(0.0, 4.0, 0.0), half)) };
    let traced = tracer.trace(scene, &ask);
    let mut worst = 0.0_f64;
    for (index, found) in (0..).zip(traced.slot(Slot::Direct)) {
        let place = |pixel: u32| half * ((2.0 * f64::from(pixel) + 1.0) / f64::from(SIDE) - 1.0);
        let point = DVec3::new(place(index % SIDE), 0.0, place(index / SIDE));
        let expected = expected(point);
        let error = ((found - expected) / expected).abs().max_element();
        assert!(error < 1e-3, "{what}: {found} in place of {expected} at {point}");
        worst = worst.max(error);
    }
    println!("{what}: largest relative error {worst:.2e}");
    assert!(worst < 1e-4, "{what}: {worst:.2e}");
}

#[test]
fn a_plane_shows_each_kind_of_light() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let albedo = DVec3::new(0.5, 0.25, 0.75);
    let bare = || floor(3.0, lambert([0.5, 0.25, 0.75]));
    let position = DVec3::new(0.4, 1.2, -0.3);
    let axis = (DVec3::new(0.2, 0.0, 0.1) - position).normalize();
    let arriving = |point: DVec3| (position - point).normalize().y / (position - point).length_squared();
    let intensity = [4.0, 9.0, 2.0];
    let watts = DVec3::from(intensity.map(f64::from));

    let mut scene = bare();
    add_light(&mut scene, LightKind::Point, position, DVec3::NEG_Y, intensity);
    assert_plane(&mut tracer, "a point light", &scene, 2.0, |point| albedo * FRAC_1_PI * watts * arriving(point));

    let (inner, outer) = (0.3_f64, 1.2_f64);
    let mut scene = bare();
    let spot = LightKind::Spot { inner_angle: inner as f32, outer_angle: outer as f32 };
    add_light(&mut scene, spot, position, axis, intensity);
    assert_plane(&mut tracer, "a spot light", &scene, 0.8, |point| {
        let cosine = (point - position).normalize().dot(axis);
        let falloff = ((cosine - outer.cos()) / (inner.cos() - outer.cos())).clamp(0.0, 1.0).powi(2);
        albedo * FRAC_1_PI * watts * (falloff * arriving(point))
    });

    let mut scene = bare();
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.6, -0.8, 0.0), intensity);
    assert_plane(&mut tracer, "a sun", &scene, 2.0, |_| albedo * FRAC_1_PI * watts * 0.8);

    let mut scene = bare();
    scene.set_sky([2.0, 1.0, 0.5]);
    let traced = tracer.trace(&scene, &Ask::new([16, 16], 256, down(DVec3::new(0.0, 4.0, 0.0), 2.0)));
    assert_near("a sky", traced.mean(Slot::Direct), albedo * DVec3::new(2.0, 1.0, 0.5), 0.002);
}

#[test]
fn the_built_in_furnace_is_as_it_says() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let furnace = builtin("furnace");
    let camera = furnace.camera_view(None).expect("its camera");
    let traced = tracer.trace(&furnace, &Ask::new([16, 16], 64, camera));
    assert_near("the built-in furnace", mean(&traced.image()), DVec3::splat(2.0), 0.005);
}
