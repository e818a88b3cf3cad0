//! How still techniques stand while lights and the camera move in small steps: what changes from frame to frame where the truth does not.

use glam::DAffine3;

use super::path_probe::{Ask, Tracer};
use super::scenes::{builtin, request};
use super::session::Session;
use crate::renderer::{Preset, Settings, Slot, Technique};

/// Mean change of luminance from one frame to the next over the mean luminance, where the truth changes by less than 1 % of it.
fn flicker(frames: &[Vec<f64>], truth: &[Vec<f64>]) -> f64 {
    let mean = truth.iter().flatten().sum::<f64>() / truth.iter().flatten().count() as f64;
    let (mut change, mut count) = (0.0, 0_usize);
    for (pair, true_pair) in frames.windows(2).zip(truth.windows(2)) {
        for pixel in 0..pair[0].len() {
            if (true_pair[1][pixel] - true_pair[0][pixel]).abs() < 0.01 * mean {
                change += (pair[1][pixel] - pair[0][pixel]).abs();
                count += 1;
            }
        }
    }
    change / (count.max(1) as f64 * mean)
}

fn luminances(pixels: impl Iterator<Item = [f64; 3]>) -> Vec<f64> {
    pixels.map(|[red, green, blue]| 0.2126 * red + 0.7152 * green + 0.0722 * blue).collect()
}

/// Steps of the light of `animated` and of the camera by half a pixel; the truth takes the same samples in every frame, so that its noise
/// stands still too. The truth has the bounces of the technique.
#[test]
fn what_stands_still_hardly_flickers() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let size = [64, 48];
    let techniques = [
        (Technique::Hybrid, Some(1), &[("lights.resolution", "256")][..]),
        (Technique::Particles, None, &[("particles.count", "20000")]),
    ];
    for (technique, bounces, changes) in techniques {
        for moves in ["light", "camera"] {
            let mut scene = builtin(if moves == "light" { "animated" } else { "cornell-point" });
            let mut settings = Settings::new(technique, Preset::Default);
            for (key, value) in changes {
                settings.set(key, value).expect("a setting and its value");
            }
            let mut renderer = session.renderer(&settings);
            let (mut frames, mut truth) = (Vec::new(), Vec::new());
            for step in 0..4 {
                if moves == "light" {
                    scene.set_frame(step);
                }
                let mut camera = scene.camera_view(None).expect("its camera");
                if moves == "camera" {
                    // A pixel is about 1/60 rad wide.
                    camera.world *= DAffine3::from_rotation_y(f64::from(step) * 0.5 / 60.0 * 0.9);
                }
                let asked = request(size, camera.clone(), &[Slot::Diffuse]);
                let frame = renderer.render(&scene, &asked).expect("a frame");
                let image = &frame.slots[&Slot::Diffuse];
                frames.push(luminances(image.pixels.iter().map(|pixel| pixel.map(f64::from))));
                let traced = tracer.trace(&scene, &Ask { bounces, ..Ask::new(size, 32, camera) });
                truth.push(luminances(traced.slot(Slot::Diffuse).iter().map(|pixel| pixel.to_array())));
            }
            let [found, least] = [flicker(&frames, &truth), flicker(&truth, &truth)];
            let name = technique.name();
            println!("{name}, {moves}: flicker {:.3} %, of the truth {:.3} %", 100.0 * found, 100.0 * least);
            assert!(found < 0.03, "{name}, {moves}: {found}");
        }
    }
}
