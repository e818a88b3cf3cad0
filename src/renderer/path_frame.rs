//! Frames of which some slots come from traced paths: the tracer's sums, the other methods' passes, and their sum on the host.

use std::collections::BTreeMap;
use std::time::Instant;

use super::render::black;
use super::{
    CausticsMethod, ColorImage, DiffuseMethod, DirectMethod, Error, Frame, FrameRequest, FrameTimings, Methods,
    Renderer, Settings, Slot, SpecularMethod,
};
use crate::graph::hash_of;
use crate::output::tonemap::tone_map;
use crate::reference::traced_scene::traced_key;
use crate::reference::tracer::{PathTracer, TraceCost};
use crate::reference::{Estimator, ReferenceRequest};
use crate::scene::Scene;
use crate::vulkan::VulkanError;

/// The tracer of a renderer, and its last result.
pub(crate) struct TracedPaths {
    tracer: PathTracer,
    held: Option<(u64, BTreeMap<Slot, ColorImage>)>,
}

impl TracedPaths {
    pub(super) fn invalidate(&mut self) {
        self.held = None;
    }

    pub(super) fn release_scene(&mut self) {
        self.tracer.release_scene();
    }
}

impl Methods {
    /// The slots that paths are traced for. The surfaces' own emission is found on the way if `direct` is traced too.
    fn traced_slots(&self) -> Vec<Slot> {
        let traced = [
            (Slot::Emission, self.direct == DirectMethod::Traced),
            (Slot::Direct, self.direct == DirectMethod::Traced),
            (Slot::Diffuse, self.diffuse == DiffuseMethod::Path),
            (Slot::Caustics, self.caustics == CausticsMethod::Path),
            (Slot::Specular, self.specular == SpecularMethod::Path),
        ];
        traced.into_iter().filter(|(_, traced)| *traced).map(|(slot, _)| slot).collect()
    }

    /// What is left for the other methods to fill.
    fn without_paths(&self) -> Methods {
        Methods {
            direct: if self.direct == DirectMethod::Traced { DirectMethod::None } else { self.direct },
            diffuse: if self.diffuse == DiffuseMethod::Path { DiffuseMethod::None } else { self.diffuse },
            caustics: if self.caustics == CausticsMethod::Path { CausticsMethod::None } else { self.caustics },
            specular: if self.specular == SpecularMethod::Path { SpecularMethod::None } else { self.specular },
        }
    }
}

impl Renderer {
    /// A frame for which paths are traced.
    pub(super) fn render_paths(&mut self, scene: &Scene, request: &FrameRequest) -> Result<Frame, Error> {
        let start = Instant::now();
        let methods = self.settings.methods;
        let traced = methods.traced_slots();
        let mut timings = FrameTimings { timing: request.timing, ..FrameTimings::default() };
        let mut slots = self.trace(scene, request, &mut timings)?;
        let others: Vec<Slot> = Slot::ALL.into_iter().filter(|slot| !traced.contains(slot)).collect();
        slots.retain(|slot, _| traced.contains(slot));
        if !others.is_empty() {
            let settings = Settings { methods: methods.without_paths(), ..self.settings.clone() };
            let settings = std::mem::replace(&mut self.settings, settings);
            let request =
                FrameRequest { slots: others, image: false, tonemap: None, read_back: true, ..request.clone() };
            let drawn = self.draw(scene, &request);
            self.settings = settings;
            let drawn = drawn?;
            slots.extend(drawn.slots);
            timings.add(drawn.timings);
        }
        let mut frame = Frame { size: request.size, image: None, slots: BTreeMap::new(), display: None, timings };
        if request.read_back || request.tonemap.is_some() {
            let image = sum_of(slots.values(), request.size);
            frame.display = request.tonemap.map(|map| tone_map(&image, map));
            frame.image = (request.image && request.read_back).then_some(image);
        }
        if request.read_back {
            slots.retain(|slot, _| request.slots.contains(slot));
            frame.slots = slots;
        }
        frame.timings.host_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(frame)
    }

    fn trace(
        &mut self,
        scene: &Scene,
        request: &FrameRequest,
        timings: &mut FrameTimings,
    ) -> Result<BTreeMap<Slot, ColorImage>, Error> {
        let start = Instant::now();
        let (device, traced_scene) = (self.device().clone(), self.traced_scene(scene)?);
        let paths = match &mut self.paths {
            Some(paths) => paths,
            None => self.paths.insert(TracedPaths { tracer: PathTracer::new(&device)?, held: None }),
        };
        paths.tracer.set_scene(traced_scene);
        timings.upload_ms = start.elapsed().as_secs_f64() * 1e3;
        let settings = &self.settings.path;
        let asked = ReferenceRequest {
            size: request.size,
            camera: request.camera.clone(),
            estimator: Estimator::Path,
            bounces: settings.bounces,
            filter: settings.filter,
            seed: settings.seed,
        };
        let view = format!("{:?}", (&asked, settings.spp));
        let key = hash_of(&(traced_key(scene), scene.sky().map(f32::to_bits), view));
        let slots = match &paths.held {
            Some((held, slots)) if *held == key => {
                timings.passes = paths.tracer.unchanged_passes();
                slots.clone()
            }
            _ => {
                paths.tracer.set_timing(request.timing);
                let slots = mean_of_samples(&mut paths.tracer, &asked, settings.spp)?;
                paths.held = Some((key, slots.clone()));
                let TraceCost { gpu_ms, pipeline_ms, passes, .. } = paths.tracer.take_cost();
                (timings.gpu_ms, timings.pipeline_ms, timings.passes) = (gpu_ms, pipeline_ms, passes);
                slots
            }
        };
        timings.memory_bytes = paths.tracer.memory_bytes();
        Ok(slots)
    }
}

impl FrameTimings {
    /// Adds what another part of the same frame cost.
    fn add(&mut self, other: FrameTimings) {
        self.gpu_ms += other.gpu_ms;
        self.upload_ms += other.upload_ms;
        self.pipeline_ms += other.pipeline_ms;
        self.passes.extend(other.passes);
        for (piece, bytes) in other.memory_bytes {
            *self.memory_bytes.entry(piece).or_insert(0) += bytes;
        }
    }
}

/// Half of the samples from each of the reference's two halves.
fn mean_of_samples(
    tracer: &mut PathTracer,
    request: &ReferenceRequest,
    spp: u32,
) -> Result<BTreeMap<Slot, ColorImage>, VulkanError> {
    let view = tracer.view(request);
    let mut sums = tracer.sums(&view, 0, 0, spp.div_ceil(2))?;
    if spp > 1 {
        let other = tracer.sums(&view, 1, 0, spp / 2)?;
        for (pixels, others) in sums.slots.iter_mut().zip(other.slots) {
            for (pixel, other) in pixels.iter_mut().zip(others) {
                *pixel = [0, 1, 2].map(|channel| pixel[channel] + other[channel]);
            }
        }
    }
    let scale = 1.0 / spp as f32;
    let image = |mut pixels: Vec<[f32; 3]>| {
        pixels.iter_mut().for_each(|pixel| *pixel = pixel.map(|channel| channel * scale));
        ColorImage { size: request.size, pixels }
    };
    Ok(Slot::ALL.into_iter().zip(sums.slots).map(|(slot, pixels)| (slot, image(pixels))).collect())
}

fn sum_of<'a>(slots: impl Iterator<Item = &'a ColorImage>, size: [u32; 2]) -> ColorImage {
    let mut sum = black(size);
    for slot in slots {
        for (pixel, other) in sum.pixels.iter_mut().zip(&slot.pixels) {
            *pixel = [0, 1, 2].map(|channel| pixel[channel] + other[channel]);
        }
    }
    sum
}
