//! What makes pixels one region.

/// What makes pixels one region, and for whom.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionRule {
    /// The passes' names begin with it, the images' with its last level.
    pub(crate) piece: &'static str,
    /// How far a region may be from a plane, over its distance.
    pub(crate) depth_threshold: f32,
    /// By how much a component of the unit normal may vary.
    pub(crate) normal_threshold: f32,
    /// By how much depth may change over it, over its distance.
    pub(crate) slope_threshold: f32,
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
