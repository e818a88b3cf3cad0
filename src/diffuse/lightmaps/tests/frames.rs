//! Maps over frames: what is renewed, what stands, and how long it takes.

use glam::{DAffine3, DVec3};

use super::super::options::{LightmapsOptions, LightmapsSettle};
use super::{options, settings};
use crate::gpu_tests::against_paths::passes_run;
use crate::gpu_tests::scenes::{add_light, box_faces, lambert, place, request, view, with_camera};
use crate::gpu_tests::session::Session;
use crate::method::{Options, Preset};
use crate::renderer::{Frame, FrameRequest, Renderer, Slot, Timing};
use crate::scene::{CameraView, LightId, LightKind, Scene};

pub(super) fn asked(camera: &CameraView) -> FrameRequest {
    FrameRequest { timing: Timing::Passes, ..request([32, 24], camera.clone(), &[Slot::Diffuse]) }
}

pub(super) fn ran(frame: &Frame) -> Vec<String> {
    passes_run(frame, "diffuse/lightmaps")
}

/// How many texels the frame gathered.
pub(super) fn renewed(frame: &Frame) -> u64 {
    let passes = frame.timings.passes.iter().filter(|row| row.full_name() == "diffuse/lightmaps/iim/gather.0");
    passes.filter_map(|row| row.work.get("texels")).sum()
}

pub(super) fn pixels(frame: &Frame) -> &[[f32; 3]] {
    &frame.slots[&Slot::Diffuse].pixels
}

/// The mean difference of two pictures, over the mean of the second.
pub(super) fn difference(found: &Frame, expected: &Frame) -> f64 {
    let values = || {
        let all = pixels(found).iter().flatten().zip(pixels(expected).iter().flatten());
        all.map(|(a, b)| (f64::from(*a), f64::from(*b)))
    };
    values().map(|(a, b)| (a - b).abs()).sum::<f64>() / values().map(|(_, b)| b).sum::<f64>()
}

pub(super) fn scale_light(scene: &mut Scene, light: usize, by: f32) {
    let mut changed = scene.lights()[light].clone();
    changed.intensity = changed.intensity.map(|channel| by * channel);
    scene.set_light(LightId(light), changed).expect("a sound light");
}

pub(super) fn frame(renderer: &mut Renderer, scene: &Scene, camera: &CameraView) -> Frame {
    renderer.render(scene, &asked(camera)).expect("a frame")
}

/// Frames until nothing is done any more.
pub(super) fn until_still(renderer: &mut Renderer, scene: &Scene, camera: &CameraView) -> (u32, Frame) {
    for number in 0..200 {
        let made = frame(renderer, scene, camera);
        if ran(&made).is_empty() {
            return (number, made);
        }
    }
    panic!("it goes on and on: {:?}", ran(&frame(renderer, scene, camera)));
}

#[test]
fn what_did_not_change_stands_and_repeats_are_the_same_bits() {
    for settle in [LightmapsSettle::First, LightmapsSettle::Always] {
        let session = Session::open();
        let (scene, camera) = with_camera("cornell-point");
        let settings = settings(LightmapsOptions { settle, count: 1000, rays: 64, ..options() });
        let mut renderer = session.renderer(&settings);
        let first = frame(&mut renderer, &scene, &camera);
        assert!(renewed(&first) > 900, "{}", renewed(&first));
        let (frames, still) = until_still(&mut renderer, &scene, &camera);
        assert!(frames <= 1, "{frames}");
        assert!(first.slots == still.slots);
        let beside = view(DVec3::new(0.1, 1.0, 2.9), DVec3::new(0.0, 1.0, 0.0));
        let moved = ran(&frame(&mut renderer, &scene, &beside));
        assert_eq!(moved, ["diffuse/lightmaps/shade/pixels"], "the camera alone moved");
        let other = frame(&mut session.renderer(&settings), &scene, &camera);
        assert!(first.slots == other.slots, "bit by bit");
    }
}

/// A light that is dimmed: what comes along links has lost its share after a few frames' bounces, what is shown goes half of the way there in each frame, and no frame
/// renews more than its share of the texels.
#[test]
fn the_same_sequence_has_the_same_bits_and_ends() {
    let session = Session::open();
    let sequence = || {
        let (mut scene, camera) = with_camera("cornell-point");
        let texels = LightmapsOptions { count: 1000, rays: 64, texels: 100, ..options() };
        let mut renderer = session.renderer(&settings(texels));
        let first = frame(&mut renderer, &scene, &camera);
        scale_light(&mut scene, 0, 0.25);
        let mut all: Vec<Frame> = (0..4).map(|_| frame(&mut renderer, &scene, &camera)).collect();
        let sum = |frame: &Frame| pixels(frame).iter().flatten().map(|&value| f64::from(value)).sum::<f64>();
        let left = [0, 3].map(|number| (sum(&all[number]) / sum(&first) - 0.25) / 0.75);
        println!("left of the change after frames 1 and 4: {left:.3?}");
        assert!((0.5..0.65).contains(&left[0]) && left[1] < 0.12, "{left:?}");
        assert!(all.iter().all(|frame| renewed(frame) <= 100), "as many as a frame may");
        assert!(renewed(&all[0]) == 100);
        let (frames, last) = until_still(&mut renderer, &scene, &camera);
        assert!((10..100).contains(&frames), "{frames}");
        for (before, after) in pixels(&first).iter().flatten().zip(pixels(&last).iter().flatten()) {
            assert!((after - 0.25 * before).abs() <= 0.01 * after, "{before} {after}");
        }
        all.push(last);
        all
    };
    let [first, again] = [sequence(), sequence()];
    assert!(first.iter().zip(&again).all(|(a, b)| a.slots == b.slots));
}

/// Two closed rooms, a light in each.
pub(super) fn two_closed_rooms() -> Scene {
    let mut scene = Scene::empty("two closed rooms");
    for (number, albedo) in [[0.7, 0.5, 0.3], [0.3, 0.5, 0.7]].into_iter().enumerate() {
        let wall = scene.add_material(lambert(albedo)).expect("a sound material");
        let center = DVec3::new(3.0 * number as f64, 0.0, 0.0);
        place(&mut scene, box_faces([1.0; 3], [wall; 6]), DAffine3::from_translation(center));
        add_light(&mut scene, LightKind::Point, center + DVec3::new(0.1, 0.3, -0.2), DVec3::NEG_Y, [1.0; 3]);
    }
    scene
}

#[test]
fn a_change_in_one_room_renews_nothing_in_the_other() {
    let session = Session::open();
    let mut scene = two_closed_rooms();
    let cameras = [0.0, 3.0].map(|x| view(DVec3::new(x + 0.7, 0.6, 0.8), DVec3::new(x, 0.0, 0.0)));
    let all = LightmapsOptions { count: 1000, rays: 64, texels: 1_000_000, ..options() };
    let mut renderer = session.renderer(&settings(all));
    let [before, other_before] = [0, 1].map(|room| frame(&mut renderer, &scene, &cameras[room]));
    let whole = renewed(&before);
    scale_light(&mut scene, 0, 3.0);
    let after = frame(&mut renderer, &scene, &cameras[0]);
    assert!(renewed(&after) == whole / 2, "{} of {whole}", renewed(&after));
    let (_, still) = until_still(&mut renderer, &scene, &cameras[0]);
    assert!((f64::from(pixels(&still)[0][0]) / f64::from(pixels(&before)[0][0]) - 3.0).abs() < 0.05);
    let (_, other) = until_still(&mut renderer, &scene, &cameras[1]);
    assert!(other.slots == other_before.slots, "bit by bit");
}

/// A light that is switched on is there within a few frames, and what comes of it in the end is what a fresh renderer makes.
#[test]
fn a_light_that_is_switched_arrives_early() {
    let session = Session::open();
    let (mut scene, camera) = with_camera("cornell-point");
    add_light(&mut scene, LightKind::Point, DVec3::new(0.6, 1.7, 0.5), DVec3::NEG_Y, [1e-6; 3]);
    let texels = LightmapsOptions { count: 2000, texels: 100, ..options() };
    let mut renderer = session.renderer(&settings(texels.clone()));
    let dark = frame(&mut renderer, &scene, &camera);
    scale_light(&mut scene, 1, 1e6);
    let expected = session.render(&scene, &settings(texels), &asked(&camera));
    let whole = difference(&dark, &expected);
    let left: Vec<f64> =
        (0..8).map(|_| difference(&frame(&mut renderer, &scene, &camera), &expected) / whole).collect();
    println!("left of the change after each frame: {left:.3?}");
    assert!(left[7] < 0.1, "{left:?}");
    let (frames, still) = until_still(&mut renderer, &scene, &camera);
    let last = difference(&still, &expected);
    println!("after {frames} more frames {last:.4}");
    assert!(last < 0.01, "{last}");
}

/// What is left of the change after each frame when the only light of a scene is switched, at the default but for the texels that a frame renews.
#[test]
#[ignore = "a measurement"]
fn how_fast_a_switched_light_arrives() {
    let session = Session::open();
    for (name, texels) in ["cornell-point", "two-rooms"].into_iter().flat_map(|name| [64, 512, 2048].map(|n| (name, n)))
    {
        let options = LightmapsOptions { texels, ..LightmapsOptions::preset(Preset::Default) };
        let settings = settings(options);
        let (bright, camera) = with_camera(name);
        let mut dark = bright.clone();
        scale_light(&mut dark, 0, 1e-3);
        let asked = FrameRequest { size: [64, 48], ..asked(&camera) };
        for (what, from, to) in [("on", &dark, &bright), ("off", &bright, &dark)] {
            let mut scene = from.clone();
            let mut renderer = session.renderer(&settings);
            let mut next = |scene: &Scene| renderer.render(scene, &asked).expect("a frame");
            let before = next(&scene);
            let light = to.lights()[0].clone();
            scene.set_light(LightId(0), light).expect("a sound light");
            let after = session.render(&scene, &settings, &asked);
            let away = |frame: &Frame| difference(frame, &after);
            let left: Vec<f64> = (0..12).map(|_| away(&next(&scene)) / away(&before)).collect();
            let frames = left.iter().position(|&left| left < 0.1).map(|number| number + 1);
            println!("{name}, {texels} texels, {what}: 90 % after {frames:?} frames; left {left:.3?}");
        }
    }
}

/// Something moves: its texels go with it, and in the end all is as a fresh renderer makes it.
#[test]
fn what_moves_takes_its_texels_along() {
    let session = Session::open();
    let mut scene = crate::gpu_tests::scenes::builtin("animated");
    let camera = scene.camera_view(None).expect("its camera");
    let texels = LightmapsOptions { count: 3000, texels: 500, ..options() };
    let mut renderer = session.renderer(&settings(texels.clone()));
    for number in 0..4 {
        scene.set_frame(number);
        frame(&mut renderer, &scene, &camera);
    }
    let (_, still) = until_still(&mut renderer, &scene, &camera);
    let expected = session.render(&scene, &settings(texels), &asked(&camera));
    let last = difference(&still, &expected);
    println!("{last:.4}");
    assert!(last < 0.015, "{last}");
}
