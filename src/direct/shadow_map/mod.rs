//! The `direct` slot by filtered shadow maps.

mod options;

use ash::vk;

use crate::frame::gbuffer::GBuffer;
use crate::frame::light_views::LightViews;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::direct::{ShadowMap, ShadowMapPush};

pub use self::options::ShadowSettings;

/// Declares the pass; returns the slot's radiance.
pub(crate) fn shadow_map(
    graph: &mut Graph<'_>,
    buffer: &GBuffer,
    lights: &LightViews,
    settings: &ShadowSettings,
) -> ImageRef {
    let direct = graph.image("direct", vk::Format::R32G32B32A32_SFLOAT, buffer.size);
    let (specular, has_specular) = buffer.specular();
    let pass = ShadowMap {
        camera: buffer.camera.clone(),
        depth: buffer.depth.sampled(),
        surface: buffer.surface.sampled(),
        specular: specular.sampled(),
        lights: lights.lights.clone(),
        views: lights.views.clone(),
        light_depth: lights.depth.sampled(),
        direct: direct.write(),
        push: ShadowMapPush {
            light_count: lights.light_count,
            has_specular,
            normal_offset: settings.normal_offset as f32,
            filter_radius: i32::try_from(settings.filter_radius).unwrap_or(0),
        },
    };
    graph.pass("direct/shadow-map", pass).note("lights", u64::from(lights.light_count)).pixels(buffer.size);
    direct
}
