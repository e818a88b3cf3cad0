//! What need not run does not, says why, and changes nothing in the image.

use glam::DAffine3;

use super::scenes::{add_light, builtin, closed_box, floor, lambert, request, settings, view};
use super::session::Session;
use crate::renderer::{DiffuseMethod, Frame, FrameRequest, PassTiming, Renderer, Slot, Timing, ToneMap};
use crate::scene::{LightId, LightKind, MaterialId, NodeId, Scene};
use glam::DVec3;

fn everything(scene: &Scene) -> FrameRequest {
    let camera = scene.camera_view(None).expect("a view");
    FrameRequest { tonemap: Some(ToneMap::Aces), timing: Timing::Passes, ..request([40, 32], camera, &Slot::ALL) }
}

fn small(scene: &Scene, session: &Session) -> (Renderer, FrameRequest) {
    (session.renderer(&settings(&[("lights.resolution", "64"), ("rsm.vpls", "32")])), everything(scene))
}

/// Full names of the passes that ran.
fn ran(frame: &Frame) -> Vec<String> {
    let passes = frame.timings.passes.iter().filter(|pass| pass.skipped.is_none());
    passes.map(PassTiming::full_name).collect()
}

/// Why the pass, or all of the piece, did not run.
fn reason<'f>(frame: &'f Frame, name: &str) -> Option<&'f str> {
    let row = frame.timings.passes.iter().find(|pass| pass.full_name().starts_with(name)).expect("a pass of this name");
    row.skipped.as_deref()
}

fn any(names: &[String], piece: &str) -> bool {
    names.iter().any(|name| name.starts_with(piece))
}

#[test]
fn a_frame_in_which_nothing_changed_runs_nothing() {
    for name in ["cornell-point", "lights", "textured"] {
        let session = Session::open();
        let scene = builtin(name);
        let (mut renderer, request) = small(&scene, &session);
        let first = renderer.render(&scene, &request).expect("a frame");
        let second = renderer.render(&scene, &request).expect("a frame");
        assert!(ran(&first).len() >= 8, "{:?}", ran(&first));
        assert!(ran(&second).is_empty(), "{name}: {:?} ran again", ran(&second));
        for (before, after) in first.timings.passes.iter().zip(&second.timings.passes) {
            let reason = after.skipped.as_deref().expect("nothing ran");
            assert!(before.skipped.as_deref() == Some(reason) || reason.starts_with("unchanged"), "{after:?}");
            assert_eq!(after.ms, None);
        }
        assert_eq!((first.image, first.slots, first.display), (second.image, second.slots, second.display));
        renderer.invalidate();
        let third = renderer.render(&scene, &request).expect("a frame");
        let names = |frame: &Frame| frame.timings.passes.iter().map(|pass| pass.pass.clone()).collect::<Vec<_>>();
        assert_eq!(names(&third).len(), first.timings.passes.len());
        assert!(third.timings.passes.iter().zip(&first.timings.passes).all(|(a, b)| a.skipped == b.skipped));
    }
}

#[test]
fn a_moved_camera_leaves_the_lights_alone() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let (mut renderer, mut request) = small(&scene, &session);
    renderer.render(&scene, &request).expect("a frame");
    request.camera.world.translation += DVec3::new(0.05, 0.0, 0.0);
    let moved = renderer.render(&scene, &request).expect("a frame");
    let names = ran(&moved);
    for piece in ["gbuffer", "direct", "diffuse/rsm/gather", "compose", "tonemap"] {
        assert!(any(&names, piece), "{piece} is not among {names:?}");
    }
    for piece in ["light-views", "diffuse/rsm/tile-flux", "diffuse/rsm/scan", "diffuse/rsm/vpls"] {
        assert!(!any(&names, piece), "{piece} ran: {names:?}");
        let reason = reason(&moved, piece).expect("it did not run");
        assert!(reason.contains("lights") && !reason.contains("camera"), "{piece}: {reason}");
    }
    let fresh = session.render(&scene, renderer.settings(), &request);
    assert_eq!(fresh.image, moved.image);
}

#[test]
fn a_brighter_light_does_not_redraw_the_view() {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let (mut renderer, request) = small(&scene, &session);
    let before = renderer.render(&scene, &request).expect("a frame");
    let mut light = scene.lights()[0].clone();
    light.intensity = light.intensity.map(|channel| channel * 2.0);
    scene.set_light(LightId(0), light).expect("a sound light");
    let after = renderer.render(&scene, &request).expect("a frame");
    let names = ran(&after);
    assert!(!any(&names, "gbuffer"), "{names:?}");
    for piece in ["light-views/reflective", "diffuse/rsm/vpls", "diffuse/rsm/gather", "direct", "compose"] {
        assert!(any(&names, piece), "{piece} is not among {names:?}");
    }
    let sum = |frame: &Frame| -> f64 {
        let image = frame.image.as_ref().expect("it was asked for");
        image.pixels.iter().flatten().map(|&channel| f64::from(channel)).sum()
    };
    assert!((sum(&after) / sum(&before) - 2.0).abs() < 1e-4, "twice the power, twice the image");
    assert_eq!(session.render(&scene, renderer.settings(), &request).image, after.image);
}

#[test]
fn a_scene_does_not_pay_for_what_it_lacks() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let (mut renderer, request) = small(&scene, &session);
    let frame = renderer.render(&scene, &request).expect("a frame");
    assert_eq!(reason(&frame, "gbuffer/textured"), Some("no textured surface"));
    assert_eq!(reason(&frame, "light-views/reflective-textured"), Some("no textured surface"));

    let dark = closed_box(1.0, lambert([0.5; 3]));
    let frame = renderer.render(&dark, &everything(&dark)).expect("a frame");
    for piece in ["light-views", "direct", "diffuse/rsm"] {
        assert_eq!(reason(&frame, piece), Some("no light"));
    }
    assert!(frame.image.expect("it was asked for").pixels.iter().all(|pixel| *pixel == [0.0; 3]));

    let mut metal = floor(1.0, crate::scene::Material { metallic: 1.0, ..lambert([0.9; 3]) });
    add_light(&mut metal, LightKind::Point, DVec3::Y, DVec3::NEG_Y, [1.0; 3]);
    let request = FrameRequest { camera: view(DVec3::new(1.0, 1.0, 1.0), DVec3::ZERO), ..everything(&metal) };
    let frame = renderer.render(&metal, &request).expect("a frame");
    assert_eq!(reason(&frame, "diffuse/rsm"), Some("no diffuse surface"));
    assert!(any(&ran(&frame), "light-views/depth"), "shadows need no more than depth");
}

#[test]
fn what_nobody_asks_for_is_not_made() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let (mut renderer, whole) = small(&scene, &session);
    let request = FrameRequest { slots: vec![Slot::Direct], image: false, tonemap: None, ..whole.clone() };
    let frame = renderer.render(&scene, &request).expect("a frame");
    let mut names = ran(&frame);
    // Where the device rounds vertices coarsely.
    names.retain(|name| !name.ends_with("/drawn") && !name.ends_with("/plane-depth"));
    let looks = ["check/clear", "check/direct"];
    assert_eq!(names, [&["gbuffer/plain", "light-views/depth", "direct/shadow-map/shade"][..], &looks].concat());
    assert!(frame.image.is_none() && frame.display.is_none());

    let mut settings = renderer.settings().clone();
    settings.methods.diffuse = DiffuseMethod::None;
    renderer.set_settings(settings).expect("within their ranges");
    let frame = renderer.render(&scene, &whole).expect("a frame");
    assert!(!any(&ran(&frame), "diffuse"), "{:?}", ran(&frame));
    assert!(frame.slots[&Slot::Diffuse].pixels.iter().all(|pixel| *pixel == [0.0; 3]));
}

#[test]
fn every_pass_that_ran_is_timed() {
    let session = Session::open();
    let scene = builtin("textured");
    let (mut renderer, request) = small(&scene, &session);
    for _ in 0..2 {
        renderer.invalidate();
        let frame = renderer.render(&scene, &request).expect("a frame");
        let mut sum = 0.0;
        for pass in &frame.timings.passes {
            assert_eq!(pass.ms.is_some(), pass.skipped.is_none(), "{pass:?}");
            assert!(pass.ms.is_none_or(|ms| ms >= 0.0), "{pass:?}");
            sum += pass.ms.unwrap_or(0.0);
        }
        let rest = frame.timings.gpu_ms - sum;
        println!("passes {sum:.3} ms of {:.3} ms", frame.timings.gpu_ms);
        assert!(sum > 0.0 && rest >= 0.0, "{sum} ms of passes in a frame of {} ms", frame.timings.gpu_ms);
        assert!(frame.timings.host_ms >= frame.timings.gpu_ms);
    }
    let frame = renderer.render(&scene, &FrameRequest { timing: Timing::Frame, ..request }).expect("a frame");
    assert!(frame.timings.passes.iter().all(|pass| pass.ms.is_none()));
}

fn bits(frame: &Frame) -> Vec<u32> {
    frame.image.iter().flat_map(|image| image.pixels.iter().flatten().map(|channel| channel.to_bits())).collect()
}

/// After each change the renderer, which keeps what it can, agrees with one that starts afresh.
#[test]
fn an_edited_scene_is_as_a_fresh_one() {
    let session = Session::open();
    for name in ["lights", "textured", "cornell-panel"] {
        let mut scene = builtin(name);
        let (mut renderer, request) = small(&scene, &session);
        let mut last = bits(&renderer.render(&scene, &request).expect("a frame"));
        let bounds = scene.bounds().expect("it has triangles");
        let lift = |scene: &mut Scene, node: NodeId| {
            let local = DAffine3::from_translation(DVec3::new(0.02, 0.03, -0.01)) * scene.nodes()[node.0].local;
            scene.set_local_transform(node, local).expect("finite");
        };
        // Something that does not bear the scene's bounds, which fix the origin that a renderer works around.
        let inside = |node: &NodeId| {
            let mut copy = scene.clone();
            lift(&mut copy, *node);
            copy.bounds() == Some(bounds)
        };
        let inner =
            scene.instances().iter().map(|instance| instance.node).find(inside).expect("something stands inside");
        type Edit = fn(&mut Scene, NodeId);
        let edits: [(&str, Edit); 4] = [
            ("a moved object", lift),
            ("a changed material", |scene, _| {
                let mut material = scene.materials()[0].clone();
                material.base_color = [0.3, 0.9, 0.2, 1.0];
                scene.set_material(MaterialId(0), material).expect("sound");
            }),
            ("an added mesh", |scene, _| {
                let center = scene.bounds().expect("it has triangles").center();
                let id = scene.add_material(lambert([0.2, 0.4, 0.8])).expect("sound");
                let faces = super::scenes::box_faces([0.1; 3], [id; 6]);
                super::scenes::place(scene, faces, DAffine3::from_translation(center));
            }),
            ("a sky", |scene, _| scene.set_sky([0.1, 0.2, 0.3])),
        ];
        for (what, edit) in edits {
            edit(&mut scene, inner);
            assert_eq!(scene.bounds(), Some(bounds), "{name}, {what}");
            let kept = bits(&renderer.render(&scene, &request).expect("a frame"));
            let fresh = bits(&session.render(&scene, renderer.settings(), &request));
            assert!(kept == fresh, "{name}, {what}: not as a fresh renderer has it");
            assert!(kept != last || what == "a sky", "{name}, {what}: it shows");
            last = kept;
        }
    }
}
