//! Options of `ambient`.

use crate::method::{OptionKind, options};

options! {
    /// Options of the `ambient` diffuse method.
    AmbientOptions, "ambient":
    /// Rays that each pixel sends into the hemisphere above it. Noise: at most its inverse square root.
    rays: u32 = 16, draft = 4, high = 64; OptionKind::Integer(0, 4096), "rays", "linear";
    /// How far a surface may be to hide the sky; 0: a fifth of the scene's radius, so that rooms without windows are not black.
    distance: f64 = 0.0; OptionKind::Number(0.0, 1e12), "metres", "grows up to the scene's size";
}
