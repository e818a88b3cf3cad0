//! The weights of mis.glsl: with paths from the lights and without them, every slot has the same mean.

use std::f32::consts::FRAC_PI_2;

use glam::{DAffine3, DVec3};

use super::path_probe::{Ask, Tracer, solid_box, sphere, turned};
use super::scenes::{add_light, lambert, place, quad, view};
use super::session::Session;
use crate::renderer::Slot;
use crate::scene::{LightKind, Material, Scene};
use crate::slot::CausticPaths;

/// Of each half, with light paths and without.
const SAMPLES: [u32; 2] = [64, 256];

#[derive(Clone, Copy, Debug)]
enum Lamp {
    Point,
    Spot,
    Sun,
    Panel,
    Sheet,
}

#[derive(Clone, Copy, Debug)]
enum Thing {
    FlatBox,
    SmoothSphere,
}

/// A thing on a matt floor before a matt wall, under a lamp.
fn scene(material: Material, thing: Thing, lamp: Lamp) -> Scene {
    let mut scene = Scene::empty("thing");
    let [red, white] = [[0.8, 0.3, 0.2], [0.7; 3]].map(|color| scene.add_material(lambert(color)).expect("sound"));
    let ground = quad([[-2.0, 0.0, -2.0], [-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0]], white);
    let wall = quad([[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 3.0, -2.0], [-2.0, 3.0, -2.0]], red);
    place(&mut scene, vec![ground, wall], DAffine3::IDENTITY);
    let id = scene.add_material(material).expect("sound");
    match thing {
        Thing::FlatBox => {
            let faces = solid_box(DVec3::splat(-0.6), DVec3::splat(0.6), id);
            place(&mut scene, faces, turned(1.0, DVec3::new(0.0, 1.1, -0.6)));
        }
        Thing::SmoothSphere => {
            place(&mut scene, vec![sphere(12, true, id)], turned(0.8, DVec3::new(0.0, 1.0, -0.6)));
        }
    }
    let position = DVec3::new(1.2, 2.6, 1.2);
    let direction = DVec3::new(0.0, 0.8, -0.6) - position;
    match lamp {
        Lamp::Point => drop(add_light(&mut scene, LightKind::Point, position, direction, [10.0; 3])),
        Lamp::Spot => {
            let kind = LightKind::Spot { inner_angle: 0.1, outer_angle: 0.3 * FRAC_PI_2 };
            add_light(&mut scene, kind, position, direction, [10.0; 3]);
        }
        Lamp::Sun => drop(add_light(&mut scene, LightKind::Directional, position, direction, [3.0; 3])),
        Lamp::Panel | Lamp::Sheet => {
            let double_sided = matches!(lamp, Lamp::Sheet);
            let glowing = Material { emissive: [12.0; 3], double_sided, ..lambert([0.5; 3]) };
            let glowing = scene.add_material(glowing).expect("sound");
            let corners = [[0.7, 2.4, 0.7], [1.5, 2.4, 0.7], [1.5, 2.4, 1.5], [0.7, 2.4, 1.5]];
            place(&mut scene, vec![quad(corners, glowing)], DAffine3::IDENTITY);
        }
    }
    scene
}

/// The slots have the same means with and without light paths.
fn assert_agreement(tracer: &mut Tracer, material: &Material, thing: Thing, lamp: Lamp) {
    assert_agreement_of(tracer, material, thing, lamp, CausticPaths::All);
}

fn assert_agreement_of(tracer: &mut Tracer, material: &Material, thing: Thing, lamp: Lamp, caustics: CausticPaths) {
    let scene = scene(material.clone(), thing, lamp);
    let camera = view(DVec3::new(-0.4, 2.0, 3.2), DVec3::new(0.0, 0.7, -0.6));
    let [with, without] = [true, false].map(|light_paths| {
        let samples = SAMPLES[usize::from(!light_paths)];
        let ask = Ask {
            light_paths: Some(light_paths),
            bounces: Some(4),
            caustics,
            ..Ask::new([80, 80], samples, camera.clone())
        };
        tracer.trace(&scene, &ask)
    });
    let mut failures = Vec::new();
    for slot in [Slot::Direct, Slot::Diffuse, Slot::Caustics, Slot::Specular] {
        let [a, b] = [&with, &without].map(|traced| traced.mean(slot));
        let [sure_a, sure_b] = [&with, &without].map(|traced| traced.error(slot));
        let noise = (sure_a.powi(2) + sure_b.powi(2)).sqrt();
        let off = (a - b).abs().max_element();
        println!(
            "{thing:?}, {lamp:?}, {slot}: {:.5} ± {sure_a:.1e} with, {:.5} ± {sure_b:.1e} without: {:+.2} %, {:.1} σ",
            a.x,
            b.x,
            100.0 * (a.x / b.x - 1.0),
            (a.x - b.x) / noise
        );
        if off > (4.0 * noise).max(0.002 * b.max_element()) || !off.is_finite() {
            failures.push(slot);
        }
    }
    assert!(failures.is_empty(), "{thing:?} of {material:?} under {lamp:?}: {failures:?}");
}

#[test]
fn rough_metal_sends_the_same_light_either_way() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let metal = |roughness| Material { metallic: 1.0, roughness, ..lambert([0.9, 0.7, 0.5]) };
    for lamp in [Lamp::Point, Lamp::Spot, Lamp::Sun, Lamp::Panel, Lamp::Sheet] {
        assert_agreement(&mut tracer, &metal(0.45), Thing::FlatBox, lamp);
    }
    assert_agreement(&mut tracer, &metal(0.6), Thing::SmoothSphere, Lamp::Point);
    assert_agreement(&mut tracer, &metal(0.4), Thing::SmoothSphere, Lamp::Panel);
}

#[test]
fn glossy_plastic_sends_the_same_light_either_way() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let plastic = Material { roughness: 0.45, base_color: [0.3, 0.6, 0.8, 1.0], ior: 2.0, ..Material::default() };
    for (thing, lamp) in [(Thing::FlatBox, Lamp::Spot), (Thing::SmoothSphere, Lamp::Panel)] {
        assert_agreement(&mut tracer, &plastic, thing, lamp);
    }
}

#[test]
fn rough_glass_sends_the_same_light_either_way() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let glass = |thickness| Material {
        transmission: 0.9,
        roughness: 0.5,
        thickness,
        base_color: [0.9, 0.8, 0.7, 1.0],
        attenuation_color: [0.5, 0.8, 0.9],
        attenuation_distance: 1.0,
        ..Material::default()
    };
    for thickness in [0.0, 1.0] {
        for (thing, lamp) in [(Thing::FlatBox, Lamp::Point), (Thing::SmoothSphere, Lamp::Panel)] {
            println!("thickness {thickness}");
            assert_agreement(&mut tracer, &glass(thickness), thing, lamp);
        }
    }
}

#[test]
fn caustics_of_specular_paths_alone_are_the_same_either_way() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let metal = Material { metallic: 1.0, roughness: 0.45, ..lambert([0.9, 0.7, 0.5]) };
    assert_agreement_of(&mut tracer, &metal, Thing::FlatBox, Lamp::Panel, CausticPaths::Specular);

    let scene = scene(metal, Thing::FlatBox, Lamp::Panel);
    let mut means = |bounces, caustics| {
        let camera = view(DVec3::new(-0.4, 2.0, 3.2), DVec3::new(0.0, 0.7, -0.6));
        let ask = Ask { bounces: Some(bounces), caustics, ..Ask::new([48, 48], 32, camera) };
        let traced = tracer.trace(&scene, &ask);
        [Slot::Diffuse, Slot::Caustics].map(|slot| traced.mean(slot).element_sum())
    };
    // After one scattering it was a specular one; after more, some light scattered diffusely before that.
    let [one, one_specular] = [CausticPaths::All, CausticPaths::Specular].map(|caustics| means(1, caustics));
    assert_eq!(one, one_specular);
    let [more, more_specular] = [CausticPaths::All, CausticPaths::Specular].map(|caustics| means(4, caustics));
    assert!(
        more_specular[1] < 0.98 * more[1] && more_specular[1] >= one[1] * 0.99,
        "{more_specular:?} of {more:?}, {one:?}"
    );
    assert!((more_specular[0] / more[0] - 1.0).abs() < 0.02, "{more_specular:?} of {more:?}");
}
