//! Options of `rsm`.

use serde::{Deserialize, Serialize};

/// Options of the `rsm` diffuse method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RsmSettings {
    /// VPLs gathered at every pixel, shared among the lights by reflected flux; 0 to 32768. Cost: linear.
    pub vpls: u32,
}
