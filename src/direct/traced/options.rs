//! Options of `traced`.

use crate::method::{OptionKind, options};

options! {
    /// Options of the `traced` direct method, where no paths are traced.
    TracedOptions, "traced":
    /// Points of emissive surfaces, and as many directions of the sky, that each pixel sends a ray to; with 0 neither gives light. Noise: at most
    /// its inverse square root. Punctual lights take one ray each whatever this says.
    samples: u32 = 4, draft = 1, high = 16; OptionKind::Integer(0, 1024), "rays", "linear";
}
