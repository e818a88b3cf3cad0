//! Options of `shadow-map`.

use serde::{Deserialize, Serialize};

/// Shadow-map filtering of the `shadow-map` direct method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShadowSettings {
    /// Half width of the percentage-closer filter, in texels of the light view; 0 (one bilinear tap) to 4.
    pub filter_radius: u32,
    /// Offset of the receiver along its normal, in texel widths at the receiver; 0 to 16.
    pub normal_offset: f64,
}
