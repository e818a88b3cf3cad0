//! `volumes`: diffuse light from dynamic radiance volumes (Reich 2015, chapter 4).
//!
//! 1. The light views are reduced to virtual area lights, and caches made at the nodes of grids around the eye where a visible surface lies (`frame/caches/`, shared with
//!    whoever lights the same caches for another slot).
//! 2. `light.rs`: the light that comes to each cache, as spherical harmonics.
//! 3. `apply.rs`: every pixel interpolates between its eight caches.

mod apply;
mod light;
pub(crate) mod options;
#[cfg(test)]
mod tests;

use std::rc::Rc;

use self::options::{VolumesOptions, VolumesVisibility, VolumesWeights};
use crate::frame::caches::AreaLights;
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

    fn light_paths(_: &VolumesOptions) -> LightPaths {
        LightPaths::up_to(1)
    }

    fn inputs(options: &VolumesOptions) -> Inputs {
        let traces = options.visibility == VolumesVisibility::Rays || options.weights == VolumesWeights::Rays;
        let rays = if traces { Rays::ToSurfaces } else { Rays::None };
        Inputs { light_depth: true, light_flux: true, rays, ..Inputs::default() }
    }

    fn shaders(options: &VolumesOptions, _: bool) -> Vec<&'static str> {
        let cones = options.visibility == VolumesVisibility::Cones;
        let voxels = if cones { voxels::shaders(&options.voxel_settings()) } else { Vec::new() };
        let light = if cones { "volumes/light_cones" } else { "volumes/light" };
        ["caches/*", "volumes/apply", light].into_iter().chain(voxels).collect()
    }

    fn skip(_: &VolumesOptions, facts: &Facts) -> Option<&'static str> {
        (!facts.diffuse).then_some("no diffuse surface")
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &VolumesOptions) -> Result<Option<ImageRef>, Error> {
        Ok(Some(volumes(cx, options).diffuse))
    }
}

/// The slot, and what is behind it.
pub(crate) struct Made {
    pub(crate) diffuse: ImageRef,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) lights: Rc<AreaLights>,
}

/// Declares the method's passes in the order in which they run.
pub(crate) fn volumes(cx: &mut FrameCx<'_, '_>, options: &VolumesOptions) -> Made {
    let settings = options.cache_settings();
    let (lights, caches) = (cx.area_lights(&settings), cx.caches(&settings));
    let light = light::light(cx, &lights, &caches, options);
    let diffuse = apply::apply(cx, &caches, light, options);
    Made { diffuse, lights }
}
