//! `radiance-maps` over frames: maps are means of what each frame drew.

use glam::DVec3;

use super::radiance_maps::{SIZE, lit_patch, set};
use super::scenes::request;
use super::session::Session;
use crate::renderer::{ColorImage, FrameRequest, Slot};
use crate::scene::Scene;

fn radiances(image: &ColorImage) -> Vec<DVec3> {
    image.pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).collect()
}

/// Of the first picture, the difference of the second over the root mean square.
fn apart(expected: &[DVec3], found: &[DVec3]) -> f64 {
    let squares: f64 = expected.iter().map(|pixel| pixel.length_squared()).sum();
    let differences: f64 = expected.iter().zip(found).map(|(a, b)| (*a - *b).length_squared()).sum();
    (differences / squares).sqrt()
}

/// What is kept is the mean of what each frame drew.
#[test]
fn maps_over_frames_are_means_of_what_each_drew() {
    let session = Session::open();
    let (scene, camera) = lit_patch();
    let settings = set(&[
        ("radiance_maps.frames", "4"),
        ("radiance_maps.fill", "none"),
        ("volumes.lights", "16"),
        ("volumes.visibility", "none"),
    ]);
    let asked = |index| FrameRequest { index, image: false, ..request(SIZE, camera.clone(), &[Slot::Specular]) };
    let alone =
        |scene: &Scene, index| radiances(&session.render(scene, &settings, &asked(index)).slots[&Slot::Specular]);
    let mut renderer = session.renderer(&settings);
    let mut mean = alone(&scene, 0);
    for index in 0..4_u32 {
        let drawn = alone(&scene, index);
        for (mean, drawn) in mean.iter_mut().zip(&drawn) {
            *mean += (*drawn - *mean) / f64::from(index + 1);
        }
        let frame = renderer.render(&scene, &asked(index)).expect("a frame");
        let error = apart(&mean, &radiances(&frame.slots[&Slot::Specular]));
        println!("frame {index}: {error:.1e} from the mean, which is {:.2} from this one's", apart(&mean, &drawn));
        assert!(error < 2e-3, "frame {index}: {error}");
        assert!(index == 0 || apart(&mean, &drawn) > 0.005, "frames draw other lights");
    }
}
