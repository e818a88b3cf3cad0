//! Photons on their way: no energy is lost or made, whatever the lobes, bodies and bounces.

use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DVec3};

use super::invariance::transformed;
use super::path_probe::{assert_near, solid_box, sphere, turned};
use super::photons_probe::{Photons, photon_settings, photons, total};
use super::scenes::{add_light, builtin, closed_box, floor, lambert, place, quad};
use super::session::Session;
use crate::renderer::Timing;
use crate::scene::{LightKind, Material, Scene};

const INTENSITY: [f32; 3] = [2.0, 1.0, 0.25];

/// A ball of a material in the middle of a matt box, and a lamp.
fn ball(material: Material, smooth: bool) -> Scene {
    let mut scene = closed_box(2.0, lambert([0.5; 3]));
    let material = scene.add_material(material).expect("a sound material");
    place(&mut scene, vec![sphere(24, smooth, material)], turned(0.5, DVec3::new(0.1, 0.0, -0.2)));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.4, 1.5, 0.3), DVec3::NEG_Y, INTENSITY);
    scene
}

fn run(session: &Session, scene: &Scene, changes: &[(&str, &str)]) -> Photons {
    let mut all = vec![("photons.max", "20000"), ("lights.resolution", "128")];
    all.extend(changes);
    photons(session, scene, &photon_settings(&all), Timing::Frame)
}

fn landed_flux(found: &Photons) -> DVec3 {
    total(found.landed.iter().map(|photon| photon.flux))
}

fn metal(color: f32, roughness: f32) -> Material {
    Material { metallic: 1.0, roughness, ..lambert([color; 3]) }
}

fn glass(thickness: f32, roughness: f32) -> Material {
    Material { transmission: 1.0, roughness, thickness, ..Material::default() }
}

/// What the ball receives, W.
fn received(session: &Session, scene: &Scene) -> DVec3 {
    let found = run(session, scene, &[("photons.bounces", "1")]);
    total(found.arrivals.iter().map(|photon| photon.flux))
}

#[test]
fn what_leaves_a_specular_body_lands_on_the_walls() {
    let session = Session::open();
    for (what, material, lost) in [
        ("a mirror", metal(1.0, 0.0), 0.0),
        // Light that rough microfacets reflect more than once.
        ("a rough mirror", metal(1.0, 0.3), 0.03),
        ("a thin shell of glass", glass(0.0, 0.0), 0.0),
        ("a ball of glass", glass(1.0, 0.0), 0.0),
    ] {
        let scene = ball(material, false);
        let found = run(&session, &scene, &[("photons.bounces", "16")]);
        let (landed, received) = (landed_flux(&found).x, received(&session, &scene).x);
        // Some light goes round and round in a ball.
        let on_its_way: f64 = found.rays.iter().map(|photon| photon.flux.x).sum();
        println!(
            "{what}: {landed} W of {received} W land, {on_its_way} W leave the last surface; {:?}",
            found.ray_counts
        );
        assert!(landed > (0.999 - lost) * received - on_its_way && landed < 1.001 * received);
        assert!(landed > 0.985 * received || lost > 0.0);
    }
}

/// Nothing depends on the unit of length, nor on where the scene is.
#[test]
fn scale_and_place_do_not_matter() {
    let session = Session::open();
    let scene = ball(glass(1.0, 0.0), false);
    let at = |scale: f64, place_at: DVec3| {
        let transform = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(scale)), translation: place_at };
        let changes = [("photons.bounces", "4"), ("photons.max", "4000")];
        run(&session, &transformed(&scene, transform, scale), &changes)
    };
    let first = at(1.0, DVec3::ZERO);
    for (scale, place_at) in [(1e-3, DVec3::ZERO), (1e3, DVec3::ZERO), (1.0, DVec3::splat(1e5))] {
        let found = at(scale, place_at);
        // Lights that are larger with the scene send more.
        let ratio = landed_flux(&found).x / (landed_flux(&first).x * scale * scale);
        println!("scale {scale}, at {place_at}: {ratio}, {:?} of {:?}", found.ray_counts, first.ray_counts);
        assert!((ratio - 1.0).abs() < 2e-3, "scale {scale}, at {place_at}: {ratio}");
        let mean = |photons: &Photons, scale: f64| {
            photons.landed.iter().map(|photon| photon.radius / scale).sum::<f64>() / photons.landed.len() as f64
        };
        assert!((mean(&found, scale) / mean(&first, 1.0) - 1.0).abs() < 1e-2);
    }
}

/// Smooth normals differ from the faces': their adjoint keeps the energy in the mean.
#[test]
fn interpolated_normals_keep_the_energy() {
    let session = Session::open();
    for (what, material) in [("a smooth mirror", metal(1.0, 0.05)), ("smooth glass", glass(1.0, 0.0))] {
        let scene = ball(material, true);
        let found = run(&session, &scene, &[("photons.bounces", "12")]);
        assert_near(what, landed_flux(&found), received(&session, &scene), 0.03);
    }
}

/// A sun through a slab of glass: (1 − F)² after two surfaces, (1 − F)/(1 + F) with all the ways between them.
#[test]
fn a_slab_passes_what_fresnel_says() {
    let session = Session::open();
    let f = 0.04;
    // Texels' middles do not lie on its edge.
    const HALF: f64 = 0.47;
    let slab = |material: Material, thickness: f64| {
        let mut scene = floor(1.0, lambert([0.5; 3]));
        let slab = scene.add_material(material).expect("a sound material");
        let faces = if thickness > 0.0 {
            solid_box(DVec3::new(-HALF, 0.5, -HALF), DVec3::new(HALF, 0.5 + thickness, HALF), slab)
        } else {
            let half = HALF as f32;
            vec![quad([[-half, 0.5, -half], [-half, 0.5, half], [half, 0.5, half], [half, 0.5, -half]], slab)]
        };
        place(&mut scene, faces, DAffine3::IDENTITY);
        add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::NEG_Y, [5.0; 3]);
        scene
    };
    let colors = [0.8_f64, 0.5, 0.2];
    let absorbing =
        Material { attenuation_color: colors.map(|color| color as f32), attenuation_distance: 0.5, ..glass(1.0, 0.0) };
    let one_way = DVec3::from(colors).powf(0.25 / 0.5);
    let transmittances = [
        ("two surfaces of a slab", glass(1.0, 0.0), 0.25, "2", DVec3::splat((1.0 - f) * (1.0 - f))),
        ("a slab", glass(1.0, 0.0), 0.25, "16", DVec3::splat((1.0 - f) / (1.0 + f))),
        ("a thin wall", glass(0.0, 0.0), 0.0, "4", DVec3::splat(1.0 - f)),
        ("absorbing glass", absorbing, 0.25, "2", one_way * ((1.0 - f) * (1.0 - f))),
    ];
    for (what, material, thickness, bounces, transmittance) in transmittances {
        let scene = slab(material, thickness);
        let found = run(&session, &scene, &[("photons.bounces", bounces)]);
        let incident = received(&session, &scene);
        // α = 10⁻³ sends a little elsewhere.
        assert_near(what, landed_flux(&found) / incident, transmittance, 3e-3);
    }
}

#[test]
fn photons_stay_within_the_scene_and_finite_at_any_roughness() {
    let session = Session::open();
    // Every material of the same ball receives the same.
    let most = received(&session, &ball(metal(1.0, 0.0), true));
    for roughness in [0.0, 0.4, 1.0] {
        let plastic = Material { roughness, ..Material::default() };
        let mixed = Material { transmission: 0.5, metallic: 0.3, roughness, ..Material::default() };
        for material in [metal(0.9, roughness), glass(1.0, roughness), glass(0.0, roughness), plastic, mixed] {
            let scene = ball(material.clone(), true);
            let found = run(&session, &scene, &[("photons.bounces", "4"), ("photons.max", "4000")]);
            assert!(!found.landed.is_empty());
            let landed = landed_flux(&found);
            assert!((landed - 1.05 * most).max_element() <= 0.0, "{landed} W of {most} W land: {material:?}");
            for photon in &found.landed {
                assert!(photon.flux.is_finite() && photon.flux.min_element() >= 0.0, "{photon:?}");
                assert!(photon.position.abs().max_element() < 2.001, "{photon:?}");
                assert!(photon.radius > 0.0 && photon.radius <= 0.2501 * 3.4642, "{photon:?}");
                assert!((photon.normal.length() - 1.0).abs() < 1e-5, "{photon:?}");
            }
        }
    }
}

/// h = C₀·√(A/N)·d/(R·√cosθ), below a mirror that sends all light straight down.
#[test]
fn discs_have_the_radius_of_their_way() {
    let session = Session::open();
    let mut scene = floor(1.0, lambert([0.5; 3]));
    let material = scene.add_material(glass(0.0, 0.0)).expect("a sound material");
    let corners = [[-0.5, 0.5, -0.5], [-0.5, 0.5, 0.5], [0.5, 0.5, 0.5], [0.5, 0.5, -0.5]];
    place(&mut scene, vec![quad(corners, material)], DAffine3::from_scale(DVec3::new(1.0, 1.0, 2.0)));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 2.5, 0.0), DVec3::NEG_Y, INTENSITY);
    let found =
        run(&session, &scene, &[("photons.bounces", "1"), ("photons.footprint", "way"), ("photons.radius", "0.25")]);
    let area: f64 = 4.0 + 2.0;
    let radius = DVec3::new(1.0, 0.25, 1.0).length();
    let mut seen = 0;
    for photon in &found.landed {
        let way = photon.position + found.origin - DVec3::new(0.0, 2.5, 0.0);
        let expected =
            0.25 * (area / found.emitted as f64).sqrt() * way.length() / radius / (2.5 / way.length()).sqrt();
        // All but those that the rough tail of a mirror sends elsewhere.
        seen += usize::from((photon.radius / expected - 1.0).abs() < 0.01);
    }
    assert!(seen as f64 > 0.95 * found.landed.len() as f64 && seen > 1000, "{seen} of {}", found.landed.len());
}

/// Light in `ring` lands around it: by solid angle, the light of the spot.
#[test]
fn the_ring_gathers_light() {
    let session = Session::open();
    let found = photons(&session, &builtin("ring"), &photon_settings(&[]), Timing::Passes);
    let mut sum = 0.0;
    for pass in found.passes.iter().filter(|pass| pass.piece.starts_with("caustics")) {
        println!("{} {}: {:?} ms {:?}", pass.piece, pass.pass, pass.ms, pass.work);
        sum += pass.ms.unwrap_or(0.0);
    }
    let flux = landed_flux(&found);
    println!(
        "{sum:.1} ms; {} photons, {:?} rays, {} landed, {flux} W",
        found.emitted,
        found.ray_counts,
        found.landed.len()
    );
    assert!(found.emitted <= 38_000 && found.emitted > 9_500);
    assert!(found.landed.len() > 9 * found.emitted / 10, "{} of {}", found.landed.len(), found.emitted);
    assert!(flux.x > flux.y && flux.y > flux.z && flux.z > 0.0, "gold is yellow: {flux}");
    assert!(flux.max_element() < 4.0 * PI * 1e4);
}
