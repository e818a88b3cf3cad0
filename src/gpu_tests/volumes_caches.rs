//! The light caches of `volumes`: no pixel lacks one, what they hold is the sum over the lights, in whatever units the scene is.

use std::f64::consts::FRAC_1_PI;

use glam::{DAffine3, DVec3};

use super::invariance::{difference, transformed};
use super::probe::{Pixel, Vpl, diffuse_and_its, probe};
use super::scenes::{add_light, builtin, lambert, place, quad, request, settings_of, view};
use super::session::Session;
use crate::renderer::{FrameRequest, Slot, Technique, Timing};
use crate::scene::{CameraView, LightId, LightKind, Scene};

/// A floor, and a wall beside it of which a narrow spot lights a patch.
fn lit_patch() -> (Scene, CameraView) {
    let mut scene = Scene::empty("patch");
    let white = scene.add_material(lambert([0.8, 0.6, 0.4])).expect("a sound material");
    let floor = [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]];
    let wall = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 2.0, -1.0], [-1.0, 2.0, -1.0]];
    place(&mut scene, vec![quad(floor, white), quad(wall, white)], DAffine3::IDENTITY);
    let kind = LightKind::Spot { inner_angle: 0.05, outer_angle: 0.1 };
    add_light(&mut scene, kind, DVec3::new(0.3, 1.3, 1.5), DVec3::new(0.0, 0.0, -1.0), [30.0, 20.0, 10.0]);
    (scene, view(DVec3::new(0.0, 1.0, 2.0), DVec3::new(0.0, 0.3, 0.0)))
}

/// Σ Φ/π · (n·−ω)⁺ / (d² + a) · K(n_x·ω), W/m², K the clamped cosine's bands 0 to 1 or 2.
fn irradiance(lights: &[Vpl], pixel: &Pixel, bands: u32) -> DVec3 {
    let of_light = |light: &Vpl| {
        let difference = light.texels[0].truncate().as_dvec3() - pixel.position_rs;
        let squared = difference.length_squared();
        let (toward, cosines) = (difference / squared.sqrt(), light.cosines_and_square(pixel).0);
        let cosine = pixel.normal.dot(toward);
        let emitted = cosines / cosine.max(1e-9);
        let last = if bands == 3 { 5.0 / 32.0 * (3.0 * cosine * cosine - 1.0) } else { 0.0 };
        let kernel = 0.25 + 0.5 * cosine + last;
        light.flux * (FRAC_1_PI * emitted * kernel / (squared + f64::from(light.texels[0].w)))
    };
    lights.iter().map(of_light).sum()
}

/// Caches hold light as harmonics of few bands: a light seen at a cosine c counts by the bands of the clamped cosine, 1/4 + c/2 + 5/32 (3c² − 1) (Ramamoorthi & Hanrahan
/// 2001). Between caches a pixel's light is interpolated, over cells that are small beside the distance.
#[test]
fn pixels_get_the_bands_of_the_clamped_cosine() {
    let session = Session::open();
    let (scene, camera) = lit_patch();
    for (bands, placement) in [(2_u32, "grid"), (3, "grid"), (3, "visible")] {
        let changes = [
            ("volumes.bands", &*bands.to_string()),
            ("volumes.placement", placement),
            ("volumes.visibility", "none"),
            ("volumes.cell", "0.05"),
            ("volumes.resolution", "64"),
        ];
        let settings = settings_of(Technique::Volumes, &changes);
        let asked = request([24, 18], camera.clone(), &[]);
        let frame = probe(&session, &scene, &settings, &asked, |graph, declared| {
            let lights = declared.volumes.as_ref().expect("volumes runs").lights.as_deref().expect("light views");
            let reads = [graph.read_back_buffer(lights.lights), graph.read_back_buffer(lights.counts)];
            let mut all = diffuse_and_its(reads[0], graph, declared);
            all.push(reads[1]);
            all
        });
        let count = frame.floats(4)[0].to_bits() as usize;
        let lights: Vec<Vpl> = frame.vpls(3).into_iter().take(count).collect();
        assert!(count > 4, "{count} lights");
        let (mut pixels, mut worst) = (0, 0.0_f64);
        for (pixel, found) in frame.pixels([0, 1], asked.size).iter().zip(frame.colors(2)) {
            // The wall itself gets nothing from its own plane but by the bands that are left out.
            let Some(pixel) = pixel.as_ref().filter(|pixel| pixel.normal.y > 0.9) else { continue };
            let expected = pixel.albedo * FRAC_1_PI * irradiance(&lights, pixel, bands);
            worst = worst.max(((found - expected) / expected).abs().max_element());
            pixels += 1;
        }
        println!("{bands} bands, {placement}: {pixels} pixels, error {worst:.3}");
        assert!(pixels > 100 && worst < if placement == "grid" { 0.02 } else { 0.1 }, "{bands} bands: {worst}");
    }
}

/// The caches of a frame, and how many pixels' caches are missing.
fn counted(session: &Session, scene: &Scene, asked: &FrameRequest, changes: &[(&str, &str)]) -> [u64; 2] {
    let settings = settings_of(Technique::Volumes, changes);
    let asked = FrameRequest { timing: Timing::Passes, ..asked.clone() };
    let frame = session.render(scene, &settings, &asked);
    let count = |pass: &str, name: &str| {
        let row = frame.timings.passes.iter().find(|row| row.full_name() == pass).expect("a pass of this name");
        row.work[name]
    };
    [count("caches/places/allocate", "caches"), count("diffuse/volumes/apply", "missing")]
}

/// Sizes that no group of pixels divides, many cascades in one picture, surfaces that touch planes of the grid.
#[test]
fn no_pixel_lacks_a_cache() {
    let session = Session::open();
    let few = [("volumes.visibility", "none"), ("volumes.lights", "16"), ("lights.resolution", "64")];
    for (name, size) in
        [("cornell-point", [131, 97]), ("corridor", [64, 64]), ("lights", [200, 50]), ("ring", [77, 131])]
    {
        let scene = builtin(name);
        let asked = request(size, scene.camera_view(None).expect("its camera"), &[Slot::Diffuse]);
        for (resolution, cascades) in [("16", "8"), ("32", "4"), ("64", "1")] {
            let mut changes = few.to_vec();
            changes.extend([("volumes.resolution", resolution), ("volumes.cascades", cascades)]);
            let [caches, missing] = counted(&session, &scene, &asked, &changes);
            println!("{name}, {cascades} cascades of {resolution}³: {caches} caches, {missing} missing");
            assert!(caches > 20 && missing == 0, "{name}, {cascades} of {resolution}³: {missing} of {caches} missing");
        }
    }
}

/// More caches than there is room for at first.
#[test]
fn room_for_caches_grows() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let asked = request([320, 240], scene.camera_view(None).expect("its camera"), &[Slot::Diffuse]);
    let fine = [
        ("volumes.resolution", "128"),
        ("volumes.cascades", "5"),
        ("volumes.cell", "0.01"),
        ("volumes.visibility", "none"),
        ("volumes.lights", "16"),
    ];
    let [caches, missing] = counted(&session, &scene, &asked, &fine);
    assert!(caches > 8192 && missing == 0, "{caches} caches, {missing} missing");
}

fn image(session: &Session, scene: &Scene, bounces: &str) -> crate::renderer::ColorImage {
    let asked = request([60, 45], scene.camera_view(None).expect("its camera"), &[Slot::Diffuse]);
    session.render(scene, &settings_of(Technique::Volumes, &[("volumes.bounces", bounces)]), &asked).slots
        [&Slot::Diffuse]
        .clone()
}

/// The picture depends on no unit of length, as `invariance.rs` has it for other techniques.
#[test]
fn scenes_of_any_scale_give_the_same_light() {
    let session = Session::open();
    for (name, bounces) in [("cornell-spot", "1"), ("lights", "1"), ("cornell-spot", "3")] {
        let scene = builtin(name);
        let original = image(&session, &scene, bounces);
        for scale in [1e-3, 1e3] {
            let copy = image(&session, &transformed(&scene, DAffine3::from_scale(DVec3::splat(scale)), scale), bounces);
            let found = difference(&original, &copy);
            println!(
                "{name}, {bounces} bounces, scaled by {scale}: rmse {:.1e}, at most {:.1e}",
                found.rmse, found.most
            );
            assert!(found.rmse < 2e-3, "{name} scaled by {scale}: {:.1e}", found.rmse);
        }
    }
}

/// Nor on the light's: half floats of the original lose all of it at 1 W/sr.
#[test]
fn lights_of_any_strength_give_the_same_picture() {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let original = image(&session, &scene, "3");
    let light = scene.lights()[0].clone();
    for factor in [1e-6_f32, 1e4] {
        let intensity = light.intensity.map(|channel| factor * channel);
        scene.set_light(LightId(0), crate::scene::Light { intensity, ..light.clone() }).expect("a sound light");
        let copy = image(&session, &scene, "3");
        for (before, after) in original.pixels.iter().flatten().zip(copy.pixels.iter().flatten()) {
            let expected = f64::from(*before) * f64::from(factor);
            assert!(
                (f64::from(*after) - expected).abs() <= 1e-5 * expected + 1e-12 * f64::from(factor),
                "{before} {after}"
            );
        }
    }
}
