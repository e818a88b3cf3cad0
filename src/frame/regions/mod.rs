//! Regions of several sizes in place of pixels (Quyen 2014, section 3.2.2): irradiance is found once for each, and interpolated between them.

mod interpolate;
mod pyramid;
mod stencil;

pub(crate) use self::interpolate::interpolate;
pub(crate) use self::pyramid::{Pyramid, level_count, pyramid, signed};
pub(crate) use self::stencil::{VALID, flattened_size, mark};

/// What makes pixels one region, and for whom.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionRule {
    /// The passes' names begin with it, the images' with its last level.
    pub(crate) piece: &'static str,
    /// How far a region may be from a plane, over its distance.
    pub(crate) depth_threshold: f32,
    /// By how much a component of the unit normal may vary.
    pub(crate) normal_threshold: f32,
}

impl RegionRule {
    pub(crate) fn pass(&self, name: &str) -> String {
        format!("{}/{name}", self.piece)
    }

    pub(crate) fn resource(&self, name: &str) -> String {
        let method = self.piece.rsplit('/').next().unwrap_or(self.piece);
        format!("{method}.{name}")
    }
}
