//! The light that a method keeps on surfaces, off the device: for whoever writes it down.

use glam::DVec3;

use super::declare::{Prepared, declare};
use super::frame::FrameRequest;
use super::render::Renderer;
use crate::frame::rays::Lightmap;
use crate::frame::stored_light::StoredLight;
use crate::graph::bindings::BufferRef;
use crate::graph::{Graph, Timing};
use crate::method::Error;
use crate::scene::{CameraView, Projection, Scene};
use crate::slot::Slot;

/// What each texel of a scene's light maps receives, W/m², by its way ([`StoredLight`]).
pub(crate) struct SurfaceLight {
    /// As in [`StoredLight`].
    pub(crate) detail: u32,
    /// Whether the texel lies in the open.
    pub(crate) valid: Vec<bool>,
    pub(crate) direct: Vec<[f32; 3]>,
    pub(crate) caustics: Vec<[f32; 3]>,
    pub(crate) arrivals: Vec<[f32; 3]>,
    pub(crate) diffuse: Vec<[f32; 3]>,
}

impl Renderer {
    /// What the settings' method of the slot `diffuse` keeps of the scene as it is now, on `detail` times as many texels a side; `None` if it keeps nothing or has
    /// nothing to do. `admit` is asked before the device works, which may take long.
    ///
    /// # Errors
    /// As [`Renderer::render`], and those of `admit`.
    pub(crate) fn surface_light<E: From<Error>>(
        &mut self,
        scene: &Scene,
        detail: u32,
        mut admit: impl FnMut(&Lightmap) -> Result<(), E>,
    ) -> Result<Option<SurfaceLight>, E> {
        // No pixel is looked at.
        let projection = Projection::Perspective { vertical_fov: 1.0, aspect: None, near: 1.0 };
        let camera = CameraView::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection);
        let request = FrameRequest::new([1, 1], camera).with(|request| {
            (request.slots, request.image, request.stored_light) = (vec![Slot::Diffuse], false, Some(detail));
        });
        loop {
            let traced = self.prepare(scene, &request)?;
            let data = self.data.as_ref().expect("prepared above");
            let prepared = Prepared { scene, data, lights: &self.lights, traced: traced.as_deref(), means: None };
            let mut graph = Graph::new(&mut self.store);
            let Some(stored) = declare(&mut graph, &prepared, &self.settings, &request)?.stored_light else {
                return Ok(None);
            };
            let StoredLight { map, detail, valid, direct, caustics, arrivals, diffuse } = &*stored;
            admit(map)?;
            let valid = graph.read_back_buffer(*valid);
            let mut read = |buffer: &BufferRef<[f32; 4]>| graph.read_back_buffer(*buffer);
            let (direct, diffuse, caustics) = (read(direct), read(diffuse), caustics.as_ref().map(&mut read));
            let arrivals = arrivals.as_ref().map(|[lamps, sky]| [read(lamps), read(sky)]);
            let mut executed = graph.run(Timing::Frame).map_err(Error::from)?;
            if !executed.outgrown.is_empty() {
                continue;
            }
            let valid: Vec<bool> = executed.take(valid).chunks_exact(4).map(|valid| word(valid) != 0).collect();
            let nothing = || vec![[0.0; 3]; valid.len()];
            let mut floats = |read_back| floats(&executed.take(read_back));
            let arrivals = arrivals.map(|[lamps, sky]| {
                let both = floats(lamps).into_iter().zip(floats(sky));
                both.map(|(lamps, one)| [0, 1, 2].map(|it| lamps[it] + scene.sky()[it] * one[it])).collect()
            });
            return Ok(Some(SurfaceLight {
                detail: *detail,
                direct: floats(direct),
                diffuse: floats(diffuse),
                caustics: caustics.map_or_else(nothing, &mut floats),
                arrivals: arrivals.unwrap_or_else(nothing),
                valid,
            }));
        }
    }
}

fn word(bytes: &[u8]) -> u32 {
    u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

/// Of four a texel.
fn floats(bytes: &[u8]) -> Vec<[f32; 3]> {
    let float = |texel: &[u8], channel: usize| f32::from_bits(word(&texel[4 * channel..]));
    bytes.chunks_exact(16).map(|texel| [0, 1, 2].map(|channel| float(texel, channel))).collect()
}
