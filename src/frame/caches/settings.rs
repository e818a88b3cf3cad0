//! What light caches, and the lights that shine on them, are made by.

use super::cascades::CascadeRule;
use super::lights::LightRule;
use crate::frame::voxels::VoxelSettings;

/// How caches see lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CacheSight {
    /// Nothing is in between.
    Open,
    /// A ray for each group of lights and cache.
    Rays,
    /// A cone for each, through voxels.
    Cones(VoxelSettings),
}

/// Where caches lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlaceRule {
    pub(crate) cascades: CascadeRule,
    /// Caches behind surfaces move before them.
    pub(crate) moves: bool,
    /// How far off their nodes they lie at most, along each axis, in cells.
    pub(crate) jitter: f32,
}

/// What methods that light the same caches go by; equal ones are made once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CacheSettings {
    pub(crate) lights: LightRule,
    pub(crate) places: PlaceRule,
    pub(crate) sight: CacheSight,
    /// Pixels send rays to their caches.
    pub(crate) weighs_by_rays: bool,
}

impl CacheSettings {
    /// Whether rays to surfaces are sent.
    pub(crate) fn traces(&self) -> bool {
        self.sight == CacheSight::Rays || self.weighs_by_rays
    }
}
