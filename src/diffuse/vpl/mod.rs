//! `vpl`: diffuse light from virtual point lights, gathered at regions of several sizes (Quyen 2014, section 3.2).

mod gather;
mod ism;
mod mirrored;
pub(crate) mod options;
mod paths;
mod sample;
mod visibility;

use ash::vk;

use self::options::{VplOptions, VplShading, VplVisibility};
use self::visibility::Visibility;
use crate::frame::light_views::Views;
use crate::frame::mirrored::MirroredPoints;
use crate::frame::regions::{self, RegionRule};
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
    const LIGHTS_MIRRORED: bool = true;

    fn light_paths(options: &VplOptions) -> LightPaths {
        LightPaths::up_to(options.bounces)
    }

    fn inputs(options: &VplOptions) -> Inputs {
        let traces = options.visibility == VplVisibility::Traced || options.bounces > 1;
        let rays = if traces { Rays::ToSurfaces } else { Rays::None };
        Inputs { light_depth: Views::All, light_flux: Views::All, rays, ..Inputs::default() }
    }

    fn shaders(options: &VplOptions, software: bool) -> Vec<&'static str> {
        let mut shaders = vec!["vpl/block_*", "vpl/share", "vpl/vpls", "vpl/gather_pixels", "vpl/gather_mirrored"];
        if options.bounces > 1 {
            shaders.extend(["vpl/copy", "vpl/path_*"]);
        }
        if options.visibility == VplVisibility::Ism {
            shaders.push("ism/*");
        }
        let regions = ["regions/first", "regions/larger", "regions/interpolate", "regions/resolve"];
        match (options.shading, software) {
            (VplShading::Pixels, _) => {}
            (VplShading::Compute, _) | (VplShading::Auto, true) => {
                shaders.extend(regions);
                shaders.push("vpl/gather_regions");
            }
            _ => {
                shaders.extend(regions);
                shaders.extend(["regions/mark", "vpl/gather_stencil"]);
            }
        }
        shaders
    }

    fn skip(options: &VplOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.diffuse, options.bounces.min(options.count)) {
            (false, _) => Some("no diffuse surface"),
            (_, 0) => Some("no VPLs asked for"),
            _ => None,
        }
    }

    fn reduced(options: &VplOptions) -> Option<String> {
        let count = paths::count_of_all(options);
        let (side, asked) = (ism::resolution_for(count, options), options.ism_resolution);
        (options.visibility == VplVisibility::Ism && side < asked).then(|| {
            format!(
                "vpl.ism_resolution is {asked}, but imperfect shadow maps of {count} VPLs have {side} texels to a side"
            )
        })
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

pub(crate) fn rule_of(options: &VplOptions) -> RegionRule {
    let (depth_threshold, normal_threshold) = (options.depth_threshold as f32, options.normal_threshold as f32);
    RegionRule { piece: "diffuse/vpl", depth_threshold, normal_threshold, slope_threshold: f32::MAX }
}

/// Declares the method's passes in the order in which they run.
pub(crate) fn vpl(cx: &mut FrameCx<'_, '_>, options: &VplOptions) -> Made {
    let buffer = cx.frame.surface;
    let diffuse = cx.graph.image("diffuse", vk::Format::R32G32B32A32_SFLOAT, buffer.size);
    let first_bounce = sample::sample(cx, options);
    let unblocked = Visibility::new(cx);
    let vpls = paths::with_bounces(cx, options, &unblocked, first_bounce);
    let visibility = unblocked.of(cx, options, vpls);
    if let Some(points) = cx.frame.offers.get::<MirroredPoints>() {
        let light = mirrored::light(cx, &points, vpls, &visibility);
        cx.frame.offers.put(light);
    }
    let mut made = Made { diffuse, vpls, invocations: None, list: None };
    let level_count = regions::level_count(buffer.size, options.levels);
    let shading = match options.shading {
        // An image so wide that its levels do not fit beside each other is gathered pixel by pixel.
        _ if level_count == 1 || regions::flattened_size(buffer.size)[0] > cx.graph.longest_side() => {
            VplShading::Pixels
        }
        VplShading::Auto if cx.graph.traits().software => VplShading::Compute,
        VplShading::Auto => VplShading::Stencil,
        chosen => chosen,
    };
    if shading == VplShading::Pixels {
        gather::gather_pixels(cx, vpls, &visibility, diffuse);
        return made;
    }
    let rule = rule_of(options);
    let listed = (shading == VplShading::Compute).then_some(gather::REGIONS_PER_GROUP);
    let pyramid = regions::pyramid(cx.graph, buffer, &rule, level_count, listed);
    made.list = pyramid.list;
    let irradiance = if let Some(list) = pyramid.list {
        gather::gather_list(cx, vpls, &visibility, &pyramid, list)
    } else {
        let stencil = regions::mark(cx.graph, buffer, &rule, &pyramid);
        let (irradiance, invocations) = gather::gather_stencil(cx, vpls, &visibility, &pyramid, stencil);
        made.invocations = Some(invocations);
        irradiance
    };
    regions::interpolate(cx.graph, buffer, &rule, &pyramid, irradiance, diffuse);
    made
}
