//! The method `points`: photons kept over frames, what it skips, and its error beside `photons`. Its filter alone: `points_filter`.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::invariance::{difference, transformed};
use super::path_probe::{Ask, Tracer};
use super::scenes::{builtin, request, view};
use super::session::Session;
use crate::renderer::{ColorImage, Frame, FrameRequest, Preset, Renderer, Settings, Slot, Technique, Timing};
use crate::scene::{LightId, Scene};
use crate::slot::{CausticPaths, PixelFilter};

pub(super) fn settings(changes: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(Technique::Direct, Preset::Default);
    settings.methods.set(Slot::Caustics, "points").expect("a method");
    for (key, value) in changes {
        settings.set(key, value).expect("a setting and its value");
    }
    settings
}

fn everything(scene: &Scene, size: [u32; 2]) -> FrameRequest {
    let camera = scene.camera_view(None).expect("a view");
    FrameRequest { image: false, timing: Timing::Passes, ..request(size, camera, &[Slot::Caustics]) }
}

fn caustics(frame: &Frame) -> &ColorImage {
    &frame.slots[&Slot::Caustics]
}

fn bits(image: &ColorImage) -> Vec<u32> {
    image.pixels.as_flattened().iter().map(|channel| channel.to_bits()).collect()
}

/// Photons that a frame sent.
fn sent(frame: &Frame) -> u64 {
    let starts =
        frame.timings.passes.iter().filter(|pass| pass.pass.starts_with("trace/start") && pass.skipped.is_none());
    starts.map(|pass| pass.work["photons"]).sum()
}

fn ran(frame: &Frame, level: &str) -> bool {
    let of = |pass: &&crate::renderer::PassTiming| pass.piece == "caustics/points" && pass.pass.starts_with(level);
    frame.timings.passes.iter().filter(of).any(|pass| pass.skipped.is_none())
}

fn move_light(scene: &mut Scene, by: f64) {
    let node = scene.placed_lights()[0].node;
    let local = DAffine3::from_translation(DVec3::new(by, 0.0, 0.3 * by)) * scene.nodes()[node.0].local;
    scene.set_local_transform(node, local).expect("finite");
}

/// How far a picture has come from the one before to the one after.
fn arrived(before: &ColorImage, now: &ColorImage, after: &ColorImage) -> f64 {
    let way = |from: &ColorImage, to: &ColorImage| -> Vec<f64> {
        let pairs = from.pixels.as_flattened().iter().zip(to.pixels.as_flattened());
        pairs.map(|(&from, &to)| f64::from(to) - f64::from(from)).collect()
    };
    let (whole, part) = (way(before, after), way(before, now));
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(&part, &whole) / product(&whole, &whole)
}

/// Where the light moves each frame sends its share of the photons; when all have been sent again the picture is that of a fresh start, and nothing runs any more.
#[test]
fn photons_are_sent_again_in_turns() {
    let session = Session::open();
    let mut scene = builtin("ring");
    let settings = settings(&[("points.photons", "4001"), ("points.frames", "4")]);
    let mut renderer = session.renderer(&settings);
    let whole = everything(&scene, [64, 48]);
    let render = |renderer: &mut Renderer, scene: &Scene, index: u32| {
        renderer.render(scene, &FrameRequest { index, ..whole.clone() }).expect("a frame")
    };
    assert_eq!(sent(&render(&mut renderer, &scene, 0)), 4001);
    let still = render(&mut renderer, &scene, 1);
    assert!(!ran(&still, ""), "nothing changed");
    move_light(&mut scene, 0.05);
    let fresh = session.render(&scene, &settings, &whole);
    let mut shares = Vec::new();
    let mut last = still;
    let before = caustics(&last).clone();
    for index in 2..6 {
        let frame = render(&mut renderer, &scene, index);
        shares.push(sent(&frame));
        println!("{index}: {:.2} of the change", arrived(&before, caustics(&frame), caustics(&fresh)));
        assert!(bits(caustics(&frame)) != bits(caustics(&last)), "frame {index} shows what it sent");
        last = frame;
    }
    shares.sort_unstable();
    assert_eq!(shares, [1000, 1000, 1000, 1001]);
    assert!(bits(caustics(&last)) == bits(caustics(&fresh)), "all were sent again");
    assert!(!ran(&render(&mut renderer, &scene, 6), ""), "nothing changed");
    // It goes on moving: every photon is four frames old at most.
    for index in 7..13 {
        move_light(&mut scene, 0.01);
        let share = sent(&render(&mut renderer, &scene, index));
        assert!((1000..=1001).contains(&share), "{share}");
    }
    for index in 13..17 {
        render(&mut renderer, &scene, index);
    }
    let camera = view(DVec3::new(0.4, 1.2, 1.1), DVec3::ZERO);
    assert!(camera != whole.camera);
    let other_size = FrameRequest { size: [60, 40], ..whole.clone() };
    let other_camera = FrameRequest { camera, ..whole.clone() };
    for (what, request) in [("another size", other_size), ("another camera", other_camera)] {
        let moved = renderer.render(&scene, &request).expect("a frame");
        let sends = ran(&moved, "trace") || ran(&moved, "choose");
        assert!(ran(&moved, "draw") && !sends, "{what} sends no photon");
        assert!(caustics(&moved).pixels.iter().any(|pixel| pixel[0] > 0.0), "{what} shows them");
    }
}

#[test]
fn the_same_frames_give_the_same_bits() {
    let run = || {
        let session = Session::open();
        let mut scene = builtin("ring");
        let mut renderer = session.renderer(&settings(&[("points.photons", "3000"), ("points.frames", "3")]));
        let whole = everything(&scene, [64, 48]);
        let mut pictures = Vec::new();
        for index in 0..4 {
            let frame = renderer.render(&scene, &FrameRequest { index, ..whole.clone() }).expect("a frame");
            pictures.push(bits(caustics(&frame)));
            move_light(&mut scene, 0.02);
        }
        renderer.invalidate();
        let frame = renderer.render(&scene, &whole).expect("a frame");
        pictures.push(bits(caustics(&frame)));
        (pictures, bits(caustics(&session.render(&scene, renderer.settings(), &whole))))
    };
    let (first, fresh) = run();
    assert!(first == run().0);
    assert!(first.last() == Some(&fresh), "what was forgotten is made anew");
}

#[test]
fn where_nothing_is_specular_or_lit_nothing_runs() {
    let session = Session::open();
    let reason = |scene: &Scene, changes: &[(&str, &str)]| {
        let frame = session.render(scene, &settings(changes), &everything(scene, [32, 24]));
        assert!(!ran(&frame, ""));
        assert!(caustics(&frame).pixels.iter().all(|pixel| *pixel == [0.0; 3]));
        let named = frame.timings.passes.iter().find(|pass| pass.full_name() == "caustics/points");
        named.and_then(|pass| pass.skipped.clone()).expect("a reason")
    };
    assert_eq!(reason(&builtin("cornell-point"), &[]), "no specular or transmissive surface");
    let mut ring = builtin("ring");
    assert_eq!(reason(&ring, &[("points.photons", "0")]), "no photons asked for");
    assert_eq!(reason(&ring, &[("points.bounces", "0")]), "no photons asked for");
    for index in 0..ring.lights().len() {
        let dark = crate::scene::Light { intensity: [0.0; 3], ..ring.lights()[index].clone() };
        ring.set_light(LightId(index), dark).expect("sound");
    }
    assert_eq!(reason(&ring, &[]), "no light");
}

/// As many photons, places and turns as buffers hold.
#[test]
fn the_largest_budgets_fit() {
    let session = Session::open();
    for [photons, bounces, frames] in [["1048576", "4", "8"], ["1048576", "2", "3"]] {
        let most = [("points.photons", photons), ("points.bounces", bounces), ("points.frames", frames)];
        let frame = session.render(&builtin("ring"), &settings(&most), &everything(&builtin("ring"), [24, 16]));
        assert!(caustics(&frame).pixels.iter().any(|pixel| pixel[0] > 0.0));
    }
}

/// More photons than pixels, fewer than turns, pictures of a pixel, scenes of all kinds: no pixel is anything but a number.
#[test]
fn any_budget_size_and_scene_will_do() {
    let session = Session::open();
    let sound = |scene: &Scene, changes: &[(&str, &str)], size: [u32; 2]| {
        let frame = session.render(scene, &settings(changes), &everything(scene, size));
        let pixels = caustics(&frame).pixels.as_flattened();
        assert!(pixels.iter().all(|channel| channel.is_finite() && *channel >= 0.0), "{changes:?}, {size:?}");
        pixels.iter().copied().fold(0.0, f32::max)
    };
    let ring = builtin("ring");
    for filter in ["screen", "world"] {
        let few = ["1", "5", "300000"].map(|count| [("points.filter", filter), ("points.photons", count)]);
        for changes in few {
            assert!(sound(&ring, &changes, [40, 32]) > 0.0 || changes[1].1 != "300000");
        }
        for size in [[1, 1], [17, 5], [3, 33]] {
            sound(&ring, &[("points.filter", filter), ("points.frames", "64")], size);
        }
        for name in ["water", "lights", "textured", "ring-occluded"] {
            let small = [("points.filter", filter), ("points.bounces", "6"), ("lights.resolution", "128")];
            sound(&builtin(name), &small, [60, 45]);
        }
    }
}

fn rrmse(found: &[DVec3], truth: &[DVec3]) -> f64 {
    let squares: f64 = found.iter().zip(truth).map(|(found, truth)| (*found - *truth).length_squared()).sum();
    let mean: f64 = truth.iter().map(|truth| truth.element_sum()).sum::<f64>() / (3 * truth.len()) as f64;
    (squares / (3 * truth.len()) as f64).sqrt() / mean
}

/// Means of blocks of 8×8 pixels of a square image.
fn blocks(pixels: &[DVec3], side: usize) -> Vec<DVec3> {
    let count = side / 8;
    let block = |index: usize| {
        let (x, y) = (index % count * 8, index / count * 8);
        let rows = (y..y + 8).flat_map(|row| &pixels[row * side + x..row * side + x + 8]);
        rows.sum::<DVec3>() / 64.0
    };
    (0..count * count).map(block).collect()
}

/// Energy against L S⁺ D E, and the error beside that of `photons` at as many photons: less of blocks, and about as much of pixels, half of which lies in a few at the
/// cusp that are brighter than what a pixel's photons are spread to.
#[test]
fn caustics_of_the_ring_are_right() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let scene = builtin("ring");
    let whole = everything(&scene, [256, 256]);
    let ask = Ask {
        bounces: Some(2),
        caustics: CausticPaths::Specular,
        filter: PixelFilter::Center,
        ..Ask::new(whole.size, 48, whole.camera.clone())
    };
    let truth = tracer.trace(&scene, &ask).slot(Slot::Caustics);
    let sum = |pixels: &[DVec3]| pixels.iter().map(|pixel| pixel.element_sum()).sum::<f64>();
    let pixels = |settings: &Settings| -> Vec<DVec3> {
        let frame = session.render(&scene, settings, &whole);
        caustics(&frame).pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).collect()
    };
    let mut other = settings(&[("photons.max", "10000")]);
    other.methods.set(Slot::Caustics, "photons").expect("a method");
    let errors = |found: &[DVec3]| [rrmse(found, &truth), rrmse(&blocks(found, 256), &blocks(&truth, 256))];
    let beside = errors(&pixels(&other));
    println!("photons: rrmse of pixels and blocks {beside:.4?}, energy {:.4}", sum(&pixels(&other)) / sum(&truth));
    let mut found_errors = Vec::new();
    for changes in [&[][..], &[("points.filter", "screen")]] {
        let found = pixels(&settings(changes));
        let (energy, error) = (sum(&found) / sum(&truth), errors(&found));
        println!("{changes:?}: rrmse of pixels and blocks {error:.4?}, energy {energy:.4}");
        assert!((energy - 1.0).abs() < 0.03, "{changes:?}: {energy}");
        found_errors.push(error);
    }
    let [world, screen] = [found_errors[0], found_errors[1]];
    assert!(world[0] < 1.1 * beside[0] && world[1] < beside[1], "{world:?} beside {beside:?}");
    assert!(world[0] < screen[0] && world[1] < screen[1], "the filter in the world is the default");
}

/// The unit of length, place and turn do not matter.
#[test]
fn a_scene_that_is_moved_as_a_whole_has_the_same_caustics() {
    let session = Session::open();
    let scene = builtin("ring");
    let image = |scene: &Scene, radius: f64| {
        let settings = settings(&[("points.photons", "4000"), ("points.radius", &radius.to_string())]);
        caustics(&session.render(scene, &settings, &everything(scene, [96, 72]))).clone()
    };
    let radius = 0.05;
    for (what, scale, place_at) in
        [("small", 1e-3, DVec3::ZERO), ("large", 1e3, DVec3::ZERO), ("far", 1.0, DVec3::splat(6e4))]
    {
        let transform = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(scale)), translation: place_at };
        let copy = transformed(&scene, transform, scale);
        for wanted in [0.0, radius] {
            let found = difference(&image(&scene, wanted), &image(&copy, wanted * scale));
            println!("{what}, radius {wanted}: rmse {:.2e}, at most {:.2e}", found.rmse, found.most);
            assert!(found.rmse < 5e-3, "{what}: {:.2e}", found.rmse);
        }
    }
    let turned = transformed(&scene, DAffine3::from_quat(DQuat::from_rotation_y(0.7)), 1.0);
    let found = difference(&image(&scene, 0.0), &image(&turned, 0.0));
    println!("turned: rmse {:.2e}", found.rmse);
    assert!(found.rmse < 0.02);
}
