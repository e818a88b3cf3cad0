//! What all methods share of a frame.

use super::caches::CacheSettings;
use super::gbuffer::GBuffer;
use super::geometry::Geometry;
use super::light_set::LightSet;
use super::light_views::LightViews;
use super::offers::Offers;
use super::rays::TracedScene;
use super::scene_data::SceneData;
use crate::scene::Facts;
use crate::shaders::types;

/// Where in a sequence a frame stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(dead_code, reason = "no method adapts over frames yet; those that do come later")]
pub(crate) struct FrameTime {
    pub(crate) index: u32,
    /// Since the frame before, seconds, not negative.
    pub(crate) step: f32,
}

/// The scene on the device, the first visible surfaces, the lights.
pub(crate) struct FrameInputs<'f> {
    pub(crate) data: &'f SceneData,
    pub(crate) facts: &'f Facts,
    pub(crate) geometry: &'f Geometry,
    pub(crate) camera: &'f types::Camera,
    /// Radiance where there is no surface, W/(m² sr).
    pub(crate) sky: [f32; 3],
    #[allow(dead_code, reason = "as above")]
    pub(crate) time: FrameTime,
    pub(crate) surface: &'f GBuffer,
    pub(crate) set: &'f LightSet,
    /// Those of light caches, for methods that take these as `volumes` has them.
    pub(crate) caches: CacheSettings,
    /// Present where some method takes them and something shines.
    pub(crate) lights: Option<LightViews>,
    pub(crate) traced: Option<&'f TracedScene>,
    /// Whether light that a method keeps on surfaces is taken off the device (`stored_light.rs`), and on how many texels along a side of its own.
    pub(crate) stored_light: Option<u32>,
    /// What methods that declared earlier offer to later ones.
    pub(crate) offers: Offers,
    /// Whether mirrors show lamps and the sky in the slot `direct`; else whoever follows reflections has to show them.
    pub(crate) mirrored_lamps: bool,
    /// Whether somebody does so who follows reflections.
    pub(crate) follows_lamps: bool,
}

impl FrameInputs<'_> {
    /// The views from the lights, for what takes them.
    pub(crate) fn light_views(&self) -> &LightViews {
        self.lights.as_ref().expect("made for every method that takes them, where something shines")
    }
}
