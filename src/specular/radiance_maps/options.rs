//! Options of `radiance-maps`.

use crate::method::{OptionKind, choices, options};

choices! {
    /// Where the light of a map is summed up.
    RadianceMapsWrite {
        /// Where it stays, light by light: the paper's default.
        Direct = "direct",
        /// In memory that its invocations share. The same bits.
        Cached = "cached",
    }
}
choices! {
    /// What is done about texels that no light is written to.
    RadianceMapsFill {
        /// Nothing: a light is written to one texel. The paper.
        None = "none",
        /// They get the mean of what lies around them: what the paper tried.
        PullPush = "pull-push",
        /// Lights are written as large as they are.
        Footprint = "footprint",
        /// Each texel looks for the lights that it shows.
        Search = "search",
    }
}
choices! {
    /// How surfaces reflect what maps show.
    RadianceMapsLobe {
        /// By a Blinn-Phong lobe made of roughness: the paper.
        BlinnPhong = "blinn-phong",
        /// By GGX, as direct light.
        Ggx = "ggx",
    }
}
choices! {
    /// Where a pixel looks its caches' maps up.
    RadianceMapsLookup {
        /// Where its own map would show its normal: the paper.
        Normal = "normal",
        /// Where each shows the direction that the pixel mirrors.
        Mirror = "mirror",
    }
}

options! {
    /// Options of the `radiance-maps` specular method (Reich 2015). Its caches and lights are those of `volumes.*`.
    RadianceMapsOptions, "radiance_maps":
    /// Texels along an edge of a cache's map. Narrower lobes than a texel are blurred to it.
    size: u32 = 16, draft = 8, high = 32; OptionKind::OneOf(&[4, 8, 16, 32, 64]), "texels", "quadratic";
    /// Where the light of a map is summed up. Maps of 64² are always written directly.
    write: RadianceMapsWrite = RadianceMapsWrite::Direct; OptionKind::Choice(RadianceMapsWrite::NAMES), "", "";
    /// What is done about texels that no light is written to.
    fill: RadianceMapsFill = RadianceMapsFill::Footprint, paper = RadianceMapsFill::None; OptionKind::Choice(RadianceMapsFill::NAMES), "", "";
    /// Maps are means over so many frames, each with lights drawn anew from what the light views see.
    frames: u32 = 1; OptionKind::Integer(1, 256), "frames", "";
    /// How surfaces reflect what maps show.
    lobe: RadianceMapsLobe = RadianceMapsLobe::Ggx, paper = RadianceMapsLobe::BlinnPhong; OptionKind::Choice(RadianceMapsLobe::NAMES), "", "";
    /// Where a pixel looks its caches' maps up.
    lookup: RadianceMapsLookup = RadianceMapsLookup::Mirror, paper = RadianceMapsLookup::Normal; OptionKind::Choice(RadianceMapsLookup::NAMES), "", "";
}
