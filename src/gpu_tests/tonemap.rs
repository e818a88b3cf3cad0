//! Display values of the device and of the host are the same to a level.

use super::scenes::{builtin, closed_box, lambert, request, settings, view};
use super::session::Session;
use crate::image::tone_map;
use crate::renderer::{FrameRequest, ToneMap};
use crate::scene::Scene;
use glam::DVec3;

const CURVES: [ToneMap; 3] = [ToneMap::Linear, ToneMap::Aces, ToneMap::Drago];

/// Largest difference in levels between the device's values and the host's, and the number of levels in use.
fn compare(session: &Session, scene: &Scene, request: &FrameRequest, curve: ToneMap) -> (u8, usize) {
    let request = FrameRequest { tonemap: Some(curve), ..request.clone() };
    let frame = session.render(scene, &settings(&[("lights.resolution", "128")]), &request);
    let host = tone_map(frame.image.as_ref().expect("it was asked for"), curve);
    let device = frame.display.expect("it was asked for");
    let levels: std::collections::BTreeSet<u8> = host.iter().map(|pixel| pixel[1]).collect();
    let apart = device.iter().zip(&host).flat_map(|(a, b)| (0..3).map(|i| a[i].abs_diff(b[i])));
    (apart.max().unwrap_or(0), levels.len())
}

#[test]
fn device_and_host_show_the_same() {
    let session = Session::open();
    for name in ["cornell-spot", "lights", "ring"] {
        let scene = builtin(name);
        // More than one block of pixels, and the last one not full.
        let request = request([97, 61], scene.camera_view(None).expect("its camera"), &[]);
        for curve in CURVES {
            let (worst, levels) = compare(&session, &scene, &request, curve);
            println!("{name}, {curve:?}: {worst} levels apart, {levels} levels in use");
            assert!(worst <= 1 && levels > 40, "{name}, {curve:?}: {worst} levels apart, {levels} in use");
        }
    }
}

#[test]
fn a_black_image_stays_black() {
    let session = Session::open();
    let scene = closed_box(1.0, lambert([0.5; 3]));
    for curve in CURVES {
        let request = FrameRequest {
            tonemap: Some(curve),
            ..request([33, 9], view(DVec3::new(0.5, 0.5, 0.5), DVec3::ZERO), &[])
        };
        let frame = session.render(&scene, &settings(&[]), &request);
        assert_eq!(frame.display, Some(vec![[0; 3]; 297]), "{curve:?}");
    }
}
