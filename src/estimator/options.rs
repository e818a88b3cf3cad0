//! Options of the estimators.

use serde::{Deserialize, Serialize};

use crate::slot::PixelFilter;

/// Options of the methods that trace paths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathSettings {
    /// Samples a pixel of one frame; 1 to 1048576. Cost: linear. Noise: its inverse square root.
    pub spp: u32,
    /// Scatterings between the light and the first visible surface at most; 0: direct light alone; null: no limit.
    pub bounces: Option<u32>,
    /// Where in a pixel light is sampled: `center` or `box`.
    pub filter: PixelFilter,
    /// Which of the equally good sequences of samples is taken.
    pub seed: u32,
}
