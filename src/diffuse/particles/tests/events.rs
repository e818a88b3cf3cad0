//! Specular events as bounces: what mirrors, coats and glass send on is there from the bounce on that it belongs to, and not before.

use glam::{DAffine3, DVec3};

use super::super::options::{ParticleDensity, ParticleTransport, ParticlesOptions};
use super::moving::{add_block, difference, shift_and_turn};
use super::{against_paths, options, passes_run, settings};
use crate::gpu_tests::scenes::{add_light, box_faces, closed_box, lambert, place, quad, request, view};
use crate::gpu_tests::session::Session;
use crate::renderer::{FrameRequest, Slot, Timing};
use crate::scene::{CameraView, LightKind, Material, Scene};

fn lamp(scene: &mut Scene) {
    add_light(scene, LightKind::Point, DVec3::new(0.3, 0.2, -0.4), DVec3::NEG_Y, [1.0; 3]);
}

/// Two grey walls, floor and ceiling, between two mirrors; under the sky without the ceiling.
fn mirrored_room(open: bool) -> Scene {
    let mut scene = Scene::empty("mirrored room");
    let grey = scene.add_material(lambert([0.6; 3])).expect("a sound material");
    let mirror = Material { metallic: 1.0, roughness: 0.05, ..lambert([0.95; 3]) };
    let mirror = scene.add_material(mirror).expect("a sound material");
    let mut faces = box_faces([1.0; 3], [mirror, mirror, grey, grey, grey, grey]);
    if open {
        faces.remove(3);
        scene.set_sky([1.0, 1.5, 2.0]);
    } else {
        lamp(&mut scene);
    }
    place(&mut scene, faces, DAffine3::IDENTITY);
    scene
}

/// A lamp in two cases of thin glass: all of its light meets two sheets or more before all else.
fn lamp_in_glass() -> Scene {
    let mut scene = closed_box(1.0, lambert([0.6; 3]));
    lamp(&mut scene);
    let glass = Material { transmission: 1.0, roughness: 0.0, double_sided: true, ..lambert([1.0; 3]) };
    let glass = Material { specular: 1.0, ior: 2.0, ..glass };
    let glass = scene.add_material(glass).expect("a sound material");
    let around = DAffine3::from_translation(DVec3::new(0.3, 0.2, -0.4));
    for half in [0.2, 0.25] {
        place(&mut scene, box_faces([half; 3], [glass; 6]), around);
    }
    scene
}

/// A lamp shines at a mirror over rough metal, which photons do not go on from.
fn metal_under_mirror() -> Scene {
    let mut scene = closed_box(1.0, lambert([0.6; 3]));
    let mirror = Material { metallic: 1.0, roughness: 0.05, ..lambert([0.95; 3]) };
    let mirror = scene.add_material(mirror).expect("a sound material");
    let metal = Material { metallic: 0.75, roughness: 0.6, specular: 1.0, ..lambert([0.9; 3]) };
    let metal = scene.add_material(metal).expect("a sound material");
    let corners = [[-0.9, -0.9, -0.9], [-0.9, -0.9, 0.9], [0.9, -0.9, 0.9], [0.9, -0.9, -0.9]];
    let above = [[-0.7, 0.9, -0.7], [0.7, 0.9, -0.7], [0.7, 0.9, 0.7], [-0.7, 0.9, 0.7]];
    place(&mut scene, vec![quad(corners, metal), quad(above, mirror)], DAffine3::IDENTITY);
    let kind = LightKind::Spot { inner_angle: 0.3, outer_angle: 0.5 };
    add_light(&mut scene, kind, DVec3::new(0.0, 0.1, 0.0), DVec3::Y, [1.0; 3]);
    scene
}

fn inside() -> CameraView {
    view(DVec3::new(0.1, -0.1, 0.9), DVec3::new(0.0, -0.3, -1.0))
}

#[test]
fn specular_events_are_bounces() {
    let session = Session::open();
    let scenes = [
        ("mirrors", mirrored_room(false), vec![0, 1, 2], 0.02),
        ("mirrors under the sky", mirrored_room(true), vec![0, 1, 2], 0.02),
        ("a lamp in glass", lamp_in_glass(), vec![2, 3, 12], 0.02),
        // Broad lobes send light on as if they were diffuse.
        ("metal under a mirror", metal_under_mirror(), vec![2, 3], 0.05),
    ];
    for (name, scene, steps, most) in &scenes {
        for &bounces in steps.iter() {
            // Gathered light counts events as the other does, step by step: the last one holds all of them.
            let gathered = (Some(&bounces) == steps.last()).then_some(ParticleTransport::GatherOnly);
            for transport in [ParticleTransport::TwoWay].into_iter().chain(gathered) {
                let options = ParticlesOptions { gather: 16, transport, ..options(4000, bounces) };
                let (ratio, error) = against_paths(&session, scene, inside(), options);
                println!("{name}, {bounces} steps, {transport:?}: mean {ratio:.3}, blocks {error:.3}");
                let sound = (ratio - 1.0).abs() < *most && error < 0.08;
                assert!(sound, "{name}, {bounces} steps, {transport:?}: {ratio}, {error}");
            }
        }
    }
}

/// The sky that links find by way of mirrors is summed anew where they are traced again, event by event.
#[test]
fn the_sky_in_mirrors_follows_what_moves() {
    let options = ParticlesOptions { density: ParticleDensity::Even, ..options(3000, 3) };
    let (session, settings) = (Session::open(), settings(options));
    let mut scene = mirrored_room(true);
    let block = add_block(&mut scene, DVec3::new(-0.3, -0.6, 0.1));
    let asked = FrameRequest { timing: Timing::Passes, ..request([48, 32], inside(), &[Slot::Diffuse]) };
    let mut renderer = session.renderer(&settings);
    renderer.render(&scene, &asked).expect("a frame");
    shift_and_turn(&mut scene, block);
    let moved = renderer.render(&scene, &asked).expect("a frame");
    assert!(passes_run(&moved, "diffuse/particles/link/arrivals").len() == 1);
    let difference = difference(&moved, &session.render(&scene, &settings, &asked));
    assert!(difference <= 1e-3, "{difference}");
}

/// What meets glass first has no bounce left for a surface between it and the picture; photons are not even sent.
#[test]
fn without_bounces_no_light_comes_through_glass() {
    let session = Session::open();
    let frame = session.render(
        &lamp_in_glass(),
        &settings(options(2000, 0)),
        &FrameRequest { timing: Timing::Passes, ..request([32, 24], inside(), &[Slot::Diffuse]) },
    );
    assert!(frame.slots[&Slot::Diffuse].pixels.iter().flatten().all(|channel| *channel == 0.0));
    let passes = passes_run(&frame, "diffuse/particles");
    assert!(!passes.iter().any(|pass| pass.ends_with("/glints")), "{passes:?}");
}
