//! Depths that triangles have by their planes, for devices whose rasteriser rounds vertices coarsely (glsl/geometry/plane_depth.glsl). Drawn twice
//! more over the depth that is there: which triangle each pixel shows, then its depth, into an image that is read in place of the other.

use ash::vk;

use super::geometry::{Attributes, DrawView, Geometry, draw_list};
use super::scene_data::SceneData;
use crate::graph::bindings::{ImageRef, Uniform};
use crate::graph::{ClearColor, Graph};
use crate::shaders::{gbuffer, groups, light_views, types};
use crate::vulkan::{DepthState, RasterState};

/// As glsl/geometry/drawn_triangle.glsl has it.
const NOTHING_DRAWN: ClearColor = ClearColor::Uint([u32::MAX; 4]);

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
    let list = || draw_list(data, Attributes::Depth, views, |_| true);
    let triangles = graph.image("gbuffer.triangles", vk::Format::R32G32_UINT, drawn.size());
    let pass = gbuffer::Drawn { geometry: geometry.clone(), camera: camera.clone() };
    graph
        .raster("gbuffer/drawn", pass, over_depth(data))
        .depth_test(drawn)
        .color(triangles, Some(NOTHING_DRAWN))
        .draw(list());
    let pass = gbuffer::PlaneDepth {
        geometry: geometry.clone(),
        camera,
        triangles: triangles.sampled(),
        push: gbuffer::PlaneDepthPush { size: drawn.size() },
    };
    let depth = graph.image("gbuffer.plane_depth", vk::Format::R32_SFLOAT, drawn.size());
    graph
        .raster("gbuffer/plane-depth", pass, over_depth(data))
        .depth_test(drawn)
        .color(depth, Some(ClearColor::Float([0.0; 4])))
        .draw(list());
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
    let list = || draw_list(data, Attributes::Depth, views, |_| true);
    let push = types::DrawnLightView { view_index: 0 };
    let triangles = graph.image("light_views.triangles", vk::Format::R32G32_UINT, drawn.size());
    let pass = light_views::Drawn { geometry: geometry.clone(), light_views: group.clone(), push };
    graph
        .raster("light-views/drawn", pass, over_depth(data))
        .depth_test(drawn)
        .color(triangles, Some(NOTHING_DRAWN))
        .draw(list());
    let pass = light_views::PlaneDepth {
        geometry: geometry.clone(),
        light_views: group.clone(),
        triangles: triangles.sampled(),
        push,
    };
    let depth = graph.image("light_views.plane_depth", vk::Format::R32_SFLOAT, drawn.size());
    graph
        .raster("light-views/plane-depth", pass, over_depth(data))
        .depth_test(drawn)
        .color(depth, Some(ClearColor::Float([0.0; 4])))
        .draw(list());
    depth
}

/// Draws what the depth attachment shows already.
fn over_depth(data: &SceneData) -> RasterState {
    let depth = Some(DepthState { compare: vk::CompareOp::EQUAL, write: false });
    RasterState { depth, ..Attributes::Depth.raster_state(data) }
}
