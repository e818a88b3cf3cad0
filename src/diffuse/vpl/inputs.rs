//! What the method takes.

use super::options::VplOptions;
use crate::frame::gbuffer::GBuffer;
use crate::frame::geometry::Geometry;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::LightViews;
use crate::frame::rays::TracedScene;
use crate::frame::scene_data::SceneData;
use crate::graph::bindings::BufferRef;

/// What the method takes.
pub(crate) struct VplInputs<'a> {
    pub(crate) buffer: &'a GBuffer,
    pub(crate) data: &'a SceneData,
    pub(crate) geometry: &'a Geometry,
    pub(crate) set: &'a LightSet,
    pub(crate) lights: &'a LightViews,
    /// Present where rays are traced for visibility or further bounces.
    pub(crate) traced: Option<&'a TracedScene>,
    pub(crate) options: &'a VplOptions,
}

/// Number of VPLs in a buffer of two texels each.
pub(super) fn vpl_count(vpls: BufferRef<[f32; 4]>) -> u32 {
    (vpls.count() / 2) as u32
}
