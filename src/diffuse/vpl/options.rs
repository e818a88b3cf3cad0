//! Options of `vpl`.

use serde::{Deserialize, Serialize};

use crate::method::choices;

choices! {
    /// Whether light from a virtual point light may be blocked.
    VplVisibility {
        /// It never is: the paper.
        None = "none",
        /// Imperfect shadow maps (Ritschel et al. 2008): a small depth map a VPL, drawn from points on the surfaces.
        Ism = "ism",
        /// One ray for each VPL and region.
        Traced = "traced",
    }
}
choices! {
    /// Where the irradiance of VPLs is gathered.
    VplShading {
        /// The faster of `stencil` and `compute` for the type of device.
        Auto = "auto",
        /// Regions of several sizes, marked in the stencil of one flattened image: the paper.
        Stencil = "stencil",
        /// The same regions, from lists that a compute pass makes.
        Compute = "compute",
        /// Every pixel.
        Pixels = "pixels",
    }
}

/// Options of the `vpl` diffuse method (Quyen 2014, section 3.2).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VplSettings {
    /// VPLs of the first bounce, shared among the lights by reflected flux; 0 to 65536. Cost: linear.
    pub count: u32,
    /// Scatterings between the light and the first visible surface at most; 0 (no indirect light) to 16. Each beyond the first takes
    /// rays from the VPLs of the one before.
    pub bounces: u32,
    /// Whether light from a VPL may be blocked.
    pub visibility: VplVisibility,
    /// Where irradiance is gathered.
    pub shading: VplShading,
    /// Sizes of regions: 1 (pixels alone) to 7 (1 to 64 pixels a side, but at most a thirty-second of the image's shorter side).
    pub levels: u32,
    /// How far a region may be from a plane, over its distance; 0 to 1. Larger: fewer regions, light that bleeds over edges.
    pub depth_threshold: f64,
    /// By how much a component of the unit normal may vary in a region; 0 to 2.
    pub normal_threshold: f64,
    /// Side of an imperfect shadow map, texels; 8 to 128.
    pub ism_resolution: u32,
    /// Points drawn into each imperfect shadow map; 16 to 65536.
    pub ism_points: u32,
}
