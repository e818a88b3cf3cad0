//! Lamps close to surfaces, and surfaces under a specular layer.

use glam::{DAffine3, DVec3};

use super::super::options::{ParticleTransport, ParticlesOptions};
use super::{against_paths, options, settings, stages};
use crate::gpu_tests::scenes::{add_light, closed_box, lambert, place, quad, request, view};
use crate::gpu_tests::session::Session;
use crate::renderer::Slot;
use crate::scene::{LightKind, Material, Scene};

const RADIANCE: f32 = 5.0;
/// Of the lamps, metres.
const SIDE: f32 = 0.6;

/// A box of 2 m with a square lamp under its ceiling, which shines upwards from so far below.
fn lamp_under_ceiling(gap: f32) -> Scene {
    let mut scene = closed_box(1.0, lambert([0.5; 3]));
    let lamp = scene.add_material(Material { emissive: [RADIANCE; 3], ..lambert([0.0; 3]) }).expect("a sound material");
    let (half, height) = (0.5 * SIDE, 1.0 - gap);
    let corners = [[-half, height, -half], [-half, height, half], [half, height, half], [half, height, -half]];
    place(&mut scene, vec![quad(corners, lamp)], DAffine3::IDENTITY);
    scene
}

#[test]
fn a_lamp_close_to_a_wall_gives_all_its_light() {
    let session = Session::open();
    let power = std::f64::consts::PI * f64::from(RADIANCE * SIDE * SIDE);
    for gap in [0.5, 0.02] {
        let made = stages(&session, &lamp_under_ceiling(gap), &options(6000, 1));
        let emitted: f64 = made.emitted.iter().map(|flux| f64::from(flux[0])).sum();
        println!("{gap} m: {:.4}", emitted / power);
        assert!((emitted / power - 1.0).abs() < 0.01, "{gap} m: {emitted} W of {power}");
    }
}

/// A flat case around the lamp lets nothing out, though it is thinner than the particles' spacing by far.
#[test]
fn nothing_shines_through_the_sides_of_a_flat_case() {
    let session = Session::open();
    let camera = view(DVec3::new(0.0, -0.2, 0.9), DVec3::new(0.0, 0.6, 0.0));
    let mean = |scene: &Scene| {
        let frame =
            session.render(scene, &settings(options(4000, 3)), &request([48, 32], camera.clone(), &[Slot::Diffuse]));
        let pixels = &frame.slots[&Slot::Diffuse].pixels;
        pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / pixels.len() as f64
    };
    let lit = mean(&lamp_under_ceiling(0.5));
    let gap = 0.004;
    let mut scene = lamp_under_ceiling(gap);
    let white = scene.add_material(Material { double_sided: true, ..lambert([0.5; 3]) }).expect("a sound material");
    let (half, bottom) = (0.5 * SIDE + 0.02, 1.0 - 1.5 * gap);
    let corners = [[-half, -half], [-half, half], [half, half], [half, -half]];
    let mut faces = vec![quad(corners.map(|[x, z]| [x, bottom, z]), white)];
    for side in 0..4 {
        let ([ax, az], [bx, bz]) = (corners[side], corners[(side + 1) % 4]);
        faces.push(quad([[ax, bottom, az], [bx, bottom, bz], [bx, 1.0, bz], [ax, 1.0, az]], white));
    }
    place(&mut scene, faces, DAffine3::IDENTITY);
    let dark = mean(&scene);
    println!("{dark:.2e} of {lit:.2e}");
    assert!(lit > 1e-3 && dark < 1e-3 * lit, "{dark} of {lit}");
}

/// What the layer keeps from the diffuse lobe it reflects to other surfaces.
#[test]
fn coated_walls_lose_no_light() {
    let session = Session::open();
    let mut scene = closed_box(1.0, Material { specular: 1.0, roughness: 0.4, ..lambert([0.7; 3]) });
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.2, -0.4), DVec3::NEG_Y, [1.0; 3]);
    let camera = view(DVec3::new(0.0, 0.0, 0.9), DVec3::new(0.0, -0.2, 0.0));
    let all = ParticlesOptions { bounces: None, gather: 16, ..options(6000, 0) };
    let (ratio, error) = against_paths(&session, &scene, camera, all);
    println!("mean {ratio:.3}, blocks {error:.3}");
    assert!((ratio - 1.0).abs() < 0.03 && error < 0.08, "{ratio} {error}");
}

/// Rough metal is no target of photons, and yet what it reflects of a lamp's light lights the walls.
#[test]
fn rough_metal_passes_the_light_of_lamps_on() {
    let session = Session::open();
    let mut scene = closed_box(1.0, lambert([0.6; 3]));
    let metal = Material { metallic: 0.75, roughness: 0.6, specular: 1.0, ..lambert([0.9; 3]) };
    let metal = scene.add_material(metal).expect("a sound material");
    let corners = [[-0.9, -0.9, -0.9], [-0.9, -0.9, 0.9], [0.9, -0.9, 0.9], [0.9, -0.9, -0.9]];
    place(&mut scene, vec![quad(corners, metal)], DAffine3::IDENTITY);
    let kind = LightKind::Spot { inner_angle: 0.3, outer_angle: 0.6 };
    add_light(&mut scene, kind, DVec3::new(0.0, 0.7, 0.0), DVec3::NEG_Y, [1.0; 3]);
    let camera = view(DVec3::new(0.0, 0.0, 0.9), DVec3::new(0.0, 0.1, -1.0));
    for transport in [ParticleTransport::TwoWay, ParticleTransport::GatherOnly] {
        let all = ParticlesOptions { bounces: None, transport, ..options(4000, 0) };
        let (ratio, error) = against_paths(&session, &scene, camera.clone(), all);
        println!("mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.04 && error < 0.1, "{transport:?}: {ratio} {error}");
    }
}
