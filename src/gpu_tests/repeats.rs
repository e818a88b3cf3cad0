//! Two runs give the same bits: another renderer on another device handle, and the same one after forgetting everything.

use super::scenes::{builtin, request, settings};
use super::session::Session;
use crate::renderer::{ColorImage, Frame, FrameRequest, Preset, Settings, Slot, Technique, ToneMap};
use crate::scene::Scene;

fn bits(image: &ColorImage) -> Vec<u32> {
    image.pixels.iter().flatten().map(|channel| channel.to_bits()).collect()
}

/// Bit for bit, NaN included.
fn assert_same(what: &str, first: &Frame, second: &Frame) {
    let image = |frame: &Frame| bits(frame.image.as_ref().expect("it was asked for"));
    assert_eq!(image(first), image(second), "{what}: the image");
    for (slot, image) in &first.slots {
        assert_eq!(bits(image), bits(&second.slots[slot]), "{what}: the slot {slot}");
    }
    assert_eq!(first.display, second.display, "{what}: the display values");
}

fn everything(scene: &Scene) -> FrameRequest {
    let camera = scene.camera_view(None).expect("a view");
    FrameRequest { tonemap: Some(ToneMap::Drago), ..request([72, 40], camera, &Slot::ALL) }
}

#[test]
fn two_runs_give_the_same_bits() {
    let settings = settings(&[("lights.resolution", "256")]);
    for name in ["cornell-point", "cornell-spot", "cornell-panel", "textured", "lights", "sky"] {
        let scene = || match name {
            "sky" => {
                let mut scene = builtin("plane");
                scene.set_sky([0.4, 0.5, 0.9]);
                scene
            }
            name => builtin(name),
        };
        let session = Session::open();
        let first_scene = scene();
        let mut renderer = session.renderer(&settings);
        let first = renderer.render(&first_scene, &everything(&first_scene)).expect("a frame");
        renderer.invalidate();
        let again = renderer.render(&first_scene, &everything(&first_scene)).expect("a frame");
        assert!(
            again
                .timings
                .passes
                .iter()
                .all(|pass| { pass.skipped.as_ref().is_none_or(|reason| !reason.starts_with("unchanged")) })
        );
        assert_same(name, &first, &again);
        let other = Session::open();
        let second_scene = scene();
        assert_same(name, &first, &other.render(&second_scene, &settings, &everything(&second_scene)));
        let lit = first.slots[&Slot::Diffuse].pixels.iter().any(|pixel| pixel[0] > 0.0);
        assert!(lit, "{name} has diffuse light to compare");
    }
}

/// Whatever memory is gone, the frame is made again to the bit: of one resource after the other, on every technique.
#[test]
fn a_resource_that_is_gone_is_made_again() {
    let session = Session::open();
    let small = |technique: Technique, changes: &[(&str, &str)]| {
        let mut settings = Settings::new(technique, Preset::Draft);
        let all = [("lights.resolution", "64"), ("rsm.vpls", "64"), ("vpl.count", "48"), ("photons.max", "300")];
        for (key, value) in all.iter().chain(changes) {
            settings.set(key, value).expect("within its range");
        }
        settings
    };
    let lists = [("photons.trace", "march"), ("photons.resolution", "32"), ("vpl.visibility", "ism")];
    let mut ambient = small(Technique::Direct, &[("ambient.rays", "4")]);
    ambient.methods.set(Slot::Diffuse, "ambient").expect("a method");
    let mut points = small(Technique::Direct, &[("points.photons", "300"), ("points.frames", "3")]);
    points.methods.set(Slot::Caustics, "points").expect("a method");
    let mut mirrors = small(Technique::Hybrid, &[]);
    mirrors.methods.set(Slot::Specular, "trace").expect("a method");
    let mut cubemap = small(Technique::Direct, &[("cubemap.resolution", "32")]);
    cubemap.methods.set(Slot::Specular, "cubemap").expect("a method");
    let hemicube = [("lightmaps.gather", "hemicube"), ("lightmaps.settle", "always"), ("lightmaps.count", "200")];
    let mut hemicubes = small(Technique::Direct, &hemicube);
    hemicubes.methods.set(Slot::Diffuse, "lightmaps").expect("a method");
    let all = [
        ("cornell-glossy", cubemap),
        ("textured", hemicubes),
        ("textured", small(Technique::Rsm, &[])),
        ("textured", small(Technique::Volumes, &[("volumes.lights", "16"), ("volumes.weights", "rays")])),
        ("textured", small(Technique::Volumes, &[("volumes.bounces", "3"), ("volumes.samples", "64")])),
        ("ring", small(Technique::Hybrid, &[("photons.downscale", "1")])),
        ("ring", small(Technique::Hybrid, &lists)),
        ("cornell-point", small(Technique::Path, &[("path.spp", "1")])),
        ("cornell-point", ambient),
        ("ring", points),
        ("ring", mirrors.clone()),
        ("ring", mirrors.with(|mirrors| mirrors.trace.supersamples = 4)),
    ];
    for (name, settings) in all {
        let scene = builtin(name);
        let camera = scene.camera_view(None).expect("a view");
        let request = request([24, 16], camera, &Slot::ALL);
        let mut renderer = session.renderer(&settings);
        let first = renderer.render(&scene, &request).expect("a frame");
        let names = renderer.store.names();
        assert!(names.len() > 3, "{names:?}");
        for gone in names {
            renderer.store.evict(&gone);
            let again = renderer.render(&scene, &request).expect("a frame");
            assert_same(&format!("{name} without {gone}"), &first, &again);
        }
    }
}
