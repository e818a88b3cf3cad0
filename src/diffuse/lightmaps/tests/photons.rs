//! The approximated map by photons: light, leaks, and which photons are sent again.

use glam::{DAffine3, DVec3};

use super::super::options::{LightmapsInvalidate, LightmapsOptions, LightmapsSource};
use super::frames::{asked, difference, frame, renewed, scale_light, until_still};
use super::{lamp_box, leak_of_a_parted_room, open_room, options, settings, with_camera};
use crate::gpu_tests::against_paths::{against_paths, leaks};
use crate::gpu_tests::scenes::{add_light, box_faces, lambert, place, view};
use crate::gpu_tests::session::Session;
use crate::renderer::Frame;
use crate::scene::{LightKind, Scene};

fn by_photons() -> LightmapsOptions {
    LightmapsOptions { source: LightmapsSource::Photons, count: 3000, ..options() }
}

/// What the pass that sends photons counted.
fn sent(frame: &Frame) -> u64 {
    let passes = frame.timings.passes.iter().filter(|row| row.full_name() == "diffuse/lightmaps/photons/send");
    passes.filter_map(|row| row.work.get("sent")).sum()
}

#[test]
fn pictures_are_those_of_paths() {
    let session = Session::open();
    let cases = [
        ("cornell-point", with_camera("cornell-point"), None),
        ("cornell-point", with_camera("cornell-point"), Some(2)),
        ("lamp", lamp_box(), None),
        ("sky", open_room(), None),
        ("ring", with_camera("ring"), None),
    ];
    for (name, (scene, camera), bounces) in cases {
        let settings = settings(LightmapsOptions { bounces, ..by_photons() });
        let (ratio, error) = against_paths(&session, &scene, camera, &settings, (128, bounces));
        println!("{name}, {bounces:?} bounces: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.06 && error < 0.1, "{name}, {bounces:?} bounces: {ratio} {error}");
    }
}

#[test]
fn light_stays_out_of_dark_rooms() {
    let found = leaks(&Session::open(), &settings(by_photons()), [32, 24]);
    println!("{found:?} of the lit hall's light");
    assert!(found.iter().all(|&share| share < 1e-3), "{found:?} of the lit hall's light");
}

#[test]
fn one_floor_under_two_rooms_does_not_leak() {
    let found = leak_of_a_parted_room(&Session::open(), &settings(by_photons()));
    println!("{found:.1e} of the lit half's light");
    assert!(found < 1e-3, "{found}");
}

/// Two closed rooms, a light in each, and a block in the first.
fn two_rooms() -> (Scene, crate::scene::NodeId) {
    let mut scene = Scene::empty("two closed rooms");
    let wall = scene.add_material(lambert([0.7, 0.5, 0.3])).expect("a sound material");
    for room in [0.0, 3.0] {
        place(&mut scene, box_faces([1.0; 3], [wall; 6]), DAffine3::from_translation(DVec3::X * room));
        let at = DVec3::new(room + 0.1, 0.5, -0.2);
        add_light(&mut scene, LightKind::Point, at, DVec3::NEG_Y, [1.0; 3]);
    }
    let mut faces = box_faces([0.2; 3], [wall; 6]);
    faces.iter_mut().for_each(|face| face.indices.reverse());
    let block = place(&mut scene, faces, DAffine3::from_translation(DVec3::new(0.4, -0.7, 0.3)));
    (scene, block)
}

/// A light sends its own photons again, a block those whose paths it crosses, and what moves in one room neither sends nor renews anything for the other.
#[test]
fn those_are_sent_again_whose_way_changed() {
    let session = Session::open();
    let (mut scene, block) = two_rooms();
    let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
    let all = LightmapsOptions { texels: 1_000_000, ..by_photons() };
    let mut renderer = session.renderer(&settings(all.clone()));
    let whole = frame(&mut renderer, &scene, &camera);
    scale_light(&mut scene, 1, 2.0);
    let lit = frame(&mut renderer, &scene, &camera);
    println!("sent {} of {}, renewed {} of {}", sent(&lit), sent(&whole), renewed(&lit), renewed(&whole));
    assert_eq!(2 * sent(&lit), sent(&whole), "the light's own");
    assert!(renewed(&lit) > 0 && 2 * renewed(&lit) <= renewed(&whole), "in its own room");
    until_still(&mut renderer, &scene, &camera);
    scene.set_local_transform(block, DAffine3::from_translation(DVec3::new(0.3, -0.7, 0.3))).expect("sound");
    let moved = frame(&mut renderer, &scene, &camera);
    println!("sent {}, renewed {}", sent(&moved), renewed(&moved));
    assert!(sent(&moved) > 0 && 2 * sent(&moved) < sent(&whole), "of the light in the block's room");
    let (_, still) = until_still(&mut renderer, &scene, &camera);
    let last = difference(&still, &session.render(&scene, &settings(all), &asked(&camera)));
    println!("{last:.4}");
    assert!(last < 0.01, "{last}");
}

/// Probes stumble on what moved, in as many frames as a group has photons at most.
#[test]
fn probes_find_what_moved() {
    let session = Session::open();
    let (mut scene, block) = two_rooms();
    let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
    let probing = LightmapsOptions { invalidate: LightmapsInvalidate::Probes, ..by_photons() };
    let mut renderer = session.renderer(&settings(probing.clone()));
    let whole = sent(&frame(&mut renderer, &scene, &camera));
    scene.set_local_transform(block, DAffine3::from_translation(DVec3::new(0.1, -0.7, 0.3))).expect("sound");
    let again: Vec<u64> = (0..8).map(|_| sent(&frame(&mut renderer, &scene, &camera))).collect();
    println!("{again:?} of {whole}");
    assert!(again[0] > 0 && again.iter().sum::<u64>() < whole, "{again:?} of {whole}");
    let (_, still) = until_still(&mut renderer, &scene, &camera);
    let last = difference(&still, &session.render(&scene, &settings(probing), &asked(&camera)));
    println!("{last:.4}");
    assert!(last < 0.02, "{last}");
}
