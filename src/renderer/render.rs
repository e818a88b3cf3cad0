//! The renderer: a scene and a request in, a frame out. Keeps on the device what still holds between frames.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use super::context::Context;
use super::declare::{Declared, Prepared, declare, inputs_of, wanted_methods};
use super::estimates::{Estimates, Means};
use super::frame::{Frame, FrameRequest};
use super::limits::first_lack;
use super::methods::{EstimatorEntry, Filler};
use super::settings::Settings;
use crate::frame::check::check_images;
use crate::frame::light_set::LightSet;
use crate::frame::rays::{TracedScene, surfaces_key, traced_key};
use crate::frame::scene_data::SceneData;
use crate::graph::{Cancel, FrameTimings, Graph, GraphDescription, Outgrown, Store, hash_of};
use crate::image::ColorImage;
use crate::method::{Error, Rays};
use crate::scene::Scene;
use crate::slot::Slot;
use crate::vulkan::{Device, VulkanError};

/// Makes frames with one set of settings on one device.
///
/// What a scene, its lights and the camera leave unchanged from one frame to the next is not made again. Any scene may be
/// rendered at any time; changing between scenes uploads them anew.
pub struct Renderer {
    pub(super) settings: Settings,
    pub(super) data: Option<SceneData>,
    pub(super) lights: LightSet,
    /// Held while something sends rays.
    pub(super) traced: Option<Arc<TracedScene>>,
    pub(crate) store: Store,
    /// Held once an estimator fills a slot.
    estimates: Option<Estimates>,
}

impl Renderer {
    /// A renderer on `context`'s device.
    ///
    /// # Errors
    /// If an option is out of range, the device lacks what a method needs, or it has no memory left.
    pub fn new(context: &Context, settings: Settings) -> Result<Renderer, Error> {
        let store = Store::new(context.pipelines())?;
        let held = (None, LightSet::default(), None, None);
        let (data, lights, traced, estimates) = held;
        check(&settings, context.shared_device())?;
        Ok(Renderer { settings, data, lights, traced, store, estimates })
    }

    /// The settings of the frames to come.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Stops a frame that this renderer makes, from another thread.
    pub fn cancel(&self) -> Cancel {
        self.store.interrupt.cancel.clone()
    }

    /// Replaces the settings.
    ///
    /// # Errors
    /// If an option is out of range, or the device lacks what a method needs; the old settings stand.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), Error> {
        check(&settings, self.store.device())?;
        self.settings = settings;
        Ok(())
    }

    /// Forgets all results, so that the next frame makes everything anew; for timings of whole frames. The scene stays on
    /// the device.
    pub fn invalidate(&mut self) {
        self.store.invalidate();
        if let Some(estimates) = &mut self.estimates {
            estimates.invalidate();
        }
    }

    /// Lets all that methods keep over frames start anew, as before the first frame. [`Renderer::invalidate`] leaves it.
    pub fn reset_history(&mut self) {
        self.store.reset_history();
    }

    /// Whether its methods kept something over the frames so far.
    #[cfg(feature = "plots")]
    pub(crate) fn keeps_past(&self) -> bool {
        self.store.past() > 0
    }

    /// Makes a frame of the scene as it is now. If some buffer could not know how much it had to hold and was too small, the frame is made again
    /// with a larger one.
    ///
    /// # Errors
    /// A frame without pixels or beyond the device's limits, a camera or a time step that is none, exhausted memory, a lost device; these two name the last
    /// pass that finished. A frame that was cancelled.
    pub fn render(&mut self, scene: &Scene, request: &FrameRequest) -> Result<Frame, Error> {
        self.check_request(request)?;
        #[cfg(feature = "capi")]
        super::hand_out::prepare(&self.store, &request.handed)?;
        self.store.interrupt.progress = request.progress.clone();
        let start = Instant::now();
        let mut timings = FrameTimings { timing: request.timing, ..FrameTimings::default() };
        let means = self.estimate(scene, request, &mut timings)?;
        // Samples are all there is to it, or else a frame is done at once.
        self.store.interrupt.done = if means.is_some() { 1.0 } else { 0.0 };
        loop {
            let Drawn { mut frame, outgrown, fault, .. } = {
                let drawn = self.draw_once(scene, request, means.as_deref())?;
                #[cfg(feature = "capi")]
                if drawn.outgrown.is_empty() && drawn.fault.is_none() {
                    super::hand_out::hand_out(&mut self.store, &request.handed, &drawn.handed, request.size)?;
                }
                drawn
            };
            if outgrown.is_empty() {
                if let Some(fault) = fault {
                    return Err(self.explain(scene, request, means.as_deref(), fault));
                }
                timings.add(std::mem::take(&mut frame.timings));
                timings.host_ms = start.elapsed().as_secs_f64() * 1e3;
                (frame.timings, frame.estimate) = (timings, means.map(|means| means.estimate.clone()));
                return Ok(frame);
            }
            for (name, [held, needed]) in outgrown {
                tracing::info!("{name} held {held} elements of {needed}; the frame is made again with more");
            }
        }
    }

    /// The estimator that fills some wanted slot.
    fn estimator(&self, request: &FrameRequest) -> Option<&'static EstimatorEntry> {
        let estimated = |slot: &Slot| matches!(self.settings.methods.filler(*slot), Some(Filler::Estimator(_)));
        let wanted = Slot::ALL.into_iter().filter(|slot| request.wants(*slot)).any(|slot| estimated(&slot));
        self.settings.methods.estimator().filter(|_| wanted)
    }

    /// The estimator at work on the scene as it is now.
    fn estimates(&mut self, entry: &EstimatorEntry, scene: &Scene) -> Result<&mut Estimates, Error> {
        let (pipelines, traced) = (self.store.pipelines().clone(), self.traced_scene(scene)?);
        let interrupt = self.store.interrupt.clone();
        let estimates = Estimates::update(self.estimates.take(), entry, &pipelines, (traced, interrupt))?;
        Ok(self.estimates.insert(estimates))
    }

    /// The means of the slots that an estimator fills.
    pub(super) fn estimate(
        &mut self,
        scene: &Scene,
        request: &FrameRequest,
        timings: &mut FrameTimings,
    ) -> Result<Option<Arc<Means>>, Error> {
        let Some(entry) = self.estimator(request) else { return Ok(None) };
        let start = Instant::now();
        let samples = (entry.samples)(&self.settings);
        let estimates = self.estimates(entry, scene)?;
        timings.upload_ms = start.elapsed().as_secs_f64() * 1e3;
        let seen = hash_of(&(traced_key(scene), scene.sky().map(f32::to_bits)));
        let asked = samples.of(request.size, &request.camera);
        Ok(Some(estimates.means(&asked, samples, request.timing, seen, timings)?))
    }

    fn draw_once(&mut self, scene: &Scene, request: &FrameRequest, means: Option<&Means>) -> Result<Drawn, Error> {
        let start = Instant::now();
        let held = self.data.as_ref().filter(|data| data.identity == scene.identity());
        let sent = held.map_or(0, |data| data.sent());
        let traced = self.prepare(scene, request)?;
        let upload_ms = start.elapsed().as_secs_f64() * 1e3;
        let data = self.data.as_ref().expect("prepared above");
        let prepared = Prepared { scene, data, lights: &self.lights, traced: traced.as_deref(), means };
        let mut graph = Graph::new(&mut self.store);
        let declared = declare(&mut graph, &prepared, &self.settings, request)?;

        let mut slots = Vec::new();
        let mut image = None;
        let mut check = None;
        let shown = declared.shown(request);
        if !shown.is_empty() {
            check = Some((check_images(&mut graph, &shown), shown));
        }
        if request.read_back {
            slots = request
                .slots
                .iter()
                .map(|&slot| (slot, declared.slot(slot).map(|image| graph.read_back(image))))
                .collect();
            image = declared.image.filter(|_| request.image).map(|image| graph.read_back(image));
        } else {
            want(&mut graph, &declared, request);
        }
        #[cfg(feature = "capi")]
        let handed = super::hand_out::want(&mut graph, &declared, &request.handed);
        // Display values are of use to the host alone.
        let display = declared.display.map(|display| graph.read_back_buffer(display));

        let mut executed = graph.run(request.timing)?;
        let size = request.size;
        let fault = check.and_then(|(faults, shown)| {
            let (index, pixels) = faults.first(|read_back| executed.take(read_back))?;
            Some(Fault { what: shown[index].0.clone(), pixels })
        });
        let mut taken = |read_back| color_image(size, &executed.take(read_back));
        let image = image.map(&mut taken);
        let slots: BTreeMap<Slot, ColorImage> = slots
            .into_iter()
            .map(|(slot, read_back)| (slot, read_back.map_or_else(|| ColorImage::black(size), &mut taken)))
            .collect();
        let display = display.map(|read_back| {
            executed.take(read_back).chunks_exact(4).map(|word| [word[0], word[1], word[2]]).collect()
        });
        let mut memory_bytes = self.store.memory_by_piece();
        let scene_bytes = if means.is_some() { 0 } else { traced.map_or(0, |traced| traced.bytes()) };
        memory_bytes.insert("scene".to_owned(), data.bytes() + scene_bytes);
        let timings = FrameTimings {
            timing: request.timing,
            gpu_ms: executed.gpu_ms,
            host_ms: 0.0,
            upload_ms,
            upload_bytes: data.sent().saturating_sub(sent),
            pipeline_ms: executed.pipeline_ms,
            passes: executed.passes,
            memory_bytes,
            memory_parts: self.store.memory_by_part(),
        };
        let frame = Frame { size, image, slots, display, estimate: None, timings };
        Ok(Drawn {
            frame,
            outgrown: std::mem::take(&mut executed.outgrown),
            fault,
            #[cfg(feature = "capi")]
            handed,
        })
    }

    /// The passes of the frame that `request` asks for, and which of them would be skipped and why. Nothing runs.
    ///
    /// # Errors
    /// As [`Renderer::render`], as far as uploading the scene goes.
    pub fn describe(&mut self, scene: &Scene, request: &FrameRequest) -> Result<GraphDescription, Error> {
        self.check_request(request)?;
        let mut estimated = GraphDescription::default();
        let mut means = None;
        if let Some(entry) = self.estimator(request) {
            let asked = (entry.samples)(&self.settings).of(request.size, &request.camera);
            estimated = self.estimates(entry, scene)?.describe(&asked)?;
            means = Some(Means::unknown(entry.slots, request.size));
        }
        let traced = self.prepare(scene, request)?;
        let data = self.data.as_ref().expect("prepared above");
        let prepared = Prepared { scene, data, lights: &self.lights, traced: traced.as_deref(), means: means.as_ref() };
        let mut graph = Graph::new(&mut self.store);
        let declared = declare(&mut graph, &prepared, &self.settings, request)?;
        want(&mut graph, &declared, request);
        estimated.append(graph.describe());
        Ok(estimated)
    }

    fn check_request(&self, request: &FrameRequest) -> Result<(), Error> {
        let [width, height] = request.size;
        if width == 0 || height == 0 {
            return Err(Error::EmptyFrame(width, height));
        }
        if let Some(fault) = request.camera.fault() {
            return Err(Error::Camera(fault));
        }
        if !(request.time_step.is_finite() && request.time_step >= 0.0) {
            return Err(Error::TimeStep(request.time_step));
        }
        let limit = self.store.device().limits().max_image_dimension2_d;
        if width.max(height) > limit {
            let (what, asked) = ("the frame".to_owned(), format!("{width}x{height} pixels"));
            return Err(VulkanError::TooLarge { what, asked, limit: format!("{limit} a side") }.into());
        }
        Ok(())
    }

    /// Brings the scene and its lights up to date on the device. Returns what rays meet, if the frame's passes send any.
    pub(super) fn prepare(&mut self, scene: &Scene, request: &FrameRequest) -> Result<Option<Arc<TracedScene>>, Error> {
        let device = self.store.device().clone();
        let data = SceneData::update(&device, self.store.pipelines(), self.data.take(), scene)?;
        let detail = self.settings.lights.detail(self.settings.shadow_map.filter_radius);
        self.lights = LightSet::update(std::mem::take(&mut self.lights), scene, &data, detail, &device);
        self.data = Some(data);
        let methods =
            |wants: &dyn Fn(Slot) -> bool| wanted_methods(&self.settings, &scene.facts(), &self.lights, wants);
        let (wanted, all) = (inputs_of(&methods(&|slot| request.wants(slot))), inputs_of(&methods(&|_| true)));
        if all.rays == Rays::None && self.settings.methods.estimator().is_none() {
            self.release_traced_scene();
        }
        // Photons and VPLs come from the light views: the surfaces that rays meet stand when a light moves.
        let held = match wanted.rays {
            Rays::None => return Ok(None),
            Rays::ToSurfaces => self.traced.as_ref().filter(|held| held.surfaces_key() == surfaces_key(scene)).cloned(),
            Rays::ToLights => None,
        };
        held.map_or_else(|| self.traced_scene(scene), Ok).map(Some)
    }

    /// The scene as rays meet it: what of it geometry, materials or lights changed is built anew.
    fn traced_scene(&mut self, scene: &Scene) -> Result<Arc<TracedScene>, Error> {
        let held = self.traced.take().filter(|held| held.is_of(scene));
        if let Some(held) = held.as_ref().filter(|held| held.key == traced_key(scene)) {
            return Ok(self.traced.insert(held.clone()).clone());
        }
        self.release_traced_scene();
        let traced = TracedScene::update(self.store.device(), scene, held.as_deref())?;
        Ok(self.traced.insert(Arc::new(traced)).clone())
    }

    fn release_traced_scene(&mut self) {
        self.traced = None;
        if let Some(estimates) = &mut self.estimates {
            estimates.release_scene();
        }
    }
}

/// A frame that was made, if nothing is wrong with it.
struct Drawn {
    frame: Frame,
    outgrown: Vec<Outgrown>,
    fault: Option<Fault>,
    /// Names of the images that go to a host.
    #[cfg(feature = "capi")]
    handed: Vec<Option<String>>,
}

/// Pixels that are no numbers or negative.
pub(super) struct Fault {
    /// `image`, or the slot.
    pub(super) what: String,
    pub(super) pixels: u32,
}

/// The frame's images stay on the device.
pub(super) fn want(graph: &mut Graph<'_>, declared: &Declared, request: &FrameRequest) {
    let slots = request.slots.iter().filter_map(|&slot| declared.slot(slot));
    for image in slots.chain(declared.image.filter(|_| request.image)) {
        graph.want(image);
    }
    if let Some(display) = declared.display {
        graph.want_buffer(display);
    }
}

fn check(settings: &Settings, device: &Device) -> Result<(), Error> {
    settings.check().map_err(|fault| Error::Settings(fault.to_string()))?;
    if let Some((piece, what)) = first_lack(device.offer(), settings, device.traits().software) {
        let (device, piece) = (device.report().name.clone(), piece.to_owned());
        return Err(VulkanError::Lacks { device, piece, what }.into());
    }
    for sentence in settings.reduced() {
        tracing::warn!("{sentence}");
    }
    Ok(())
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
