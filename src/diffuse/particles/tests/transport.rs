//! Light that particles scatter, and light that they gather: the same at equal bounces, mirrors and coats between them or not.

use glam::{DAffine3, DVec3};

use super::super::options::{ParticleTransport, ParticlesOptions};
use super::{options, settings, stages};
use crate::gpu_tests::scenes::{add_light, box_faces, closed_box, lambert, place, request, view};
use crate::gpu_tests::session::Session;
use crate::renderer::{Preset, Settings, Slot, Technique};
use crate::scene::{LightKind, Material, Scene};

fn with_lamp(mut scene: Scene) -> Scene {
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.2, -0.4), DVec3::NEG_Y, [1.0; 3]);
    scene
}

/// Two of the walls are mirrors of a colour, all others grey.
fn room_with_coloured_mirrors() -> Scene {
    let mut scene = Scene::empty("coloured mirrors");
    let grey = scene.add_material(lambert([0.6; 3])).expect("a sound material");
    let mirror = Material { metallic: 1.0, roughness: 0.1, ..lambert([0.9, 0.3, 0.1]) };
    let mirror = scene.add_material(mirror).expect("a sound material");
    place(&mut scene, box_faces([1.0; 3], [mirror, grey, grey, grey, mirror, grey]), DAffine3::IDENTITY);
    with_lamp(scene)
}

fn mean(session: &Session, scene: &Scene, settings: &Settings) -> [f64; 3] {
    let camera = view(DVec3::new(0.1, -0.1, 0.9), DVec3::new(0.0, -0.3, -1.0));
    let frame = session.render(scene, settings, &request([64, 48], camera, &[Slot::Diffuse]));
    let pixels = &frame.slots[&Slot::Diffuse].pixels;
    [0, 1, 2].map(|channel| pixels.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>() / pixels.len() as f64)
}

#[test]
fn scattering_and_gathering_bring_the_same_light() {
    let session = Session::open();
    let coated = Material { specular: 1.0, ior: 2.0, roughness: 0.4, ..lambert([0.6; 3]) };
    let scenes = [
        ("closed box", with_lamp(closed_box(1.0, lambert([0.7, 0.5, 0.3])))),
        ("coloured mirrors", room_with_coloured_mirrors()),
        ("coats", with_lamp(closed_box(1.0, coated))),
    ];
    for (name, scene) in &scenes {
        for bounces in [0, 1, 4] {
            let options = ParticlesOptions { gather: 16, ..options(8000, bounces) };
            let gathered = ParticlesOptions { transport: ParticleTransport::GatherOnly, ..options.clone() };
            let [scattered, gathered] = [options, gathered].map(|options| mean(&session, scene, &settings(options)));
            let ratio = [0, 1, 2].map(|channel| gathered[channel] / scattered[channel]);
            println!("{name}, {bounces} steps: {scattered:.4?}, {ratio:.4?}");
            let within = |ratio: f64, most: f64| (ratio - 1.0).abs() < most;
            assert!(within(ratio.iter().sum::<f64>() / 3.0, 0.01), "{name}, {bounces} steps: {ratio:?}");
            assert!(ratio.iter().all(|&ratio| within(ratio, 0.015)), "{name}, {bounces} steps: {ratio:?}");
        }
    }
}

/// A particle gets few links of others, but what it sends out is hardly noisier than if it had gathered through all of its own.
#[test]
fn no_particle_stands_out_for_the_few_links_that_end_on_it() {
    let session = Session::open();
    let scene = with_lamp(closed_box(1.0, lambert([0.7; 3])));
    let options = ParticlesOptions { gather: 16, ..options(8000, 4) };
    let gathered = ParticlesOptions { transport: ParticleTransport::GatherOnly, ..options.clone() };
    let [scattered, gathered] = [options, gathered].map(|options| stages(&session, &scene, &options).radiance);
    let pairs = || scattered.iter().zip(&gathered).map(|(a, b)| (f64::from(a[1]), f64::from(b[1])));
    let mean = pairs().map(|(_, b)| b).sum::<f64>() / gathered.len() as f64;
    let error = (pairs().map(|(a, b)| (a - b).powi(2)).sum::<f64>() / gathered.len() as f64).sqrt() / mean;
    println!("radiances differ by {error:.4}");
    assert!(error < 0.15, "{error}");
}

/// What a mirror of a colour sends on between particles has its colour.
#[test]
fn coloured_mirrors_colour_the_light() {
    let session = Session::open();
    let scene = room_with_coloured_mirrors();
    let options = ParticlesOptions { bounces: None, gather: 16, ..options(8000, 0) };
    let found = mean(&session, &scene, &settings(options));
    let mut path = Settings::new(Technique::Path, Preset::Default);
    path.path.spp = 256;
    let expected = mean(&session, &scene, &path);
    let ratio = [0, 1, 2].map(|channel| found[channel] / expected[channel]);
    println!("{found:.4?} of {expected:.4?}: {ratio:.4?}");
    assert!(ratio.iter().all(|ratio| (ratio - 1.0).abs() < 0.03), "{ratio:?}");
}
