//! Slots: the parts of the light at the first visible surface. They add up to the image. And which light an image shows: its paths, and where in
//! a pixel it is sampled.

use serde::{Deserialize, Serialize};

/// One part of the light that leaves the first visible surface x towards the eye. With D and S an event in the
/// diffuse or the specular lobe, L the light, E the eye:
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Slot {
    /// L E: the surface itself emits; also the sky where no surface is.
    Emission,
    /// L (D|S) E: from the lights, shadowed.
    Direct,
    /// L (D|S)* D D E: the last vertex before x scattered diffusely, x's diffuse lobe answers.
    Diffuse,
    /// L (D|S)* S D E: the last vertex before x scattered specularly, x's diffuse lobe answers.
    Caustics,
    /// L (D|S)+ S E: x's specular lobe answers to anything but the lights themselves.
    Specular,
}

impl Slot {
    /// All slots, in the order in which images list them.
    pub const ALL: [Slot; 5] = [Slot::Emission, Slot::Direct, Slot::Diffuse, Slot::Caustics, Slot::Specular];

    /// The name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Slot::Emission => "emission",
            Slot::Direct => "direct",
            Slot::Diffuse => "diffuse",
            Slot::Caustics => "caustics",
            Slot::Specular => "specular",
        }
    }

    /// The slot called `name`, if there is one.
    pub fn from_name(name: &str) -> Option<Slot> {
        Slot::ALL.into_iter().find(|slot| slot.name() == name)
    }
}

impl std::fmt::Display for Slot {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// The name of the sum of all slots where parts of a picture go by name.
pub const IMAGE: &str = "image";

/// Where in a pixel light is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum PixelFilter {
    /// At its centre, as rasterisation does.
    #[default]
    Center,
    /// Evenly all over it.
    Box,
}

impl PixelFilter {
    /// All of them.
    pub const ALL: [PixelFilter; 2] = [PixelFilter::Center, PixelFilter::Box];
    /// Their names.
    pub const NAMES: &[&str] = &["center", "box"];

    /// The name on the command line and in files.
    pub fn name(self) -> &'static str {
        PixelFilter::NAMES[self as usize]
    }
}

/// Which caustics there are: in the slot `caustics`, and in mirrors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum CausticPaths {
    /// All that reaches a diffuse lobe from a specular vertex, L (D|S)* S D E: the slot's definition.
    #[default]
    All,
    /// Only what met nothing but specular lobes on its way from the light, L S⁺ D E: what photons from specular surfaces can find.
    Specular,
    /// None in what mirrors and glass show, L (D|S)* S D S⁺ E: what rays that follow reflections find of the slot `specular`. It has besides what of the slot
    /// `direct` only they find: lamps and the sky behind one surface of glass, and unlit surfaces in mirrors.
    Unmirrored,
    /// All, and in mirrors too; the two slots have what they have of `Unmirrored`.
    Mirrored,
    /// None, and nothing else specular before the first visible surface: L D* D E and L D⁺ S E, what maps of diffusely lit surfaces can show.
    None,
}

impl CausticPaths {
    /// All of them.
    pub const ALL: [CausticPaths; 5] = [
        CausticPaths::All,
        CausticPaths::Specular,
        CausticPaths::Unmirrored,
        CausticPaths::Mirrored,
        CausticPaths::None,
    ];

    /// The name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            CausticPaths::All => "all",
            CausticPaths::Specular => "specular",
            CausticPaths::Unmirrored => "unmirrored",
            CausticPaths::Mirrored => "mirrored",
            CausticPaths::None => "none",
        }
    }
}

/// The light that a slot shows, or that a method can find for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct LightPaths {
    /// Scatterings between the light and the first visible surface at most; `None`: no limit.
    pub bounces: Option<u32>,
    /// Which caustics there are.
    pub caustics: CausticPaths,
    /// Reflections and refractions between the eye and the surface that mirrors and glass show, at most; `bounces` are those between the light and that surface
    /// then. The last surface's specular lobe answers to lamps and the sky if it is wide. `None`: they are bounces like
    /// others.
    pub mirrors: Option<u32>,
}

impl LightPaths {
    /// All paths with at most so many scatterings before the first visible surface.
    pub fn up_to(bounces: impl Into<Option<u32>>) -> LightPaths {
        LightPaths { bounces: bounces.into(), caustics: CausticPaths::All, mirrors: None }
    }
}
