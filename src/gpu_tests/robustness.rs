//! Odd sizes, empty scenes, extreme numbers: no message, no panic, nothing in any slot but finite numbers.

use glam::{DAffine3, DVec3};

use super::scenes::{add_light, box_faces, builtin, closed_box, lambert, place, quad, request, settings, view};
use super::session::Session;
use crate::renderer::{Frame, FrameRequest, Settings, Slot, ToneMap};
use crate::scene::{CameraView, LightKind, Material, Scene};

fn assert_finite(what: &str, frame: &Frame) {
    let images = frame.slots.values().chain(&frame.image);
    for (index, pixel) in images.flat_map(|image| image.pixels.iter().enumerate()) {
        assert!(pixel.iter().all(|channel| channel.is_finite() && *channel >= 0.0), "{what}: {pixel:?} at {index}");
    }
}

fn finite_frame(session: &Session, what: &str, scene: &Scene, settings: &Settings, request: &FrameRequest) -> Frame {
    let request = FrameRequest { tonemap: Some(ToneMap::Drago), ..request.clone() };
    let frame = session.render(scene, settings, &request);
    assert_finite(what, &frame);
    frame
}

fn small() -> Settings {
    settings(&[("lights.resolution", "64"), ("rsm.vpls", "64")])
}

fn inside() -> CameraView {
    view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO)
}

/// Total of the image's channels.
fn light_of(frame: &Frame) -> f64 {
    frame.image.iter().flat_map(|image| image.pixels.iter().flatten()).map(|&channel| f64::from(channel)).sum()
}

fn lit_box(material: Material, position: DVec3, intensity: [f32; 3]) -> Scene {
    let mut scene = closed_box(1.0, material);
    add_light(&mut scene, LightKind::Point, position, DVec3::NEG_Y, intensity);
    scene
}

#[test]
fn frames_of_odd_sizes_are_whole() {
    let session = Session::open();
    let scene = builtin("lights");
    let camera = scene.camera_view(None).expect("its camera");
    for size in [[1, 1], [17, 5], [3, 33]] {
        let frame = finite_frame(&session, "an odd size", &scene, &small(), &request(size, camera.clone(), &Slot::ALL));
        assert_eq!(frame.display.as_ref().map(Vec::len), Some((size[0] * size[1]) as usize));
        assert!(light_of(&frame) > 0.0);
    }
}

#[test]
fn a_frame_changes_its_size_between_frames() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let mut renderer = session.renderer(&small());
    for size in [[40, 30], [17, 5], [18, 5], [64, 48], [40, 30]] {
        let request = FrameRequest { tonemap: Some(ToneMap::Aces), ..request(size, camera.clone(), &Slot::ALL) };
        let kept = renderer.render(&scene, &request).expect("a frame");
        let fresh = session.render(&scene, &small(), &request);
        assert_eq!((kept.image, kept.slots, kept.display), (fresh.image, fresh.slots, fresh.display), "{size:?}");
    }
}

#[test]
fn a_frame_beyond_the_device_is_refused() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let mut renderer = session.renderer(&small());
    let limit = session.context.shared_device().limits().max_image_dimension2_d.to_string();
    for size in [[100_000, 100_000], [100_000, 1], [1, u32::MAX]] {
        let request = FrameRequest { tonemap: Some(ToneMap::Aces), ..request(size, camera.clone(), &Slot::ALL) };
        let error = renderer.render(&scene, &request).expect_err("too large").to_string();
        assert!(error.contains(&limit) && error.contains(&size[1].to_string()), "{error}");
    }
    let error = renderer.render(&scene, &request([0, 5], camera.clone(), &[])).expect_err("no pixels").to_string();
    assert!(error.contains("0x5"), "{error}");
    let frame = renderer.render(&scene, &request([8, 8], camera, &[])).expect("the next frame is sound");
    assert!(light_of(&frame) > 0.0);
}

#[test]
fn a_time_step_is_a_time() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    for step in [-1.0, f32::NAN, f32::INFINITY] {
        let asked = FrameRequest { time_step: step, ..request([8, 8], camera.clone(), &[]) };
        let error = session.renderer(&small()).render(&scene, &asked).expect_err("no time").to_string();
        assert!(error.contains("time step"), "{error}");
    }
}

#[test]
fn scenes_without_triangles_are_black_or_sky() {
    let session = Session::open();
    let mut scene = Scene::empty("nothing");
    let request = request([9, 7], inside(), &Slot::ALL);
    assert_eq!(light_of(&finite_frame(&session, "nothing", &scene, &small(), &request)), 0.0);
    add_light(&mut scene, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    assert_eq!(light_of(&finite_frame(&session, "lights alone", &scene, &small(), &request)), 0.0);
    scene.set_sky([1.0, 2.0, 3.0]);
    let sky = finite_frame(&session, "sky alone", &scene, &small(), &request);
    assert_eq!(sky.image.map(|image| image.pixels), Some(vec![[1.0, 2.0, 3.0]; 63]));
}

#[test]
fn numbers_of_virtual_lights_from_none_to_most() {
    let session = Session::open();
    let scene = builtin("cornell-empty");
    let camera = scene.camera_view(None).expect("its camera");
    let light = |count: &str| {
        let settings = settings(&[("rsm.vpls", count), ("lights.resolution", "128")]);
        let request = request([5, 4], camera.clone(), &[Slot::Diffuse]);
        let frame = finite_frame(&session, count, &scene, &settings, &request);
        frame.slots[&Slot::Diffuse].pixels.iter().flatten().map(|&channel| f64::from(channel)).sum::<f64>()
    };
    assert_eq!(light("0"), 0.0);
    let (one, few, most) = (light("1"), light("1000"), light("32768"));
    assert!(one >= 0.0 && (few / most - 1.0).abs() < 0.05, "{one} {few} {most}");
}

#[test]
fn lights_on_walls_edges_and_corners_do_no_harm() {
    let session = Session::open();
    let request = request([32, 24], inside(), &Slot::ALL);
    for position in [DVec3::Y, DVec3::new(1.0, 1.0, 0.0), DVec3::ONE, DVec3::new(0.2, -1.0 + 1e-7, 0.3)] {
        let scene = lit_box(lambert([0.7; 3]), position, [2.0; 3]);
        finite_frame(&session, &format!("a light at {position}"), &scene, &small(), &request);
        let mut scene = closed_box(1.0, lambert([0.7; 3]));
        let spot = LightKind::Spot { inner_angle: 0.0, outer_angle: std::f32::consts::FRAC_PI_2 };
        add_light(&mut scene, spot, position, -position, [2.0; 3]);
        finite_frame(&session, &format!("a wide spot at {position}"), &scene, &small(), &request);
    }
}

#[test]
fn lights_of_any_power_scale_the_image() {
    let session = Session::open();
    let request = request([32, 24], inside(), &Slot::ALL);
    let frame = |power: f32| {
        let scene = lit_box(lambert([0.7; 3]), DVec3::new(0.1, 0.5, 0.0), [power, power, 0.5 * power]);
        finite_frame(&session, &format!("power {power}"), &scene, &small(), &request)
    };
    let unit = frame(1.0);
    for power in [1e12, 1e-12, 1e-20] {
        let scaled = frame(power);
        let ratio = light_of(&scaled) / light_of(&unit) / f64::from(power);
        println!("power {power:.0e}: image / power {ratio:.7}");
        assert!((ratio - 1.0).abs() < 1e-4, "{power}: {ratio}");
        let apart = |a: [u8; 3], b: [u8; 3]| (0..3).map(|i| a[i].abs_diff(b[i])).max();
        let display = |frame: &Frame| frame.display.clone().expect("it was asked for");
        let worst = display(&unit).into_iter().zip(display(&scaled)).filter_map(|(a, b)| apart(a, b)).max();
        assert!(worst <= Some(1), "{power}: the exposed picture is {worst:?} levels off");
    }
}

#[test]
fn mirrors_and_strange_materials_stay_finite() {
    let session = Session::open();
    let request = request([32, 24], inside(), &Slot::ALL);
    let base = Material::default();
    let materials = [
        ("a mirror", Material { metallic: 1.0, roughness: 0.0, ..base.clone() }),
        ("a smooth dielectric", Material { roughness: 0.0, ..base.clone() }),
        ("an index of 0", Material { ior: 0.0, roughness: 0.1, ..base.clone() }),
        ("an index of 1", Material { ior: 1.0, ..base.clone() }),
        ("black", Material { base_color: [0.0; 4], ..base.clone() }),
        ("beyond white", Material { base_color: [8.0; 4], specular_color: [100.0; 3], ..base.clone() }),
        ("glass", Material { transmission: 1.0, roughness: 0.0, ..base.clone() }),
        ("glowing", Material { emissive: [1e6; 3], ..base.clone() }),
        ("unlit", Material { unlit: true, ..base }),
    ];
    for (what, material) in materials {
        // The light's mirror image in a wall is in view.
        let scene = lit_box(material, DVec3::new(0.7, 0.6, 0.79), [1.0; 3]);
        finite_frame(&session, what, &scene, &small(), &request);
    }
}

#[test]
fn degenerate_triangles_are_not_there() {
    let session = Session::open();
    let request = request([32, 24], inside(), &Slot::ALL);
    let plain = lit_box(lambert([0.7; 3]), DVec3::new(0.1, 0.5, 0.0), [1.0; 3]);
    let mut scene = plain.clone();
    let id = scene.add_material(Material { emissive: [3.0; 3], ..lambert([1.0; 3]) }).expect("sound");
    let point = quad([[0.3; 3]; 4], id);
    let line = quad([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.2, 0.0, 0.0], [0.3, 0.0, 0.0]], id);
    let empty = crate::scene::Primitive { material: id, ..Default::default() };
    let unused = crate::scene::Primitive { positions: vec![[0.5; 3]], material: id, ..Default::default() };
    place(&mut scene, vec![point, line, empty, unused], DAffine3::IDENTITY);
    // And a whole box flattened to nothing by its node.
    place(&mut scene, box_faces([0.2; 3], [id; 6]), DAffine3::from_scale(DVec3::new(1.0, 0.0, 0.0)));
    let (with, without) = (
        finite_frame(&session, "degenerate", &scene, &small(), &request),
        finite_frame(&session, "plain", &plain, &small(), &request),
    );
    assert_eq!(with.image, without.image);
}
