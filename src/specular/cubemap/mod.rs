//! `cubemap`: reflections from maps of the surroundings, one around each glossy object's middle (Larsen & Christensen 2004, section 6).
//!
//! 1. `objects.rs`: which objects get one.
//! 2. `maps.rs`, before other methods declare their passes: one ray a texel, and rays from where it ends to the lights. A method of the slot `diffuse` says what diffuse light
//!    comes there (`frame/mirrored.rs`); then the map's levels, for lobes of all widths. They stand while the camera alone moves, if that light does.
//! 3. `apply.rs`: each pixel looks its object's map up where its reflection leaves what the map shows.
//!
//! It finds L D⁺ S E, also by way of metal that a map shows, and what wide lobes reflect of lamps. What glass lets through is missing.

mod apply;
mod maps;
mod objects;
pub(crate) mod options;

use self::objects::Object;
use self::options::CubemapOptions;
use crate::frame::mirrored::{MirroredCaustics, MirroredLight, MirroredPoints, Seen};
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{CausticPaths, LightPaths, Slot};

/// Reflections on the way to the eye: those that a map shows (glsl/cubemap/rays.comp), and the pixel's.
const MIRRORS: u32 = 4;

/// Maps of the surroundings.
pub(crate) struct Cubemap;

impl Method for Cubemap {
    const NAME: &'static str = "cubemap";
    const SLOT: Slot = Slot::Specular;
    type Options = CubemapOptions;

    fn light_paths(_: &CubemapOptions) -> LightPaths {
        LightPaths { bounces: None, caustics: CausticPaths::Unmirrored, mirrors: Some(MIRRORS) }
    }

    fn inputs(_: &CubemapOptions) -> Inputs {
        Inputs { rays: Rays::ToLights, mirrored_light: true, ..Inputs::default() }
    }

    fn shaders(_: &CubemapOptions, _: bool) -> Vec<&'static str> {
        vec!["cubemap/*", "mirrored/*"]
    }

    fn skip(_: &CubemapOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.specular, facts.lit()) {
            (false, _) => Some("no specular surface"),
            (_, false) => Some("no light"),
            _ => None,
        }
    }

    fn prepare(cx: &mut FrameCx<'_, '_>, options: &CubemapOptions) {
        let Some(scene) = cx.rays() else { return };
        let objects = objects::choose(cx.frame, scene, options.objects);
        if objects.is_empty() {
            cx.graph.skip("specular/cubemap/rays", "no specular surface in view");
            return;
        }
        let seen = maps::see(cx, scene, &objects, options);
        cx.frame
            .offers
            .put(MirroredPoints { lists: seen.iter().map(|seen| seen.list).collect(), seen: Seen::default() });
        cx.frame.offers.put(Surroundings { objects, seen });
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &CubemapOptions) -> Result<Option<ImageRef>, Error> {
        Ok(cubemap(cx, options).map(|made| made.specular))
    }
}

/// What was found before other methods declared their passes.
struct Surroundings {
    objects: Vec<Object>,
    seen: Vec<maps::Seen>,
}

/// The slot, and what is behind it.
pub(crate) struct Made {
    pub(crate) specular: ImageRef,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) maps: Vec<maps::Map>,
}

/// Declares the passes that follow what other methods say of the light.
pub(crate) fn cubemap(cx: &mut FrameCx<'_, '_>, options: &CubemapOptions) -> Option<Made> {
    let scene = cx.rays()?;
    let offers = &cx.frame.offers;
    let found = offers.get::<Surroundings>()?;
    let (diffuse, caustics) = (offers.get::<MirroredLight>(), offers.get::<MirroredCaustics>());
    let mut map = |(number, seen)| {
        let diffuse = diffuse.as_ref().map(|diffuse| diffuse.irradiance[number]);
        let caustics = caustics.as_ref().map(|caustics| caustics.irradiance[number]);
        maps::map(cx.graph, number, seen, [diffuse, caustics], options)
    };
    let maps: Vec<_> = found.seen.iter().enumerate().map(&mut map).collect();
    let specular = apply::apply(cx, scene, &found.objects, &maps, options);
    Some(Made { specular, maps })
}
