//! What the light views show of surfaces that reflect or transmit specularly (glsl/photons/specular_targets.glsl).
//!
//! The views hold depth, and what virtual point lights need if a method asks for those. Photons need other things of few texels: the
//! instances that have such a lobe are drawn once more, over the views' depth, where they equal it.

use ash::vk;

use crate::frame::geometry::{Attributes, draw_list};
use crate::frame::inputs::FrameInputs;
use crate::frame::light_views::draw_views;
use crate::frame::scene_data::{DrawnInstance, SceneData};
use crate::graph::bindings::ImageRef;
use crate::graph::{ClearColor, Graph};
use crate::shaders::photons::{Specular, SpecularTextured};
use crate::shaders::types::DrawnLightView;
use crate::vulkan::{DepthState, RasterState};

/// Images of the light views' atlas.
#[derive(Clone, Copy)]
pub(crate) struct SpecularViews {
    /// W: the flux that a texel receives, times the share that its specular lobes may send on; 0 where there is no such surface. The other
    /// images hold nothing there.
    pub(crate) mask: ImageRef,
    pub(crate) surface: ImageRef,
    pub(crate) layer: ImageRef,
}

/// Declares the passes; `piece`: the method's.
pub(crate) fn specular_views(graph: &mut Graph<'_>, frame: &FrameInputs<'_>, piece: &str) -> SpecularViews {
    let (data, geometry, set, lights) = (frame.data, frame.geometry, frame.set, frame.light_views());
    let size = set.atlas.size.map(|side| side.max(1));
    let made = SpecularViews {
        mask: graph.image("photons.mask", vk::Format::R32_SFLOAT, size),
        surface: graph.image("photons.surface", vk::Format::R32G32B32A32_UINT, size),
        layer: graph.image("photons.layer", vk::Format::R32G32_UINT, size),
    };
    let views = draw_views(set);

    let plain = |drawn: &DrawnInstance| drawn.specular && !drawn.textured;
    let pass = Specular {
        geometry: geometry.clone(),
        light_views: lights.group.clone(),
        push: DrawnLightView { view_index: 0 },
    };
    let list = draw_list(data, Attributes::Plain, &views, plain);
    graph
        .raster(&format!("{piece}/choose/views"), pass, over_depth(Attributes::Plain, data))
        .depth_test(lights.drawn_depth)
        .color_fresh(made.surface)
        .color_fresh(made.layer)
        .color(made.mask, Some(ClearColor::Float([0.0; 4])))
        .draw(list);

    let textured_name = format!("{piece}/choose/views-textured");
    let textured = |drawn: &DrawnInstance| drawn.specular && drawn.textured;
    if !data.drawn.iter().any(textured) {
        graph.skip(&textured_name, "no textured specular surface");
        return made;
    }
    let pass = SpecularTextured {
        geometry: geometry.clone(),
        light_views: lights.group.clone(),
        textures: data.texture_kinds(textured),
        push: DrawnLightView { view_index: 0 },
    };
    let list = draw_list(data, Attributes::Textured, &views, textured);
    graph
        .raster(&textured_name, pass, over_depth(Attributes::Textured, data))
        .depth_test(lights.drawn_depth)
        .color(made.surface, None)
        .color(made.layer, None)
        .color(made.mask, None)
        .draw(list);
    made
}

/// Draws what the depth attachment shows already.
fn over_depth(attributes: Attributes, data: &SceneData) -> RasterState {
    let depth = Some(DepthState { compare: vk::CompareOp::EQUAL, write: false });
    RasterState { depth, ..attributes.raster_state(data) }
}
