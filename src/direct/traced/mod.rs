//! The `direct` slot by rays from the G-buffer's surfaces to the lights: exact visibility in place of shadow maps (glsl/direct/).
//!
//! Punctual lights take one ray each and are without noise. Emissive surfaces are estimated from points drawn by power and from
//! directions drawn by the BRDF, each weighted against the other: points alone are noisy where an emitter is near or a lobe narrow. The
//! sky is estimated from the same directions. Each kind of light has a kernel of its own, which adds to what the one before it found: kernels stay
//! small, and a scene runs only those that it has lights for.

pub(crate) mod options;

use ash::vk;

use self::options::TracedOptions;
use crate::frame::direct_light::SharpLight;
use crate::frame::gbuffer::GBuffer;
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::{ImageRef, SampledImage};
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::shaders::direct::{Directions, DirectionsPush, Emitters, EmittersPush, Punctual, PunctualPush};
use crate::shaders::groups::{DirectSum, Lobes, SceneLights, SceneRays};
use crate::slot::{LightPaths, Slot};

/// Rays to the lights: exact shadows; noise where light comes from surfaces or the sky.
pub(crate) struct Traced;

impl Method for Traced {
    const NAME: &'static str = "traced";
    const SLOT: Slot = Slot::Direct;
    type Options = TracedOptions;
    const SHOWS_LAMPS: bool = true;

    fn light_paths(_: &TracedOptions) -> LightPaths {
        LightPaths::up_to(0)
    }

    fn inputs(_: &TracedOptions) -> Inputs {
        Inputs { rays: Rays::ToLights, ..Inputs::default() }
    }

    fn shaders(_: &TracedOptions, _: bool) -> Vec<&'static str> {
        vec!["direct/punctual", "direct/emitters", "direct/directions"]
    }

    fn skip(_: &TracedOptions, facts: &Facts) -> Option<&'static str> {
        (!facts.lit()).then_some("no light")
    }

    /// The passes that the scene's lights need.
    fn declare(cx: &mut FrameCx<'_, '_>, options: &TracedOptions) -> Result<Option<ImageRef>, Error> {
        let Some(scene) = cx.rays() else { return Ok(None) };
        let emissive = scene.emissive_count > 0;
        let sky = scene.sky.iter().any(|&channel| channel > 0.0);
        let wanted = |reason: Option<&'static str>| reason.or((options.samples == 0).then_some("no samples asked for"));
        let shift = (cx.frame.data.origin - scene.origin).as_vec3().to_array();
        let graph = &mut *cx.graph;
        let (rays, lights) = (scene.rays(graph), scene.lights(graph));
        let frame = TracedFrame { buffer: cx.frame.surface, scene, rays, lights, shift, samples: options.samples };
        let mut direct = None;
        match (scene.punctual_count == 0).then_some("no punctual light") {
            Some(reason) => graph.skip("direct/traced/punctual", reason),
            None => {
                let punctual = frame.punctual(graph, direct);
                cx.frame.offers.put(SharpLight(punctual));
                direct = Some(punctual);
            }
        }
        match wanted((!emissive).then_some("no emissive surface")) {
            Some(reason) => graph.skip("direct/traced/emitters", reason),
            None => direct = Some(frame.emitters(graph, direct)),
        }
        match wanted((!sky && !emissive).then_some("no sky, no emissive surface")) {
            Some(reason) => graph.skip("direct/traced/directions", reason),
            None => direct = Some(frame.directions(graph, direct)),
        }
        Ok(direct)
    }
}

/// What the passes share.
struct TracedFrame<'a> {
    buffer: &'a GBuffer,
    scene: &'a TracedScene,
    rays: SceneRays,
    lights: SceneLights,
    shift: [f32; 3],
    samples: u32,
}

impl TracedFrame<'_> {
    /// What is `found` already with more added to it.
    fn sum(&self, graph: &mut Graph<'_>, name: &str, found: Option<ImageRef>) -> (ImageRef, DirectSum) {
        let direct = graph.image(name, vk::Format::R32G32B32A32_SFLOAT, self.buffer.size);
        let (before, adds) = (SampledImage::of(found), u32::from(found.is_some()));
        (direct, DirectSum { before, direct: direct.write(), adds })
    }

    /// What the G-buffer knows of: reflection alone.
    fn lobes(&self) -> Lobes {
        Lobes { specular_lobes: self.buffer.group.has_specular, transmissive: 0 }
    }

    fn punctual(&self, graph: &mut Graph<'_>, found: Option<ImageRef>) -> ImageRef {
        let (direct, direct_sum) = self.sum(graph, "direct.punctual", found);
        let light_count = self.scene.punctual_count;
        let pass = Punctual {
            surface: self.buffer.group.clone(),
            scene_rays: self.rays.clone(),
            scene_lights: self.lights.clone(),
            direct_sum,
            lobes: self.lobes(),
            push: PunctualPush { shift: self.shift, light_count },
        };
        graph.pass("direct/traced/punctual", pass).note("lights", u64::from(light_count)).pixels(self.buffer.size);
        direct
    }

    fn emitters(&self, graph: &mut Graph<'_>, found: Option<ImageRef>) -> ImageRef {
        let (direct, direct_sum) = self.sum(graph, "direct.emitters", found);
        let pass = Emitters {
            surface: self.buffer.group.clone(),
            scene_rays: self.rays.clone(),
            scene_lights: self.lights.clone(),
            direct_sum,
            lobes: self.lobes(),
            push: EmittersPush {
                shift: self.shift,
                emitter_count: self.scene.emissive_count,
                sample_count: self.samples,
                density_scale: self.scene.emissive_density_scale,
            },
        };
        graph.pass("direct/traced/emitters", pass).note("samples", u64::from(self.samples)).pixels(self.buffer.size);
        direct
    }

    fn directions(&self, graph: &mut Graph<'_>, found: Option<ImageRef>) -> ImageRef {
        let (direct, direct_sum) = self.sum(graph, "direct.directions", found);
        let pass = Directions {
            surface: self.buffer.group.clone(),
            scene_rays: self.rays.clone(),
            scene_lights: self.lights.clone(),
            direct_sum,
            lobes: self.lobes(),
            finds_emitters: u32::from(self.scene.emissive_count > 0),
            push: DirectionsPush {
                shift: self.shift,
                sample_count: self.samples,
                sky: self.scene.sky,
                density_scale: self.scene.emissive_density_scale,
            },
        };
        graph.pass("direct/traced/directions", pass).note("samples", u64::from(self.samples)).pixels(self.buffer.size);
        direct
    }
}
