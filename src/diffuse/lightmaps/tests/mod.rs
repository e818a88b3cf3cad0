//! Light maps against closed forms and paths, and what stands when something changes.

mod frames;
mod hemicube;
mod lamps;
mod photons;
mod rounds;

use glam::{DAffine3, DVec3};

use self::frames::asked;
use super::Lightmaps;
use super::options::{LightmapsOptions, LightmapsSettle, LightmapsShow};
use crate::gpu_tests::against_paths::{against_paths, leaks};
use crate::gpu_tests::scenes::{
    add_light, box_faces, closed_box, lambert, lamp_box, open_room, place, quad, request, sunlit_corner, view,
    with_camera,
};
use crate::gpu_tests::session::Session;
use crate::method::{Method, Options, Preset};
use crate::renderer::{DiffuseMethod, Settings, Slot, Technique};
use crate::scene::{CameraView, LightKind, Material, NodeId, Scene};

/// Few and coarse texels; nothing joins once they are gathered.
fn options() -> LightmapsOptions {
    LightmapsOptions { count: 4000, rays: 128, rounds: 1, ..LightmapsOptions::preset(Preset::Default) }
}

fn settings(options: LightmapsOptions) -> Settings {
    let mut settings = Settings::new(Technique::Direct, Preset::Default);
    settings.methods.diffuse = DiffuseMethod::Lightmaps;
    Settings { lightmaps: options, ..settings }
}

/// The same box with a mirror before one wall.
fn lamp_and_mirror() -> (Scene, CameraView) {
    let (mut scene, camera) = lamp_box();
    let metal = Material { metallic: 1.0, roughness: 0.0, ..lambert([0.9; 3]) };
    let mirror = scene.add_material(metal).expect("a sound material");
    let corners = [[-0.99, -0.9, 0.9], [-0.99, -0.9, -0.9], [-0.99, 0.9, -0.9], [-0.99, 0.9, 0.9]];
    place(&mut scene, vec![quad(corners, mirror)], DAffine3::IDENTITY);
    (scene, camera)
}

/// One closed room that a wall of 5 mm, which reaches into its walls, parts into two: floor, ceiling and two walls go on under and behind it. A light in one of them.
fn parted_room(scale: f64, light: f32) -> Scene {
    let mut scene = closed_box(1.0, lambert([0.6, 0.5, 0.7]));
    let wall = scene.add_material(lambert([0.5; 3])).expect("a sound material");
    let mut faces = box_faces([0.0025, 1.05, 1.05], [wall; 6]);
    faces.iter_mut().for_each(|face| face.indices.reverse());
    place(&mut scene, faces, DAffine3::IDENTITY);
    for node in 0..scene.nodes().len() {
        scene.set_local_transform(NodeId(node), DAffine3::from_scale(DVec3::splat(scale))).expect("sound");
    }
    let intensity = light * (scale * scale) as f32;
    add_light(&mut scene, LightKind::Point, DVec3::new(0.4, 0.3, -0.2) * scale, DVec3::NEG_Y, [intensity; 3]);
    scene
}

/// A look into the lit half of it, and into the dark one.
fn into_parted_room(scale: f64) -> [CameraView; 2] {
    [1.0, -1.0].map(|side| view(DVec3::new(0.9 * side, 0.5, 0.9) * scale, DVec3::new(0.0, -0.6, -0.3) * scale))
}

/// In a closed box of albedo ρ that emits L_e everywhere, radiance is L_e/(1 − ρ): of it ρ²·L_e/(1 − ρ) was scattered twice or more often, at every point.
#[test]
fn a_furnace_is_even() {
    let session = Session::open();
    let (scene, camera) = with_camera("furnace");
    let frame = session.render(&scene, &settings(options()), &request([32, 24], camera, &[Slot::Diffuse]));
    let pixels = &frame.slots[&Slot::Diffuse].pixels;
    let values = || pixels.iter().flatten().map(|&value| f64::from(value));
    let mean = values().sum::<f64>() / (3 * pixels.len()) as f64;
    let farthest = values().map(|value| (value - 0.5).abs()).fold(0.0, f64::max);
    println!("mean {mean:.4}, farthest {farthest:.4}");
    assert!((mean - 0.5).abs() < 0.003 && farthest < 0.02, "{mean} {farthest}");
}

/// The same furnace, of albedo ½ and radiance 2, half of which is emitted: all of it arrives at texels, E/π = 2; what rays gather is what was scattered, E/π = 1.
#[test]
fn maps_can_be_looked_at() {
    let session = Session::open();
    let (scene, camera) = with_camera("furnace");
    for (show, expected) in [(LightmapsShow::Gathered, 1.0), (LightmapsShow::Received, 2.0)] {
        let mut renderer = session.renderer(&settings(LightmapsOptions { show, ..options() }));
        for number in 0..3 {
            let frame = frames::frame(&mut renderer, &scene, &camera);
            let pixels = frame.slots[&Slot::Diffuse].pixels.as_flattened();
            let mean = pixels.iter().map(|&value| f64::from(value)).sum::<f64>() / pixels.len() as f64;
            assert!((mean - expected).abs() < 0.01 * expected, "{show:?}, frame {number}: {mean}");
        }
    }
}

/// Every kind of light, few bounces and all.
#[test]
fn pictures_are_those_of_paths() {
    let session = Session::open();
    let cases = [
        ("cornell-point", with_camera("cornell-point"), None),
        ("cornell-point", with_camera("cornell-point"), Some(1)),
        ("cornell-point", with_camera("cornell-point"), Some(3)),
        ("cornell-spot", with_camera("cornell-spot"), None),
        ("lamp", lamp_box(), None),
        ("sky", open_room(), None),
        ("sun", sunlit_corner(), None),
        ("ring", with_camera("ring"), None),
        ("ring", with_camera("ring"), Some(1)),
        ("ring", with_camera("ring"), Some(2)),
        ("lamp and mirror", lamp_and_mirror(), Some(1)),
        ("lamp and mirror", lamp_and_mirror(), Some(2)),
        ("lamp and mirror", lamp_and_mirror(), None),
    ];
    for (name, (scene, camera), bounces) in cases {
        let settings = settings(LightmapsOptions { bounces, ..options() });
        let (ratio, error) = against_paths(&session, &scene, camera, &settings, (128, bounces));
        println!("{name}, {bounces:?} bounces: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.025 && error < 0.07, "{name}, {bounces:?} bounces: {ratio} {error}");
    }
}

#[test]
fn light_stays_out_of_dark_rooms() {
    let found = leaks(&Session::open(), &settings(options()), [32, 24]);
    println!("{found:?} of the lit hall's light");
    assert!(found.iter().all(|&share| share < 1e-3), "{found:?} of the lit hall's light");
}

/// One floor under two rooms: what of the lit one's light comes into the dark one.
pub(super) fn leak_of_a_parted_room(session: &Session, settings: &Settings) -> f64 {
    let scene = parted_room(1.0, 1.0);
    let [lit, dark] = into_parted_room(1.0).map(|camera| {
        let frame = session.render(&scene, settings, &request([48, 32], camera, &[Slot::Diffuse]));
        frame.slots[&Slot::Diffuse].pixels.iter().flatten().map(|&value| f64::from(value)).sum::<f64>()
    });
    assert!(lit > 0.0);
    dark / lit
}

#[test]
fn one_floor_under_two_rooms_does_not_leak() {
    let found = leak_of_a_parted_room(&Session::open(), &settings(options()));
    println!("{found:.1e} of the lit half's light");
    assert!(found < 1e-3, "{found}");
}

/// Neither the unit of length nor that of light matters.
#[test]
fn units_do_not_matter() {
    let session = Session::open();
    let picture = |scale: f64, light: f32| {
        let [camera, _] = into_parted_room(scale);
        let scene = parted_room(scale, light);
        let frame = session.render(&scene, &settings(options()), &request([24, 16], camera, &[Slot::Diffuse]));
        frame.slots[&Slot::Diffuse].pixels.clone()
    };
    let expected = picture(1.0, 1.0);
    for (scale, light, within) in [(1.0, 1024.0_f32, 1e-6), (64.0, 1.0, 1e-3), (0.25, 1.0, 1e-3)] {
        for (found, expected) in picture(scale, light).iter().flatten().zip(expected.iter().flatten()) {
            assert!(
                (found - light * expected).abs() <= within * light * expected,
                "{scale} {light}: {found} {expected}"
            );
        }
    }
}

#[test]
fn scenes_without_need_pay_nothing() {
    let session = Session::open();
    let reason = |scene: &Scene, bounces| {
        let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
        let settings = settings(LightmapsOptions { bounces, ..options() });
        let frame = session.render(scene, &settings, &request([8, 8], camera, &[Slot::Diffuse]));
        let row = frame.timings.passes.into_iter().find(|pass| pass.full_name().starts_with("diffuse/lightmaps"));
        row.and_then(|row| row.skipped).expect("a reason")
    };
    assert_eq!(reason(&closed_box(1.0, lambert([0.5; 3])), None), "no light");
    assert_eq!(reason(&lamp_box().0, Some(0)), "no bounces asked for");
    let mut metal = closed_box(1.0, Material { metallic: 1.0, ..lambert([0.5; 3]) });
    add_light(&mut metal, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    assert_eq!(reason(&metal, None), "no diffuse surface");
}

/// A picture without a past, or one in which everything is renewed whenever something changed: the same light.
#[test]
fn settling_at_once_and_always_are_the_same() {
    let session = Session::open();
    let (scene, camera) = with_camera("cornell-point");
    let asked = request([24, 16], camera, &[Slot::Diffuse]);
    let [first, always] = [LightmapsSettle::First, LightmapsSettle::Always]
        .map(|settle| session.render(&scene, &settings(LightmapsOptions { settle, ..options() }), &asked));
    for (a, b) in
        first.slots[&Slot::Diffuse].pixels.iter().flatten().zip(always.slots[&Slot::Diffuse].pixels.iter().flatten())
    {
        assert!((a - b).abs() <= 1e-5 * b, "{a} {b}");
    }
}

/// Rays that texels send to lights: from four quarters of each to lamps without area, and to see whether these are in the open; else as many as there are samples.
#[test]
fn rays_to_lights_are_those_that_are_needed() {
    let session = Session::open();
    let rays = |(scene, camera): (Scene, CameraView)| {
        let few = LightmapsOptions { count: 500, rays: 16, ..options() };
        let frame = session.render(&scene, &settings(few), &asked(&camera));
        let noted = |pass: &str, work: &str| {
            let row = frame.timings.passes.iter().find(|row| row.full_name() == format!("diffuse/lightmaps/{pass}"));
            row.expect("it ran").work[work]
        };
        noted("aim/direct", "rays") as f64 / noted("texels/place", "texels") as f64
    };
    let samples = f64::from(options().samples);
    assert_eq!(rays(with_camera("cornell-point")), 8.0);
    assert_eq!(rays(open_room()), samples);
    assert_eq!(rays(lamp_box()), 2.0 * samples);
}

#[test]
fn fewer_texels_than_asked_for_are_told() {
    let told = |links, count, texel| Lightmaps::reduced(&LightmapsOptions { links, count, texel, ..options() });
    assert_eq!(told(32, 500_000, 0.0), None);
    assert!(told(32, 1_000_000, 0.0).is_some_and(|said| said.contains("524288")));
    assert_eq!(told(32, 1_000_000, 0.1), None, "their size counts, not their number");
}
