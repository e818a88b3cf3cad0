//! `vpl`: diffuse light from virtual point lights, gathered at regions of several sizes (Quyen 2014, section 3.2).

use crate::frame::gbuffer::GBuffer;
use crate::frame::geometry::Geometry;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::{LightViews, ReflectiveViews};
use crate::frame::scene_data::SceneData;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::reference::traced_scene::TracedScene;
use crate::renderer::VplSettings;

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

/// Declares the method's passes in the order in which they run; returns the slot.
pub(crate) fn vpl(graph: &mut Graph<'_>, inputs: &VplInputs<'_>) -> Option<ImageRef> {
    let _ = inputs;
    graph.skip("diffuse/vpl", "not built yet");
    None
}
