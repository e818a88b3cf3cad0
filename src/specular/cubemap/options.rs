//! Options of `cubemap`.

use crate::method::{OptionKind, options};

options! {
    /// Options of the `cubemap` specular method (Larsen & Christensen 2004).
    CubemapOptions, "cubemap":
    /// Texels along an edge of a map's faces. Mirrors are as sharp as a texel.
    resolution: u32 = 128, draft = 64, high = 256; OptionKind::OneOf(&[32, 64, 128, 256, 512]), "texels", "quadratic";
    /// Objects that get a map at most, the largest on the screen first. What belongs to none looks up the nearest one's.
    objects: u32 = 8, draft = 4, high = 16; OptionKind::Integer(1, 32), "maps", "linear";
    /// Points of emissive surfaces, and as many directions of the sky, that the surface at each texel sends a ray to.
    light_samples: u32 = 16, draft = 4, high = 64; OptionKind::Integer(1, 256), "rays", "linear";
}
