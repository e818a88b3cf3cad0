//! `final-gather`: diffuse light by a photon map and final gathering (Jensen 1996, with irradiance at photons as Christensen 1999 computes it beforehand), the
//! traditional method of offline rendering that Chang, Park & Ihm compare theirs with. It is no real-time method: each pixel sends hundreds of rays.
//!
//! 1. The photon map (`map.rs`): photons from all lights are left at diffuse surfaces; at some of them irradiance is estimated from those around. Stands while
//!    the camera alone moves.
//! 2. Gathering (`gather.rs`): rays by the cosine from each pixel; the point of the map that is nearest to where a ray ends says what comes along it.

mod gather;
mod grid;
mod map;
pub(crate) mod options;
#[cfg(test)]
mod tests;

use self::map::PhotonMap;
use self::options::FinalGatherOptions;
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{LightPaths, Slot};

/// A photon map and gather rays.
pub(crate) struct FinalGather;

impl Method for FinalGather {
    const NAME: &'static str = "final-gather";
    const SLOT: Slot = Slot::Diffuse;
    type Options = FinalGatherOptions;
    const LIGHTS_MIRRORED: bool = true;

    fn light_paths(options: &FinalGatherOptions) -> LightPaths {
        LightPaths::up_to(options.bounces)
    }

    fn inputs(_: &FinalGatherOptions) -> Inputs {
        Inputs { rays: Rays::ToLights, ..Inputs::default() }
    }

    fn shaders(_: &FinalGatherOptions, _: bool) -> Vec<&'static str> {
        vec!["final_gather/*", "buckets/*"]
    }

    fn skip(options: &FinalGatherOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.diffuse, facts.lit(), options.bounces) {
            (false, ..) => Some("no diffuse surface"),
            (_, false, _) => Some("no light"),
            (.., Some(0)) => Some("no bounces asked for"),
            _ => None,
        }
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &FinalGatherOptions) -> Result<Option<ImageRef>, Error> {
        let Some(scene) = cx.rays() else { return Ok(None) };
        let map = PhotonMap::declare(cx.graph, scene, options);
        Ok(Some(gather::gather(cx, scene, &map, options.rays)))
    }
}
