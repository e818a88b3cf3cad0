//! The technique `hybrid` as a whole: what it skips, that it repeats, that nothing it is given breaks it.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};

use super::path_probe::{Ask, Tracer};
use super::scenes::{add_light, box_faces, builtin, closed_box, lambert, place, quad, request, view};
use super::session::Session;
use crate::frame::rays::{surfaces_key, traced_key};
use crate::renderer::{ColorImage, Frame, FrameRequest, PassTiming, Preset, Settings, Slot, Technique, Timing};
use crate::scene::{CameraView, Light, LightId, LightKind, Material, Scene};

const INDIRECT: [Slot; 2] = [Slot::Diffuse, Slot::Caustics];

fn hybrid(preset: Preset, changes: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(Technique::Hybrid, preset);
    for (key, value) in changes {
        settings.set(key, value).expect("a setting and its value");
    }
    settings
}

/// Settings whose every way of doing things is tried by some test.
fn variants() -> Vec<Settings> {
    let small = [("lights.resolution", "128"), ("vpl.count", "64"), ("photons.max", "4000")];
    let variant = |preset, more: &[(&str, &str)]| hybrid(preset, &[&small[..], more].concat());
    vec![
        variant(Preset::Default, &[]),
        variant(Preset::Paper, &[]),
        variant(Preset::High, &[("vpl.bounces", "3")]),
        variant(
            Preset::Default,
            &[
                ("vpl.visibility", "ism"),
                ("vpl.shading", "stencil"),
                ("photons.trace", "march"),
                ("photons.splat", "discs"),
            ],
        ),
        variant(
            Preset::Paper,
            &[
                ("vpl.shading", "pixels"),
                ("photons.geometry", "layers:2"),
                ("photons.splat", "tiles"),
                ("photons.downscale", "2"),
            ],
        ),
    ]
}

fn everything(scene: &Scene, size: [u32; 2]) -> FrameRequest {
    let camera = scene.camera_view(None).expect("a view");
    FrameRequest { timing: Timing::Passes, ..request(size, camera, &Slot::ALL) }
}

fn assert_sound(what: &str, frame: &Frame) {
    for (slot, image) in &frame.slots {
        for (index, pixel) in image.pixels.iter().enumerate() {
            let sound = pixel.iter().all(|channel| channel.is_finite() && *channel >= 0.0);
            assert!(sound, "{what}: {pixel:?} at {index} of {slot}");
        }
    }
}

fn mean(image: &ColorImage) -> f64 {
    let sum: f64 = image.pixels.as_flattened().iter().map(|&channel| f64::from(channel)).sum();
    sum / image.pixels.as_flattened().len() as f64
}

/// The first few values of which two images differ in a bit: their place, and both.
fn differing_bits(one: &ColorImage, other: &ColorImage) -> Vec<(usize, f32, f32)> {
    let [one, other] = [one, other].map(|image| image.pixels.as_flattened());
    let pairs = one.iter().zip(other).enumerate().filter(|(_, (one, other))| one.to_bits() != other.to_bits());
    pairs.map(|(place, (&one, &other))| (place, one, other)).take(8).collect()
}

fn maximum(image: &ColorImage) -> f32 {
    image.pixels.as_flattened().iter().copied().fold(0.0, f32::max)
}

fn ran(frame: &Frame, piece: &str) -> bool {
    frame.timings.passes.iter().any(|pass| pass.skipped.is_none() && pass.piece.starts_with(piece))
}

fn reason<'f>(frame: &'f Frame, name: &str) -> Option<&'f str> {
    let named = |pass: &&PassTiming| pass.full_name().starts_with(name);
    frame.timings.passes.iter().find(named)?.skipped.as_deref()
}

#[test]
fn a_scene_without_specular_surfaces_records_no_photon() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let frame = session.render(&scene, &hybrid(Preset::Default, &[]), &everything(&scene, [40, 32]));
    assert!(ran(&frame, "diffuse/vpl") && !ran(&frame, "caustics"));
    assert_eq!(reason(&frame, "caustics"), Some("no specular or transmissive surface"));

    let mut metal = closed_box(1.0, Material { metallic: 1.0, ..lambert([0.9; 3]) });
    add_light(&mut metal, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    let frame = session.render(&metal, &hybrid(Preset::Default, &[]), &everything(&metal, [40, 32]));
    assert!(!ran(&frame, "diffuse") && !ran(&frame, "caustics"));
    assert_eq!(reason(&frame, "diffuse/vpl"), Some("no diffuse surface"));
}

/// Without rays the scene takes what it takes for reflective shadow maps.
#[test]
fn only_what_sends_rays_builds_the_hierarchy() {
    let session = Session::open();
    let bytes = |name: &str, settings: &Settings| {
        let scene = builtin(name);
        session.render(&scene, settings, &everything(&scene, [16, 12])).timings.memory_bytes["scene"]
    };
    let rsm = Settings::new(Technique::Rsm, Preset::Default);
    let bare: BTreeMap<_, _> = ["cornell-point", "ring"].map(|name| (name, bytes(name, &rsm))).into();
    let without_rays = [
        ("cornell-point", vec![]),
        ("ring", vec![("photons.max", "0")]),
        ("ring", vec![("photons.bounces", "0")]),
        ("ring", vec![("photons.trace", "march")]),
        ("cornell-point", vec![("vpl.visibility", "traced"), ("vpl.count", "0")]),
        ("cornell-point", vec![("vpl.visibility", "traced"), ("vpl.bounces", "0")]),
    ];
    for (name, changes) in without_rays {
        assert_eq!(bytes(name, &hybrid(Preset::Default, &changes)), bare[name], "{name}, {changes:?}");
    }
    for (name, changes) in [("ring", vec![]), ("cornell-point", vec![("vpl.bounces", "2")])] {
        assert!(bytes(name, &hybrid(Preset::Default, &changes)) > bare[name], "{name}, {changes:?}");
    }
}

/// A light that changes leaves the hierarchy as it is, and the picture is that of a hierarchy made for the light as it is now.
#[test]
fn the_hierarchy_outlasts_a_light_that_changes() {
    let session = Session::open();
    let settings = hybrid(Preset::Default, &[("vpl.visibility", "traced"), ("vpl.bounces", "2"), ("vpl.count", "32")]);
    let (mut scene, mut renderer) = (builtin("ring"), session.renderer(&settings));
    let keys = |scene: &Scene| (surfaces_key(scene), traced_key(scene));
    renderer.render(&scene, &everything(&scene, [24, 16])).expect("a frame");
    let before = keys(&scene);
    let light = Light { intensity: [9.0, 1.0, 0.5], ..scene.lights()[0].clone() };
    scene.set_light(LightId(0), light).expect("a sound light");
    let after = keys(&scene);
    assert!(before.0 == after.0 && before.1 != after.1, "the light alone changes");
    let request = everything(&scene, [24, 16]);
    let changed = renderer.render(&scene, &request).expect("a frame");
    assert_eq!(changed.slots, session.render(&scene, &settings, &request).slots);
}

/// Photons that are traced through the hierarchy leave the passes of the diffuse light alone.
#[test]
fn diffuse_light_does_not_depend_on_how_photons_are_traced() {
    let session = Session::open();
    let (scene, mut renderer) = (builtin("ring"), session.renderer(&hybrid(Preset::Default, &[])));
    let with = |slots: &[Slot]| FrameRequest { image: false, slots: slots.to_vec(), ..everything(&scene, [48, 40]) };
    renderer.render(&scene, &with(&[Slot::Diffuse])).expect("a frame");
    let both = renderer.render(&scene, &with(&INDIRECT)).expect("a frame");
    assert!(ran(&both, "caustics") && !ran(&both, "diffuse"));
}

#[test]
fn nothing_runs_again_where_nothing_moved() {
    for name in ["ring", "water"] {
        for settings in variants() {
            let session = Session::open();
            let (scene, mut renderer) = (builtin(name), session.renderer(&settings));
            let request = everything(&scene, [48, 40]);
            let first = renderer.render(&scene, &request).expect("a frame");
            let second = renderer.render(&scene, &request).expect("a frame");
            let again = second.timings.passes.iter().filter(|pass| pass.skipped.is_none());
            let again: Vec<_> = again.map(|pass| &pass.pass).collect();
            assert!(again.is_empty(), "{name}, {:?}: {again:?}", settings.options());
            assert_eq!(first.slots, second.slots);
        }
    }
}

#[test]
fn two_runs_give_the_same_bits() {
    // Every variant where there is all that they differ in; elsewhere what is the default.
    let default = || vec![hybrid(Preset::Default, &[])];
    for (name, variants) in [("ring", variants()), ("water", default()), ("lights", default())] {
        for settings in variants {
            let scene = builtin(name);
            let frame = || Session::open().render(&scene, &settings, &everything(&scene, [64, 48]));
            let [first, second] = [frame(), frame()];
            for slot in INDIRECT {
                let differ = differing_bits(&first.slots[&slot], &second.slots[&slot]);
                assert!(differ.is_empty(), "{name}, {slot}: {differ:?}, {:?}", settings.options());
            }
            assert!(mean(&first.slots[&Slot::Diffuse]) > 0.0, "{name} has diffuse light to compare");
            assert!(name == "lights" || mean(&first.slots[&Slot::Caustics]) > 0.0, "{name} has caustics to compare");
        }
    }
}

/// A room with a ball-like box of this material in it.
fn room(material: Material, light: DVec3) -> Scene {
    let mut scene = Scene::empty("room");
    let white = scene.add_material(lambert([0.7; 3])).expect("a sound material");
    let thing = scene.add_material(material).expect("a sound material");
    place(&mut scene, box_faces([1.0; 3], [white; 6]), DAffine3::IDENTITY);
    let corners = [[-0.4, -0.5, -0.4], [-0.4, -0.3, 0.4], [0.4, -0.3, 0.4], [0.4, -0.5, -0.4]];
    place(&mut scene, vec![quad(corners, thing)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, light, DVec3::NEG_Y, [2.0; 3]);
    scene
}

fn inside() -> CameraView {
    view(DVec3::new(0.8, 0.5, 0.9), DVec3::new(0.0, -0.4, 0.0))
}

#[test]
fn no_pixel_outshines_the_truth_whatever_the_surface_and_the_light() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let on_the_wall = DVec3::new(0.2, 1.0, -0.1);
    let near_the_wall = DVec3::new(0.2, 0.999, -0.1);
    for roughness in [0.0, 0.05, 0.3, 1.0] {
        for light in [DVec3::new(0.1, 0.6, 0.2), near_the_wall, on_the_wall] {
            let scene = room(Material { metallic: 1.0, roughness, ..lambert([0.9, 0.8, 0.6]) }, light);
            let ask = Ask { bounces: Some(3), ..Ask::new([40, 32], 16, inside()) };
            let traced = tracer.trace(&scene, &ask);
            for settings in variants() {
                let frame = session.render(&scene, &settings, &request([40, 32], inside(), &Slot::ALL));
                let what = format!("roughness {roughness}, light at {light}, {:?}", settings.options());
                assert_sound(&what, &frame);
                // Where the truth is nearly dark, nothing is asked but that it stays below what is direct.
                let of = |slot| traced.slot(slot).iter().map(|pixel| pixel.max_element()).fold(0.0, f64::max);
                let most = INDIRECT.into_iter().chain([Slot::Direct]).map(of).fold(0.0, f64::max);
                for slot in INDIRECT {
                    let found = f64::from(maximum(&frame.slots[&slot]));
                    assert!(found <= 10.0 * most, "{what}: {found} in {slot}, at most {most} in truth");
                }
            }
        }
    }
}

#[test]
fn any_budget_and_any_size_will_do() {
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("its camera");
    for trace in ["bvh", "march", "lines"] {
        let mut renderer = session.renderer(&hybrid(Preset::Default, &[]));
        for budget in ["0", "1", "1000000"] {
            let settings =
                hybrid(Preset::Default, &[("photons.max", budget), ("photons.trace", trace), ("vpl.count", "32")]);
            renderer.set_settings(settings).expect("within their ranges");
            let frame = renderer.render(&scene, &request([32, 24], camera.clone(), &Slot::ALL)).expect("a frame");
            assert_sound(&format!("{budget} photons, {trace}"), &frame);
            assert_eq!(mean(&frame.slots[&Slot::Caustics]) > 0.0, budget != "0", "{budget} photons, {trace}");
        }
    }
    for settings in variants() {
        let mut renderer = session.renderer(&settings);
        for size in [[1, 1], [17, 5], [3, 33]] {
            let frame = renderer.render(&scene, &request(size, camera.clone(), &Slot::ALL)).expect("a frame");
            assert_sound(&format!("{size:?}"), &frame);
        }
    }
}

/// A renderer that was told to forget everything, or is asked for other images of the same frame, makes what a fresh one makes.
#[test]
fn what_is_made_again_is_the_same() {
    for settings in variants().into_iter().chain([hybrid(Preset::Default, &[])]) {
        let session = Session::open();
        let (scene, mut renderer) = (builtin("ring"), session.renderer(&settings));
        let all = everything(&scene, [64, 48]);
        let fresh = session.render(&scene, &settings, &all);
        let image_alone = FrameRequest { slots: Vec::new(), read_back: false, ..all.clone() };
        for round in 0..3 {
            renderer.invalidate();
            for timing in [Timing::Passes, Timing::Frame] {
                renderer.render(&scene, &FrameRequest { timing, ..image_alone.clone() }).expect("a frame");
            }
            let found = renderer.render(&scene, &all).expect("a frame");
            for slot in INDIRECT {
                let differ = differing_bits(&found.slots[&slot], &fresh.slots[&slot]);
                assert!(differ.is_empty(), "{slot}, round {round}: {differ:?}, {:?}", settings.options());
            }
        }
    }
}
