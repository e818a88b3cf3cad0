//! Light in rooms that none gets into: what a technique lets through walls.
//!
//! A scene names the cameras that stand in such rooms ([`Scene::dark_cameras`]). What arrives at the surfaces that one of them shows is what they send on over what they reflect,
//! Σ π L/ρ dA over its pixels, W; of surfaces without a diffuse lobe Σ π L dA. Over the power of all lights it is a leak.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::report::Leaks;
use crate::renderer::{ColorImage, FrameRequest, Renderer, Slot};
use crate::scene::{CameraView, Scene};

/// Width and height of the pictures, whatever those of the bench have.
const SIZE: [u32; 2] = [128, 96];
/// Albedos below this are none.
const LEAST_ALBEDO: f64 = 0.01;

/// Why there are none.
type Stopped = Box<dyn std::error::Error>;

/// The leaks of the renderer's settings; `None` if the scene has no dark room. `lead_in`: frames before the one that counts.
pub(crate) fn leaks(renderer: &mut Renderer, scene: &Scene, lead_in: u32) -> Result<Option<Leaks>, Stopped> {
    if scene.dark_cameras.is_empty() {
        return Ok(None);
    }
    let emitted_w = scene.emitted_power().into_iter().sum::<f64>();
    let mut rooms = BTreeMap::new();
    for camera in &scene.dark_cameras {
        let arrived = arrived(renderer, scene, &scene.camera_view(Some(camera))?, lead_in)?;
        let shares =
            arrived.into_iter().map(|(slot, power)| (slot, if emitted_w > 0.0 { power / emitted_w } else { 0.0 }));
        rooms.insert(camera.clone(), shares.collect());
    }
    Ok(Some(Leaks { emitted_w, rooms }))
}

/// The power that arrives at the surfaces that a view shows, W, by the slot that it is seen in.
pub(crate) fn arrived(
    renderer: &mut Renderer,
    scene: &Scene,
    view: &CameraView,
    lead_in: u32,
) -> Result<BTreeMap<Slot, f64>, Stopped> {
    let methods = &renderer.settings().methods;
    let slots = Slot::ALL.into_iter().filter(|&slot| slot != Slot::Emission && methods.fills(slot)).collect();
    let request = FrameRequest { slots, read_back: true, ..FrameRequest::new(SIZE, view.clone()) };
    for _ in 0..lead_in {
        renderer.render(scene, &request)?;
    }
    let frame = renderer.render(scene, &request)?;
    let seen = scene.seen_surfaces(view, SIZE);
    let of_slot = |image: &ColorImage| {
        let pixels = image.pixels.iter().zip(&seen).filter_map(|(pixel, seen)| Some((pixel, seen.as_ref()?)));
        let arriving = pixels.map(|(pixel, seen)| {
            let of_channel = |channel: usize| {
                let albedo = f64::from(seen.albedo[channel]);
                f64::from(pixel[channel]) / if albedo > LEAST_ALBEDO { albedo } else { 1.0 }
            };
            PI * seen.area * (0..3).map(of_channel).sum::<f64>()
        });
        arriving.sum::<f64>()
    };
    Ok(frame.slots.iter().map(|(&slot, image)| (slot, of_slot(image))).collect())
}
