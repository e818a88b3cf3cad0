//! What caches hold: colour in fewer bands than luminance; and where they lie.

use super::{counted, difference};
use crate::gpu_tests::against_paths::against_paths;
use crate::gpu_tests::scenes::{add_light, builtin, closed_box, lambert, request, settings_of, view};
use crate::gpu_tests::session::Session;
use crate::renderer::{Frame, FrameRequest, Slot, Technique, Timing};
use crate::scene::{CameraView, LightKind, Scene};
use glam::DVec3;

fn rendered(session: &Session, scene: &Scene, camera: &CameraView, changes: &[(&str, &str)]) -> Frame {
    let asked = FrameRequest { timing: Timing::Passes, ..request([64, 48], camera.clone(), &[Slot::Diffuse]) };
    session.render(scene, &settings_of(Technique::Volumes, changes), &asked)
}

fn bytes_of_light(frame: &Frame) -> u64 {
    frame.timings.memory_parts.values().filter_map(|parts| parts.get("volumes.light")).sum()
}

/// Where all light is of one colour, its luminance is all that there is to know of the upper bands.
#[test]
fn light_of_one_colour_loses_nothing_by_fewer_bands_of_colour() {
    let session = Session::open();
    let mut scene = closed_box(1.0, lambert([0.7; 3]));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.5, -0.2), DVec3::NEG_Y, [3.0, 1.0, 0.25]);
    let camera = view(DVec3::new(0.8, 0.3, 0.9), DVec3::new(-0.2, -0.3, 0.0));
    for (bands, chromas) in [("3", &["1", "2"][..]), ("2", &["1"])] {
        let full = rendered(&session, &scene, &camera, &[("volumes.bands", bands)]);
        for chroma in chromas {
            let less = rendered(&session, &scene, &camera, &[("volumes.bands", bands), ("volumes.chroma", chroma)]);
            let found = difference(&less, &full);
            println!("{bands} bands, {chroma} of colour: {found:.1e}");
            assert!(found < 1e-4, "{bands} bands, {chroma} of colour: {found}");
        }
    }
}

#[test]
fn fewer_bands_of_colour_take_less_memory_and_little_off_the_picture() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let full = rendered(&session, &scene, &camera, &[]);
    for (chroma, numbers, bound) in [("2", 20, 0.03), ("1", 12, 0.1)] {
        let changes = [("volumes.chroma", chroma)];
        let less = rendered(&session, &scene, &camera, &changes);
        let found = difference(&less, &full);
        let settings = settings_of(Technique::Volumes, &changes);
        let (ratio, error) = against_paths(&session, &scene, camera.clone(), &settings, (256, Some(1)));
        println!("{chroma} bands: {found:.4} of the full picture, mean {ratio:.3}, blocks {error:.3}");
        assert_eq!(28 * bytes_of_light(&less), numbers * bytes_of_light(&full), "numbers of each cache");
        assert!(found > 1e-4 && found < bound, "{chroma} bands: {found}");
        assert!((ratio - 1.0).abs() < 0.03 && error < 0.08, "{chroma} bands: {ratio} {error}");
    }
}

#[test]
fn caches_off_their_nodes_give_about_the_same_light() {
    let session = Session::open();
    for name in ["cornell-point", "corridor"] {
        let scene = builtin(name);
        let camera = scene.camera_view(None).expect("its camera");
        let changes = [("volumes.jitter", "0.25")];
        let [even, off, again] =
            [&[][..], &changes, &changes].map(|changes| rendered(&session, &scene, &camera, changes));
        assert_eq!(counted(&off, "diffuse/volumes/apply", "missing"), 0);
        assert_eq!(off.slots, again.slots, "bit by bit");
        assert_ne!(off.slots, even.slots);
        let settings = settings_of(Technique::Volumes, &changes);
        let (ratio, error) = against_paths(&session, &scene, camera, &settings, (256, Some(1)));
        println!("{name}: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.03 && error < 0.08, "{name}: {ratio} {error}");
    }
}
