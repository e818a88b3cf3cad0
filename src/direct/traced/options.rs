//! Options of `traced`.

use serde::{Deserialize, Serialize};

/// Options of the `traced` direct method, where no paths are traced.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TracedSettings {
    /// Points of emissive surfaces, and as many directions of the sky, that each pixel sends a ray to; 0 (neither gives light) to
    /// 1024. Cost: linear. Noise: at most its inverse square root. Punctual lights take one ray each whatever this says.
    pub samples: u32,
}
