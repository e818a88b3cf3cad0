//! Ambient occlusion against closed forms.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use super::options::AmbientOptions;
use crate::gpu_tests::scenes::{closed_box, floor, lambert, place, quad, request, view};
use crate::gpu_tests::session::Session;
use crate::renderer::{DiffuseMethod, Preset, Settings, Slot, Technique};
use crate::scene::{Material, Scene};

fn settings(change: impl FnOnce(&mut AmbientOptions)) -> Settings {
    let mut settings = Settings::new(Technique::Direct, Preset::Default);
    settings.methods.diffuse = DiffuseMethod::Ambient;
    change(&mut settings.ambient);
    settings
}

/// The slot at the middle of a view straight down onto the floor's centre from a height of 0.3.
fn at_centre(session: &Session, scene: &Scene, settings: &Settings) -> [f32; 3] {
    let camera = view(DVec3::new(0.0, 0.3, 1e-3), DVec3::ZERO);
    let frame = session.render(scene, settings, &request([9, 9], camera, &[Slot::Diffuse]));
    frame.slots[&Slot::Diffuse].pixels[40]
}

fn assert_close(what: &str, found: [f32; 3], expected: [f64; 3], within: f64) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((f64::from(*found) - expected).abs() <= within, "{what}: {found} for {expected}");
    }
}

const ALBEDO: [f32; 3] = [0.6, 0.3, 0.9];

#[test]
fn an_open_floor_shows_its_albedo_times_the_sky() {
    let session = Session::open();
    let mut scene = floor(2.0, lambert(ALBEDO));
    let all = settings(|_| ());
    let albedo = ALBEDO.map(f64::from);
    assert_close("under a black sky", at_centre(&session, &scene, &all), albedo, 2e-3);
    scene.set_sky([2.0, 4.0, 0.5]);
    let expected = [2.0 * albedo[0], 4.0 * albedo[1], 0.5 * albedo[2]];
    assert_close("under its own", at_centre(&session, &scene, &all), expected, 1e-2);
}

/// The view factor from a point to a square of side 2h above it at height 1: 4·(2/2π)·h/√(1+h²)·atan(h/√(1+h²)) (Howell, B-3).
#[test]
fn a_square_overhead_hides_its_view_factor() {
    let session = Session::open();
    let half = 1.5_f64;
    let root = (1.0 + half * half).sqrt();
    let hidden = 4.0 / PI * (half / root) * (half / root).atan();
    let mut scene = floor(8.0, lambert(ALBEDO));
    let lid = scene.add_material(Material { double_sided: true, ..lambert([0.5; 3]) }).expect("a sound material");
    let h = half as f32;
    let corners = [[-h, 1.0, -h], [h, 1.0, -h], [h, 1.0, h], [-h, 1.0, h]];
    place(&mut scene, vec![quad(corners, lid)], DAffine3::IDENTITY);
    let rays = settings(|ambient| (ambient.rays, ambient.distance) = (4096, 100.0));
    let expected = ALBEDO.map(|albedo| f64::from(albedo) * (1.0 - hidden));
    assert_close("under a lid", at_centre(&session, &scene, &rays), expected, 4e-3);
    let near = settings(|ambient| ambient.distance = 0.9);
    assert_close("a lid out of reach", at_centre(&session, &scene, &near), ALBEDO.map(f64::from), 2e-3);
}

#[test]
fn a_closed_box_is_dark_and_a_scene_without_need_pays_nothing() {
    let session = Session::open();
    let scene = closed_box(1.0, lambert(ALBEDO));
    let frame = |scene: &Scene, settings: &Settings| {
        session.render(
            scene,
            settings,
            &request([16, 12], view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO), &[Slot::Diffuse]),
        )
    };
    let dark = frame(&scene, &settings(|ambient| ambient.distance = 100.0));
    assert!(dark.slots[&Slot::Diffuse].pixels.iter().all(|pixel| *pixel == [0.0; 3]));
    let near = frame(&scene, &settings(|_| ()));
    assert!(near.slots[&Slot::Diffuse].pixels.iter().all(|pixel| pixel[0] > 0.1), "by default it is lit");
    let reason = |scene: &Scene, settings: &Settings| {
        let frame = frame(scene, settings);
        let row = frame
            .timings
            .passes
            .into_iter()
            .find(|pass| format!("{}/{}", pass.piece, pass.pass).starts_with("diffuse/ambient"));
        row.and_then(|row| row.skipped).expect("a reason")
    };
    assert_eq!(reason(&scene, &settings(|ambient| ambient.rays = 0)), "no rays asked for");
    let metal = closed_box(1.0, Material { metallic: 1.0, ..lambert(ALBEDO) });
    assert_eq!(reason(&metal, &settings(|_| ())), "no diffuse surface");
}
