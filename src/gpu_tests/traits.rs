//! What passes make otherwise for one driver than for another makes the same picture.

use super::scenes::builtin;
use super::session::Session;
use crate::renderer::{Frame, FrameRequest, Preset, Settings, Technique, Timing};
use crate::slot::Slot;
use crate::vulkan::DeviceTraits;

fn frame(session: &Session, settings: &[(&str, &str)], scene: &str, slot: Slot) -> Frame {
    let mut of = Settings::new(Technique::Hybrid, Preset::Default);
    settings.iter().for_each(|(key, value)| of.set(key, value).expect("a setting"));
    slots_of(session, &of, scene, &[slot])
}

fn slots_of(session: &Session, settings: &Settings, scene: &str, slots: &[Slot]) -> Frame {
    let scene = builtin(scene);
    let view = scene.camera_view(None).expect("a camera");
    let request = FrameRequest { slots: slots.to_vec(), timing: Timing::Passes, ..FrameRequest::new([48, 36], view) };
    session.render(&scene, settings, &request)
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

/// Texels have the same bits wherever they are read from.
#[test]
fn lists_in_storage_buffers_change_no_bit() {
    let settings = Settings::new(Technique::Hybrid, Preset::Default);
    let in_storage = Session::with_traits(|known| DeviceTraits { texels_in_storage: true, ..known });
    let [storage, usual] =
        [&in_storage, &Session::open()].map(|session| slots_of(session, &settings, "ring", &Slot::ALL));
    for (slot, image) in &storage.slots {
        assert!(image == &usual.slots[slot], "{slot} differs");
    }
    assert!(storage.slots[&Slot::Caustics].pixels.iter().any(|pixel| pixel[0] > 0.0));
}

/// Depths by the triangles' planes are where a fine rasteriser has them, and light and shadow with them, but along edges.
#[test]
fn depths_of_planes_are_those_of_a_fine_rasteriser() {
    let fine = Session::open();
    if fine.context.shared_device().traits().plane_depths {
        eprintln!("a coarse rasteriser: its depths are nothing to compare with");
        return;
    }
    let by_planes = Session::with_traits(|known| DeviceTraits { plane_depths: true, ..known });
    let settings = Settings::new(Technique::Direct, Preset::Default);
    // The second has views from emitters, which stand elsewhere then.
    for scene in ["cornell-point", "cornell-panel"] {
        let [planes, rasterised] =
            [&by_planes, &fine].map(|session| slots_of(session, &settings, scene, &[Slot::Direct]));
        let ran = |frame: &Frame| frame.timings.passes.iter().filter(|pass| pass.pass.ends_with("plane-depth")).count();
        assert_eq!((ran(&planes), ran(&rasterised)), (2, 0), "passes that draw depths by planes");
        let [planes, rasterised] = [&planes, &rasterised].map(|frame| &frame.slots[&Slot::Direct].pixels);
        let off =
            |(a, b): &(&[f32; 3], &[f32; 3])| (0..3).any(|channel| (a[channel] - b[channel]).abs() > 1e-3 * b[channel]);
        let differ = planes.iter().zip(rasterised).filter(off).count();
        println!("{scene}: {differ} of {} pixels differ", planes.len());
        assert!(differ * 100 <= planes.len(), "{scene}: {differ} of {} pixels differ", planes.len());
    }
}
