//! Frames of which some slots come from traced paths: the tracer's sums, the other methods' passes, and their sum on the host.

use std::collections::BTreeMap;
use std::time::Instant;

use super::frame::{Frame, FrameRequest};
use super::render::Renderer;
use super::settings::{CausticsMethod, DiffuseMethod, DirectMethod, Methods, Settings, SpecularMethod};
use super::traced_paths::{Traced, TracedPaths, mean_of_samples};
use crate::estimator::path::PathTracer;
use crate::estimator::{EstimateRequest, TraceCost};
use crate::frame::rays::traced_key;
use crate::graph::{FrameTimings, GraphDescription, hash_of};
use crate::image::{ColorImage, tone_map};
use crate::method::Error;
use crate::scene::Scene;
use crate::slot::{CausticPaths, Slot};

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
        let Traced { mut slots, estimate } = self.trace(scene, request, &traced, &mut timings)?;
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
        let (size, estimate) = (request.size, Some(estimate));
        let mut frame = Frame { size, image: None, slots: BTreeMap::new(), display: None, estimate, timings };
        if request.read_back || request.tonemap.is_some() {
            let image = ColorImage::sum(request.size, slots.values());
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

    /// The passes that trace paths. Those of other methods are described without them.
    pub(super) fn describe_paths(&mut self, scene: &Scene, request: &FrameRequest) -> Result<GraphDescription, Error> {
        let asked = self.asked_of_paths(request);
        let tracer = &mut self.paths_of(scene)?.tracer;
        let view = tracer.view(&asked);
        Ok(tracer.describe(&view)?)
    }

    fn asked_of_paths(&self, request: &FrameRequest) -> EstimateRequest {
        let settings = &self.settings.path;
        EstimateRequest {
            size: request.size,
            camera: request.camera.clone(),
            bounces: settings.bounces,
            caustics: CausticPaths::All,
            filter: settings.filter,
            seed: settings.seed,
        }
    }

    /// The tracer, with the scene as it is now.
    fn paths_of(&mut self, scene: &Scene) -> Result<&mut TracedPaths, Error> {
        let (device, traced_scene) = (self.device().clone(), self.traced_scene(scene)?);
        if self.paths.is_none() {
            self.paths = Some(TracedPaths { tracer: PathTracer::new(&device)?, held: None });
        }
        let paths = self.paths.as_mut().expect("made above");
        paths.tracer.set_scene(traced_scene);
        Ok(paths)
    }

    fn trace(
        &mut self,
        scene: &Scene,
        request: &FrameRequest,
        traced: &[Slot],
        timings: &mut FrameTimings,
    ) -> Result<Traced, Error> {
        let start = Instant::now();
        let (asked, spp) = (self.asked_of_paths(request), self.settings.path.spp);
        let paths = self.paths_of(scene)?;
        timings.upload_ms = start.elapsed().as_secs_f64() * 1e3;
        let view = format!("{:?}", (&asked, spp));
        let key = hash_of(&(traced_key(scene), scene.sky().map(f32::to_bits), view, traced));
        let made = match &paths.held {
            Some((held, made)) if *held == key => {
                timings.passes = paths.tracer.unchanged_passes();
                made.clone()
            }
            _ => {
                paths.tracer.set_timing(request.timing);
                let mut made = mean_of_samples(&mut paths.tracer, &asked, spp, traced)?;
                let TraceCost { gpu_ms, pipeline_ms, passes, rays } = paths.tracer.take_cost();
                (timings.gpu_ms, timings.pipeline_ms, timings.passes) = (gpu_ms, pipeline_ms, passes);
                (made.estimate.rays, made.estimate.seconds) = (rays, 1e-3 * gpu_ms);
                paths.held = Some((key, made.clone()));
                made
            }
        };
        timings.memory_bytes = paths.tracer.memory_bytes();
        Ok(made)
    }
}
