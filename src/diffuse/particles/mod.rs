//! `particles`: diffuse global illumination in particle spaces (Chang, Park & Ihm). Surfaces are cut into area particles; links, rays traced once, lead from
//! each to the particles that it sees. Light is then moved along links alone: scattered forwards bounce by bounce, gathered backwards where the picture
//! needs it.
//!
//! 1. Geometry stage (`geometry.rs`): particles, their areas, links, lists. Stands while geometry and materials do.
//! 2. Lighting stage (`lighting.rs`): emission, scattering. Stands while the camera alone moves.
//! 3. Shading (`shading.rs`): the particles around what the picture shows gather through all their links; pixels read the lists of their particle, or interpolate
//!    between radiance particles (`mesh/`).

mod cells;
mod events;
mod formats;
mod geometry;
mod kept;
mod lighting;
mod links;
mod lists;
mod measure;
mod mesh;
mod mirrored;
mod moved;
pub(crate) mod options;
mod place;
mod receivers;
mod shading;
mod stage;
#[cfg(test)]
mod tests;

use self::geometry::ParticleSpace;
use self::options::{MOST_BOUNCES, ParticlesOptions};
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{LightPaths, Slot};

/// Light between particles along links.
pub(crate) struct Particles;

/// Scattering steps after which less than a hundredth of the flux is left, if surfaces reflect `albedo` of it.
fn steps_for(albedo: f64) -> u32 {
    ((0.01_f64.ln() / albedo.clamp(1e-3, 0.99).ln()).ceil() as u32).clamp(1, MOST_BOUNCES)
}

impl Method for Particles {
    const NAME: &'static str = "particles";
    const SLOT: Slot = Slot::Diffuse;
    type Options = ParticlesOptions;
    const LIGHTS_MIRRORED: bool = true;

    fn light_paths(options: &ParticlesOptions) -> LightPaths {
        LightPaths::up_to(options.bounces.map(|bounces| bounces + 1))
    }

    fn inputs(_: &ParticlesOptions) -> Inputs {
        Inputs { rays: Rays::ToLights, ..Inputs::default() }
    }

    fn shaders(_: &ParticlesOptions, _: bool) -> Vec<&'static str> {
        vec!["particles/*", "buckets/*", "regions/first", "regions/larger", "regions/interpolate", "regions/resolve"]
    }

    fn skip(_: &ParticlesOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.diffuse, facts.lit()) {
            (false, _) => Some("no diffuse surface"),
            (_, false) => Some("no light"),
            _ => None,
        }
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &ParticlesOptions) -> Result<Option<ImageRef>, Error> {
        let Some(scene) = cx.rays() else { return Ok(None) };
        let shift = (cx.frame.data.origin - scene.origin).as_vec3().to_array();
        let steps = options.bounces.unwrap_or_else(|| steps_for(scene.greatest_albedo()));
        let space = ParticleSpace::declare(cx.graph, scene, options);
        let radiance = lighting::light(cx.graph, scene, &space, options, steps).radiance;
        Ok(Some(shading::shade(cx, scene, &space, shift, options, radiance)))
    }
}

#[cfg(test)]
mod unit_tests {
    use super::*;

    #[test]
    fn steps_leave_less_than_a_hundredth() {
        for albedo in [0.2, 0.5, 0.73, 0.86] {
            let steps = steps_for(albedo);
            assert!(albedo.powi(steps as i32) <= 0.01 && albedo.powi(steps as i32 - 1) > 0.01, "{albedo}: {steps}");
        }
        assert_eq!((steps_for(0.0), steps_for(1.0)), (1, MOST_BOUNCES));
    }
}
