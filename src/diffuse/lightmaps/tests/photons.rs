//! The approximated map by photons: light, leaks, and which photons are sent again.

use glam::{DAffine3, DVec3};

use super::super::options::{LightmapsInvalidate, LightmapsOptions, LightmapsSource};
use super::frames::{asked, difference, frame, renewed, scale_light, until_still};
use super::{leak_of_a_parted_room, options, settings};
use crate::gpu_tests::against_paths::{against_paths, leaks};
use crate::gpu_tests::scenes::{
    add_light, box_faces, floor, lambert, lamp_box, open_room, place, quad, view, with_camera,
};
use crate::gpu_tests::session::Session;
use crate::renderer::{DiffuseMethod, Frame};
use crate::scene::{CameraView, LightKind, Material, MaterialId, NodeId, Scene};

pub(super) fn by_photons() -> LightmapsOptions {
    LightmapsOptions { source: LightmapsSource::Photons, count: 3000, ..options() }
}

/// What the pass that sends photons counted.
pub(super) fn sent(frame: &Frame) -> u64 {
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
pub(super) fn two_rooms() -> (Scene, NodeId) {
    let mut scene = Scene::empty("two closed rooms");
    let wall = scene.add_material(lambert([0.7, 0.5, 0.3])).expect("a sound material");
    for room in [0.0, 3.0] {
        place(&mut scene, box_faces([1.0; 3], [wall; 6]), DAffine3::from_translation(DVec3::X * room));
        let at = DVec3::new(room + 0.1, 0.5, -0.2);
        add_light(&mut scene, LightKind::Point, at, DVec3::NEG_Y, [1.0; 3]);
    }
    let block = block(&mut scene, wall, DVec3::new(0.5, -0.5, 0.25));
    (scene, block)
}

fn block(scene: &mut Scene, material: MaterialId, center: DVec3) -> NodeId {
    let mut faces = box_faces([0.25; 3], [material; 6]);
    faces.iter_mut().for_each(|face| face.indices.reverse());
    place(scene, faces, DAffine3::from_translation(center))
}

pub(super) fn move_to(scene: &mut Scene, node: NodeId, center: DVec3) {
    scene.set_local_transform(node, DAffine3::from_translation(center)).expect("sound");
}

fn into_first_room() -> CameraView {
    view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO)
}

/// A floor below a light, and a block in the open air; a sheet above it bounds the scene wherever the block goes.
fn open_air() -> (Scene, NodeId) {
    let mut scene = floor(2.0, lambert([0.7; 3]));
    let white = scene.add_material(lambert([0.8; 3])).expect("a sound material");
    let corners = [[1.9, 2.0, 1.9], [2.0, 2.0, 1.9], [2.0, 2.0, 2.0], [1.9, 2.0, 2.0]];
    place(&mut scene, vec![quad(corners, white)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 0.75, 0.0), DVec3::NEG_Y, [1.0; 3]);
    let block = block(&mut scene, white, DVec3::new(1.5, 1.5, 1.5));
    (scene, block)
}

/// A light sends its own photons again, a block those whose paths it crosses, and what moves in one room neither sends nor renews anything for the other.
#[test]
fn those_are_sent_again_whose_way_changed() {
    let session = Session::open();
    let (mut scene, block) = two_rooms();
    let camera = into_first_room();
    let all = LightmapsOptions { texels: 1_000_000, ..by_photons() };
    let mut renderer = session.renderer(&settings(all.clone()));
    let whole = frame(&mut renderer, &scene, &camera);
    scale_light(&mut scene, 1, 2.0);
    let lit = frame(&mut renderer, &scene, &camera);
    println!("sent {} of {}, renewed {} of {}", sent(&lit), sent(&whole), renewed(&lit), renewed(&whole));
    assert_eq!(2 * sent(&lit), sent(&whole), "the light's own");
    assert!(renewed(&lit) > 0 && 2 * renewed(&lit) <= renewed(&whole), "in its own room");
    until_still(&mut renderer, &scene, &camera);
    move_to(&mut scene, block, DVec3::new(0.25, -0.5, 0.25));
    let moved = frame(&mut renderer, &scene, &camera);
    println!("sent {}, renewed {}", sent(&moved), renewed(&moved));
    assert!(sent(&moved) > 0 && 2 * sent(&moved) < sent(&whole), "of the light in the block's room");
    let (_, still) = until_still(&mut renderer, &scene, &camera);
    let last = difference(&still, &session.render(&scene, &settings(all), &asked(&camera)));
    println!("{last:.4}");
    assert!(last < 0.01, "{last}");
    // What moved before stands now.
    scale_light(&mut scene, 1, 0.5);
    assert_eq!(2 * sent(&frame(&mut renderer, &scene, &camera)), sent(&whole), "the light's own");
}

/// Photons that left an open scene are sent again where something comes into their way.
#[test]
fn what_comes_into_the_open_air_is_lit() {
    let session = Session::open();
    let (mut scene, block) = open_air();
    let camera = view(DVec3::new(0.0, 2.5, 3.5), DVec3::new(0.0, 0.3, 0.0));
    let all = LightmapsOptions { texels: 1_000_000, links: 256, ..by_photons() };
    let mut renderer = session.renderer(&settings(all.clone()));
    let whole = sent(&frame(&mut renderer, &scene, &camera));
    move_to(&mut scene, block, DVec3::new(0.0, 1.5, 0.0));
    let moved = sent(&frame(&mut renderer, &scene, &camera));
    let (_, still) = until_still(&mut renderer, &scene, &camera);
    let last = difference(&still, &session.render(&scene, &settings(all), &asked(&camera)));
    println!("sent {moved} of {whole}, {last:.4}");
    assert!(moved > 0 && moved < whole, "sent {moved} of {whole}");
    assert!(last < 0.02, "{last}");
}

/// A mesh that is replaced is no motion, though its surfaces and texels are the same ones on the map.
#[test]
fn another_mesh_sends_photons_again() {
    let session = Session::open();
    let (mut scene, block) = two_rooms();
    let camera = into_first_room();
    let mut renderer = session.renderer(&settings(by_photons()));
    frame(&mut renderer, &scene, &camera);
    let id = scene.nodes()[block.0].mesh.expect("the block's");
    let mut mesh = scene.meshes()[id.0].clone();
    mesh.primitives.iter_mut().flat_map(|face| &mut face.positions).for_each(|corner| corner[0] -= 0.5);
    scene.set_mesh(id, mesh).expect("a sound mesh");
    let again = sent(&frame(&mut renderer, &scene, &camera));
    let (_, still) = until_still(&mut renderer, &scene, &camera);
    let last = difference(&still, &session.render(&scene, &settings(by_photons()), &asked(&camera)));
    println!("sent {again}, {last:.4}");
    assert!(again > 0, "none were sent");
    assert!(last < 0.01, "{last}");
}

/// What moved while another method made the pictures is no motion of the first frame after these: all are sent again.
#[test]
fn what_moved_in_other_frames_sends_photons_again() {
    let session = Session::open();
    let (mut scene, block) = two_rooms();
    let camera = into_first_room();
    let mut renderer = session.renderer(&settings(by_photons()));
    let whole = sent(&frame(&mut renderer, &scene, &camera));
    let mut other = settings(by_photons());
    other.methods.diffuse = DiffuseMethod::FinalGather;
    renderer.set_settings(other).expect("sound settings");
    move_to(&mut scene, block, DVec3::new(0.0, -0.5, 0.25));
    frame(&mut renderer, &scene, &camera);
    renderer.set_settings(settings(by_photons())).expect("sound settings");
    move_to(&mut scene, block, DVec3::new(0.0, -0.5, 0.3));
    assert_eq!(sent(&frame(&mut renderer, &scene, &camera)), whole);
    let (_, still) = until_still(&mut renderer, &scene, &camera);
    let last = difference(&still, &session.render(&scene, &settings(by_photons()), &asked(&camera)));
    println!("{last:.4}");
    assert!(last < 0.01, "{last}");
}

/// A plate parts a floor into a sunlit half and one under a roof. It moves on, and no photon is sent again, for all go along it; but the texels of one half see the other
/// one now, and photons there.
#[test]
fn texels_see_what_something_moved_away_from() {
    let session = Session::open();
    let mut scene = Scene::empty("half a roof");
    let both = Material { double_sided: true, ..lambert([0.7; 3]) };
    let white = scene.add_material(both).expect("a sound material");
    let flat = |low: f32, high: f32, y: f32| [[low, y, -1.0], [low, y, 1.0], [high, y, 1.0], [high, y, -1.0]];
    place(&mut scene, vec![quad(flat(-1.0, 1.0, 0.0), white)], DAffine3::IDENTITY);
    place(&mut scene, vec![quad(flat(-1.0, 0.01, 0.5), white)], DAffine3::IDENTITY);
    let upright = [[0.01, 0.0, -1.0], [0.01, 0.0, 1.0], [0.01, 0.45, 1.0], [0.01, 0.45, -1.0]];
    let plate = place(&mut scene, vec![quad(upright, white)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::NEG_Y, [3.0; 3]);
    let below_the_roof = view(DVec3::new(-0.5, 0.25, 0.95), DVec3::new(-0.5, 0.5, -0.3));
    let whole_floor = LightmapsOptions { bounces: Some(1), nearest: 10_000, ..by_photons() };
    let mut renderer = session.renderer(&settings(whole_floor.clone()));
    let before = frame(&mut renderer, &scene, &below_the_roof);
    move_to(&mut scene, plate, DVec3::new(-0.9, 0.0, 0.0));
    assert_eq!(sent(&frame(&mut renderer, &scene, &below_the_roof)), 0);
    let (_, still) = until_still(&mut renderer, &scene, &below_the_roof);
    let expected = session.render(&scene, &settings(whole_floor), &asked(&below_the_roof));
    let [change, last] = [&before, &still].map(|frame| difference(frame, &expected));
    println!("{last:.4}, before {change:.4}");
    assert!(change > 0.5 && last < 0.01, "{last}, before {change}");
}

/// Neither other settings nor a copy of the scene find what was made for others.
#[test]
fn maps_are_of_their_settings_and_scene() {
    let session = Session::open();
    let (scene, camera) = with_camera("cornell-point");
    let few = LightmapsOptions { count: 1000, rays: 64, photons: 20_000, ..by_photons() };
    let mut renderer = session.renderer(&settings(few.clone()));
    let (_, first) = until_still(&mut renderer, &scene, &camera);
    let mut copy = scene.clone();
    scale_light(&mut copy, 0, 0.25);
    until_still(&mut renderer, &copy, &camera);
    let again = frame(&mut renderer, &scene, &camera);
    assert!(difference(&again, &first) < 0.01, "{}", difference(&again, &first));
    until_still(&mut renderer, &scene, &camera);
    for other in [LightmapsOptions { photons: 40_000, ..few.clone() }, LightmapsOptions { nearest: 10, ..few }] {
        renderer.set_settings(settings(other)).expect("sound settings");
        assert!(sent(&frame(&mut renderer, &scene, &camera)) > 0);
        until_still(&mut renderer, &scene, &camera);
    }
}

/// Probes stumble on what moved, in as many frames as a group has photons at most.
#[test]
fn probes_find_what_moved() {
    let session = Session::open();
    let (mut scene, block) = two_rooms();
    let camera = into_first_room();
    let probing = LightmapsOptions { invalidate: LightmapsInvalidate::Probes, ..by_photons() };
    let mut renderer = session.renderer(&settings(probing.clone()));
    let whole = sent(&frame(&mut renderer, &scene, &camera));
    move_to(&mut scene, block, DVec3::new(0.0, -0.5, 0.25));
    let again: Vec<u64> = (0..8).map(|_| sent(&frame(&mut renderer, &scene, &camera))).collect();
    println!("{again:?} of {whole}");
    assert!(again[0] > 0 && again.iter().sum::<u64>() < whole, "{again:?} of {whole}");
    let (_, still) = until_still(&mut renderer, &scene, &camera);
    let last = difference(&still, &session.render(&scene, &settings(probing), &asked(&camera)));
    println!("{last:.4}");
    assert!(last < 0.02, "{last}");
}

/// Probes go on from frame to frame also while something changes in each: what moved once is found though something else, which no photon meets, never rests.
#[test]
fn probes_go_on_while_something_moves() {
    let session = Session::open();
    let (mut scene, block) = two_rooms();
    let white = scene.add_material(lambert([0.5; 3])).expect("a sound material");
    let corners = [[-0.1, 0.0, -0.1], [0.1, 0.0, -0.1], [0.1, 0.0, 0.1], [-0.1, 0.0, 0.1]];
    let between = |step: u8| DVec3::new(1.5, 0.05 * f64::from(step), 0.0);
    let restless = place(&mut scene, vec![quad(corners, white)], DAffine3::from_translation(between(0)));
    let camera = into_first_room();
    let probing = LightmapsOptions { invalidate: LightmapsInvalidate::Probes, count: 1000, rays: 16, ..by_photons() };
    let mut renderer = session.renderer(&settings(probing));
    let whole = sent(&frame(&mut renderer, &scene, &camera));
    move_to(&mut scene, block, DVec3::new(0.0, -0.5, 0.25));
    let again: Vec<u64> = (1..9)
        .map(|step| {
            move_to(&mut scene, restless, between(step));
            sent(&frame(&mut renderer, &scene, &camera))
        })
        .collect();
    println!("{again:?} of {whole}");
    assert!(again[1..].iter().sum::<u64>() > 0, "{again:?} of {whole}");
}
