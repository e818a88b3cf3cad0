//! Light that `volumes` shows after more than one bounce: where the light views see nothing, as much as was reflected, and only if it is asked for.

use glam::DVec3;

use super::against_paths::{against_paths, passes_run};
use super::probe::probe;
use super::scenes::{add_light, builtin, closed_box, lambert, request, settings_of, view};
use super::session::Session;
use crate::renderer::{FrameRequest, Slot, Technique, Timing};
use crate::scene::{LightId, LightKind, Scene};

/// What light views reflect of the light that comes from the lamps, and what samples do of light that was reflected up to the bounce before the last, W.
fn reflected(session: &Session, scene: &Scene, bounces: &str) -> [DVec3; 2] {
    let settings = settings_of(Technique::Volumes, &[("volumes.bounces", bounces), ("volumes.samples", "1024")]);
    let asked = request([8, 8], view(DVec3::new(0.9, 0.8, 0.7), DVec3::ZERO), &[]);
    let frame = probe(session, scene, &settings, &asked, |graph, declared| {
        let made = declared.volumes.as_ref().expect("volumes runs");
        let sets = [made.lights.as_deref().expect("a lamp"), (*made.samples).as_ref().expect("samples")];
        sets.iter().flat_map(|set| [graph.read_back_buffer(set.lights), graph.read_back_buffer(set.counts)]).collect()
    });
    [0, 2].map(|read| {
        let count = frame.floats(read + 1)[0].to_bits() as usize;
        frame.vpls(read).into_iter().take(count).map(|light| light.flux).sum()
    })
}

/// In a closed box what is reflected falls by the albedo from bounce to bounce.
#[test]
fn every_bounce_reflects_the_albedo_of_the_one_before() {
    let session = Session::open();
    let albedo = DVec3::new(0.8, 0.5, 0.2);
    let mut scene = closed_box(1.0, lambert(albedo.as_vec3().to_array()));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.2, -0.4), DVec3::NEG_Y, [1.0; 3]);
    let [first, second] = reflected(&session, &scene, "2");
    let [third, fourth] = ["3", "4"].map(|bounces| reflected(&session, &scene, bounces)[1]);
    for (bounce, before, after) in
        [(2, first, second), (3, second, third - second), (4, third - second, fourth - third)]
    {
        let ratio = after / before / albedo;
        println!("bounce {bounce}: {after:.4} W of {before:.4} W, over the albedo {ratio:.4}");
        assert!((ratio - 1.0).abs().max_element() < 0.03, "bounce {bounce}: {ratio}");
    }
}

/// The leg of the corridor that no light view sees.
#[test]
fn light_comes_round_two_corners() {
    let session = Session::open();
    let scene = builtin("corridor");
    let camera = view(DVec3::new(0.1, 1.4, 1.6), DVec3::new(0.0, 1.0, 4.4));
    let of = |bounces: &str, paths: u32| {
        let settings = settings_of(Technique::Volumes, &[("volumes.bounces", bounces)]);
        against_paths(&session, &scene, camera.clone(), &settings, (1024, Some(paths)))
    };
    let (one, _) = of("1", 2);
    for (bounces, number) in [("2", 2), ("4", 4)] {
        let (ratio, error) = of(bounces, number);
        println!("{bounces} bounces: mean {ratio:.3}, blocks {error:.3}; one bounce {one:.3} of two");
        assert!((ratio - 1.0).abs() < 0.1 && error < 0.15, "{bounces} bounces: {ratio} {error}");
    }
    assert!(one < 0.5, "{one}: most of the light there was reflected twice");
}

#[test]
fn pictures_of_several_bounces_are_those_of_paths() {
    let session = Session::open();
    for (name, bounces, number, mean_bound, error_bound) in [
        ("cornell-point", "3", Some(3), 0.03, 0.08),
        ("cornell-panel", "3", Some(3), 0.06, 0.12),
        ("textured", "2", Some(2), 0.06, 0.15),
    ] {
        let scene = builtin(name);
        let camera = scene.camera_view(None).expect("its camera");
        let settings = settings_of(Technique::Volumes, &[("volumes.bounces", bounces)]);
        let (ratio, error) = against_paths(&session, &scene, camera, &settings, (256, number));
        println!("{name}, {bounces} bounces: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < mean_bound && error < error_bound, "{name}: {ratio} {error}");
    }
}

#[test]
fn who_asks_for_one_bounce_pays_for_one_and_what_stands_is_not_made_again() {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let asked = |camera| FrameRequest { timing: Timing::Passes, ..request([64, 48], camera, &[Slot::Diffuse]) };
    let one = session.render(&scene, &settings_of(Technique::Volumes, &[]), &asked(camera.clone()));
    assert!(passes_run(&one, "bounces").is_empty() && passes_run(&one, "diffuse/volumes/light-samples").is_empty());
    let settings = settings_of(Technique::Volumes, &[("volumes.bounces", "3"), ("volumes.samples", "256")]);
    let mut renderer = session.renderer(&settings);
    let first = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    assert!(passes_run(&first, "bounces").len() >= 6, "{:?}", passes_run(&first, "bounces"));
    let beside = view(DVec3::new(0.1, 1.0, 2.9), DVec3::new(0.0, 1.0, 0.0));
    let moved = renderer.render(&scene, &asked(beside)).expect("a frame");
    assert!(passes_run(&moved, "bounces").is_empty(), "{:?}", passes_run(&moved, "bounces"));
    let mut light = scene.lights()[0].clone();
    light.intensity = light.intensity.map(|channel| 2.0 * channel);
    scene.set_light(LightId(0), light).expect("a sound light");
    let relit = renderer.render(&scene, &asked(camera)).expect("a frame");
    assert!(passes_run(&relit, "bounces/samples").is_empty(), "{:?}", passes_run(&relit, "bounces/samples"));
    assert!(!passes_run(&relit, "bounces/light").is_empty());
}
