//! `ambient`: ambient occlusion, the baseline that every user knows. Rays ask how much of the hemisphere above a pixel is open, and a sky of one
//! radiance (the scene's own, or 1 where it is black) shines through that part (glsl/ambient/gather.comp). No light of the scene takes part: what it
//! shows is no light path, and its error against any reference is that of a picture without one.

pub(crate) mod options;
#[cfg(test)]
mod tests;

use ash::vk;

use self::options::AmbientOptions;
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays};
use crate::scene::Facts;
use crate::shaders::ambient::{Gather, GatherPush};
use crate::slot::{LightPaths, Slot};

/// How far surfaces hide the sky unless the options say it, as a share of the scene's radius.
const REACH: f64 = 0.2;

/// Ambient occlusion under a constant sky.
pub(crate) struct Ambient;

impl Method for Ambient {
    const NAME: &'static str = "ambient";
    const SLOT: Slot = Slot::Diffuse;
    type Options = AmbientOptions;

    fn light_paths(_: &AmbientOptions) -> LightPaths {
        LightPaths::up_to(1)
    }

    fn inputs(_: &AmbientOptions) -> Inputs {
        Inputs { rays: Rays::ToSurfaces, ..Inputs::default() }
    }

    fn shaders(_: &AmbientOptions, _: bool) -> Vec<&'static str> {
        vec!["ambient/*"]
    }

    fn skip(options: &AmbientOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.diffuse, options.rays) {
            (false, _) => Some("no diffuse surface"),
            (_, 0) => Some("no rays asked for"),
            _ => None,
        }
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &AmbientOptions) -> Result<Option<ImageRef>, Error> {
        let Some(scene) = cx.rays() else { return Ok(None) };
        let (frame, surface) = (cx.frame, cx.frame.surface);
        let diffuse = cx.graph.image("ambient.diffuse", vk::Format::R32G32B32A32_SFLOAT, surface.size);
        let pass = Gather {
            scene_rays: scene.rays(cx.graph),
            surface: surface.group.clone(),
            diffuse: diffuse.write(),
            push: GatherPush {
                shift: (frame.data.origin - scene.origin).as_vec3().to_array(),
                ray_count: options.rays,
                sky_radiance: if frame.sky == [0.0; 3] { [1.0; 3] } else { frame.sky },
                reach: if options.distance > 0.0 { options.distance } else { REACH * frame.data.radius } as f32,
            },
        };
        cx.graph.pass("diffuse/ambient/gather", pass).note("rays", u64::from(options.rays)).pixels(surface.size);
        Ok(Some(diffuse))
    }
}
