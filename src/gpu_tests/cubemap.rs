//! Maps of the surroundings: closed forms, paths, what levels hold, and what is not done again.

use glam::{DAffine3, DVec3};

use super::blocks::{assert_close, mean};
use super::invariance::transformed;
use super::path_probe::{Ask, Tracer, sphere, turned};
use super::probe::{Probe, probe};
use super::scenes::{add_light, box_faces, builtin, closed_box, lambert, place, quad, request, settings_of, view};
use super::session::Session;
use crate::frame::lobe_albedos::lobe_albedos;
use crate::renderer::{FrameRequest, Settings, Slot, SpecularMethod, Technique, Timing};
use crate::scene::{CameraView, Light, LightId, LightKind, Material, Primitive, Scene};
use crate::slot::{LightPaths, PixelFilter};

const SIZE: [u32; 2] = [64, 48];
const COLOR: [f32; 3] = [0.2, 0.5, 1.0];

fn metal(color: [f32; 3], roughness: f32) -> Material {
    let [red, green, blue] = color;
    Material { base_color: [red, green, blue, 1.0], metallic: 1.0, roughness, ..Material::default() }
}

/// The technique with small maps of diffuse light, which stand after one frame.
fn settings(changes: &[(&str, &str)]) -> Settings {
    let diffuse = [("lightmaps.count", "3000"), ("lightmaps.rays", "128"), ("lightmaps.rounds", "1")];
    let small = diffuse.iter().chain(&[("cubemap.light_samples", "32")]);
    settings_of(Technique::Lightmaps, &small.chain(changes).copied().collect::<Vec<_>>())
}

/// The same without diffuse light.
fn direct(changes: &[(&str, &str)]) -> Settings {
    let mut settings = settings_of(Technique::Direct, changes);
    settings.methods.specular = SpecularMethod::Cubemap;
    settings
}

fn add_sphere(scene: &mut Scene, material: Material, radius: f64, middle: DVec3) {
    let id = scene.add_material(material).expect("sound");
    let at = DAffine3::from_translation(middle) * DAffine3::from_scale(DVec3::splat(radius));
    place(scene, vec![sphere(24, true, id)], at);
}

/// A room that shows one colour everywhere, whatever shines on it, and a metal sphere.
fn even_room(roughness: f32) -> Scene {
    let [red, green, blue] = COLOR;
    let mut scene = closed_box(2.0, Material { unlit: true, base_color: [red, green, blue, 1.0], ..lambert([0.0; 3]) });
    add_sphere(&mut scene, metal([1.0; 3], roughness), 0.5, DVec3::new(0.3, -0.2, 0.1));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 1.5, 0.0), DVec3::NEG_Y, [1.0; 3]);
    scene
}

/// At the sphere, no more than which is in view.
fn at_the_sphere() -> CameraView {
    let mut camera = view(DVec3::new(0.3, -0.2, 1.6), DVec3::new(0.3, -0.2, 0.1));
    camera.projection = crate::scene::Projection::Perspective { vertical_fov: 0.3, aspect: None, near: 0.01 };
    camera
}

fn specular_of(session: &Session, scene: &Scene, settings: &Settings, camera: &CameraView) -> Vec<DVec3> {
    let asked = FrameRequest { image: false, ..request(SIZE, camera.clone(), &[Slot::Specular]) };
    let frame = session.render(scene, settings, &asked);
    frame.slots[&Slot::Specular].pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).collect()
}

#[test]
fn an_even_room_is_mirrored_as_it_is() {
    let session = Session::open();
    let color = DVec3::from(COLOR.map(f64::from));
    for step in [0, 3, 6, 9, 15] {
        let roughness = step as f32 / 15.0;
        let pixels = specular_of(&session, &even_room(roughness), &direct(&[]), &at_the_sphere());
        // In the middle the view goes along the normal.
        let [rest, grazing, ..] = lobe_albedos()[16 * step + 15].map(f64::from);
        let middle = pixels[24 * 64 + 32] / color;
        assert!((middle / (rest + grazing) - 1.0).abs().max_element() < 3e-3, "{roughness}: {middle}");
        for pixel in &pixels {
            let share = *pixel / color;
            assert!(share.max_element() - share.min_element() < 1e-3, "{roughness}: {pixel}");
            assert!(share.x < 1.0 + 1e-3 && (step > 0 || share.x > 0.99), "{roughness}: {share}");
        }
    }
}

/// What the maps of a frame hold, buffer by buffer: squares, then lobes, of each.
fn maps_of(session: &Session, scene: &Scene, settings: &Settings, camera: &CameraView) -> Probe {
    let asked = request(SIZE, camera.clone(), &[Slot::Specular]);
    probe(session, scene, settings, &asked, |graph, declared| {
        let maps = declared.cubemaps.as_ref().expect("maps are made").maps.clone();
        maps.into_iter().flat_map(|map| [map.boxes, map.lobes].map(|buffer| graph.read_back_buffer(buffer))).collect()
    })
}

/// The solid angle of each texel of a level, up to a factor.
fn solid_angles(side: u32) -> Vec<f64> {
    let place = |index: u32| (f64::from(index) + 0.5) * 2.0 / f64::from(side) - 1.0;
    let face = (0..side * side).map(|texel| {
        let [u, v] = [place(texel % side), place(texel / side)];
        (1.0 + u * u + v * v).powf(-1.5) / f64::from(side * side)
    });
    (0..6).flat_map(|_| face.clone()).collect()
}

/// Levels of one map: their sides, and which of the two buffers holds them.
fn levels(resolution: u32) -> Vec<(usize, u32)> {
    let boxes = (0..resolution.ilog2() - 1).map(|level| (0, resolution >> level));
    boxes.chain((0..resolution.ilog2()).map(|level| (1, (resolution >> level).max(8)))).collect()
}

#[test]
fn every_level_of_an_even_room_is_even() {
    let session = Session::open();
    let color = DVec3::from(COLOR.map(f64::from));
    for resolution in [32_u32, 64] {
        let settings = direct(&[("cubemap.resolution", &resolution.to_string())]);
        let found = maps_of(&session, &even_room(0.3), &settings, &at_the_sphere());
        for buffer in 0..2 {
            let texels = found.colors(buffer);
            let expected: u32 =
                levels(resolution).iter().filter(|level| level.0 == buffer).map(|level| 6 * level.1.pow(2)).sum();
            assert_eq!(texels.len(), expected as usize);
            for texel in texels {
                assert!((texel / color - 1.0).abs().max_element() < 1e-5, "{resolution}, {buffer}: {texel}");
            }
        }
    }
}

/// A room with walls of different colours and a metal sphere.
fn room(roughness: f32, lamp: bool) -> Scene {
    let mut scene = walls(lamp);
    add_sphere(&mut scene, metal([0.9, 0.8, 0.7], roughness), 0.35, DVec3::new(0.2, -0.3, 0.2));
    scene
}

/// The walls, lit by a spot or by a lamp: paths do not find a spot's light by way of mirrors behind other surfaces.
fn walls(lamp: bool) -> Scene {
    let mut scene = Scene::empty("room");
    let walls = [[0.7, 0.2, 0.1], [0.2, 0.6, 0.2], [0.5; 3], [0.7; 3], [0.3, 0.4, 0.7], [0.6, 0.6, 0.3]];
    let walls = walls.map(|albedo| scene.add_material(lambert(albedo)).expect("sound"));
    place(&mut scene, box_faces([1.5, 1.0, 1.5], walls), DAffine3::IDENTITY);
    if lamp {
        let id = scene.add_material(Material { emissive: [6.0, 5.0, 4.0], ..lambert([0.0; 3]) }).expect("sound");
        let corners = [[-1.0, 0.95, -0.4], [0.0, 0.95, -0.4], [0.0, 0.95, 0.4], [-1.0, 0.95, 0.4]];
        place(&mut scene, vec![quad(corners, id)], DAffine3::IDENTITY);
    } else {
        let kind = LightKind::Spot { inner_angle: 0.5, outer_angle: 0.8 };
        add_light(&mut scene, kind, DVec3::new(-0.6, 0.8, 0.4), DVec3::new(1.0, -0.6, -0.3), [6.0, 5.0, 4.0]);
    }
    scene
}

fn in_the_room() -> CameraView {
    view(DVec3::new(-0.3, 0.1, 1.3), DVec3::new(0.2, -0.3, 0.2))
}

#[test]
fn every_level_holds_all_light() {
    let session = Session::open();
    let resolution = 64;
    let found = maps_of(&session, &room(0.3, false), &direct(&[("cubemap.resolution", "64")]), &in_the_room());
    let mut first = [0; 2];
    let mut whole = None;
    for (buffer, side) in levels(resolution) {
        let texels = &found.colors(buffer)[first[buffer]..first[buffer] + 6 * (side * side) as usize];
        first[buffer] += texels.len();
        let angles = solid_angles(side);
        let flux = texels.iter().zip(&angles).map(|(light, angle)| *light * *angle).sum::<DVec3>();
        let flux = flux / angles.iter().sum::<f64>();
        let whole = *whole.get_or_insert(flux);
        assert!(whole.min_element() > 0.01, "{whole}");
        // Squares are exact; lobes are sums over samples.
        let most = if buffer == 0 { 5e-3 } else { 0.015 };
        assert!((flux / whole - 1.0).abs().max_element() < most, "{buffer}, {side}: {flux} of {whole}");
    }
}

/// The slot by paths of the light that the settings say.
fn by_paths(session: &Session, scene: &Scene, settings: &Settings, camera: &CameraView, samples: u32) -> Vec<DVec3> {
    let LightPaths { bounces, caustics, mirrors } = settings.light_paths(Slot::Specular);
    let ask =
        Ask { bounces, caustics, mirrors, filter: PixelFilter::Center, ..Ask::new(SIZE, samples, camera.clone()) };
    Tracer::new(session).trace(scene, &ask).slot(Slot::Specular)
}

#[test]
fn metal_spheres_are_those_of_paths() {
    let session = Session::open();
    for (roughness, error) in [(0.0, 0.03), (0.3, 0.08), (0.6, 0.06)] {
        let camera = in_the_room();
        // Of all of it, caustics of light that a wall scattered first are missing.
        for (what, settings, lamp, most) in [
            ("a spot", direct(&[]), false, 0.03),
            ("a lamp", direct(&[]), true, 0.03),
            ("all of a lamp", settings(&[]), true, 0.045),
        ] {
            // A wide lobe takes light from below the horizon, of which a spot's small patch leaves much.
            if roughness > 0.5 && !lamp {
                continue;
            }
            let scene = room(roughness, lamp);
            let truth = by_paths(&session, &scene, &settings, &camera, 64);
            let found = specular_of(&session, &scene, &settings, &camera);
            assert_close(&format!("{what}, roughness {roughness}"), &found, &truth, most, error);
        }
    }
}

/// But for what is reflected within it.
#[test]
fn glass_shows_what_lies_behind_it() {
    let session = Session::open();
    let glass = Material { transmission: 1.0, roughness: 0.0, thickness: 1.0, ..Material::default() };
    let tinted = Material { thickness: 0.0, base_color: [0.9, 0.6, 0.3, 1.0], ..glass.clone() };
    for (what, thick) in [("a ball", true), ("a pane", false)] {
        let mut scene = walls(false);
        if thick {
            add_sphere(&mut scene, glass.clone(), 0.35, DVec3::new(0.2, -0.3, 0.2));
        } else {
            let id = scene.add_material(tinted.clone()).expect("sound");
            let corners = [[-0.5, -0.8, 0.2], [0.6, -0.8, 0.2], [0.6, 0.3, 0.2], [-0.5, 0.3, 0.2]];
            place(&mut scene, vec![quad(corners, id)], DAffine3::IDENTITY);
        }
        let (settings, camera) = (direct(&[]), in_the_room());
        let truth = by_paths(&session, &scene, &settings, &camera, 64);
        assert_close(what, &specular_of(&session, &scene, &settings, &camera), &truth, 0.06, 0.1);
    }
}

/// A room whose walls are glossy is an object around its own map.
#[test]
fn a_glossy_room_mirrors_itself() {
    let session = Session::open();
    let varnish = Material { roughness: 0.2, base_color: [0.5, 0.4, 0.3, 1.0], ..Material::default() };
    let mut scene = Scene::empty("glossy room");
    let walls = scene.add_material(varnish).expect("sound");
    let mut room = Primitive { material: walls, ..Primitive::default() };
    for face in box_faces([1.5; 3], [walls; 6]) {
        let first = room.positions.len() as u32;
        room.indices.extend(face.indices.iter().map(|index| first + index));
        room.positions.extend(face.positions);
    }
    place(&mut scene, vec![room], DAffine3::IDENTITY);
    let id = scene.add_material(Material { emissive: [6.0, 5.0, 4.0], ..lambert([0.0; 3]) }).expect("sound");
    let corners = [[-0.5, 1.45, -0.4], [0.5, 1.45, -0.4], [0.5, 1.45, 0.4], [-0.5, 1.45, 0.4]];
    place(&mut scene, vec![quad(corners, id)], DAffine3::IDENTITY);
    let camera = view(DVec3::new(-0.9, 0.3, 1.2), DVec3::new(1.0, -0.8, -1.0));
    let settings = settings(&[]);
    // Coats in the mirror mirror nothing.
    let LightPaths { bounces, caustics, .. } = settings.light_paths(Slot::Specular);
    let ask =
        Ask { bounces, caustics, mirrors: Some(1), filter: PixelFilter::Center, ..Ask::new(SIZE, 96, camera.clone()) };
    let truth = Tracer::new(&session).trace(&scene, &ask).slot(Slot::Specular);
    assert_close("a glossy room", &specular_of(&session, &scene, &settings, &camera), &truth, 0.05, 0.1);
}

/// A map's texels lie otherwise then.
#[test]
fn a_turned_room_looks_the_same() {
    let session = Session::open();
    let (scene, camera, settings) = (room(0.2, false), in_the_room(), direct(&[]));
    let turn = turned(1.0, DVec3::new(30.0, -20.0, 10.0));
    let moved = CameraView { world: turn * camera.world, ..camera.clone() };
    let before = specular_of(&session, &scene, &settings, &camera);
    let after = specular_of(&session, &transformed(&scene, turn, 1.0), &settings, &moved);
    assert_close("turned", &after, &before, 0.01, 0.01);
}

#[test]
fn what_has_no_map_takes_the_nearest_one() {
    let session = Session::open();
    let mut scene = even_room(0.0);
    add_sphere(&mut scene, metal([1.0; 3], 0.0), 0.2, DVec3::new(-0.6, -0.2, 0.1));
    let camera = view(DVec3::new(0.0, -0.2, 1.6), DVec3::new(0.0, -0.2, 0.1));
    let lit = |count: &str| {
        let pixels = specular_of(&session, &scene, &direct(&[("cubemap.objects", count)]), &camera);
        let color = DVec3::from(COLOR.map(f64::from));
        assert!(pixels.iter().all(|pixel| *pixel == DVec3::ZERO || (*pixel / color - 1.0).abs().max_element() < 0.01));
        pixels.iter().filter(|pixel| pixel.x > 0.0).count()
    };
    assert!(lit("1") > 200);
    assert_eq!(lit("1"), lit("2"));
}

#[test]
fn a_lone_slot_and_a_second_run_have_the_same_bits() {
    let session = Session::open();
    let (scene, camera, settings) = (room(0.2, true), in_the_room(), settings(&[]));
    let bits = |frame: &crate::renderer::Frame| -> Vec<[u32; 3]> {
        frame.slots[&Slot::Specular].pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
    };
    let all = session.render(&scene, &settings, &request(SIZE, camera.clone(), &Slot::ALL));
    let asked = FrameRequest { image: false, ..request(SIZE, camera, &[Slot::Specular]) };
    let mut renderer = session.renderer(&settings);
    assert_eq!(bits(&all), bits(&renderer.render(&scene, &asked).expect("a frame")));
    renderer.invalidate();
    assert_eq!(bits(&all), bits(&renderer.render(&scene, &asked).expect("a frame")));
}

#[test]
fn what_nothing_reflects_costs_nothing() {
    let session = Session::open();
    let rows = |scene: &Scene, camera: &CameraView| {
        let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera.clone(), &[Slot::Specular]) };
        let frame = session.render(scene, &direct(&[]), &asked);
        assert_eq!(
            mean(
                &frame.slots[&Slot::Specular].pixels.iter().map(|p| DVec3::from(p.map(f64::from))).collect::<Vec<_>>()
            ),
            DVec3::ZERO
        );
        frame.timings.passes.into_iter().filter(|pass| pass.piece == "specular/cubemap").collect::<Vec<_>>()
    };
    let reasons = |scene: &Scene, camera: &CameraView| -> Vec<Option<String>> {
        rows(scene, camera).into_iter().map(|pass| pass.skipped).collect()
    };
    let matt = builtin("cornell-point");
    let camera = matt.camera_view(None).expect("a view");
    assert_eq!(reasons(&matt, &camera), [Some("no specular surface".to_owned())]);
    let away = view(DVec3::new(0.3, -0.2, 1.6), DVec3::new(0.3, -0.2, 9.0));
    assert_eq!(reasons(&even_room(0.1), &away), [Some("no specular surface in view".to_owned())]);
    let mut dark = Scene::empty("dark");
    add_sphere(&mut dark, metal([1.0; 3], 0.0), 0.5, DVec3::ZERO);
    assert_eq!(reasons(&dark, &view(DVec3::Z * 3.0, DVec3::ZERO)), [Some("no light".to_owned())]);
}

#[test]
fn maps_stand_while_the_camera_moves() {
    let session = Session::open();
    let mut scene = room(0.2, false);
    let mut renderer = session.renderer(&settings(&[]));
    let mut ran = |scene: &Scene, eye: DVec3| {
        let camera = view(eye, DVec3::new(0.2, -0.3, 0.2));
        let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera, &[Slot::Specular]) };
        let frame = renderer.render(scene, &asked).expect("a frame");
        let running = frame.timings.passes.into_iter().filter(|pass| pass.skipped.is_none());
        let names = running.map(|pass| pass.full_name()).filter(|name| name.starts_with("specular/cubemap/"));
        names.map(|name| name["specular/cubemap/".len()..].to_owned()).collect::<Vec<_>>()
    };
    let eye = DVec3::new(-0.3, 0.1, 1.3);
    let all = ["rays.0", "light/punctual.0", "resolve.0", "coarser.0", "prefilter.0", "find", "apply.0"];
    assert_eq!(ran(&scene, eye), all);
    // The frames after the first one still renew light maps, whatever the camera does; then all stands.
    let mut frames = 0;
    while !ran(&scene, eye).is_empty() {
        frames += 1;
        assert!(frames < 200, "maps go on for ever");
    }
    assert_eq!(ran(&scene, eye + 0.1), ["find", "apply.0"]);
    let light = Light { intensity: [1.0, 2.0, 3.0], ..scene.lights()[0].clone() };
    scene.set_light(LightId(0), light).expect("sound");
    assert_eq!(ran(&scene, eye + 0.1), ["light/punctual.0", "resolve.0", "coarser.0", "prefilter.0", "apply.0"]);
}

/// What a block hides from the floor's middle, the map of the block shows: the floor beside it mirrors the green wall.
#[test]
fn other_maps_show_what_is_hidden_from_one() {
    let session = Session::open();
    let scene = builtin("cornell-glossy");
    let camera = scene.camera_view(None).expect("a view");
    let asked = FrameRequest { image: false, ..request([64, 64], camera, &[Slot::Specular]) };
    let frame = session.render(&scene, &direct(&[]), &asked);
    let part = |rows: std::ops::Range<usize>, columns: std::ops::Range<usize>| {
        let pixels = rows.flat_map(|row| columns.clone().map(move |column| 64 * row + column));
        mean(
            &pixels
                .map(|pixel| DVec3::from(frame.slots[&Slot::Specular].pixels[pixel].map(f64::from)))
                .collect::<Vec<_>>(),
        )
    };
    let beside = part(53..57, 54..57);
    assert!(beside.y > 1.3 * beside.x.max(beside.z), "{beside}");
}

/// A flat mirror, whose map lies in its plane.
#[test]
fn a_flat_mirror_shows_the_room() {
    let session = Session::open();
    let mut scene = walls(true);
    add_sphere(&mut scene, lambert([0.7, 0.3, 0.2]), 0.35, DVec3::new(0.2, -0.3, 0.2));
    let mirror = scene.add_material(metal([0.9; 3], 0.0)).expect("sound");
    let corners = [[-0.5, -0.4, -1.4], [0.5, -0.4, -1.4], [0.5, 0.4, -1.4], [-0.5, 0.4, -1.4]];
    place(&mut scene, vec![quad(corners, mirror)], DAffine3::IDENTITY);
    let camera = view(DVec3::new(-0.2, 0.2, 0.6), DVec3::new(0.0, 0.0, -1.4));
    let settings = settings(&[]);
    let truth = by_paths(&session, &scene, &settings, &camera, 64);
    assert_close("a flat mirror", &specular_of(&session, &scene, &settings, &camera), &truth, 0.05, 0.15);
}
