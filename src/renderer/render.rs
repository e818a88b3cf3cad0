//! The renderer: a scene and a request in, a frame out. Keeps on the device what still holds between frames.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use super::context::Context;
use super::declare::{Prepared, declare, sends_rays};
use super::frame::{Frame, FrameRequest};
use super::settings::Settings;
use super::traced_paths::TracedPaths;
use crate::frame::light_set::LightSet;
use crate::frame::rays::{TracedScene, surfaces_key, traced_key};
use crate::frame::scene_data::SceneData;
use crate::graph::{FrameTimings, Graph, GraphDescription, Outgrown, Store};
use crate::image::ColorImage;
use crate::method::Error;
use crate::scene::Scene;
use crate::slot::Slot;
use crate::vulkan::{Device, VulkanError};

/// Makes frames with one set of settings on one device.
///
/// What a scene, its lights and the camera leave unchanged from one frame to the next is not made again. Any scene may be
/// rendered at any time; changing between scenes uploads them anew.
pub struct Renderer {
    pub(super) settings: Settings,
    data: Option<SceneData>,
    lights: LightSet,
    /// Held while some method sends rays.
    traced: Option<Arc<TracedScene>>,
    store: Store,
    pub(super) paths: Option<TracedPaths>,
}

impl Renderer {
    /// A renderer on `context`'s device.
    ///
    /// # Errors
    /// If the device has no memory left.
    pub fn new(context: &Context, settings: Settings) -> Result<Renderer, Error> {
        let store = Store::new(context.shared_device())?;
        Ok(Renderer { settings, data: None, lights: LightSet::default(), traced: None, store, paths: None })
    }

    /// The settings of the frames to come.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Replaces the settings.
    pub fn set_settings(&mut self, settings: Settings) {
        self.settings = settings;
    }

    /// Forgets all results, so that the next frame makes everything anew; for timings of whole frames. The scene stays on
    /// the device.
    pub fn invalidate(&mut self) {
        self.store.invalidate();
        if let Some(paths) = &mut self.paths {
            paths.invalidate();
        }
    }

    /// Makes a frame of the scene as it is now.
    ///
    /// # Errors
    /// A frame without pixels or beyond the device's limits, exhausted memory, a lost device. The last two name the last
    /// pass that finished.
    pub fn render(&mut self, scene: &Scene, request: &FrameRequest) -> Result<Frame, Error> {
        self.check_size(request)?;
        let traces_paths = self.settings.methods.traces_paths();
        let facts = scene.facts();
        if !traces_paths && !Slot::ALL.into_iter().any(|slot| sends_rays(&self.settings, &facts, slot)) {
            self.release_traced_scene();
        }
        if traces_paths { self.render_paths(scene, request) } else { self.draw(scene, request) }
    }

    pub(super) fn device(&self) -> &Arc<Device> {
        self.store.device()
    }

    /// A frame whose methods are all passes of one graph. If some buffer could not know how much it had to hold and was too small, the
    /// frame is made again with a larger one.
    pub(super) fn draw(&mut self, scene: &Scene, request: &FrameRequest) -> Result<Frame, Error> {
        loop {
            let (frame, outgrown) = self.draw_once(scene, request)?;
            if outgrown.is_empty() {
                return Ok(frame);
            }
            for (name, [held, needed]) in outgrown {
                tracing::info!("{name} held {held} elements of {needed}; the frame is made again with more");
            }
        }
    }

    fn draw_once(&mut self, scene: &Scene, request: &FrameRequest) -> Result<(Frame, Vec<Outgrown>), Error> {
        let start = Instant::now();
        let traced = self.prepare(scene, request)?;
        let upload_ms = start.elapsed().as_secs_f64() * 1e3;
        let data = self.data.as_ref().expect("prepared above");
        let prepared = Prepared { scene, data, lights: &self.lights, traced: traced.as_deref() };
        let mut graph = Graph::new(&mut self.store);
        let declared = declare(&mut graph, &prepared, &self.settings, request);

        let mut slots = Vec::new();
        for &slot in &request.slots {
            let made = declared.slot(slot);
            if let (Some(image), false) = (made, request.read_back) {
                graph.want(image);
            }
            slots.push((slot, made.filter(|_| request.read_back).map(|image| graph.read_back(image))));
        }
        let image = declared.image.filter(|_| request.image);
        if let (Some(image), false) = (image, request.read_back) {
            graph.want(image);
        }
        let image = image.filter(|_| request.read_back).map(|image| graph.read_back(image));
        // Display values are of use to the host alone.
        let display = declared.display.map(|display| graph.read_back_buffer(display));

        let mut executed = graph.run(request.timing)?;
        let size = request.size;
        let mut frame = Frame {
            size,
            image: None,
            slots: BTreeMap::new(),
            display: None,
            estimate: None,
            timings: FrameTimings::default(),
        };
        frame.image = image.map(|read_back| color_image(size, &executed.take(read_back)));
        if request.read_back {
            for (slot, read_back) in slots {
                let image = read_back
                    .map_or_else(|| ColorImage::black(size), |read_back| color_image(size, &executed.take(read_back)));
                frame.slots.insert(slot, image);
            }
        }
        frame.display = display.map(|read_back| {
            executed.take(read_back).chunks_exact(4).map(|word| [word[0], word[1], word[2]]).collect()
        });
        let mut memory_bytes = self.store.memory_by_piece();
        memory_bytes.insert("scene".to_owned(), data.bytes() + traced.map_or(0, |traced| traced.bytes()));
        frame.timings = FrameTimings {
            timing: request.timing,
            gpu_ms: executed.gpu_ms,
            host_ms: start.elapsed().as_secs_f64() * 1e3,
            upload_ms,
            pipeline_ms: executed.pipeline_ms,
            passes: executed.passes,
            memory_bytes,
        };
        Ok((frame, std::mem::take(&mut executed.outgrown)))
    }

    /// The passes of the frame that `request` asks for, and which of them would be skipped and why. Nothing runs.
    ///
    /// # Errors
    /// As [`Renderer::render`], as far as uploading the scene goes.
    pub fn describe(&mut self, scene: &Scene, request: &FrameRequest) -> Result<GraphDescription, Error> {
        self.check_size(request)?;
        if self.settings.methods.traces_paths() {
            return self.describe_paths(scene, request);
        }
        let traced = self.prepare(scene, request)?;
        let data = self.data.as_ref().expect("prepared above");
        let prepared = Prepared { scene, data, lights: &self.lights, traced: traced.as_deref() };
        let mut graph = Graph::new(&mut self.store);
        let declared = declare(&mut graph, &prepared, &self.settings, request);
        for image in
            Slot::ALL.into_iter().filter(|slot| request.slots.contains(slot)).filter_map(|slot| declared.slot(slot))
        {
            graph.want(image);
        }
        if let Some(image) = declared.image.filter(|_| request.image) {
            graph.want(image);
        }
        if let Some(display) = declared.display {
            graph.want_buffer(display);
        }
        Ok(graph.describe())
    }

    fn check_size(&self, request: &FrameRequest) -> Result<(), Error> {
        let [width, height] = request.size;
        if width == 0 || height == 0 {
            return Err(Error::EmptyFrame(width, height));
        }
        let limit = self.store.device().limits().max_image_dimension2_d;
        if width.max(height) > limit {
            let (what, asked) = ("the frame".to_owned(), format!("{width}x{height} pixels"));
            return Err(VulkanError::TooLarge { what, asked, limit: format!("{limit} a side") }.into());
        }
        Ok(())
    }

    /// Brings the scene and its lights up to date on the device. Returns what rays meet, if the frame's passes send any.
    fn prepare(&mut self, scene: &Scene, request: &FrameRequest) -> Result<Option<Arc<TracedScene>>, Error> {
        let device = self.store.device().clone();
        let limit = device.limits().max_image_dimension2_d;
        let data = SceneData::update(&device, self.store.pipelines(), self.data.take(), scene)?;
        self.lights = LightSet::update(
            std::mem::take(&mut self.lights),
            scene,
            &data,
            &self.settings.lights,
            self.settings.shadow.filter_radius,
            limit,
        );
        self.data = Some(data);
        let (settings, facts) = (&self.settings, scene.facts());
        let traces = |slot| request.wants(slot) && sends_rays(settings, &facts, slot);
        if !facts.lit() || !Slot::ALL.into_iter().any(traces) {
            return Ok(None);
        }
        // Photons and VPLs come from the light views.
        let to_lights = traces(Slot::Direct);
        let held = self.traced.as_ref().filter(|held| !to_lights && held.surfaces_key == surfaces_key(scene)).cloned();
        held.map_or_else(|| self.traced_scene(scene), Ok).map(Some)
    }

    /// The scene as rays meet it, built anew if geometry, materials or lights changed.
    pub(super) fn traced_scene(&mut self, scene: &Scene) -> Result<Arc<TracedScene>, Error> {
        if let Some(held) = self.traced.take().filter(|held| held.key == traced_key(scene)) {
            return Ok(self.traced.insert(held).clone());
        }
        self.release_traced_scene();
        let traced = TracedScene::new(self.store.device(), scene)?;
        Ok(self.traced.insert(Arc::new(traced)).clone())
    }

    fn release_traced_scene(&mut self) {
        self.traced = None;
        if let Some(paths) = &mut self.paths {
            paths.release_scene();
        }
    }
}

impl std::fmt::Debug for Renderer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Renderer").field("settings", &self.settings).finish_non_exhaustive()
    }
}

/// From four floats a pixel.
fn color_image(size: [u32; 2], bytes: &[u8]) -> ColorImage {
    let float = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let pixels =
        bytes.chunks_exact(16).map(|texel| [float(&texel[0..4]), float(&texel[4..8]), float(&texel[8..12])]).collect();
    ColorImage { size, pixels }
}
