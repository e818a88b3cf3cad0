//! What the method takes.

use super::options::PhotonOptions;
use crate::frame::gbuffer::GBuffer;
use crate::frame::geometry::Geometry;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::LightViews;
use crate::frame::rays::TracedScene;
use crate::frame::scene_data::SceneData;
use crate::scene::Facts;
use crate::shaders::types;

/// What the method takes.
pub(crate) struct PhotonInputs<'a> {
    pub(crate) buffer: &'a GBuffer,
    pub(crate) data: &'a SceneData,
    pub(crate) geometry: &'a Geometry,
    pub(crate) facts: &'a Facts,
    pub(crate) camera: &'a types::Camera,
    pub(crate) set: &'a LightSet,
    pub(crate) lights: &'a LightViews,
    /// Present where photons are traced through the hierarchy.
    pub(crate) traced: Option<&'a TracedScene>,
    pub(crate) options: &'a PhotonOptions,
}
