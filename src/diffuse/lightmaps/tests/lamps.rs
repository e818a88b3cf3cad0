//! Lights that have maps of their own.

use glam::{DAffine3, DVec3};

use super::super::options::{LightmapsOptions, LightmapsSettle, LightmapsSource};
use super::frames::{asked, difference, frame, pixels, ran, renewed, until_still};
use super::{lamp_and_mirror, options, settings};
use crate::gpu_tests::scenes::{add_light, lamp_box, open_room, with_camera};
use crate::gpu_tests::session::Session;
use crate::renderer::Frame;
use crate::scene::{CameraView, LightId, LightKind, NodeId, Scene};

fn owning(per_light: u32) -> LightmapsOptions {
    LightmapsOptions { per_light, count: 1000, rays: 64, ..options() }
}

/// The Cornell box with a second light, and a third one.
fn three_lights() -> (Scene, CameraView) {
    let (mut scene, camera) = with_camera("cornell-point");
    add_light(&mut scene, LightKind::Point, DVec3::new(0.6, 1.7, 0.5), DVec3::NEG_Y, [0.5, 0.2, 0.1]);
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.1, -0.2, -1.0), [0.1, 0.2, 0.4]);
    (scene, camera)
}

fn set_intensity(scene: &mut Scene, light: usize, intensity: [f32; 3]) {
    let mut changed = scene.lights()[light].clone();
    changed.intensity = intensity;
    scene.set_light(LightId(light), changed).expect("a sound light");
}

/// The farthest that a pixel is off, over its own value.
fn farthest(found: &Frame, expected: &Frame) -> f64 {
    let pairs = pixels(found).as_flattened().iter().zip(pixels(expected).as_flattened());
    pairs.map(|(a, b)| f64::from((a - b).abs()) / f64::from(b.max(1e-6))).fold(0.0, f64::max)
}

/// Lights that are dimmed, tinted, put out and lit again: pixels are shaded anew, nothing else, and at once they show what a fresh renderer makes.
#[test]
fn a_dimmed_light_renews_nothing() {
    let session = Session::open();
    for rounds in [1, 2] {
        let options = LightmapsOptions { rounds, ..owning(3) };
        let (mut scene, camera) = three_lights();
        let mut renderer = session.renderer(&settings(options.clone()));
        until_still(&mut renderer, &scene, &camera);
        let colors =
            [[[0.3, 0.1, 0.0], [1.0, 2.0, 3.0], [0.1; 3]], [[0.0; 3], [0.5, 0.2, 0.1], [0.0; 3]], [[1.0; 3]; 3]];
        for intensities in colors {
            (0..3).for_each(|light| set_intensity(&mut scene, light, intensities[light]));
            let changed = frame(&mut renderer, &scene, &camera);
            assert_eq!(ran(&changed), ["diffuse/lightmaps/shade/combine.gathered", "diffuse/lightmaps/shade/pixels"]);
            let (_, fresh) = until_still(&mut session.renderer(&settings(options.clone())), &scene, &camera);
            let off = farthest(&changed, &fresh);
            println!("{intensities:?}: {off:.1e}");
            assert!(off < 1e-5, "{intensities:?}: {off}");
        }
    }
}

/// Dimming while rounds join begins none of them anew.
#[test]
fn a_dimmed_light_keeps_rounds() {
    let session = Session::open();
    let (mut scene, camera) = three_lights();
    let mut renderer = session.renderer(&settings(LightmapsOptions { rounds: 4, texels: 300, ..owning(3) }));
    let used = renewed(&frame(&mut renderer, &scene, &camera));
    let mut gathered = used;
    for number in 0..60_u8 {
        set_intensity(&mut scene, 0, [f32::from(number % 7); 3]);
        gathered += renewed(&frame(&mut renderer, &scene, &camera));
    }
    assert_eq!(gathered, 4 * used);
}

/// The same light whether lights have maps of their own or not, of every kind, by rays and by photons.
#[test]
fn maps_of_their_own_hold_the_same_light() {
    let session = Session::open();
    let with_light = |(mut scene, camera): (Scene, CameraView)| {
        add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.4, -0.2), DVec3::NEG_Y, [0.5, 0.2, 0.1]);
        (scene, camera)
    };
    let cases = [
        ("three lights", three_lights(), 3),
        ("three lights", three_lights(), 2),
        ("lamp", with_light(lamp_box()), 1),
        ("sky", with_light(open_room()), 1),
        ("lamp and mirror", with_light(lamp_and_mirror()), 1),
        ("ring", with_camera("ring"), 15),
    ];
    for source in [LightmapsSource::Rays, LightmapsSource::Photons] {
        for (name, (scene, camera), own) in &cases {
            for settle in [LightmapsSettle::First, LightmapsSettle::Always] {
                let [shared, own] = [0, *own].map(|per_light| {
                    let options = LightmapsOptions { source, settle, photons: 4000, ..owning(per_light) };
                    session.render(scene, &settings(options), &asked(camera))
                });
                let off = difference(&own, &shared);
                println!("{name}, {source:?}, {settle:?}: {off:.1e}");
                // Photons are ended by their colour.
                let within = if source == LightmapsSource::Rays { 5e-3 } else { 0.1 };
                assert!(off < within, "{name}, {source:?}, {settle:?}: {off}");
            }
        }
    }
}

/// A light with a map of its own that moves, and one that has none and is dimmed, renew texels, and in the end all is as a fresh renderer makes it.
#[test]
fn other_changes_renew_texels() {
    let session = Session::open();
    let (mut scene, camera) = three_lights();
    let options = owning(1);
    let mut renderer = session.renderer(&settings(options.clone()));
    until_still(&mut renderer, &scene, &camera);
    set_intensity(&mut scene, 0, [0.3; 3]);
    assert_eq!(renewed(&frame(&mut renderer, &scene, &camera)), 0);
    for moves in [false, true] {
        if moves {
            let node = scene.placed_lights()[0].node;
            let moved = DAffine3::from_translation(DVec3::new(0.3, 0.6, 0.2));
            scene.set_local_transform(NodeId(node.0), moved).expect("sound");
        } else {
            set_intensity(&mut scene, 1, [5.0, 2.0, 1.0]);
        }
        assert!(renewed(&frame(&mut renderer, &scene, &camera)) > 0, "moves: {moves}");
        let (_, still) = until_still(&mut renderer, &scene, &camera);
        let last = difference(&still, &session.render(&scene, &settings(options.clone()), &asked(&camera)));
        println!("moves: {moves}, {last:.4}");
        assert!(last < 0.01, "moves: {moves}, {last}");
    }
}
