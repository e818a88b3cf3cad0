//! What passes make otherwise for one driver than for another makes the same picture.

use super::scenes::builtin;
use super::session::Session;
use crate::renderer::{Frame, FrameRequest, Preset, Settings, Technique, Timing};
use crate::slot::Slot;
use crate::vulkan::DeviceTraits;

fn frame(session: &Session, settings: &[(&str, &str)], scene: &str, slot: Slot) -> Frame {
    let mut of = Settings::new(Technique::Hybrid, Preset::Default);
    settings.iter().for_each(|(key, value)| of.set(key, value).expect("a setting"));
    let scene = builtin(scene);
    let view = scene.camera_view(None).expect("a camera");
    let request = FrameRequest { slots: vec![slot], timing: Timing::Passes, ..FrameRequest::new([48, 36], view) };
    session.render(&scene, &of, &request)
}

/// Lanes that are not known to run in step share their work through the group's memory, or each do it alone.
#[test]
fn pictures_do_not_depend_on_how_subgroups_run() {
    let in_step = Session::open();
    let apart = Session::with_traits(|known| DeviceTraits { lanes_in_step: false, ..known });
    let ism = [("vpl.visibility", "ism"), ("vpl.count", "64")];
    let crowded = [("photons.splat", "tiles"), ("photons.max", "60000")];
    for (settings, scene, slot) in [(&ism, "leak", Slot::Diffuse), (&crowded, "ring", Slot::Caustics)] {
        let [one, other] = [&in_step, &apart].map(|session| frame(session, settings, scene, slot));
        assert!(one.slots[&slot].pixels.iter().any(|pixel| pixel[0] > 0.0), "{scene} is lit");
        assert_eq!(one.slots[&slot].pixels, other.slots[&slot].pixels, "{scene}");
    }
}

/// A GPU gathers in one pass what a driver with short loops takes several for.
#[test]
fn pictures_do_not_depend_on_how_long_loops_may_be() {
    let short = Session::with_traits(|known| DeviceTraits { loop_steps: 65_535, ..known });
    let long = Session::with_traits(|known| DeviceTraits { loop_steps: DeviceTraits::GPU.loop_steps, ..known });
    let settings = [("vpl.visibility", "traced"), ("vpl.count", "250")];
    let [one, other] = [&short, &long].map(|session| frame(session, &settings, "cornell-point", Slot::Diffuse));
    let gathers =
        |frame: &Frame| frame.timings.passes.iter().filter(|pass| pass.pass.starts_with("gather/pixels")).count();
    assert_eq!((gathers(&one), gathers(&other)), (3, 1));
    for (one, other) in one.slots[&Slot::Diffuse].pixels.iter().zip(&other.slots[&Slot::Diffuse].pixels) {
        for (one, other) in one.iter().zip(other) {
            assert!((one - other).abs() <= 1e-5 * other.abs(), "{one} of several passes, {other} of one");
        }
    }
}
