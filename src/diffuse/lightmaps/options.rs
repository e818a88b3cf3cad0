//! Options of `lightmaps`.

use crate::method::{OptionKind, choices, options};

choices! {
    /// When all texels are renewed in one frame, whatever `texels` says.
    LightmapsSettle {
        /// In frames without a past: a picture by itself shows the settled maps.
        First = "first",
        /// In every frame in which something changed; `true` is the same.
        #[serde(alias = "true")]
        Always = "always",
        /// Never: the paper; `false` is the same.
        #[serde(alias = "false")]
        Never = "never",
    }
}

choices! {
    /// What the approximated illumination map is made of.
    LightmapsSource {
        /// Direct light by shadow rays, bounces along links.
        Rays = "rays",
        /// Photons: the paper.
        Photons = "photons",
    }
}

choices! {
    /// How texels gather.
    LightmapsGather {
        /// By rays through the hierarchy.
        Rays = "rays",
        /// By drawing what they see: the paper.
        Hemicube = "hemicube",
    }
}

choices! {
    /// Which photons are sent again where something moves; those of a light that changed are in any case.
    LightmapsInvalidate {
        /// Groups of which a path crosses the bounds of what moved.
        Exact = "exact",
        /// Groups whose probe, one photon each frame, goes another way: the paper.
        Probes = "probes",
    }
}

choices! {
    /// What the slot shows: its light, or maps by themselves, to look at.
    LightmapsShow {
        /// Diffuse light.
        Light = "light",
        /// The indirect illumination map, as on white surfaces: its irradiance over π.
        Gathered = "gathered",
        /// The approximated illumination map, likewise.
        Received = "received",
    }
}

options! {
    /// Options of the `lightmaps` diffuse method (Larsen & Christensen 2004).
    LightmapsOptions, "lightmaps":
    /// Side of a texel, or more where a buffer of 128 MiB holds the links of fewer; 0: by `count`.
    texel: f64 = 0.0; OptionKind::Number(0.0, 1e6), "metres", "falls with the square";
    /// Texels on the area of all surfaces, and no more than 128 MiB hold links of; many small surfaces take up to twice as many.
    count: u32 = 24_000, draft = 8_000, high = 60_000; OptionKind::Integer(16, 1_000_000), "texels", "linear";
    /// How texels gather what the approximated illumination map says of the surfaces around.
    gather: LightmapsGather = LightmapsGather::Rays, paper = LightmapsGather::Hemicube; OptionKind::Choice(LightmapsGather::NAMES), "", "";
    /// Rays that a texel is gathered by, with `gather=rays`.
    rays: u32 = 256, draft = 96, high = 1024; OptionKind::Integer(16, 4096), "rays", "linear";
    /// Fragments along a side of what a texel sees, with `gather=hemicube`.
    fragments: u32 = 16, draft = 8, high = 32, paper = 32; OptionKind::Integer(4, 64), "fragments", "its square";
    /// How much the front of the hemicube is enlarged, and stands for the sides that are not drawn: the mean of what it shows does.
    plane: f64 = 2.0; OptionKind::Number(0.5, 8.0), "times its side", "";
    /// What the approximated illumination map is made of.
    source: LightmapsSource = LightmapsSource::Rays, paper = LightmapsSource::Photons; OptionKind::Choice(LightmapsSource::NAMES), "", "";
    /// Photons; 0: 20,000 to 200,000 by the number of surfaces.
    photons: u32 = 0, paper = 3080; OptionKind::Integer(0, 200_000), "photons", "linear";
    /// Photons that a texel's irradiance is estimated by.
    nearest: u32 = 100; OptionKind::Integer(1, 10_000), "photons", "";
    /// Which photons are sent again where something moves.
    invalidate: LightmapsInvalidate = LightmapsInvalidate::Exact, paper = LightmapsInvalidate::Probes; OptionKind::Choice(LightmapsInvalidate::NAMES), "", "";
    /// Links of each texel, along which light is moved from bounce to bounce before it is gathered.
    links: u32 = 32, draft = 16, high = 64; OptionKind::Integer(4, 256), "links", "linear";
    /// Points of emissive surfaces, and directions that look for these and the sky, by which a texel's direct light is estimated.
    samples: u32 = 32, draft = 16, high = 128; OptionKind::Integer(1, 1024), "rays", "linear";
    /// Scatterings before the surface that the picture shows. None: until next to nothing of the flux is left.
    bounces: Option<u32> = None; OptionKind::Limit(0, 64), "scatterings", "linear";
    /// When all texels are renewed in one frame; `true` is always, `false` never.
    settle: LightmapsSettle = LightmapsSettle::First, paper = LightmapsSettle::Never; OptionKind::Choice(LightmapsSettle::NAMES), "", "";
    /// Texels that a frame renews at most, those first whose light changed most.
    texels: u32 = 512, draft = 256, high = 2048, paper = 20; OptionKind::Integer(1, 1_000_000), "texels", "linear";
    /// Rounds of other rays, and of other photons, that join while nothing changes: the mean is kept. 1: none joins. Hemicubes have rounds of photons alone.
    rounds: u32 = 16, draft = 4, paper = 1; OptionKind::Integer(1, 64), "rounds", "";
    /// Share of what is left to a texel's new light that a frame goes; 1: at once.
    blend: f64 = 0.5; OptionKind::Number(0.01, 1.0), "", "";
    /// Punctual lights that have maps of their own, the first ones of the scene: dimming, tinting and switching them renews nothing.
    per_light: u32 = 0; OptionKind::Integer(0, 15), "lights", "linear";
    /// What the slot shows: its light, or one of the two maps on white surfaces, to look at.
    show: LightmapsShow = LightmapsShow::Light; OptionKind::Choice(LightmapsShow::NAMES), "", "";
}
