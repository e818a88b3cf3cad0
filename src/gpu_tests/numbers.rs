//! Nothing but numbers: triangles that a rasteriser interpolates badly over, sums that say what they leave out, and frames that are looked at before
//! anybody else sees them.

use glam::{DAffine3, DVec3};

use super::scenes::{add_light, builtin, floor, lambert, place, request, view};
use super::session::Session;
use crate::renderer::{Error, FrameRequest, Preset, Settings, Slot, Technique, Timing};
use crate::scene::{LightKind, Material, Primitive, Scene};

/// A floor of 3 m and slivers on it in all directions, a metre long and a few millionths of that high, with colours and normals, under a lamp.
fn slivers() -> Scene {
    let mut scene = floor(3.0, lambert([0.6; 3]));
    let material = scene.add_material(lambert([0.5; 3])).expect("a sound material");
    let mut sliver = Primitive { material, ..Primitive::default() };
    let (mut normals, mut colors) = (Vec::new(), Vec::new());
    for number in 0..3000_u32 {
        let share = |turns: f64| (f64::from(number) * turns).fract();
        let angle = std::f64::consts::TAU * share(0.618_034);
        let (along, across) = (DVec3::new(angle.cos(), 0.0, angle.sin()), DVec3::new(-angle.sin(), 0.0, angle.cos()));
        let start = DVec3::new(4.0 * share(0.754_878) - 2.0, 0.2 * share(0.35), 4.0 * share(0.569_84) - 2.0);
        let height = [3e-7, 1e-6, 4e-6][number as usize % 3];
        let first = 3 * number;
        for corner in [start, start + 0.5 * along + height * across, start + along] {
            sliver.positions.push(corner.as_vec3().to_array());
            normals.push([0.0, 1.0, 0.0]);
            colors.push([1.0, 0.5, f64::from(number % 7) as f32 / 7.0, 1.0]);
        }
        sliver.indices.extend([first, first + 1, first + 2]);
    }
    (sliver.normals, sliver.colors) = (Some(normals), Some(colors));
    place(&mut scene, vec![sliver], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 1.5, -0.2), DVec3::NEG_Y, [2.0; 3]);
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.3, -1.0, 0.2), [0.5; 3]);
    scene
}

fn timed(scene: &Scene, technique: Technique, session: &Session, camera: crate::scene::CameraView) -> [u64; 2] {
    let request = FrameRequest { timing: Timing::Passes, ..request([64, 48], camera, &Slot::ALL) };
    let frame = session.render(scene, &Settings::new(technique, Preset::Default), &request);
    let counts = frame.timings.passes.iter().filter_map(|pass| pass.work.get("dropped"));
    counts.fold([0, 0], |[rows, sum], &dropped| [rows + 1, sum + dropped])
}

#[test]
fn slivers_spoil_no_sum() {
    let session = Session::open();
    let scene = slivers();
    for technique in [Technique::Rsm, Technique::Hybrid, Technique::Volumes] {
        let camera = view(DVec3::new(1.9, 1.4, 1.3), DVec3::new(0.0, 0.1, 0.0));
        let [rows, dropped] = timed(&scene, technique, &session, camera);
        assert!(rows > 0 && dropped == 0, "{technique:?}: {rows} rows, {dropped} dropped");
    }
}

#[test]
fn built_in_scenes_drop_nothing() {
    let session = Session::open();
    let hybrid = ["ring", "textured", "lights"].map(|name| (name, Technique::Hybrid));
    for (name, technique) in
        hybrid.into_iter().chain([("lights", Technique::Volumes), ("cornell-point", Technique::Path)])
    {
        let scene = builtin(name);
        let [rows, dropped] = timed(&scene, technique, &session, scene.camera_view(None).expect("a camera"));
        assert!(rows > 0 && dropped == 0, "{name}: {rows} rows, {dropped} dropped");
    }
}

/// A lamp of more light than a float holds where it falls.
#[test]
fn a_frame_that_is_no_number_names_the_pass() {
    let session = Session::open();
    let mut scene = floor(1.0, lambert([0.5; 3]));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 0.05, 0.0), DVec3::NEG_Y, [3e38; 3]);
    let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
    let mut renderer = session.renderer(&Settings::new(Technique::Direct, Preset::Default));
    let error = renderer.render(&scene, &request([32, 24], camera.clone(), &[Slot::Direct])).expect_err("infinite");
    let Error::NotFinite { what, pixels, pass } = error else { panic!("{error}") };
    assert_eq!((what.as_str(), pass.as_deref()), ("direct", Some("direct/shadow-map/shade")));
    assert!(pixels > 0);
    // The renderer is sound all the same.
    let sound = floor(1.0, Material::default());
    renderer.render(&sound, &request([32, 24], camera, &[Slot::Direct])).expect("a frame");
}

/// The passes of whole frames write numbers alone, texels included: else the first one at fault could not be told.
#[test]
fn sound_passes_are_not_blamed() {
    let session = Session::open();
    let all = [
        ("ring", Technique::Hybrid),
        ("textured", Technique::Rsm),
        ("textured", Technique::Volumes),
        ("ring", Technique::Path),
    ];
    for (name, technique) in all {
        let scene = builtin(name);
        let request = request([48, 32], scene.camera_view(None).expect("a camera"), &Slot::ALL);
        let mut renderer = session.renderer(&Settings::new(technique, Preset::Draft));
        renderer.render(&scene, &request).expect("a frame");
        renderer.invalidate();
        let blamed = renderer.blame(&scene, &request).expect("a frame");
        assert_eq!(blamed, None, "{name}");
    }
}

#[test]
fn what_was_looked_at_is_not_looked_at_again() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let request = request([32, 32], scene.camera_view(None).expect("a camera"), &[Slot::Direct]);
    let mut renderer = session.renderer(&Settings::new(Technique::Direct, Preset::Default));
    let looks = |frame: crate::renderer::Frame| {
        let checks = frame.timings.passes.into_iter().filter(|pass| pass.lies_in("check"));
        checks.map(|pass| pass.skipped.is_some()).collect::<Vec<_>>()
    };
    assert_eq!(looks(renderer.render(&scene, &request).expect("a frame")), [false; 3]);
    assert_eq!(looks(renderer.render(&scene, &request).expect("a frame")), [true; 3]);
    assert!(looks(renderer.render(&scene, &FrameRequest { read_back: false, ..request }).expect("a frame")).is_empty());
}
