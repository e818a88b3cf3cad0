//! Gathering by hemicubes beside rays, paths and closed forms.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use super::super::options::{LightmapsGather, LightmapsOptions, LightmapsShow};
use super::frames::{asked, difference, frame, renewed, scale_light, until_still};
use super::{lamp_and_mirror, leak_of_a_parted_room, options, settings};
use crate::gpu_tests::against_paths::{against_paths, leaks};
use crate::gpu_tests::scenes::{
    add_light, box_faces, closed_box, floor, lambert, lamp_box, lattice, open_room, place, quad, request, view,
    with_camera,
};
use crate::gpu_tests::session::Session;
use crate::renderer::{Frame, Slot};
use crate::scene::{LightKind, Scene};

fn by_hemicube() -> LightmapsOptions {
    LightmapsOptions { gather: LightmapsGather::Hemicube, ..options() }
}

fn gathered_alone(options: LightmapsOptions) -> LightmapsOptions {
    LightmapsOptions { show: LightmapsShow::Gathered, ..options }
}

fn mean(frame: &Frame) -> f64 {
    let pixels = frame.slots[&Slot::Diffuse].pixels.as_flattened();
    pixels.iter().map(|&value| f64::from(value)).sum::<f64>() / pixels.len() as f64
}

/// In a furnace of albedo ½ that emits 1 everywhere, what texels gather is what was scattered: E/π = 1, whatever the plane shows of it, in one batch or in several.
#[test]
fn even_light_is_even() {
    let session = Session::open();
    let (scene, camera) = with_camera("furnace");
    for (plane, fragments) in [(1.0, 8), (2.0, 8), (2.0, 16), (3.5, 31), (2.0, 32)] {
        let options = gathered_alone(LightmapsOptions { plane, fragments, ..by_hemicube() });
        let frame = session.render(&scene, &settings(options), &asked(&camera));
        let batches =
            frame.timings.passes.iter().filter(|row| row.full_name().starts_with("diffuse/lightmaps/iim/draw"));
        println!("plane {plane}, {fragments}² fragments, {} batches: {:.4}", batches.count(), mean(&frame));
        for &value in frame.slots[&Slot::Diffuse].pixels.as_flattened() {
            assert!((value - 1.0).abs() < 0.02, "plane {plane}, {fragments}² fragments: {value}");
        }
    }
}

/// A patch below a square that alone is lit, from |x|, |y| = ½ on at a distance of 1 nothing: its share of the hemisphere over that of the plane.
#[test]
fn fragments_count_by_their_weights() {
    let session = Session::open();
    let mut scene = floor(0.02, lambert([0.5; 3]));
    let white = scene.add_material(lambert([0.7; 3])).expect("a sound material");
    let corners = [[-0.5, 1.0, -0.5], [0.5, 1.0, -0.5], [0.5, 1.0, 0.5], [-0.5, 1.0, 0.5]];
    place(&mut scene, vec![quad(corners, white)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::Y, [3.0; 3]);
    let camera = view(DVec3::new(0.0, 0.025, 0.0), DVec3::ZERO);
    let share = |half: f64| {
        let t = half / f64::hypot(1.0, half);
        4.0 / PI * t * t.atan()
    };
    for (plane, fragments) in [(1.0, 32), (2.0, 32), (2.0, 64)] {
        let options = gathered_alone(LightmapsOptions { plane, fragments, texel: 0.05, ..by_hemicube() });
        let frame = session.render(&scene, &settings(options), &request([8, 8], camera.clone(), &[Slot::Diffuse]));
        let found = mean(&frame) / (0.7 * 3.0 / PI * share(0.5) / share(plane));
        println!("plane {plane}, {fragments}²: {found:.4}");
        assert!((found - 1.0).abs() < 0.02, "plane {plane}, {fragments}²: {found}");
    }
}

/// Every kind of light: what emits, and what mirrors show, is not gathered a second time.
#[test]
fn pictures_are_those_of_paths() {
    let session = Session::open();
    let cases = [
        ("cornell-point", with_camera("cornell-point")),
        ("lamp", lamp_box()),
        ("sky", open_room()),
        ("ring", with_camera("ring")),
        ("lamp and mirror", lamp_and_mirror()),
    ];
    for (name, (scene, camera)) in cases {
        let (ratio, error) = against_paths(&session, &scene, camera, &settings(by_hemicube()), (128, None));
        println!("{name}: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.05 && error < 0.08, "{name}: {ratio} {error}");
    }
}

#[test]
fn light_stays_out_of_dark_rooms() {
    let session = Session::open();
    let found = leaks(&session, &settings(by_hemicube()), [32, 24]);
    println!("{found:?} of the lit hall's light");
    assert!(found.iter().all(|&share| share < 1e-3), "{found:?} of the lit hall's light");
    let found = leak_of_a_parted_room(&session, &settings(by_hemicube()));
    println!("{found:.1e} of the lit half's light");
    assert!(found < 1e-3, "{found}");
}

/// Half of the light of one half of a box comes through a wall with holes into the other: as rays find it.
#[test]
fn what_alpha_cuts_out_lets_light_through() {
    let session = Session::open();
    let mut scene = closed_box(1.0, lambert([0.7; 3]));
    let wall = lattice(&mut scene, [[0.0, -1.0, 1.0], [0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0]]);
    place(&mut scene, vec![wall], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(0.9, 0.3, -0.2), DVec3::NEG_Y, [1.0; 3]);
    let camera = view(DVec3::new(-0.1, 0.5, 0.9), DVec3::new(-0.6, -0.6, -0.3));
    let shown = |options| session.render(&scene, &settings(gathered_alone(options)), &asked(&camera));
    let [found, expected] = [by_hemicube(), options()].map(shown);
    println!("{:.4} {:.4}", mean(&found), mean(&expected));
    assert!(mean(&expected) > 0.05 && (mean(&found) / mean(&expected) - 1.0).abs() < 0.04);
}

/// Frame by frame, a part of the texels in each, and from renderer to renderer.
#[test]
fn repeats_are_the_same_bits() {
    let session = Session::open();
    let sequence = || {
        let (mut scene, camera) = with_camera("ring");
        let few = LightmapsOptions { count: 1000, texels: 100, ..by_hemicube() };
        let mut renderer = session.renderer(&settings(few));
        let first = frame(&mut renderer, &scene, &camera);
        scale_light(&mut scene, 0, 0.25);
        let mut all: Vec<Frame> = (0..3).map(|_| frame(&mut renderer, &scene, &camera)).collect();
        assert!(renewed(&first) > 900 && all.iter().all(|frame| (1..=100).contains(&renewed(frame))));
        let (frames, last) = until_still(&mut renderer, &scene, &camera);
        assert!((5..100).contains(&frames), "{frames}");
        let ratio = mean(&last) / mean(&first);
        assert!((ratio - 0.25).abs() < 0.003, "{ratio}");
        all.extend([first, last]);
        all
    };
    let [first, again] = [sequence(), sequence()];
    assert!(first.iter().zip(&again).all(|(a, b)| a.slots == b.slots));
}

/// A hall so many times as wide as it is high, with a lamp in its middle: what it shows over what rays find, and how far the pictures are apart.
fn hall(width: f64, session: &Session, options: &LightmapsOptions) -> [f64; 2] {
    let mut scene = Scene::empty("hall");
    let wall = scene.add_material(lambert([0.6; 3])).expect("a sound material");
    let half = width as f32;
    place(&mut scene, box_faces([half, 1.0, half], [wall; 6]), DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 0.5, 0.0), DVec3::NEG_Y, [10.0; 3]);
    let camera = view(DVec3::new(0.0, 0.6, 0.9 * width), DVec3::new(0.0, -0.5, 0.0));
    let shown = |options: &LightmapsOptions| {
        session.render(&scene, &settings(gathered_alone(options.clone())), &asked(&camera))
    };
    let rays = LightmapsOptions { gather: LightmapsGather::Rays, rays: 1024, ..options.clone() };
    let [found, expected] = [options, &rays].map(shown);
    [mean(&found) / mean(&expected), difference(&found, &expected)]
}

/// The sides of the hemicube that are not drawn count as if they were like the front: the wider the hall, and the smaller the plane, the more that is off.
#[test]
#[ignore = "prints a table"]
fn what_the_missing_sides_do_in_wide_halls() {
    let session = Session::open();
    for width in [1.0, 2.0, 4.0, 8.0] {
        for (plane, fragments) in [(1.0, 16), (2.0, 16), (2.0, 32), (4.0, 32), (8.0, 64)] {
            let [ratio, apart] = hall(width, &session, &LightmapsOptions { plane, fragments, ..by_hemicube() });
            println!("{width} times as wide, plane {plane}, {fragments}²: {ratio:.3}, {apart:.3}");
        }
    }
}
