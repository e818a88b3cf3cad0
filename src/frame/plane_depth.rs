//! Depths that triangles have by their planes, for devices whose rasteriser rounds vertices coarsely (glsl/geometry/plane_depth.glsl). Drawn once
//! more over the depth that is there, into an image that is read in its place.

use ash::vk;

use super::geometry::{Attributes, DrawView, Geometry, draw_list};
use super::scene_data::SceneData;
use crate::graph::bindings::{ImageRef, Uniform};
use crate::graph::{ClearColor, Graph};
use crate::shaders::{gbuffer, groups, light_views, types};
use crate::vulkan::{DepthState, RasterState};

/// What is read as the depth of the camera's view; `drawn` is what was rasterised.
pub(super) fn of_camera(
    graph: &mut Graph<'_>,
    data: &SceneData,
    geometry: &Geometry,
    (camera, views): (Uniform<types::Camera>, &[DrawView]),
    drawn: ImageRef,
) -> ImageRef {
    if !graph.draws_plane_depths() {
        return drawn;
    }
    let pass = gbuffer::PlaneDepth {
        geometry: geometry.clone(),
        camera,
        push: gbuffer::PlaneDepthPush { size: drawn.size() },
    };
    let depth = graph.image("gbuffer.plane_depth", vk::Format::R32_SFLOAT, drawn.size());
    let list = draw_list(data, Attributes::Depth, views, |_| true);
    graph
        .raster("gbuffer/plane-depth", pass, over_depth(data))
        .depth_test(drawn)
        .color(depth, Some(ClearColor::Float([0.0; 4])))
        .draw(list);
    depth
}

/// What is read as the depth of the light views.
pub(super) fn of_lights(
    graph: &mut Graph<'_>,
    data: &SceneData,
    geometry: &Geometry,
    (group, views): (&groups::LightViews, &[DrawView]),
    drawn: ImageRef,
) -> ImageRef {
    if !graph.draws_plane_depths() {
        return drawn;
    }
    let pass = light_views::PlaneDepth {
        geometry: geometry.clone(),
        light_views: group.clone(),
        push: types::DrawnLightView { view_index: 0 },
    };
    let depth = graph.image("light_views.plane_depth", vk::Format::R32_SFLOAT, drawn.size());
    let list = draw_list(data, Attributes::Depth, views, |_| true);
    graph
        .raster("light-views/plane-depth", pass, over_depth(data))
        .depth_test(drawn)
        .color(depth, Some(ClearColor::Float([0.0; 4])))
        .draw(list);
    depth
}

/// Draws what the depth attachment shows already.
fn over_depth(data: &SceneData) -> RasterState {
    let depth = Some(DepthState { compare: vk::CompareOp::EQUAL, write: false });
    RasterState { depth, ..Attributes::Depth.raster_state(data) }
}
