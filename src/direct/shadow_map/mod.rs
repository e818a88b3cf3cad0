//! The `direct` slot by filtered shadow maps.

pub(crate) mod options;

use ash::vk;

use self::options::ShadowOptions;
use crate::frame::direct_light::SharpLight;
use crate::frame::light_views::Views;
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method};
use crate::scene::Facts;
use crate::shaders::direct::{ShadowMap as Pass, ShadowMapPush};
use crate::slot::{LightPaths, Slot};

/// Filtered, normal-offset shadow maps.
pub(crate) struct ShadowMap;

impl Method for ShadowMap {
    const NAME: &'static str = "shadow-map";
    const SLOT: Slot = Slot::Direct;
    type Options = ShadowOptions;

    fn light_paths(_: &ShadowOptions) -> LightPaths {
        LightPaths::up_to(0)
    }

    fn inputs(_: &ShadowOptions) -> Inputs {
        Inputs { light_depth: Views::All, ..Inputs::default() }
    }

    fn shaders(_: &ShadowOptions, _: bool) -> Vec<&'static str> {
        vec!["direct/shadow_map"]
    }

    fn skip(_: &ShadowOptions, _: &Facts) -> Option<&'static str> {
        None
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &ShadowOptions) -> Result<Option<ImageRef>, Error> {
        let (buffer, lights) = (cx.frame.surface, cx.lights());
        let direct = cx.graph.image("direct", vk::Format::R32G32B32A32_SFLOAT, buffer.size);
        let pass = Pass {
            surface: buffer.group.clone(),
            light_views: lights.group.clone(),
            direct: direct.write(),
            push: ShadowMapPush {
                light_count: lights.light_count,
                normal_offset: options.normal_offset as f32,
                diffuse_from: if cx.frame.follows_lamps { cx.frame.set.punctual_count } else { lights.light_count },
                filter_radius: i32::try_from(options.filter_radius).unwrap_or(0),
            },
        };
        cx.graph
            .pass("direct/shadow-map/shade", pass)
            .note("lights", u64::from(lights.light_count))
            .pixels(buffer.size);
        // The few views that stand for emissive surfaces and the sky throw sharp shadows which the scene does not have.
        if cx.frame.set.punctual_count == lights.light_count {
            cx.frame.offers.put(SharpLight(direct));
        }
        Ok(Some(direct))
    }
}
