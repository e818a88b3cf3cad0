//! Photons where they start: how many there are, what they carry, where they are sent.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use super::path_probe::{sphere, turned};
use super::photons_probe::{passes_of_second_frame, photon_settings, photons, total};
use super::scenes::{add_light, builtin, closed_box, floor, lambert, place, quad, request};
use super::session::Session;
use crate::renderer::{DirectMethod, Methods, Settings, Slot, Timing};
use crate::scene::{Alpha, LightKind, Material, Scene, Texture, TextureRef, Wrap};

fn mirror() -> Material {
    Material { metallic: 1.0, roughness: 0.0, ..Material::default() }
}

const INTENSITY: [f32; 3] = [2.0, 1.0, 0.25];

fn intensity() -> DVec3 {
    DVec3::from(INTENSITY.map(f64::from))
}

/// A box that is a mirror all over, seen from the inside.
fn mirror_box(kind: LightKind) -> Scene {
    let mut scene = closed_box(1.0, mirror());
    add_light(&mut scene, kind, DVec3::new(0.2, 0.3, -0.1), DVec3::new(0.3, -0.8, 0.1), INTENSITY);
    scene
}

fn first_bounce(most: &str, resolution: &str) -> Settings {
    photon_settings(&[("photons.max", most), ("photons.bounces", "1"), ("lights.resolution", resolution)])
}

#[test]
fn photons_carry_what_specular_surfaces_receive_however_many_they_are() {
    let session = Session::open();
    let scene = mirror_box(LightKind::Point);
    let expected = 4.0 * PI * intensity();
    for most in [1, 100, 17_021, 38_000, 1_000_000] {
        let found = photons(&session, &scene, &first_bounce(&most.to_string(), "128"), Timing::Frame);
        let flux = total(found.arrivals.iter().map(|photon| photon.flux));
        println!("at most {most}: {} photons of level {}, {flux} W of {expected} W", found.emitted, found.level);
        assert_eq!(found.emitted, most, "photons sent of those allowed");
        let mut numbers: Vec<u32> = found.arrivals.iter().map(|photon| photon.number).collect();
        numbers.sort_unstable();
        numbers.dedup();
        assert_eq!([found.emitted; 2], [found.arrivals.len(), numbers.len()]);
        assert!(((flux - expected) / expected).abs().max_element() < 1e-3, "{flux} W of {expected} W");
    }
}

/// A ball hangs in the light of a lamp: (1 − cosθ)/2 of its power falls on it, with sinθ = r/d. Whatever the level, none of its
/// silhouette is lost; what blocks cut off is only where their photon sits.
#[test]
fn silhouettes_keep_their_flux() {
    let session = Session::open();
    let mut scene = closed_box(2.0, lambert([0.5; 3]));
    let material = scene.add_material(mirror()).expect("a sound material");
    place(&mut scene, vec![sphere(64, true, material)], DAffine3::from_scale(DVec3::splat(0.3)));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.2, 1.1, 0.4), DVec3::NEG_Y, INTENSITY);
    let distance = DVec3::new(0.2, 1.1, 0.4).length();
    let cosine = (1.0 - (0.3 / distance).powi(2)).sqrt();
    let expected = 2.0 * PI * (1.0 - cosine) * intensity();
    for most in ["40", "700", "100000"] {
        let found = photons(&session, &scene, &first_bounce(most, "128"), Timing::Frame);
        let flux = total(found.arrivals.iter().map(|photon| photon.flux));
        println!("{} photons of level {}: {flux} W of {expected} W", found.emitted, found.level);
        // The ball has facets, and the views have texels: 1 % of its outline.
        assert!(((flux - expected) / expected).abs().max_element() < 0.01, "{flux} W of {expected} W");
        for photon in &found.arrivals {
            let off = photon.origin.length() - 0.3;
            // At the outline the plane of a texel of 2 cm leaves the ball.
            assert!(off.abs() < 0.02, "a photon {off} m off the ball");
        }
    }
}

#[test]
fn every_kind_of_light_sends_photons() {
    let session = Session::open();
    let spot = LightKind::Spot { inner_angle: 0.3, outer_angle: 0.6 };
    let wide = LightKind::Spot { inner_angle: 1.3, outer_angle: 1.45 };
    for kind in [LightKind::Point, spot, wide, LightKind::Directional] {
        let scene = mirror_box(kind);
        let settings = first_bounce("20000", "128");
        let found = photons(&session, &scene, &settings, Timing::Frame);
        let flux = total(found.arrivals.iter().map(|photon| photon.flux));
        let expected = expected_flux(kind);
        println!("{kind:?}: {flux} W of {expected} W by {} photons", found.emitted);
        assert!(((flux - expected) / expected).abs().max_element() < 0.005, "{kind:?}: {flux} W of {expected} W");
    }
    let mut scene = closed_box(1.0, mirror());
    let glowing = Material { emissive: [2.0, 4.0, 1.0], ..lambert([0.0; 3]) };
    let glowing = scene.add_material(glowing).expect("a sound material");
    let corners = [[-0.4, 0.0, -0.3], [-0.4, 0.0, 0.3], [0.4, 0.0, 0.3], [0.4, 0.0, -0.3]];
    place(&mut scene, vec![quad(corners, glowing)], DAffine3::IDENTITY);
    let found = photons(&session, &scene, &first_bounce("20000", "128"), Timing::Frame);
    let flux = total(found.arrivals.iter().map(|photon| photon.flux));
    let expected = DVec3::new(2.0, 4.0, 1.0) * (PI * 0.48);
    println!("a panel: {flux} W of {expected} W by {} photons", found.emitted);
    assert!(((flux - expected) / expected).abs().max_element() < 0.005, "a panel: {flux} W of {expected} W");
}

/// Power in the box of 2 m, W.
fn expected_flux(kind: LightKind) -> DVec3 {
    match kind {
        LightKind::Point => 4.0 * PI * intensity(),
        LightKind::Directional => 4.0 * DVec3::new(0.3, -0.8, 0.1).normalize().abs().element_sum() * intensity(),
        LightKind::Spot { inner_angle, outer_angle } => {
            let (inner, outer) = (f64::from(inner_angle).cos(), f64::from(outer_angle).cos());
            // ∫ ((c − outer)/(inner − outer))² dc over the rim, and 1 within.
            2.0 * PI * ((1.0 - inner) + (inner - outer) / 3.0) * intensity()
        }
    }
}

/// Photons leave an upright mirror as if they came from the light's image behind it.
#[test]
fn a_mirror_sends_photons_from_the_image_of_the_light() {
    let session = Session::open();
    let mut scene = floor(1.5, lambert([0.5; 3]));
    let material = scene.add_material(mirror()).expect("a sound material");
    let corners = [[-1.0, 0.0, -1.5], [-1.0, 2.0, -1.5], [-1.0, 2.0, 1.5], [-1.0, 0.0, 1.5]];
    place(&mut scene, vec![quad(corners, material)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(-0.4, 1.0, 0.1), DVec3::NEG_Y, INTENSITY);
    let image = DVec3::new(-1.6, 1.0, 0.1);
    for most in ["2000", "60000"] {
        let found = photons(&session, &scene, &first_bounce(most, "384"), Timing::Frame);
        let mut worst = [0.0_f64; 2];
        for ray in &found.rays {
            let way = ray.origin + found.origin - image;
            worst[0] = worst[0].max(way.normalize().distance(ray.direction));
            worst[1] = worst[1].max((way.length() - ray.travelled).abs());
        }
        println!("{} photons: directions {:.1e}, ways {:.1e} m off", found.emitted, worst[0], worst[1]);
        // GGX of α = 10⁻³ has long tails.
        let near = found
            .rays
            .iter()
            .filter(|ray| (ray.origin + found.origin - image).normalize().distance(ray.direction) < 0.01);
        assert!(near.count() as f64 > 0.9 * found.rays.len() as f64);
        assert!(worst[1] < 2e-3);
        // What the floor gets of the image: its solid angle as seen through the mirror, by the photons' own positions.
        let landed = total(found.landed.iter().map(|photon| photon.flux));
        let expected = intensity() * floor_through_mirror(image);
        println!("{landed} W of {expected} W land");
        assert!(((landed - expected) / expected).abs().max_element() < 0.01, "{landed} W of {expected} W");
        for photon in &found.landed {
            let position = photon.position + found.origin;
            assert!(position.y.abs() < 1e-4 && photon.normal.y > 0.999, "{photon:?}");
        }
    }
}

/// ∫ dω over the directions from the image through the mirror (x = −1) to the floor (x in −1 … 1.5, |z| < 1.5).
fn floor_through_mirror(image: DVec3) -> f64 {
    let steps = 800;
    let (mut sum, cell) = (0.0, 2.5 * 3.0 / f64::from(steps * steps));
    for i in 0..steps {
        for j in 0..steps {
            let share = |step: i32| (f64::from(step) + 0.5) / f64::from(steps);
            let point = DVec3::new(-1.0 + 2.5 * share(i), 0.0, -1.5 + 3.0 * share(j));
            let way = point - image;
            let through = image + way * ((-1.0 - image.x) / way.x);
            if through.y < 2.0 && through.z.abs() < 1.5 {
                sum += cell * way.normalize().y.abs() / way.length_squared();
            }
        }
    }
    sum
}

#[test]
fn the_same_photons_land_every_time() {
    let session = Session::open();
    let scene = builtin("ring");
    let settings = photon_settings(&[("photons.max", "5000"), ("lights.resolution", "256")]);
    let sorted = || {
        let mut landed = photons(&session, &scene, &settings, Timing::Frame).landed_words;
        landed.sort_unstable();
        landed
    };
    let landed = sorted();
    assert!(landed.len() > 500, "{} photons landed", landed.len());
    assert!(landed == sorted(), "another run lands other photons");
}

#[test]
fn photons_that_nothing_changed_are_not_sent_again() {
    let session = Session::open();
    let settings = photon_settings(&[("photons.max", "500"), ("lights.resolution", "64")]);
    for pass in passes_of_second_frame(&session, &builtin("ring"), &settings) {
        assert!(pass.skipped.is_some(), "{} runs again", pass.full_name());
    }
}

/// Cut-outs, textures and normal maps: drawn over the views' depth, every texel of a surface is found again.
#[test]
fn textured_and_masked_surfaces_are_found_to_the_texel() {
    let session = Session::open();
    for masked in [false, true] {
        let mut scene = Scene::empty("checkered");
        let texture = scene.add_texture(checkers()).expect("a sound texture");
        let texture = TextureRef::new(texture);
        let material = Material {
            base_color_texture: Some(texture),
            alpha: if masked { Alpha::Mask { cutoff: 0.5 } } else { Alpha::Opaque },
            ..mirror()
        };
        let material = scene.add_material(material).expect("a sound material");
        let mut faces = super::scenes::box_faces([1.0; 3], [material; 6]);
        for face in &mut faces {
            face.texcoords[0] = Some(vec![[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]);
        }
        place(&mut scene, faces, turned(0.7, DVec3::ZERO));
        add_light(&mut scene, LightKind::Point, DVec3::new(0.05, 0.02, -0.03), DVec3::NEG_Y, INTENSITY);
        let found = photons(&session, &scene, &first_bounce("100000", "64"), Timing::Frame);
        let flux = total(found.arrivals.iter().map(|photon| photon.flux));
        // Half of the squares are holes, in all directions alike as the light is nearly in the middle.
        let expected = 4.0 * PI * intensity() * if masked { 0.5 } else { 1.0 };
        let tolerance = if masked { 0.02 } else { 1e-3 };
        println!("masked {masked}: {flux} W of {expected} W by {} photons", found.emitted);
        assert!(((flux - expected) / expected).abs().max_element() < tolerance, "{flux} W of {expected} W");
    }
}

/// 16x16 texels in squares of two, opaque or not by turns.
fn checkers() -> Texture {
    let alpha = |index: u32| if (index / 2 + index / 32).is_multiple_of(2) { 255 } else { 0 };
    Texture {
        name: String::new(),
        width: 16,
        height: 16,
        rgba8: (0..256).flat_map(|index| [255, 255, 255, alpha(index)]).collect(),
        wrap: [Wrap::Repeat; 2],
        nearest: true,
        srgb: true,
    }
}

/// Rays of direct light and photons go through the same hierarchy.
#[test]
fn photons_share_the_hierarchy_with_direct_light() {
    let session = Session::open();
    let scene = builtin("ring");
    let settings = photon_settings(&[("photons.max", "500"), ("lights.resolution", "64")]);
    let settings = Settings { methods: Methods { direct: DirectMethod::Traced, ..settings.methods }, ..settings };
    let camera = scene.camera_view(None).expect("a camera");
    let frame = session.render(&scene, &settings, &request([16, 16], camera, &[Slot::Direct, Slot::Caustics]));
    assert!(frame.slots[&Slot::Direct].pixels.iter().any(|pixel| pixel[0] > 0.0));
}
