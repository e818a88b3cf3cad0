//! Caches far away that are not lit anew in each frame.

use glam::DVec3;

use super::{counted, difference};
use crate::gpu_tests::against_paths::passes_run;
use crate::gpu_tests::scenes::{builtin, request, settings_of};
use crate::gpu_tests::session::Session;
use crate::renderer::{Frame, FrameRequest, Renderer, Slot, Technique, Timing};
use crate::scene::{CameraView, Scene};

/// Several volumes in one picture.
const NEAR: [(&str, &str); 4] =
    [("volumes.cell", "0.05"), ("volumes.resolution", "16"), ("volumes.cascades", "5"), ("volumes.spread", "views")];

fn renderer(session: &Session, update: &str, more: &[(&str, &str)]) -> Renderer {
    session.renderer(&settings_of(Technique::Volumes, &[&NEAR[..], &[("volumes.update", update)], more].concat()))
}

fn frame(renderer: &mut Renderer, scene: &Scene, camera: &CameraView, index: u32) -> Frame {
    let asked = request([64, 48], camera.clone(), &[Slot::Diffuse]);
    let asked = FrameRequest { timing: Timing::Passes, index, time_step: 1.0 / 30.0, ..asked };
    renderer.render(scene, &asked).expect("a frame")
}

fn lit(frame: &Frame) -> u64 {
    counted(frame, "diffuse/volumes/carry", "lit anew")
}

fn is_idle(frame: &Frame) -> bool {
    passes_run(frame, "caches").is_empty() && passes_run(frame, "diffuse/volumes").is_empty()
}

#[test]
fn a_picture_alone_and_a_still_scene_have_all_their_light() {
    let session = Session::open();
    let scene = builtin("corridor");
    let camera = scene.camera_view(None).expect("its camera");
    let plain = frame(&mut renderer(&session, "1", &[]), &scene, &camera, 0);
    let mut renderer = renderer(&session, "16", &[]);
    let first = frame(&mut renderer, &scene, &camera, 0);
    assert_eq!(lit(&first), counted(&first, "caches/places/allocate", "caches"));
    assert_eq!(first.slots, plain.slots, "bit by bit");
    for index in 1..3 {
        let again = frame(&mut renderer, &scene, &camera, index);
        assert!(is_idle(&again), "{:?}", passes_run(&again, "diffuse/volumes"));
        assert_eq!(again.slots, plain.slots);
    }
}

/// While the light of `animated` moves: near caches follow at once, far ones in turns. Once it stands, all have followed after as many frames as turns take.
#[test]
fn far_caches_take_turns_and_catch_up() {
    let session = Session::open();
    let mut scene = builtin("animated");
    let mut renderers = ["1", "8", "8"].map(|update| renderer(&session, update, &[]));
    let mut camera = scene.camera_view(None).expect("its camera");
    let (mut worst, mut lit_anew, mut caches) = (0.0_f64, 0, 0);
    for index in 0..4 {
        scene.set_frame(index);
        camera = scene.camera_view(None).expect("its camera");
        let [plain, turns, again] = renderers.each_mut().map(|renderer| frame(renderer, &scene, &camera, index));
        assert_eq!(turns.slots, again.slots, "the same frames have the same bits");
        let lag = difference(&turns, &plain);
        let [own, all] = [lit(&turns), counted(&turns, "caches/places/allocate", "caches")];
        println!("frame {index}: {own} of {all} lit anew, {lag:.4} behind");
        if index == 0 {
            assert_eq!((own, lag), (all, 0.0));
        } else {
            (worst, lit_anew, caches) = (worst.max(lag), lit_anew + own, caches + all);
        }
    }
    assert!(2 * lit_anew < caches, "{lit_anew} of {caches}");
    assert!(worst > 1e-4 && worst < 0.06, "{worst}");
    let [plain, ..] = renderers.each_mut().map(|renderer| frame(renderer, &scene, &camera, 4));
    let mut behind = 0;
    for index in 5..16 {
        let still = frame(&mut renderers[1], &scene, &camera, index);
        behind = if still.slots == plain.slots { behind } else { index };
        if index > 12 {
            assert!(is_idle(&still), "frame {index}: {:?}", passes_run(&still, "diffuse/volumes"));
        }
    }
    assert!(behind <= 11, "behind until frame {behind}");
}

/// The camera goes on by more than a cell, so that all volumes snap: caches are found again by where they are, and lie where they lay however far off their nodes.
#[test]
fn caches_are_found_again_when_the_camera_moves() {
    let session = Session::open();
    let scene = builtin("corridor");
    let camera = scene.camera_view(None).expect("its camera");
    for more in [&[][..], &[("volumes.jitter", "0.4"), ("volumes.placement", "grid")]] {
        let mut renderer = renderer(&session, "16", more);
        frame(&mut renderer, &scene, &camera, 0);
        let mut moved = camera.clone();
        let ahead = moved.world.matrix3 * DVec3::NEG_Z;
        moved.world.translation += 0.12 * ahead;
        let next = frame(&mut renderer, &scene, &moved, 1);
        let [own, all] = [lit(&next), counted(&next, "caches/places/allocate", "caches")];
        let fresh = frame(&mut self::renderer(&session, "1", more), &scene, &moved, 0);
        let lag = difference(&next, &fresh);
        println!("{more:?}: {own} of {all} lit anew, {lag:.5} behind");
        assert!(own > 0 && 10 * own < 7 * all, "{own} of {all}");
        assert!(lag < 0.04, "nothing but the camera moved: {lag}");
    }
}
