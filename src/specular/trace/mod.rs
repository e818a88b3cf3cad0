//! `trace`: the slot `specular` by rays that follow reflections and refractions (Whitted 1980; the ray tracing stage of Chang, Park & Ihm, 4.3).
//!
//! 1. `walk.rs`, before other methods declare their passes: rays from the surfaces of the picture list the points that mirrors and glass show; `frame/mirrored_light.rs`:
//!    rays from the points to the lights.
//! 2. A method of the slot `diffuse` says what diffuse light comes to these, if it does so, and one of the slot `caustics` what caustics do (`frame/mirrored.rs`).
//! 3. `light.rs`: the sum at each pixel.
//!
//! If it supersamples, `marks.rs` lists pixels whose centres do not stand for all of them; `supersample.rs` sends rays through these from the camera, whose points
//! are listed and lit like the others, and at the end puts the means into all slots.

mod light;
mod marks;
pub(crate) mod options;
mod supersample;
mod walk;

use self::options::TraceOptions;
use crate::frame::mirrored::{MirroredCaustics, MirroredLight, MirroredPoints, Seen};
use crate::frame::mirrored_light::Shining;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{CausticPaths, LightPaths, Slot};

/// Rays that follow reflections and refractions.
pub(crate) struct Trace;

impl Method for Trace {
    const NAME: &'static str = "trace";
    const SLOT: Slot = Slot::Specular;
    type Options = TraceOptions;
    const FOLLOWS_LAMPS: bool = true;

    fn light_paths(options: &TraceOptions) -> LightPaths {
        LightPaths { bounces: None, caustics: CausticPaths::Unmirrored, mirrors: Some(options.depth) }
    }

    fn inputs(options: &TraceOptions) -> Inputs {
        let slots = options.supersamples > 0;
        Inputs { rays: Rays::ToLights, mirrored_light: true, slots, ..Inputs::default() }
    }

    fn shaders(options: &TraceOptions, _: bool) -> Vec<&'static str> {
        let mut shaders = vec!["trace/glass", "trace/walk", "trace/arguments", "mirrored/*", "trace/resolve"];
        if options.supersamples > 0 {
            shaders.extend(["trace/reflected", "trace/marks", "trace/supersample", "trace/replace"]);
        }
        shaders
    }

    fn skip(options: &TraceOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.specular || options.supersamples > 0, facts.lit()) {
            (false, _) => Some("no specular surface"),
            (_, false) => Some("no light"),
            _ => None,
        }
    }

    fn prepare(cx: &mut FrameCx<'_, '_>, options: &TraceOptions) {
        let Some(scene) = cx.rays() else { return };
        let walked = cx.frame.facts.specular.then(|| walk::walk(cx, scene, options));
        let supersamples = options.supersamples > 0;
        let size = cx.frame.surface.size;
        let reflected = walked.as_ref().filter(|_| supersamples).map(|_| marks::ReflectedImages::new(cx.graph, size));
        let mut light = Vec::new();
        match &walked {
            None => cx.graph.skip("specular/trace/walk", "no specular surface"),
            Some(walked) => {
                for (number, band) in walked.bands.iter().enumerate() {
                    let shining = Shining::new(cx.graph, scene, band.list, ("specular/trace/light", number), false);
                    let found = shining.find_punctual(cx.graph);
                    if let Some(images) = reflected {
                        images.sum(cx, walked, number, found.then_some(shining.light));
                    }
                    shining.find_others(cx.graph, found, options.light_samples);
                    light.push(shining.light);
                }
            }
        }
        let samples = if supersamples { supersample::sample(cx, scene, reflected, options) } else { Vec::new() };
        let lists = walked.iter().flat_map(|walked| &walked.bands).map(|band| band.list);
        let lists = lists.chain(samples.iter().map(|band| band.list)).collect();
        let shift = (cx.frame.data.origin - scene.origin).as_vec3();
        let seen = Seen::by_pixels(cx.frame.camera, size, shift);
        cx.frame.offers.put(MirroredPoints { lists, seen });
        cx.frame.offers.put(Traced { walked, light, samples });
    }

    fn declare(cx: &mut FrameCx<'_, '_>, _: &TraceOptions) -> Result<Option<ImageRef>, Error> {
        let offers = &cx.frame.offers;
        let Some(traced) = offers.get::<Traced>() else { return Ok(None) };
        let (diffuse, caustics) = (offers.get::<MirroredLight>(), offers.get::<MirroredCaustics>());
        let indirect = light::Indirect { diffuse: diffuse.as_deref(), caustics: caustics.as_deref() };
        let graph = &mut *cx.graph;
        Ok(traced.walked.as_ref().map(|walked| light::resolve(graph, walked, &traced.light, &indirect)))
    }

    fn refine(cx: &mut FrameCx<'_, '_>, _: &TraceOptions, slots: &[(Slot, ImageRef)]) {
        let offers = &cx.frame.offers;
        let Some(traced) = offers.get::<Traced>() else { return };
        let (diffuse, caustics) = (offers.get::<MirroredLight>(), offers.get::<MirroredCaustics>());
        let of_samples = traced.light.len()..;
        let diffuse = diffuse.as_ref().map(|diffuse| &diffuse.irradiance[of_samples.clone()]);
        let caustics = caustics.as_ref().map(|caustics| &caustics.irradiance[of_samples]);
        supersample::replace(cx, &traced.samples, [diffuse, caustics], slots);
    }
}

/// What was found before other methods declared their passes.
struct Traced {
    /// Absent where nothing is specular.
    walked: Option<walk::Walked>,
    /// Direct light of each band's points.
    light: Vec<BufferRef<[f32; 4]>>,
    samples: Vec<supersample::Samples>,
}
