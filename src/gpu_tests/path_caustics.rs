//! Traced paths against closed forms of specular light: a mirror's image source, slabs of glass, thin walls, absorption.

use std::f64::consts::FRAC_1_PI;

use glam::{DAffine3, DVec3};

use super::path_probe::{Ask, Tracer, assert_near, down, solid_box};
use super::scenes::{add_light, floor, lambert, place, quad};
use super::session::Session;
use crate::renderer::Slot;
use crate::scene::{LightKind, Material, Scene};

/// Of glass with an index of 1.5 at normal incidence.
const FRESNEL: f64 = 0.04;

/// A spot beside an upright mirror: on the floor before it lies the light of the spot's image behind it, times Schlick's
/// reflectance at the angle of incidence.
#[test]
fn a_mirror_lights_the_floor_as_the_image_of_the_light_would() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let albedo = DVec3::new(0.5, 0.25, 0.75);
    let f0 = DVec3::new(0.9, 0.5, 0.7);
    let mut scene = floor(1.5, lambert([0.5, 0.25, 0.75]));
    let mirror = Material { metallic: 1.0, roughness: 0.0, ..lambert(f0.as_vec3().to_array()) };
    let mirror = scene.add_material(mirror).expect("a sound material");
    let corners = [[-1.0, 0.0, -1.5], [-1.0, 2.0, -1.5], [-1.0, 2.0, 1.5], [-1.0, 0.0, 1.5]];
    place(&mut scene, vec![quad(corners, mirror)], DAffine3::IDENTITY);
    let (middle, half) = (DVec3::new(0.0, 0.0, 0.2), 0.4);
    let position = DVec3::new(-0.4, 1.0, 0.1);
    let image = DVec3::new(-1.6, 1.0, 0.1);
    // The core of the cone covers what is seen, by way of the mirror.
    let toward = (middle - image) * DVec3::new(-1.0, 1.0, 1.0);
    let spot = LightKind::Spot { inner_angle: 0.42, outer_angle: 0.43 };
    add_light(&mut scene, spot, position, toward, [3.0; 3]);

    const SIDE: u32 = 96;
    let ask = Ask::new([SIDE; 2], 16, down(middle + 0.9 * DVec3::Y, half));
    let traced = tracer.trace(&scene, &ask);
    let expected_at = |point: DVec3| {
        let way = image - point;
        let to_light = way.normalize();
        let schlick = f0 + (DVec3::ONE - f0) * (1.0 - to_light.x.abs()).powi(5);
        albedo * schlick * (3.0 * FRAC_1_PI * to_light.y / way.length_squared())
    };
    let step = 2.0 * half / f64::from(SIDE);
    // The whole, and its quarters, among which the light falls off.
    let mut sums = [[DVec3::ZERO; 2]; 4];
    for (index, found) in (0..).zip(traced.slot(Slot::Caustics)) {
        let (x, y) = (index % SIDE, index / SIDE);
        let place = |pixel: u32| step * (f64::from(pixel) + 0.5) - half;
        let quarter = 2 * usize::from(2 * y >= SIDE) + usize::from(2 * x >= SIDE);
        sums[quarter][0] += found;
        sums[quarter][1] += expected_at(middle + DVec3::new(place(x), 0.0, place(y)));
    }
    let all = |which: usize| sums.iter().map(|quarter| quarter[which]).sum::<DVec3>();
    assert_near("light by way of a mirror", all(0), all(1), 0.01);
    for [found, expected] in sums {
        assert_near("a quarter of it", found, expected, 0.03);
    }
}

/// Between a floor and a height of 0.5 nothing, then a slab of this material and thickness; a sun above.
fn under_a_slab(slab: Material, thickness: f64, floor_material: Material) -> Scene {
    let mut scene = floor(1.0, floor_material);
    let slab = scene.add_material(slab).expect("a sound material");
    let faces = if thickness > 0.0 {
        solid_box(DVec3::new(-1.0, 0.5, -1.0), DVec3::new(1.0, 0.5 + thickness, 1.0), slab)
    } else {
        vec![quad([[-1.0, 0.5, -1.0], [-1.0, 0.5, 1.0], [1.0, 0.5, 1.0], [1.0, 0.5, -1.0]], slab)]
    };
    place(&mut scene, faces, DAffine3::IDENTITY);
    scene
}

fn glass() -> Material {
    Material { transmission: 1.0, roughness: 0.0, thickness: 1.0, ..Material::default() }
}

/// What a floor gets of a sun through a slab, in the slot `caustics`, and what the eye sees of a floor that glows, in `specular`: both
/// are the slab's transmittance.
fn assert_slab(tracer: &mut Tracer, what: &str, slab: &Material, thickness: f64, transmittance: DVec3) {
    // So dark that light that goes back and forth between floor and slab does not count.
    let albedo = 0.02;
    let mut scene = under_a_slab(slab.clone(), thickness, lambert([albedo as f32; 3]));
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::NEG_Y, [5.0; 3]);
    let below = Ask::new([96, 96], 10, down(DVec3::new(0.0, 0.4, 0.0), 0.6));
    let traced = tracer.trace(&scene, &below);
    let expected = transmittance * (5.0 * albedo * FRAC_1_PI);
    println!("standard error {:.1e}", traced.error(Slot::Caustics) / expected.x);
    assert_near(&format!("a sun through {what}"), traced.mean(Slot::Caustics), expected, 0.01);
    assert_eq!(traced.mean(Slot::Specular), DVec3::ZERO, "the floor is matt");

    let glowing = Material { emissive: [3.0, 2.0, 1.0], ..lambert([0.0; 3]) };
    let scene = under_a_slab(slab.clone(), thickness, glowing);
    let above = Ask::new([64, 64], 2, down(DVec3::new(0.0, 2.0, 0.0), 0.2));
    let traced = tracer.trace(&scene, &above);
    // What is met at once is direct light, what is met through a second surface is not.
    let slot = if thickness > 0.0 { Slot::Specular } else { Slot::Direct };
    assert_near(&format!("a view through {what}"), traced.mean(slot), transmittance * DVec3::new(3.0, 2.0, 1.0), 0.01);
}

#[test]
fn a_slab_of_glass_passes_what_fresnel_says() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let (f, d) = (FRESNEL, 0.25);
    assert_slab(&mut tracer, "a slab", &glass(), d, DVec3::splat((1.0 - f) / (1.0 + f)));
    let thin = Material { thickness: 0.0, ..glass() };
    assert_slab(&mut tracer, "a thin wall", &thin, 0.0, DVec3::splat(1.0 - f));
    let tinted = Material { base_color: [0.9, 0.6, 0.3, 1.0], ..thin };
    assert_slab(&mut tracer, "a tinted thin wall", &tinted, 0.0, DVec3::new(0.9, 0.6, 0.3) * (1.0 - f));
}

/// Beer and Lambert: the colour after the distance is the attenuation colour, and its power elsewhere.
#[test]
fn a_slab_absorbs_by_its_thickness() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let colors = [0.8, 0.5, 0.2];
    let absorbing = Material { attenuation_color: colors, attenuation_distance: 0.5, ..glass() };
    for thickness in [0.25, 1.0] {
        let one_way = DVec3::from(colors.map(|color| f64::from(color).powf(thickness / 0.5)));
        let f = FRESNEL;
        let expected = one_way * ((1.0 - f) * (1.0 - f)) / (DVec3::ONE - one_way * one_way * (f * f));
        assert_slab(&mut tracer, &format!("{thickness} m of absorbing glass"), &absorbing, thickness, expected);
    }
}
