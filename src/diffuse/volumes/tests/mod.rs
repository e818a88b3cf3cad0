//! Radiance volumes against paths, and what stands when something moves.

mod storage;
mod together;
mod updates;
mod views;

use glam::{DAffine3, DVec3};

use crate::gpu_tests::against_paths::{against_paths, leaks, passes_run};
use crate::gpu_tests::scenes::{
    add_light, box_faces, builtin, closed_box, floor, lambert, place, quad, request, settings_of, view,
};
use crate::gpu_tests::session::Session;
use crate::renderer::{Frame, FrameRequest, Preset, Settings, Slot, Technique, Timing};
use crate::scene::{LightId, LightKind, Material, Scene};

/// What passes whose names begin so counted.
fn counted(frame: &Frame, pass: &str, name: &str) -> u64 {
    let rows = frame.timings.passes.iter().filter(|row| row.skipped.is_none() && row.full_name().starts_with(pass));
    rows.filter_map(|row| row.work.get(name)).sum()
}

/// Root mean square of what two pictures differ by, over the mean of the second.
fn difference(found: &Frame, expected: &Frame) -> f64 {
    let [found, expected] = [found, expected].map(|frame| frame.slots[&Slot::Diffuse].pixels.as_flattened());
    let squares: f64 = found.iter().zip(expected).map(|(a, b)| f64::from(a - b).powi(2)).sum();
    let sum: f64 = expected.iter().copied().map(f64::from).sum();
    (squares / expected.len() as f64).sqrt() / (sum / expected.len() as f64)
}

#[test]
fn pictures_are_those_of_paths_of_one_bounce() {
    let session = Session::open();
    for (name, mean_bound, error_bound) in [
        ("cornell-point", 0.03, 0.06),
        ("cornell-spot", 0.03, 0.06),
        ("cornell-panel", 0.03, 0.08),
        ("corridor", 0.03, 0.06),
    ] {
        let scene = builtin(name);
        let camera = scene.camera_view(None).expect("its camera");
        let settings = settings_of(Technique::Volumes, &[]);
        let (ratio, error) = against_paths(&session, &scene, camera, &settings, (256, Some(1)));
        println!("{name}: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < mean_bound && error < error_bound, "{name}: {ratio} {error}");
    }
}

/// Cones through voxels see what rays do, but for what is thinner than a voxel or beside a cache.
#[test]
fn cones_show_about_what_rays_do() {
    let session = Session::open();
    for (name, changes, mean_bound, error_bound) in [
        ("cornell-point", &[("volumes.visibility", "cones")][..], 0.09, 0.12),
        (
            "cornell-point",
            &[("volumes.visibility", "cones"), ("volumes.lod", "2"), ("volumes.empty", "march")],
            0.09,
            0.12,
        ),
        ("corridor", &[("volumes.visibility", "cones"), ("volumes.occluders", "solids")], 0.12, 0.16),
    ] {
        let scene = builtin(name);
        let camera = scene.camera_view(None).expect("its camera");
        let settings = settings_of(Technique::Volumes, changes);
        let (ratio, error) = against_paths(&session, &scene, camera, &settings, (256, Some(1)));
        println!("{name}, {changes:?}: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < mean_bound && error < error_bound, "{name}: {ratio} {error}");
    }
    let leaked = leaks(&session, &settings_of(Technique::Volumes, &[("volumes.visibility", "cones")]), [32, 24]);
    println!("of the lit hall's light: {leaked:?}");
    assert!(leaked.iter().all(|&leak| leak < 0.1), "{leaked:?}");
}

#[test]
fn the_thesis_settings_are_within_its_error() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let settings = Settings::new(Technique::Volumes, Preset::Paper);
    let (ratio, error) = against_paths(&session, &scene, camera, &settings, (256, Some(1)));
    println!("mean {ratio:.3}, blocks {error:.3}");
    assert!((ratio - 1.0).abs() < 0.08 && error < 0.2, "{ratio} {error}");
}

/// A flat floor gives itself no light, however near its lights are to its caches: neither alone nor under metal, which asks for caches that face all ways and gives
/// nothing diffusely.
#[test]
fn a_floor_does_not_light_itself() {
    for block in [false, true] {
        let share = light_of_a_floor(block);
        assert!(share < 1e-5, "{share:.1e} of the direct light, block {block}");
    }
}

fn light_of_a_floor(block: bool) -> f64 {
    let session = Session::open();
    let mut scene = floor(2.0, lambert([0.8; 3]));
    if block {
        let metal = Material { metallic: 1.0, ..lambert([0.9; 3]) };
        let metal = scene.add_material(metal).expect("a sound material");
        let turned = DAffine3::from_rotation_y(0.5) * DAffine3::from_translation(DVec3::new(0.0, 0.2, 0.0));
        place(&mut scene, box_faces([0.3, 0.2, 0.3], [metal; 6]), turned);
    }
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.7, 0.2), DVec3::NEG_Y, [5.0; 3]);
    let camera = view(DVec3::new(1.5, 1.2, 1.8), DVec3::ZERO);
    let mean = |slot| {
        let frame =
            session.render(&scene, &settings_of(Technique::Volumes, &[]), &request([64, 48], camera.clone(), &[slot]));
        frame.slots[&slot].pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>()
    };
    mean(Slot::Diffuse) / mean(Slot::Direct)
}

/// Light of the sky, through a window that few directions lead through, and of more small lamps than views stand for.
#[test]
fn the_light_of_skies_and_of_many_lamps_gets_in() {
    let session = Session::open();
    let mut room = Scene::empty("window");
    let white = room.add_material(lambert([0.7; 3])).expect("a sound material");
    let mut faces = box_faces([1.0; 3], [white; 6]);
    let sill = [[1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [1.0, 0.2, 1.0], [1.0, 0.2, -1.0]];
    faces[1] = quad(sill, white);
    place(&mut room, faces, DAffine3::IDENTITY);
    room.set_sky([0.5, 0.7, 1.0]);

    let mut lamps = closed_box(1.0, lambert([0.7; 3]));
    for number in 0..24 {
        let shine = Material { emissive: [20.0, 15.0, 10.0], ..lambert([0.5; 3]) };
        let material = lamps.add_material(shine).expect("a sound material");
        let [x, y, z] =
            [0.754_877, 0.569_840, 0.430_159].map(|step: f64| 1.6 * (f64::from(number) * step).fract() - 0.8);
        place(&mut lamps, box_faces([-0.03; 3], [material; 6]), DAffine3::from_translation(DVec3::new(x, y, z)));
    }
    for (name, scene) in [("window", room), ("lamps", lamps)] {
        let camera = view(DVec3::new(-0.9, 0.1, 0.9), DVec3::new(0.2, -0.3, -1.0));
        let settings = settings_of(Technique::Volumes, &[]);
        let (ratio, error) = against_paths(&session, &scene, camera, &settings, (1024, Some(1)));
        println!("{name}: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.04 && error < 0.1, "{name}: {ratio} {error}");
    }
}

#[test]
fn who_sees_by_rays_does_not_pay_for_voxels() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let asked = FrameRequest { timing: Timing::Passes, ..request([64, 48], camera, &[Slot::Diffuse]) };
    let voxels = |visibility| {
        let settings = settings_of(Technique::Volumes, &[("volumes.visibility", visibility)]);
        passes_run(&session.render(&scene, &settings, &asked), "voxels").len()
    };
    assert_eq!((voxels("none"), voxels("rays")), (0, 0));
    assert!(voxels("cones") > 5);
}

/// Rays from caches to lights, and from pixels to caches.
#[test]
fn rays_keep_light_out_of_dark_rooms() {
    let session = Session::open();
    let of = |visibility, weights| {
        let changes = [("volumes.visibility", visibility), ("volumes.weights", weights)];
        leaks(&session, &settings_of(Technique::Volumes, &changes), [32, 24])
    };
    let (none, rays, both) = (of("none", "trilinear"), of("rays", "trilinear"), of("rays", "rays"));
    println!(
        "of the lit hall's light: {none:?} without rays, {rays:?} with rays to lights, {both:?} with rays to caches too"
    );
    assert!(none.iter().all(|&leak| leak > 0.1), "{none:?}");
    assert!(rays.iter().all(|&leak| leak < 1e-3), "{rays:?}");
    assert!(both[1..].iter().zip(&rays[1..]).all(|(with, without)| *with <= 0.01 * without), "{both:?} {rays:?}");
}

#[test]
fn what_did_not_change_stands_and_repeats_are_the_same_bits() {
    for (spread, lights) in [("views", "caches/lights"), ("picture", "caches/spread")] {
        stands_and_repeats(spread, lights);
    }
}

fn stands_and_repeats(spread: &str, lights: &str) {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let asked = |camera| FrameRequest { timing: Timing::Passes, ..request([512, 384], camera, &[Slot::Diffuse]) };
    let ran = |frame: &_| [passes_run(frame, "caches"), passes_run(frame, "diffuse/volumes")].concat();
    // So large that caches get other numbers each time.
    let mut renderer =
        session.renderer(&settings_of(Technique::Volumes, &[("volumes.lights", "16"), ("volumes.spread", spread)]));
    let first = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    let again = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    assert!(ran(&again).is_empty(), "{:?}", ran(&again));
    for _ in 0..3 {
        renderer.invalidate();
        let anew = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
        assert!(!ran(&anew).is_empty(), "it is made anew");
        assert_eq!(first.slots, anew.slots, "bit by bit");
    }

    let beside = view(DVec3::new(0.1, 1.0, 2.9), DVec3::new(0.0, 1.0, 0.0));
    let moved = renderer.render(&scene, &asked(beside)).expect("a frame");
    // Which lights are small follows from what the picture shows, if it is asked to.
    assert_eq!(passes_run(&moved, lights).is_empty(), spread == "views", "{:?}", ran(&moved));
    assert!(passes_run(&moved, &format!("{lights}/reduce")).is_empty(), "{:?}", ran(&moved));
    assert!(passes_run(&moved, "light-views").is_empty() && !passes_run(&moved, "caches/places").is_empty());

    renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    let mut light = scene.lights()[0].clone();
    light.intensity = light.intensity.map(|channel| 2.0 * channel);
    scene.set_light(LightId(0), light).expect("a sound light");
    let relit = renderer.render(&scene, &asked(camera)).expect("a frame");
    assert!(
        passes_run(&relit, "caches/places").is_empty(),
        "caches stand where a light alone changes: {:?}",
        ran(&relit)
    );
    assert!(!passes_run(&relit, lights).is_empty() && !passes_run(&relit, "diffuse/volumes").is_empty());
}

#[test]
fn scenes_without_need_pay_nothing() {
    let session = Session::open();
    let reason = |scene: &Scene| {
        let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
        let frame =
            session.render(scene, &settings_of(Technique::Volumes, &[]), &request([8, 8], camera, &[Slot::Diffuse]));
        assert!(passes_run(&frame, "caches").is_empty() && passes_run(&frame, "bounces").is_empty());
        let row = frame.timings.passes.into_iter().find(|pass| pass.full_name().starts_with("diffuse/volumes"));
        row.and_then(|row| row.skipped).expect("a reason")
    };
    assert_eq!(reason(&closed_box(1.0, lambert([0.5; 3]))), "no light");
    let mut metal = closed_box(1.0, Material { metallic: 1.0, ..lambert([0.5; 3]) });
    add_light(&mut metal, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    assert_eq!(reason(&metal), "no diffuse surface");
}
