//! `radiance-maps`: glossy reflections of what lights shine on, from a map of directions at each light cache (Reich 2015, sections 4.3.3 and 4.4).
//!
//! 1. Caches are those of `volumes` (`frame/caches/`), made once for both; virtual area lights are blocks of all light views, shared where `volumes` has the same.
//! 2. `choose.rs`: caches around specular surfaces get maps. `maps.rs`: all lights are written to them, and they get their levels.
//! 3. `apply.rs`: every pixel looks its eight caches' maps up as wide as its lobe is.
//!
//! It finds L D S E alone: light that one diffuse surface scattered. Mirrors in mirrors, caustics in mirrors and further bounces are missing.

mod accumulate;
mod apply;
mod choose;
mod maps;
pub(crate) mod options;
mod search;
mod tables;

use std::rc::Rc;

use self::choose::Maps;
use self::options::{RadianceMapsFill, RadianceMapsLobe, RadianceMapsLookup, RadianceMapsOptions, RadianceMapsWrite};
#[cfg(test)]
pub(crate) use self::tables::direction_of_texel;
use crate::frame::caches::AreaLights;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::method::{Error, FrameCx, Inputs, Method};
use crate::scene::Facts;
use crate::slot::{CausticPaths, LightPaths, Slot};

/// Maps of incoming light at light caches.
pub(crate) struct RadianceMaps;

impl Method for RadianceMaps {
    const NAME: &'static str = "radiance-maps";
    const SLOT: Slot = Slot::Specular;
    type Options = RadianceMapsOptions;

    fn light_paths(_: &RadianceMapsOptions) -> LightPaths {
        LightPaths { bounces: Some(1), caustics: CausticPaths::None, mirrors: None }
    }

    fn lead_in(options: &RadianceMapsOptions) -> u32 {
        options.frames - 1
    }

    fn inputs(_: &RadianceMapsOptions) -> Inputs {
        Inputs { caches: true, ..Inputs::default() }
    }

    fn shaders(_: &RadianceMapsOptions, _: bool) -> Vec<&'static str> {
        vec!["radiance_maps/*"]
    }

    fn skip(_: &RadianceMapsOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.specular, facts.diffuse) {
            (false, _) => Some("no specular surface"),
            (_, false) => Some("no diffuse surface"),
            _ => None,
        }
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &RadianceMapsOptions) -> Result<Option<ImageRef>, Error> {
        Ok(Some(radiance_maps(cx, options).specular))
    }
}

/// Frames after which lights are drawn as before.
const LONGEST_DRAW: u32 = 1 << 15;

/// The slot, and what is behind it.
pub(crate) struct Made {
    pub(crate) specular: ImageRef,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) maps: Maps,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) lights: Rc<AreaLights>,
    /// Where all caches lie.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) positions: BufferRef<[f32; 4]>,
}

/// Declares the method's passes in the order in which they run.
pub(crate) fn radiance_maps(cx: &mut FrameCx<'_, '_>, options: &RadianceMapsOptions) -> Made {
    let mut settings = cx.frame.caches;
    if options.frames > 1 {
        settings.lights.drawn = 1 + cx.frame.time.index % LONGEST_DRAW;
    }
    let (lights, caches) = (cx.area_lights(&settings), cx.caches(&settings));
    let maps = maps::maps(cx, &lights, &caches, options);
    if options.frames > 1 {
        accumulate::accumulate(cx, &caches, &maps, options);
    }
    let specular = apply::apply(cx, &caches, &maps, options);
    Made { specular, maps, lights, positions: caches.positions }
}

impl RadianceMapsOptions {
    /// Maps are summed up in shared memory, of which every device has 16 kB: enough for 32² and the levels above.
    fn is_cached(&self) -> bool {
        self.write == RadianceMapsWrite::Cached && self.size <= 32
    }

    /// The kinds of glsl/radiance_maps/mips.comp.
    fn fill_kind(&self) -> u32 {
        match self.fill {
            RadianceMapsFill::None => 0,
            RadianceMapsFill::PullPush => 1,
            RadianceMapsFill::Footprint => 2,
            RadianceMapsFill::Search => 3,
        }
    }

    /// The kinds of glsl/radiance_maps/lobes.glsl.
    fn lobe_kind(&self) -> u32 {
        match self.lobe {
            RadianceMapsLobe::BlinnPhong => 0,
            RadianceMapsLobe::Ggx => 1,
        }
    }

    fn follows_mirror(&self) -> u32 {
        u32::from(self.lookup == RadianceMapsLookup::Mirror)
    }
}
