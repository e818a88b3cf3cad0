//! Options of what stands for the lights.

use serde::{Deserialize, Serialize};

/// What stands for the scene's lights, and the resolution of their views.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightSettings {
    /// Side of a spot, directional or point-face light view, in texels; 16 to 4096.
    pub resolution: u32,
    /// Cosine emitters that stand for all emissive surfaces together; 0 to 256.
    pub emitter_samples: u32,
    /// Side of an emitter sample's hemicube top, in texels; 16 to 1024.
    pub emitter_resolution: u32,
    /// Directional lights that stand for a `--sky`; 1 to 256.
    pub sky_samples: u32,
}
