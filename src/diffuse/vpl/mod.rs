//! `vpl`: diffuse light from virtual point lights, gathered at regions of several sizes (Quyen 2014, section 3.2).

mod gather;
mod inputs;
pub(crate) mod interpolate;
mod ism;
pub(crate) mod options;
mod paths;
pub(crate) mod pyramid;
pub(crate) mod regions;
mod sample;
mod visibility;

use ash::vk;

use self::inputs::VplInputs;
use self::options::{VplOptions, VplShading, VplVisibility};
use self::visibility::Visibility;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{LightPaths, Slot};

/// Virtual point lights, gathered at regions of several sizes.
pub(crate) struct Vpl;

impl Method for Vpl {
    const NAME: &'static str = "vpl";
    const SLOT: Slot = Slot::Diffuse;
    type Options = VplOptions;

    fn light_paths(options: &VplOptions) -> LightPaths {
        LightPaths::up_to(options.bounces)
    }

    fn inputs(options: &VplOptions) -> Inputs {
        let traces = options.visibility == VplVisibility::Traced || options.bounces > 1;
        let rays = if traces { Rays::ToSurfaces } else { Rays::None };
        Inputs { light_depth: true, light_flux: true, rays }
    }

    fn skip(options: &VplOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.diffuse, options.bounces.min(options.count)) {
            (false, _) => Some("no diffuse surface"),
            (_, 0) => Some("no VPLs asked for"),
            _ => None,
        }
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &VplOptions) -> Result<Option<ImageRef>, Error> {
        Ok(Some(vpl(cx, options).diffuse))
    }
}


/// The slot, and the VPLs behind it: two texels each (glsl/lib/vpl.glsl).
pub(crate) struct Made {
    pub(crate) diffuse: ImageRef,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) vpls: BufferRef<[f32; 4]>,
    /// Where regions are marked in a stencil: how often the gather's shader ran.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) invocations: Option<BufferRef<u32>>,
    /// Where regions are listed.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) list: Option<BufferRef<u32>>,
}

/// Declares the method's passes in the order in which they run.
pub(crate) fn vpl(cx: &mut FrameCx<'_, '_>, options: &VplOptions) -> Made {
    let inputs = &VplInputs {
        buffer: cx.frame.surface,
        data: cx.frame.data,
        geometry: cx.frame.geometry,
        set: cx.frame.set,
        lights: cx.lights(),
        traced: cx.rays(),
        options,
    };
    let graph = &mut *cx.graph;
    let diffuse = graph.image("diffuse", vk::Format::R32G32B32A32_SFLOAT, inputs.buffer.size);
    let first_bounce = sample::sample(graph, inputs);
    let unblocked = Visibility::new(graph, inputs);
    let vpls = paths::with_bounces(graph, inputs, &unblocked, first_bounce);
    let visibility = unblocked.of(graph, inputs, vpls);
    let mut made = Made { diffuse, vpls, invocations: None, list: None };
    let level_count = pyramid::level_count(inputs.buffer.size, inputs.options.levels);
    let shading = match inputs.options.shading {
        // An image so wide that its levels do not fit beside each other is gathered pixel by pixel.
        _ if level_count == 1 || regions::flattened_size(inputs.buffer.size)[0] > graph.longest_side() => {
            VplShading::Pixels
        }
        VplShading::Auto if graph.runs_on_cpu() => VplShading::Compute,
        VplShading::Auto => VplShading::Stencil,
        chosen => chosen,
    };
    if shading == VplShading::Pixels {
        gather::gather_pixels(graph, inputs, vpls, &visibility, diffuse);
        return made;
    }
    let listed = (shading == VplShading::Compute).then_some(gather::REGIONS_PER_GROUP);
    let pyramid = pyramid::pyramid(graph, inputs.buffer, inputs.options, level_count, listed);
    made.list = pyramid.list;
    let irradiance = if let Some(list) = pyramid.list {
        gather::gather_list(graph, inputs, vpls, &visibility, &pyramid, list)
    } else {
        let stencil = regions::mark(graph, inputs, &pyramid);
        let (irradiance, invocations) = gather::gather_stencil(graph, inputs, vpls, &visibility, &pyramid, stencil);
        made.invocations = Some(invocations);
        irradiance
    };
    interpolate::interpolate(graph, inputs.buffer, inputs.options, &pyramid, irradiance, diffuse);
    made
}
