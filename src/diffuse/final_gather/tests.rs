//! Final gathering against paths, and what stands when something moves.

use glam::DVec3;

use super::options::FinalGatherOptions;
use crate::gpu_tests::against_paths::{against_paths, leaks, passes_run};
use crate::gpu_tests::scenes::{
    add_light, builtin, closed_box, lambert, lamp_box, open_room, request, sunlit_corner, view, with_camera,
};
use crate::gpu_tests::session::Session;
use crate::method::{Options, Preset};
use crate::renderer::{DiffuseMethod, Frame, FrameRequest, Settings, Slot, Technique, Timing};
use crate::scene::{CameraView, LightKind, Material, Scene};

/// Few rays: blocks of pixels average.
fn options() -> FinalGatherOptions {
    FinalGatherOptions { rays: 64, photons: 50_000, ..FinalGatherOptions::preset(Preset::Default) }
}

fn settings(options: FinalGatherOptions) -> Settings {
    let mut settings = Settings::new(Technique::Direct, Preset::Default);
    settings.methods.diffuse = DiffuseMethod::FinalGather;
    Settings { final_gather: options, ..settings }
}

/// Every kind of light, mirrors and glass on its way, few bounces and all.
#[test]
fn pictures_are_those_of_paths() {
    let session = Session::open();
    let cases = [
        ("cornell-point", with_camera("cornell-point"), None),
        ("cornell-point", with_camera("cornell-point"), Some(1)),
        ("cornell-point", with_camera("cornell-point"), Some(3)),
        ("cornell-spot", with_camera("cornell-spot"), None),
        ("lamp", lamp_box(), None),
        ("sky", open_room(), None),
        ("sun", sunlit_corner(), None),
        ("ring", with_camera("ring"), None),
        ("water", with_camera("water"), None),
    ];
    for (name, (scene, camera), bounces) in cases {
        let settings = settings(FinalGatherOptions { bounces, ..options() });
        let (ratio, error) = against_paths(&session, &scene, camera, &settings, (128, bounces));
        println!("{name}, {bounces:?} bounces: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.025 && error < 0.06, "{name}, {bounces:?} bounces: {ratio} {error}");
    }
}

/// Walls that are thicker than the discs of the estimate keep it out.
#[test]
fn light_stays_out_of_dark_rooms() {
    let found = leaks(&Session::open(), &settings(options()), [32, 24]);
    println!("{found:?} of the lit hall's light");
    let [thin, thick, sealed] = found;
    assert!(thin < 0.06 && thick < 1e-3 && sealed < 1e-3, "{found:?} of the lit hall's light");
}

/// The passes of the method that ran.
fn ran(frame: &Frame) -> Vec<String> {
    passes_run(frame, "diffuse/final-gather")
}

#[test]
fn what_did_not_change_stands_and_repeats_are_the_same_bits() {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let asked =
        |camera: CameraView| FrameRequest { timing: Timing::Passes, ..request([16, 12], camera, &[Slot::Diffuse]) };
    let few = FinalGatherOptions { photons: 5000, rays: 16, ..options() };
    let mut renderer = session.renderer(&settings(few));
    let first = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    let again = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    assert!(ran(&again).is_empty(), "{:?}", ran(&again));
    renderer.invalidate();
    let anew = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    assert_eq!(first.slots, anew.slots, "bit by bit");

    let beside = view(DVec3::new(0.1, 1.0, 2.9), DVec3::new(0.0, 1.0, 0.0));
    let moved = ran(&renderer.render(&scene, &asked(beside)).expect("a frame"));
    assert!(!moved.is_empty() && moved.iter().all(|name| name.contains("/gather/")), "{moved:?}");

    let mut light = scene.lights()[0].clone();
    light.intensity = light.intensity.map(|channel| 2.0 * channel);
    scene.set_light(crate::scene::LightId(0), light).expect("a sound light");
    let relit = renderer.render(&scene, &asked(camera)).expect("a frame");
    assert!(ran(&relit).iter().any(|name| name.ends_with("/map/emit")), "{:?}", ran(&relit));
    for (before, after) in first.slots[&Slot::Diffuse].pixels.iter().zip(&relit.slots[&Slot::Diffuse].pixels) {
        assert!((after[0] - 2.0 * before[0]).abs() <= 1e-3 * after[0], "{before:?} {after:?}");
    }
}

#[test]
fn scenes_without_need_pay_nothing() {
    let session = Session::open();
    let reason = |scene: &Scene, bounces| {
        let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
        let settings = settings(FinalGatherOptions { bounces, ..options() });
        let frame = session.render(scene, &settings, &request([8, 8], camera, &[Slot::Diffuse]));
        let row = frame.timings.passes.into_iter().find(|pass| pass.full_name().starts_with("diffuse/final-gather"));
        row.and_then(|row| row.skipped).expect("a reason")
    };
    assert_eq!(reason(&closed_box(1.0, lambert([0.5; 3])), None), "no light");
    assert_eq!(reason(&lamp_box().0, Some(0)), "no bounces asked for");
    let mut metal = closed_box(1.0, Material { metallic: 1.0, ..lambert([0.5; 3]) });
    add_light(&mut metal, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    assert_eq!(reason(&metal, None), "no diffuse surface");
}
