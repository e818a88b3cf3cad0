//! `vpl`: diffuse light from virtual point lights, gathered at regions of several sizes (Quyen 2014, section 3.2).

mod gather;
mod ism;
mod sample;
mod visibility;

use ash::vk;

use crate::frame::gbuffer::GBuffer;
use crate::frame::geometry::Geometry;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::{LightViews, ReflectiveViews};
use crate::frame::scene_data::SceneData;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::reference::traced_scene::TracedScene;
use crate::renderer::VplSettings;
use visibility::{Rays, Visibility};

/// What the method takes.
pub(crate) struct VplInputs<'a> {
    pub(crate) buffer: &'a GBuffer,
    pub(crate) data: &'a SceneData,
    pub(crate) geometry: &'a Geometry,
    pub(crate) set: &'a LightSet,
    pub(crate) lights: &'a LightViews,
    pub(crate) reflective: ReflectiveViews,
    /// Present where rays are traced for visibility or further bounces.
    pub(crate) traced: Option<&'a TracedScene>,
    pub(crate) settings: &'a VplSettings,
}

/// The slot, and the VPLs behind it: two texels each (glsl/lib/vpl.glsl).
pub(crate) struct Vpl {
    pub(crate) diffuse: ImageRef,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) vpls: BufferRef<[f32; 4]>,
}

/// Declares the method's passes in the order in which they run.
pub(crate) fn vpl(graph: &mut Graph<'_>, inputs: &VplInputs<'_>) -> Vpl {
    let diffuse = graph.image("diffuse", vk::Format::R32G32B32A32_SFLOAT, inputs.buffer.size);
    let vpls = sample::sample(graph, inputs);
    let rays = inputs.traced.map(|traced| Rays::new(graph, inputs, traced));
    let visibility = Visibility::new(graph, inputs, rays.as_ref(), vpls, inputs.settings.count);
    gather::gather_pixels(graph, inputs, vpls, &visibility, diffuse);
    Vpl { diffuse, vpls }
}
