//! `volumes`: diffuse light from dynamic radiance volumes (Reich 2015, chapter 4).
//!
//! 1. The light views are reduced to virtual area lights, and caches made at the nodes of grids around the eye where a visible surface lies (`frame/caches/`, shared with
//!    whoever lights the same caches for another slot).
//! 2. Samples of all surfaces become such lights too, by the light of emissive surfaces and the sky and by what was reflected before (`frame/bounces/`).
//! 3. `light.rs`: the light that comes to each cache, as spherical harmonics; `renewal.rs`: of caches far away not in each frame.
//! 4. `apply.rs`: every pixel interpolates between its eight caches.

mod apply;
mod light;
mod mirrored;
pub(crate) mod options;
mod renewal;
#[cfg(test)]
mod tests;

use std::rc::Rc;

use self::options::{VolumesAreaLights, VolumesOptions, VolumesSpread, VolumesVal, VolumesVisibility, VolumesWeights};
use crate::frame::bounces::{self, BounceRule, FirstLights};
use crate::frame::caches::{AreaLights, LightRule, Picture, Points, area_lights, spread_lights};
use crate::frame::light_views::Views;
use crate::frame::mirrored::MirroredPoints;
use crate::frame::voxels;
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{LightPaths, Slot};

/// Light caches around what the camera sees, lit by virtual area lights.
pub(crate) struct Volumes;

impl Method for Volumes {
    const NAME: &'static str = "volumes";
    const SLOT: Slot = Slot::Diffuse;
    type Options = VolumesOptions;
    const LIGHTS_MIRRORED: bool = true;

    fn light_paths(options: &VolumesOptions) -> LightPaths {
        LightPaths::up_to(options.bounces)
    }

    fn inputs(options: &VolumesOptions) -> Inputs {
        let traces = options.visibility == VolumesVisibility::Rays || options.weights == VolumesWeights::Rays;
        let traces = traces || options.spread == VolumesSpread::Picture || options.bounces > 1;
        let rays = if options.area_lights == VolumesAreaLights::Rays {
            Rays::ToLights
        } else if traces {
            Rays::ToSurfaces
        } else {
            Rays::None
        };
        let views = if light_rule(options).punctual { Views::Punctual } else { Views::All };
        Inputs { light_depth: views, light_flux: views, rays, ..Inputs::default() }
    }

    fn shaders(options: &VolumesOptions, _: bool) -> Vec<&'static str> {
        let cones = options.visibility == VolumesVisibility::Cones;
        let voxels = if cones { voxels::shaders(&options.voxel_settings()) } else { Vec::new() };
        let light = if cones { "volumes/light_cones" } else { "volumes/light" };
        let samples = options.bounces > 1 || options.area_lights == VolumesAreaLights::Rays;
        let bounces: &[_] = if samples { &["bounces/*"] } else { &[] };
        ["caches/*", "volumes/apply", "volumes/mirrored", light].iter().chain(bounces).copied().chain(voxels).collect()
    }

    fn skip(options: &VolumesOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.diffuse, options.bounces) {
            (false, _) => Some("no diffuse surface"),
            (_, 0) => Some("no bounce asked for"),
            _ => None,
        }
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &VolumesOptions) -> Result<Option<ImageRef>, Error> {
        Ok(Some(volumes(cx, options).diffuse))
    }
}

/// The slot, and what is behind it.
pub(crate) struct Made {
    pub(crate) diffuse: ImageRef,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) lights: Option<Rc<AreaLights>>,
    #[cfg_attr(not(test), allow(dead_code, reason = "as above"))]
    pub(crate) samples: Rc<Option<AreaLights>>,
}

/// Lamps and the sky are in views of their own where rays do not bring their light.
fn light_rule(options: &VolumesOptions) -> LightRule {
    LightRule { punctual: options.area_lights == VolumesAreaLights::Rays, ..options.cache_settings().lights }
}

/// Lights of what the light views see, if any do.
fn lights(cx: &mut FrameCx<'_, '_>, options: &VolumesOptions) -> Option<Rc<AreaLights>> {
    let rule = light_rule(options);
    if cx.frame.set.views_of(rule.punctual).is_empty() || options.spread == VolumesSpread::Views {
        return even_lights(cx, options);
    }
    let (scene_rays, rays) = cx.cache_rays();
    let points = Points::Picture(Picture { surface: cx.frame.surface, scene_rays, shift: rays.shift });
    Some(cx.shared((rule, options.spread), |cx, (rule, _)| {
        spread_lights(cx.graph, cx.frame.set, cx.lights(), &points, rule)
    }))
}

fn even_lights(cx: &mut FrameCx<'_, '_>, options: &VolumesOptions) -> Option<Rc<AreaLights>> {
    let rule = light_rule(options).told_apart(cx.frame.set);
    let any = !cx.frame.set.views_of(rule.punctual).is_empty();
    any.then(|| cx.shared(rule, |cx, rule| area_lights(cx.graph, cx.frame.set, cx.lights(), rule)))
}

/// Those that samples receive.
fn first_lights<'f>(cx: &mut FrameCx<'f, '_>, options: &VolumesOptions) -> Option<FirstLights<'f>> {
    if options.spread == VolumesSpread::Views {
        return even_lights(cx, options).map(FirstLights::Made);
    }
    let (set, rule) = (cx.frame.set, light_rule(options));
    let any = !set.views_of(rule.punctual).is_empty();
    any.then(|| FirstLights::BySamples { set, views: cx.lights(), rule })
}

/// Lights of what samples of the surfaces reflect, if anything is asked of them.
fn sample_lights(cx: &mut FrameCx<'_, '_>, options: &VolumesOptions) -> Rc<Option<AreaLights>> {
    let area_lights = options.area_lights == VolumesAreaLights::Rays;
    let &VolumesOptions { bounces, samples, lod, val, .. } = options;
    let rule = BounceRule { bounces, samples, lod, area_lights, paper: val == VolumesVal::Paper };
    let Some(scene) = cx.rays().filter(|scene| rule.wants_samples(scene)) else { return Rc::new(None) };
    let shift = (cx.frame.data.origin - scene.origin).as_vec3().to_array();
    // Whatever the picture shows, so that they stand while the camera moves.
    let first = if options.bounces > 1 { first_lights(cx, options) } else { None };
    cx.shared((light_rule(options), rule), |cx, (_, rule)| bounces::sample_lights(cx.graph, scene, shift, first, rule))
}

/// Declares the method's passes in the order in which they run.
pub(crate) fn volumes(cx: &mut FrameCx<'_, '_>, options: &VolumesOptions) -> Made {
    let lights = lights(cx, options);
    let caches = cx.caches(&options.cache_settings());
    let samples = sample_lights(cx, options);
    let light = light::light(cx, (lights.as_deref(), (*samples).as_ref()), &caches, options);
    if let Some(points) = cx.frame.offers.get::<MirroredPoints>() {
        let shown = mirrored::light(cx, &points, &caches, light, options);
        cx.frame.offers.put(shown);
    }
    let diffuse = apply::apply(cx, &caches, light, options);
    Made { diffuse, lights, samples }
}
