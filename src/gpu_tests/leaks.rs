//! Light through walls: what direct light brings into the dark rooms of the built-in scene `leak`, whose true radiance is 0.

use super::scenes::{builtin, request, settings};
use super::session::Session;
use crate::renderer::Slot;

/// The mean of the slot `direct` in the view of a camera.
fn direct_light(session: &Session, camera: &str) -> f64 {
    let scene = builtin("leak");
    let view = scene.camera_view(Some(camera)).expect("one of its cameras");
    let frame = session.render(&scene, &settings(&[]), &request([128, 96], view, &[Slot::Direct]));
    let pixels = &frame.slots[&Slot::Direct].pixels;
    pixels.iter().flatten().map(|&channel| f64::from(channel)).sum::<f64>() / (3 * pixels.len()) as f64
}

#[test]
fn direct_light_stays_out_of_dark_rooms() {
    let session = Session::open();
    let lit = direct_light(&session, "lit");
    assert!(lit > 0.1, "the lit hall");
    for (camera, bound) in [("thin", 1e-3), ("thick", 0.0), ("sealed", 0.0)] {
        let leak = direct_light(&session, camera) / lit;
        println!("{camera}: {leak:.1e} of the lit hall's light");
        assert!(leak <= bound, "{camera}: {leak:.1e}");
    }
}
