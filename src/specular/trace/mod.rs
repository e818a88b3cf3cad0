//! `trace`: the slot `specular` by rays that follow reflections and refractions (Whitted 1980; the ray tracing stage of Chang, Park & Ihm, 4.3).
//!
//! 1. `walk.rs`, before other methods declare their passes: rays from the surfaces of the picture list the points that mirrors and glass show.
//! 2. A method of the slot `diffuse` says what diffuse light comes to these, if it does so (`frame/mirrored.rs`).
//! 3. `light.rs`: rays from the points to the lights; the sum at each pixel.

mod light;
pub(crate) mod options;
mod walk;

use self::options::TraceOptions;
use crate::frame::mirrored::MirroredLight;
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{CausticPaths, LightPaths, Slot};

/// Rays that follow reflections and refractions.
pub(crate) struct Trace;

impl Method for Trace {
    const NAME: &'static str = "trace";
    const SLOT: Slot = Slot::Specular;
    type Options = TraceOptions;

    fn light_paths(_: &TraceOptions) -> LightPaths {
        LightPaths { bounces: None, caustics: CausticPaths::Unmirrored }
    }

    fn inputs(_: &TraceOptions) -> Inputs {
        Inputs { rays: Rays::ToLights, mirrored_light: true, ..Inputs::default() }
    }

    fn shaders(_: &TraceOptions, _: bool) -> Vec<&'static str> {
        vec![
            "trace/glass",
            "trace/walk",
            "trace/arguments",
            "trace/punctual",
            "trace/emitters",
            "trace/sky",
            "trace/resolve",
        ]
    }

    fn skip(_: &TraceOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.specular, facts.lit()) {
            (false, _) => Some("no specular surface"),
            (_, false) => Some("no light"),
            _ => None,
        }
    }

    fn prepare(cx: &mut FrameCx<'_, '_>, options: &TraceOptions) {
        let Some(scene) = cx.rays() else { return };
        let walked = walk::walk(cx, scene, options);
        cx.frame.offers.put(walked.mirrored());
        cx.frame.offers.put(walked);
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &TraceOptions) -> Result<Option<ImageRef>, Error> {
        let offers = &cx.frame.offers;
        let (Some(scene), Some(walked)) = (cx.rays(), offers.get::<walk::Walked>()) else { return Ok(None) };
        let diffuse = offers.get::<MirroredLight>();
        Ok(Some(light::light(cx.graph, scene, &walked, diffuse.as_deref(), options)))
    }
}
