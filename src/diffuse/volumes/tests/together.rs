//! Groups of lights that share a visibility where a cache sees them small.

use super::{counted, difference};
use crate::gpu_tests::against_paths::against_paths;
use crate::gpu_tests::scenes::{builtin, request, settings_of};
use crate::gpu_tests::session::Session;
use crate::renderer::{Frame, FrameRequest, Slot, Technique, Timing};

fn rendered(session: &Session, name: &str, changes: &[(&str, &str)]) -> Frame {
    let scene = builtin(name);
    let camera = scene.camera_view(None).expect("its camera");
    let asked = FrameRequest { timing: Timing::Passes, ..request([64, 48], camera, &[Slot::Diffuse]) };
    session.render(&scene, &settings_of(Technique::Volumes, changes), &asked)
}

/// With an aperture that no group is small enough for each has its own visibility, by the same rays.
#[test]
fn groups_alone_are_what_they_are_without_an_aperture() {
    let session = Session::open();
    for visibility in ["rays", "cones"] {
        let alike = [("volumes.visibility", visibility), ("volumes.lights", "32"), ("volumes.voxels", "64")];
        let alone = rendered(&session, "cornell-point", &alike);
        let tiny = rendered(&session, "cornell-point", &[&alike[..], &[("volumes.aperture", "0.0000001")]].concat());
        let asked = |frame: &Frame| counted(frame, "diffuse/volumes/light", visibility);
        assert_eq!(asked(&alone), asked(&tiny));
        assert!(asked(&alone) > 1000);
        assert_eq!(alone.slots, tiny.slots, "{visibility}: bit by bit");
    }
}

/// A wider aperture takes fewer rays, and as few of them go further than where all groups are coarser alike.
#[test]
fn small_groups_share_rays() {
    let session = Session::open();
    let changes = |lod: &'static str, aperture: &'static str| [("volumes.lod", lod), ("volumes.aperture", aperture)];
    let rays = |frame: &Frame| counted(frame, "diffuse/volumes/light", "rays");
    let fine = rendered(&session, "cornell-point", &changes("0", "0"));
    let [narrow, wide] = ["12", "30"].map(|aperture| rendered(&session, "cornell-point", &changes("0", aperture)));
    let [of_fine, of_narrow, of_wide] = [&fine, &narrow, &wide].map(rays);
    let [by_narrow, by_wide] = [&narrow, &wide].map(|frame| difference(frame, &fine));
    println!("{of_fine} rays; 12°: {of_narrow}, {by_narrow:.4}; 30°: {of_wide}, {by_wide:.4}");
    assert!(2 * of_narrow < of_fine && 2 * of_wide < of_narrow);
    assert!(by_narrow < 0.01 && by_wide < 0.03);
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let settings = settings_of(Technique::Volumes, &changes("0", "12"));
    let (ratio, error) = against_paths(&session, &scene, camera, &settings, (256, Some(1)));
    println!("against paths: mean {ratio:.3}, blocks {error:.3}");
    assert!((ratio - 1.0).abs() < 0.03 && error < 0.06, "{ratio} {error}");
}
