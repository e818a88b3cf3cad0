//! `photons`: caustics by photons that leave the specular surfaces which lights see (Quyen 2014, section 3.3).

#[allow(dead_code, reason = "the caller joins with the emission of photons")]
pub(crate) mod layers;
#[allow(dead_code, reason = "the caller joins with the emission of photons")]
pub(crate) mod lines;
#[allow(dead_code, reason = "the caller joins with the emission of photons")]
pub(crate) mod lists;
#[allow(dead_code, reason = "the caller joins with the emission of photons")]
pub(crate) mod march;
pub(crate) mod records;
#[allow(dead_code, reason = "the caller joins with the emission of photons")]
pub(crate) mod views;

use crate::frame::gbuffer::GBuffer;
use crate::frame::geometry::Geometry;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::LightViews;
use crate::frame::scene_data::SceneData;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::reference::traced_scene::TracedScene;
use crate::renderer::PhotonSettings;
use crate::scene::Facts;

/// What the method takes.
pub(crate) struct PhotonInputs<'a> {
    pub(crate) buffer: &'a GBuffer,
    pub(crate) data: &'a SceneData,
    pub(crate) geometry: &'a Geometry,
    pub(crate) facts: &'a Facts,
    pub(crate) set: &'a LightSet,
    pub(crate) lights: &'a LightViews,
    /// Present where photons are traced through the hierarchy.
    pub(crate) traced: Option<&'a TracedScene>,
    pub(crate) settings: &'a PhotonSettings,
}

/// Declares the method's passes in the order in which they run; returns the slot.
pub(crate) fn photons(graph: &mut Graph<'_>, inputs: &PhotonInputs<'_>) -> Option<ImageRef> {
    let _ = inputs;
    graph.skip("caustics/photons", "not built yet");
    None
}
