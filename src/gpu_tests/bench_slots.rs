//! What the bench compares with references is what the contenders were timed for; and what it finds of light in dark rooms.

use glam::DVec3;

use super::scenes::{add_light, floor, lambert, settings_of, view};
use super::session::Session;
use crate::bench::leaks::{arrived, leaks};
use crate::bench::{Options, Subject, run};
use crate::image::ColorImage;
use crate::renderer::{Preset, Settings, Slot, Technique};
use crate::scene::{LightKind, Scene};

#[test]
fn contenders_give_the_slots_that_they_fill_and_these_add_up() {
    let session = Session::open();
    let scene = Scene::open("cornell-point").expect("a built-in scene");
    let camera = scene.camera_view(None).expect("it has a camera");
    let subject = Subject { name: "box", scene: &scene, camera: &camera, load_ms: 0.0 };
    let contenders = [Technique::Direct, Technique::Rsm].map(|technique| Settings::new(technique, Preset::Draft));
    let pieces = Vec::new();
    let options = Options {
        size: [32, 24],
        frames: 1,
        warmup: 0,
        lead_in: Some(2),
        max_seconds: None,
        pictures: false,
        slots: true,
        pieces,
    };
    let outcomes = run(&session.context, &subject, &contenders, &options, &mut || ());
    for (outcome, settings) in outcomes.into_iter().zip(&contenders) {
        let finished = outcome.expect("it came through");
        assert_eq!(
            (finished.run.lead_in, finished.run.cold_ms.is_some()),
            (2, true),
            "steady and cold frames are told apart"
        );
        let images = finished.images.expect("they were wanted");
        let filled = Slot::ALL.into_iter().filter(|slot| settings.methods.fills(*slot));
        assert!(images.slots.keys().copied().eq(filled));
        let covered = ColorImage::sum(options.size, images.slots.values());
        let values = covered.pixels.as_flattened().iter().zip(images.image.pixels.as_flattened());
        assert!(values.clone().any(|(a, _)| *a > 0.0));
        for (a, b) in values {
            assert!((a - b).abs() <= 1e-4 * b.abs().max(1e-3), "slots {a}, image {b}");
        }
    }
    // A run that is not to be compared reads nothing back.
    let options = Options { slots: false, lead_in: None, ..options };
    let outcomes = run(&session.context, &subject, &contenders[..1], &options, &mut || ());
    let finished = outcomes.into_iter().next().expect("one contender").expect("it came through");
    assert!(
        finished.images.is_none() && finished.run.cold_ms.is_none(),
        "nothing is kept: no frame is another one's past"
    );
}

/// A lamp a metre above a square floor of 2 m sends 4 asin(1/2)/4π = a sixth of its light to it.
#[test]
fn what_arrives_is_the_light_that_the_solid_angle_holds() {
    let session = Session::open();
    let mut scene = floor(1.0, lambert([0.8, 0.4, 0.1]));
    add_light(&mut scene, LightKind::Point, DVec3::Y, DVec3::NEG_Y, [3.0, 2.0, 1.0]);
    let camera = view(DVec3::new(0.0, 4.0, 0.01), DVec3::ZERO);
    let mut renderer = session.renderer(&settings_of(Technique::Direct, &[]));
    let power = arrived(&mut renderer, &scene, &camera, 0).expect("a frame")[&Slot::Direct];
    let share = power / scene.emitted_power().into_iter().sum::<f64>();
    println!("{share:.5} of the light arrives");
    assert!((6.0 * share - 1.0).abs() < 0.02, "{share}");
}

#[test]
fn scenes_with_dark_rooms_show_what_gets_in() {
    let session = Session::open();
    let scene = Scene::open("leak").expect("a built-in scene");
    let found = |visibility| {
        let settings = settings_of(Technique::Volumes, &[("volumes.visibility", visibility), ("volumes.lights", "16")]);
        leaks(&mut session.renderer(&settings), &scene, 0).expect("frames").expect("it has dark rooms")
    };
    let [open, rays] = ["none", "rays"].map(found);
    println!("{open:?}\n{rays:?}");
    assert!(open.rooms.keys().eq(["sealed", "thick", "thin"]));
    assert!(open.rooms.values().all(|room| room[&Slot::Diffuse] > 1e-3), "nothing is in the way: {open:?}");
    assert!(rays.rooms["sealed"].values().all(|share| *share == 0.0), "{rays:?}");
    assert!(rays.rooms.values().all(|room| room[&Slot::Diffuse] < 1e-5), "{rays:?}");
    let none = Scene::open("corridor").expect("a built-in scene");
    let settings = settings_of(Technique::Direct, &[]);
    assert!(leaks(&mut session.renderer(&settings), &none, 0).expect("no frame").is_none());
}
