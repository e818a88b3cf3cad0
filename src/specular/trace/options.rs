//! Options of `trace`.

use crate::method::{OptionKind, options};

options! {
    /// Options of the `trace` specular method (Whitted 1980; Chang, Park & Ihm).
    TraceOptions, "trace":
    /// Reflections and refractions on the way to a pixel at most.
    depth: u32 = 8, draft = 4, high = 16; OptionKind::Integer(1, 32), "events", "linear where glass is seen through glass";
    /// Rays that a pixel sends out by a wide lobe which reflects a quarter of the light or more; fewer where it reflects less. Noise: at most its inverse
    /// square root. Smooth surfaces take one.
    samples: u32 = 4, draft = 1, high = 16; OptionKind::Integer(1, 256), "rays", "linear where something is rough";
    /// Points of emissive surfaces, and as many directions of the sky, that each surface which mirrors show sends a ray to; fewer where it shows little.
    light_samples: u32 = 4, draft = 1, high = 16; OptionKind::Integer(1, 256), "rays", "linear";
    /// Samples of each pixel that differs from a neighbour in surface, normal, colour, direct light or what a smooth surface shows of these; the slots `emission`,
    /// `direct`, `diffuse` and `specular` of these pixels are the mean over the pixel then. 0: of none.
    supersamples: u32 = 0, paper = 9; OptionKind::OneOf(&[0, 4, 9, 16]), "samples", "linear in pixels that differ";
    /// Contrast of colours and of light to a neighbour, |a − b|/(a + b), beyond which a pixel is sampled so.
    contrast: f64 = 0.2; OptionKind::Number(0.0, 1.0), "", "fewer pixels with larger ones";
}
