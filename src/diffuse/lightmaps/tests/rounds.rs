//! Rounds of rays and photons that join while nothing changes.

use glam::{DAffine3, DVec3};

use super::super::options::{LightmapsOptions, LightmapsSettle, LightmapsShow};
use super::frames::{difference, frame, pixels, ran, renewed, scale_light, two_closed_rooms, until_still};
use super::photons::{by_photons, move_to, sent, two_rooms};
use super::{options, settings};
use crate::gpu_tests::scenes::{add_light, box_faces, lambert, place, quad, view, with_camera};
use crate::gpu_tests::session::Session;
use crate::renderer::Frame;
use crate::scene::{CameraView, LightKind, Scene};

/// Texels of which a frame gathers all.
fn at_once(rounds: u32) -> LightmapsOptions {
    LightmapsOptions { count: 1000, rays: 16, texels: 1_000_000, rounds, ..options() }
}

/// Against as many rays as there can be: rounds bring the error down, at least as fast as their square root, until nothing runs any more. A picture by itself has one.
#[test]
fn rounds_of_rays_bring_the_error_down() {
    let session = Session::open();
    for (name, rays) in [("cornell-point", 16), ("two-rooms", 64)] {
        let (scene, camera) = with_camera(name);
        let truth = LightmapsOptions { rays: 4096, settle: LightmapsSettle::Always, ..at_once(1) };
        let truth = session.render(&scene, &settings(truth), &super::frames::asked(&camera));
        let few = LightmapsOptions { rays, ..at_once(16) };
        let mut renderer = session.renderer(&settings(few.clone()));
        let first = frame(&mut renderer, &scene, &camera);
        let alone =
            session.render(&scene, &settings(LightmapsOptions { rounds: 1, ..few }), &super::frames::asked(&camera));
        assert!(first.slots == alone.slots, "a first frame has one round");
        let mut gathered = renewed(&first);
        let used = gathered;
        let still = loop {
            let made = frame(&mut renderer, &scene, &camera);
            if ran(&made).is_empty() {
                break made;
            }
            gathered += renewed(&made);
        };
        let [one, all] = [&first, &still].map(|frame| difference(frame, &truth));
        println!("{name}: {one:.4} after a round, {all:.4} after 16, {gathered} of {used} texels");
        assert_eq!(gathered, 16 * used);
        assert!(all < 0.3 * one, "{name}: {one} {all}");
    }
}

/// Rays of later rounds go on along the sequence of the first one: sixteen rounds of 16 are one of 256.
#[test]
fn many_rounds_of_few_rays_are_one_of_many() {
    let session = Session::open();
    let (scene, camera) = with_camera("cornell-point");
    let (_, rounds) = until_still(&mut session.renderer(&settings(at_once(16))), &scene, &camera);
    let many = LightmapsOptions { rays: 256, ..at_once(1) };
    let off = difference(&rounds, &session.render(&scene, &settings(many), &super::frames::asked(&camera)));
    println!("{off:.1e}");
    assert!(off < 1e-4, "{off}");
}

/// The same frames have the same bits, also where a change comes between rounds, and no frame gathers more than it may.
#[test]
fn rounds_have_the_same_bits() {
    let session = Session::open();
    let sequence = || {
        let (mut scene, camera) = with_camera("cornell-point");
        let mut renderer = session.renderer(&settings(LightmapsOptions { texels: 300, ..at_once(4) }));
        let mut all: Vec<Frame> = (0..5).map(|_| frame(&mut renderer, &scene, &camera)).collect();
        assert!(all[1..].iter().all(|frame| renewed(frame) == 300), "as many as a frame may");
        scale_light(&mut scene, 0, 2.0);
        all.extend((0..5).map(|_| frame(&mut renderer, &scene, &camera)));
        all.push(until_still(&mut renderer, &scene, &camera).1);
        all
    };
    let [first, again] = [sequence(), sequence()];
    assert!(first.iter().zip(&again).all(|(a, b)| a.slots == b.slots));
}

/// Of two closed rooms one gets another light: its texels have all rounds again, and the other one keeps its own.
#[test]
fn rooms_without_a_change_keep_their_rounds() {
    let session = Session::open();
    let mut scene = two_closed_rooms();
    let cameras = [0.0, 3.0].map(|x| view(DVec3::new(x + 0.7, 0.6, 0.8), DVec3::new(x, 0.0, 0.0)));
    let mut renderer = session.renderer(&settings(at_once(4)));
    let whole = renewed(&frame(&mut renderer, &scene, &cameras[0]));
    until_still(&mut renderer, &scene, &cameras[0]);
    let other_before = frame(&mut renderer, &scene, &cameras[1]);
    scale_light(&mut scene, 0, 3.0);
    let mut gathered = 0;
    let still = loop {
        let made = frame(&mut renderer, &scene, &cameras[0]);
        if ran(&made).is_empty() {
            break made;
        }
        gathered += renewed(&made);
    };
    // While bounces come in, texels are renewed more than once before their rounds; both rooms' would be more than that.
    println!("{gathered} of {whole} texels");
    assert!((4 * whole / 2..8 * whole / 2).contains(&gathered), "{gathered} of {whole}");
    let mut fresh = session.renderer(&settings(at_once(4)));
    let (_, expected) = until_still(&mut fresh, &scene, &cameras[0]);
    let last = difference(&still, &expected);
    println!("{last:.4}");
    assert!(last < 0.01, "{last}");
    assert!(frame(&mut renderer, &scene, &cameras[1]).slots == other_before.slots, "bit by bit");
}

/// By how much what texels receive differs from 2π in the furnace (albedo ½, radiance 2), rms, over it.
fn noise(frame: &Frame) -> f64 {
    let values = pixels(frame).as_flattened();
    let sum: f64 = values.iter().map(|&value| (f64::from(value) / 2.0 - 1.0).powi(2)).sum();
    (sum / values.len() as f64).sqrt()
}

/// In a furnace texels receive the same everywhere: what photons say of it has noise alone, and rounds bring that down.
#[test]
fn rounds_of_photons_bring_noise_down() {
    let session = Session::open();
    let (scene, camera) = with_camera("furnace");
    let show = LightmapsShow::Received;
    let few = LightmapsOptions { rounds: 16, photons: 4000, show, ..by_photons() };
    let mut renderer = session.renderer(&settings(few));
    let all: Vec<(u64, f64)> = (0..18)
        .map(|_| {
            let made = frame(&mut renderer, &scene, &camera);
            (sent(&made), noise(&made))
        })
        .collect();
    println!("{all:.4?}");
    assert!(all[..16].iter().all(|&(sent, _)| sent == all[0].0) && all[16].0 == 0, "sixteen rounds: {all:?}");
    // Later rounds look for fewer photons: noise goes as the third root of rounds.
    assert!(all[17].1 < 0.42 * all[0].1, "{all:?}");
}

fn into_room(x: f64) -> CameraView {
    view(DVec3::new(x + 0.7, 0.6, 0.8), DVec3::new(x, 0.0, 0.0))
}

/// A block moves in one room: the other one keeps its rounds, bit by bit, and the block's is in the end as if it had always been there.
#[test]
fn what_moves_touches_no_rounds_of_another_room() {
    let session = Session::open();
    let (mut scene, block) = two_rooms();
    let all = LightmapsOptions { rounds: 4, texels: 1_000_000, ..by_photons() };
    let mut renderer = session.renderer(&settings(all.clone()));
    until_still(&mut renderer, &scene, &into_room(0.0));
    let other = frame(&mut renderer, &scene, &into_room(3.0));
    move_to(&mut scene, block, DVec3::new(0.25, -0.5, 0.25));
    let (_, still) = until_still(&mut renderer, &scene, &into_room(0.0));
    assert!(frame(&mut renderer, &scene, &into_room(3.0)).slots == other.slots, "bit by bit");
    let (_, expected) = until_still(&mut session.renderer(&settings(all)), &scene, &into_room(0.0));
    let last = difference(&still, &expected);
    println!("{last:.4}");
    assert!(last < 0.01, "{last}");
}

/// A room that holds many plates, and so few photons that a round reaches some of these only.
fn room_of_plates() -> Scene {
    let mut scene = Scene::empty("plates");
    let white = scene.add_material(lambert([0.7; 3])).expect("a sound material");
    place(&mut scene, box_faces([1.0; 3], [white; 6]), DAffine3::IDENTITY);
    for number in 0..36_u8 {
        let [x, z] = [number % 6, number / 6].map(|place| 0.3 * f32::from(place) - 0.75);
        let corners =
            [[x - 0.1, -0.9, z - 0.1], [x - 0.1, -0.9, z + 0.1], [x + 0.1, -0.9, z + 0.1], [x + 0.1, -0.9, z - 0.1]];
        place(&mut scene, vec![quad(corners, white)], DAffine3::IDENTITY);
    }
    add_light(&mut scene, LightKind::Point, DVec3::new(0.1, 0.3, -0.2), DVec3::NEG_Y, [1.0; 3]);
    scene
}

/// What a light brought in any round goes with it, also where the last round's photons did not come.
#[test]
fn no_light_of_earlier_rounds_stays_behind() {
    let session = Session::open();
    let mut scene = room_of_plates();
    let camera = view(DVec3::new(0.0, 0.9, 0.2), DVec3::new(0.0, -1.0, 0.0));
    let few = LightmapsOptions { rounds: 16, photons: 40, show: LightmapsShow::Received, ..by_photons() };
    let mut renderer = session.renderer(&settings(few));
    let sum = |frame: &Frame| pixels(frame).iter().flatten().map(|&value| f64::from(value)).sum::<f64>();
    let lit = sum((0..18).map(|_| frame(&mut renderer, &scene, &camera)).last().as_ref().expect("some"));
    scale_light(&mut scene, 0, 1e-6);
    let dark = sum(&frame(&mut renderer, &scene, &camera));
    println!("{:.1e} is left", dark / lit);
    assert!(lit > 0.0 && dark < 1e-4 * lit, "{dark} of {lit}");
}

/// What moves where no photon of the last round went may have been in the way of one of an earlier round: what the light brought begins anew.
#[test]
fn what_moves_between_paths_begins_rounds_anew() {
    let session = Session::open();
    let mut scene = room_of_plates();
    let white = scene.add_material(lambert([0.7; 3])).expect("a sound material");
    let speck = [[0.0, 0.0, 0.0], [0.0, 0.0, 1e-3], [1e-3, 0.0, 1e-3], [1e-3, 0.0, 0.0]];
    let speck = place(&mut scene, vec![quad(speck, white)], DAffine3::from_translation(DVec3::new(0.7, 0.6, 0.7)));
    let camera = view(DVec3::new(0.0, 0.9, 0.2), DVec3::new(0.0, -1.0, 0.0));
    let few = LightmapsOptions { rounds: 16, photons: 40, show: LightmapsShow::Received, ..by_photons() };
    let mut renderer = session.renderer(&settings(few));
    let before = (0..18).map(|_| frame(&mut renderer, &scene, &camera)).last().expect("some");
    move_to(&mut scene, speck, DVec3::new(0.7, 0.601, 0.7));
    let after = frame(&mut renderer, &scene, &camera);
    println!("{:.3}", difference(&after, &before));
    assert_eq!(sent(&after), 0, "no path crosses it");
    assert!(difference(&after, &before) > 0.01, "sixteen rounds are one now");
}
