//! Options of `vpl`.

use crate::method::{OptionKind, choices, options};

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

options! {
    /// Options of the `vpl` diffuse method (Quyen 2014, section 3.2).
    VplOptions, "vpl":
    /// VPLs of the first bounce, shared among the lights by reflected flux.
    count: u32 = 256, draft = 64, high = 320; OptionKind::Integer(0, 65536), "VPLs", "linear";
    /// Scatterings between the light and the first visible surface at most; 0: no indirect light. Each beyond the first takes rays from the VPLs of
    /// the one before.
    bounces: u32 = 1, high = 16; OptionKind::Integer(0, 16), "scatterings", "linear";
    /// Whether light from a VPL may be blocked.
    visibility: VplVisibility = VplVisibility::None, high = VplVisibility::Traced; OptionKind::Choice(VplVisibility::NAMES), "", "";
    /// Where irradiance is gathered.
    shading: VplShading = VplShading::Auto, paper = VplShading::Stencil; OptionKind::Choice(VplShading::NAMES), "", "";
    /// Sizes of regions: 1 (pixels alone) to 7 (1 to 64 pixels a side, but at most a thirty-second of the image's shorter side).
    levels: u32 = 7; OptionKind::Integer(1, 7), "sizes", "falls";
    /// How far a region may be from a plane, over its distance. Larger: fewer regions, light that bleeds over edges.
    depth_threshold: f64 = 0.01; OptionKind::Number(0.0, 1.0), "", "falls";
    /// By how much a component of the unit normal may vary in a region.
    normal_threshold: f64 = 0.1; OptionKind::Number(0.0, 2.0), "", "falls";
    /// Side of an imperfect shadow map.
    ism_resolution: u32 = 32; OptionKind::Integer(8, 128), "texels", "quadratic";
    /// Points drawn into each imperfect shadow map.
    ism_points: u32 = 2048; OptionKind::Integer(16, 65536), "points", "linear";
}
