//! `lightmaps`: indirect light in light maps (Larsen & Christensen 2004). Their texels are few, are renewed where light changed, and stand while it does not.
//!
//! 1. Texels on all diffuse surfaces, and links between them: rays traced once (`texels.rs`). They stand while geometry and materials do.
//! 2. The approximated illumination map (AIM): all light that texels receive, of the lights by shadow rays, of other texels along links (`aim.rs`). It stands while
//!    lights do. Or by photons (`photons.rs`).
//! 3. The indirect illumination map (IIM): texels gather by rays what the AIM says of where these end (`iim.rs`), or by drawing what they see (`hemicube.rs`), all of
//!    them, or as many a frame as the options say (`renewal.rs`); while nothing changes, with further rounds of rays and of photons (`rounds.rs`).
//! 4. Pixels interpolate the IIM (`shade.rs`). That alone follows the camera.
//!
//! Whoever takes the light off the device gets it on finer texels (`detail.rs`).

mod aim;
mod detail;
mod formats;
mod hemicube;
mod iim;
mod lamps;
mod maps;
pub(crate) mod options;
mod photons;
mod renewal;
mod rounds;
mod shade;
#[cfg(test)]
mod tests;
mod texels;

use self::aim::Approximated;
use self::detail::in_detail;
use self::lamps::Lamps;
use self::maps::Maps;
use self::options::{LightmapsGather, LightmapsOptions, LightmapsSettle, LightmapsSource};
use self::renewal::renewed;
use self::texels::LightTexels;
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::slot::{LightPaths, Slot};

/// Light maps.
pub(crate) struct Lightmaps;

impl Method for Lightmaps {
    const NAME: &'static str = "lightmaps";
    const SLOT: Slot = Slot::Diffuse;
    type Options = LightmapsOptions;
    const LIGHTS_MIRRORED: bool = true;

    fn light_paths(options: &LightmapsOptions) -> LightPaths {
        LightPaths::up_to(options.bounces)
    }

    fn inputs(_: &LightmapsOptions) -> Inputs {
        Inputs { rays: Rays::ToLights, ..Inputs::default() }
    }

    fn shaders(options: &LightmapsOptions, _: bool) -> Vec<&'static str> {
        let mut shaders = vec!["lightmaps/*", "buckets/*"];
        if options.gather == LightmapsGather::Hemicube {
            shaders.push("hemicube/*");
        }
        shaders
    }

    fn skip(options: &LightmapsOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.diffuse, facts.lit(), options.bounces) {
            (false, ..) => Some("no diffuse surface"),
            (_, false, _) => Some("no light"),
            (.., Some(0)) => Some("no bounces asked for"),
            _ => None,
        }
    }

    fn reduced(options: &LightmapsOptions) -> Option<String> {
        let LightmapsOptions { texel, count, links, .. } = *options;
        let most = texels::most_texels(links);
        (texel == 0.0 && count > most).then(|| {
            format!("lightmaps.count is {count}, but a buffer holds {links} links of {most} texels: there are no more")
        })
    }

    fn lead_in(options: &LightmapsOptions) -> u32 {
        if options.settle == LightmapsSettle::Never { 32 } else { 0 }
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &LightmapsOptions) -> Result<Option<ImageRef>, Error> {
        let Some(scene) = cx.rays() else { return Ok(None) };
        let Some(texels) = LightTexels::declare(cx.graph, scene, options) else { return Ok(None) };
        let lamps = Lamps::declare(cx.graph, scene, options);
        let light = Approximated::declare(cx.graph, scene, (&texels, &lamps), options);
        let maps = match options.settle {
            LightmapsSettle::Always => {
                let (aim, caustics) = match options.source {
                    LightmapsSource::Rays => {
                        let caustics = photons::caustics(cx.graph, (scene, &lamps), &texels, options, None);
                        (light.settled(cx.graph, &texels, caustics), caustics)
                    }
                    LightmapsSource::Photons => (photons::aim(cx.graph, (scene, &lamps), &texels, options, None), None),
                };
                let diffuse = iim::all(cx.graph, &texels, (aim, lamps.maps()), options);
                if let Some(detail) = cx.frame.stored_light {
                    let light = (diffuse, caustics);
                    cx.frame.offers.put(in_detail(cx.graph, scene, (&texels, &lamps), light, (options, detail)));
                }
                Maps { gathered: diffuse, received: Some(aim) }
            }
            LightmapsSettle::First | LightmapsSettle::Never => {
                renewed(cx.graph, (scene, cx.frame.data.identity), (&texels, &lamps), &light, options)
            }
        };
        let maps = Maps {
            gathered: lamps.combined(cx.graph, &texels, (maps.gathered, "gathered")),
            received: maps.received.map(|received| lamps.combined(cx.graph, &texels, (received, "received"))),
        };
        Ok(Some(shade::shade(cx, scene, &texels, &maps, options.show)))
    }
}
