//! What all steps of the photons' ways share.

use super::choose::Choice;
use super::records::{Arrivals, LandedPhotons, PhotonRays};
use super::views::SpecularViews;
use crate::frame::rays::TracedScene;
use crate::shaders::groups::SceneRays;

/// From where photons are sent, and the memory of their ways.
pub(crate) struct Ways<'a> {
    pub(crate) views: &'a SpecularViews,
    pub(crate) choice: &'a Choice,
    pub(crate) arrivals: Arrivals,
    pub(crate) rays: PhotonRays,
    pub(crate) landed: LandedPhotons,
    /// What rays are sent through, where it is triangles.
    pub(crate) scene: Option<(&'a TracedScene, &'a SceneRays)>,
}
