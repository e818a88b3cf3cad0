//! What a diffuse method shows beside what paths show, what it lets into dark rooms, and which of its passes ran.

use super::scenes::{builtin, request};
use super::session::Session;
use crate::renderer::{Frame, PassTiming, Preset, Settings, Slot, Technique};
use crate::scene::{CameraView, Scene};

/// A small picture's slot `diffuse` and that of paths with so many scatterings: the ratio of their means, and the relative error of blocks of 8×8 pixels.
pub(crate) fn against_paths(
    session: &Session,
    scene: &Scene,
    camera: CameraView,
    settings: &Settings,
    (samples, bounces): (u32, Option<u32>),
) -> (f64, f64) {
    let asked = request([64, 48], camera, &[Slot::Diffuse]);
    let mut path = Settings::new(Technique::Path, Preset::Default);
    (path.path.spp, path.path.bounces) = (samples, bounces);
    let blocks = |frame: &Frame| {
        let pixels = &frame.slots[&Slot::Diffuse].pixels;
        let block = |index: usize| {
            let [row, column] = [8 * (index / 8), 8 * (index % 8)];
            let sum: f64 = (0..64).map(|p| f64::from(pixels[(row + p / 8) * 64 + column + p % 8][1])).sum();
            sum / 64.0
        };
        (0..48).map(block).collect::<Vec<f64>>()
    };
    let [found, expected] = [settings, &path].map(|settings| blocks(&session.render(scene, settings, &asked)));
    let mean = expected.iter().sum::<f64>() / 48.0;
    let squares: f64 = found.iter().zip(&expected).map(|(a, b)| (a - b).powi(2)).sum();
    (found.iter().sum::<f64>() / 48.0 / mean, (squares / 48.0).sqrt() / mean)
}

/// The mean of the slot `diffuse` in the dark rooms of the scene `leak` over that of the lit hall: behind a thin wall, behind a thick one, in a sealed room.
pub(crate) fn leaks(session: &Session, settings: &Settings, size: [u32; 2]) -> [f64; 3] {
    let scene = builtin("leak");
    let mean = |camera: &str| {
        let view = scene.camera_view(Some(camera)).expect("one of its cameras");
        let frame = session.render(&scene, settings, &request(size, view, &[Slot::Diffuse]));
        let pixels = &frame.slots[&Slot::Diffuse].pixels;
        pixels.iter().flatten().map(|&channel| f64::from(channel)).sum::<f64>() / (3 * pixels.len()) as f64
    };
    let lit = mean("lit");
    assert!(lit > 0.0);
    ["thin", "thick", "sealed"].map(|camera| mean(camera) / lit)
}

/// Full names of the passes of a piece that ran.
pub(crate) fn passes_run(frame: &Frame, piece: &str) -> Vec<String> {
    let running = frame.timings.passes.iter().filter(|pass| pass.skipped.is_none());
    running.map(PassTiming::full_name).filter(|name| name.starts_with(piece)).collect()
}
