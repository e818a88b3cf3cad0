//! The options of every piece, addressed as `piece.key`: their meaning, units and ranges.

use serde::{Deserialize, Serialize};

use crate::reference::PixelFilter;

/// Choices by name: an enum that is written and read as its names.
macro_rules! choices {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $text:literal),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum $name { $($(#[$variant_doc])* #[serde(rename = $text)] $variant),* }

        impl $name {
            /// The names of all choices.
            pub const NAMES: &[&str] = &[$($text),*];

            /// The name used on the command line.
            pub fn name(self) -> &'static str {
                match self { $($name::$variant => $text),* }
            }

            #[allow(dead_code, reason = "settings are read by serde")]
            pub(super) fn from_name(name: &str) -> Option<Self> {
                match name { $($text => Some($name::$variant),)* _ => None }
            }
        }
    };
}
pub(super) use choices;

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

/// Shadow-map filtering of the `shadow-map` direct method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShadowSettings {
    /// Half width of the percentage-closer filter, in texels of the light view; 0 (one bilinear tap) to 4.
    pub filter_radius: u32,
    /// Offset of the receiver along its normal, in texel widths at the receiver; 0 to 16.
    pub normal_offset: f64,
}

/// Options of the `traced` direct method, where no paths are traced.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TracedSettings {
    /// Points of emissive surfaces, and as many directions of the sky, that each pixel sends a ray to; 0 (neither gives light) to
    /// 1024. Cost: linear. Noise: at most its inverse square root. Punctual lights take one ray each whatever this says.
    pub samples: u32,
}

/// Options of the `rsm` diffuse method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RsmSettings {
    /// VPLs gathered at every pixel, shared among the lights by reflected flux; 0 to 32768. Cost: linear.
    pub vpls: u32,
}

/// Options of the methods that trace paths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathSettings {
    /// Samples a pixel of one frame; 1 to 1048576. Cost: linear. Noise: its inverse square root.
    pub spp: u32,
    /// Scatterings between the light and the first visible surface at most; 0: direct light alone; null: no limit.
    pub bounces: Option<u32>,
    /// Where in a pixel light is sampled: `center` or `box`.
    pub filter: PixelFilter,
    /// Which of the equally good sequences of samples is taken.
    pub seed: u32,
}

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

choices! {
    /// How photons find what they hit.
    PhotonTracing {
        /// Rays drawn as lines over per-pixel lists of the scene: the paper.
        Lines = "lines",
        /// Rays marched over the pixels of the same lists, past empty blocks of them.
        March = "march",
        /// A bounding volume hierarchy: exact.
        Bvh = "bvh",
    }
}
choices! {
    /// From where per-pixel lists of the scene are drawn.
    ListProjection {
        /// From the camera: the paper. What it does not see cannot be hit.
        Camera = "camera",
        /// Along fixed axes, all of the scene.
        Scene = "scene",
    }
}
choices! {
    /// How photons become irradiance.
    PhotonSplatting {
        /// The faster one: `tiles` on all devices that were measured.
        Auto = "auto",
        /// A disc a photon, drawn: the paper.
        Discs = "discs",
        /// Pixels gather the photons of their tile.
        Tiles = "tiles",
    }
}
choices! {
    /// How a photon's flux is spread over its disc. Both have unit integral.
    PhotonKernel {
        /// 3(1 − d/h)/(πh²).
        Cone = "cone",
        /// A Gaussian that ends at h.
        Gaussian = "gaussian",
    }
}

choices! {
    /// What decides the radius of a photon's disc.
    PhotonFootprint {
        /// The way from the light and the number of photons: the paper.
        Way = "way",
        /// How far apart neighbouring photons land: ray differentials.
        Beam = "beam",
    }
}

/// What stands for the scene where photons are not traced through its hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PhotonGeometry {
    /// Every surface, in lists of each pixel.
    Lists,
    /// The nearest K surfaces of each pixel, by depth peeling (Krüger et al. 2006); 1 to 16.
    Layers(u32),
}

impl Serialize for PhotonGeometry {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            PhotonGeometry::Lists => serializer.serialize_str("lists"),
            PhotonGeometry::Layers(count) => serializer.serialize_str(&format!("layers:{count}")),
        }
    }
}

impl<'de> Deserialize<'de> for PhotonGeometry {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<PhotonGeometry, D::Error> {
        let text = String::deserialize(deserializer)?;
        if text == "lists" {
            return Ok(PhotonGeometry::Lists);
        }
        let layers = text.strip_prefix("layers:").and_then(|count| count.parse().ok());
        let layers = layers.filter(|count| (1..=16).contains(count));
        layers
            .map(PhotonGeometry::Layers)
            .ok_or_else(|| serde::de::Error::custom("it takes lists or layers:1 to layers:16"))
    }
}

/// Options of the `photons` caustics method (Quyen 2014, section 3.3).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhotonSettings {
    /// Photons that leave the specular surfaces which lights see, at most; 0 to 4194304, of which buffers of 128 MiB hold 1.68 million, or 2.8
    /// million over `bounces` if that is less. Cost: linear.
    pub max: u32,
    /// Specular reflections and refractions of a photon at most; 0 (no caustics) to 16.
    pub bounces: u32,
    /// How photons find what they hit.
    pub trace: PhotonTracing,
    /// What stands for the scene, for `lines` and `march`.
    pub geometry: PhotonGeometry,
    /// From where that is drawn.
    pub projection: ListProjection,
    /// Views of the projection `scene`, along different axes; 1 to 3. A view is blind to surfaces that it sees edge-on.
    pub views: u32,
    /// Side of the lists, texels, and of the image that rays are drawn or marched over; 16 to 1024.
    pub resolution: u32,
    /// How photons become irradiance.
    pub splat: PhotonSplatting,
    /// Pixels to a side of a texel of that irradiance; 1, 2 or 4. Beyond 1 it is upsampled.
    pub downscale: u32,
    /// How a photon's flux is spread.
    pub kernel: PhotonKernel,
    /// What decides the radius of its disc.
    pub footprint: PhotonFootprint,
    /// C₀ of the radius; 0.01 to 100. `way`: h = C₀·√(A/N)·d/(R·√cosθ), A the scene's area in m², N the photons' number, d the way from the
    /// light in metres, R the scene's radius, θ the angle of incidence. `beam`: h = C₀·√2·s along each axis of an
    /// ellipse, s the way to the neighbouring photon, wider by what the lobe spreads.
    pub radius: f64,
}
