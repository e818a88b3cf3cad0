//! Options of `photons`.

use serde::{Deserialize, Serialize};

use crate::method::{OptionKind, choices, options};

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
#[non_exhaustive]
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

options! {
    /// Options of the `photons` caustics method (Quyen 2014, section 3.3).
    PhotonOptions, "photons":
    /// Photons that leave the specular surfaces which lights see; buffers of 128 MiB hold 1.68 million, or 2.8 million over `bounces` if
    /// that is less. All of them are sent.
    max: u32 = 38_000, draft = 9_500, paper = 38_146; OptionKind::Integer(0, 1 << 22), "photons", "linear";
    /// Specular reflections and refractions of a photon at most; 0: no caustics.
    bounces: u32 = 2, high = 4, paper = 1; OptionKind::Integer(0, 16), "scatterings", "linear";
    /// How photons find what they hit.
    trace: PhotonTracing = PhotonTracing::Bvh, paper = PhotonTracing::Lines; OptionKind::Choice(PhotonTracing::NAMES), "", "";
    /// What stands for the scene, for `lines` and `march`.
    geometry: PhotonGeometry = PhotonGeometry::Lists; OptionKind::Text("lists or layers:1 to layers:16"), "", "";
    /// From where that is drawn.
    projection: ListProjection = ListProjection::Scene, paper = ListProjection::Camera; OptionKind::Choice(ListProjection::NAMES), "", "";
    /// Views of the projection `scene`, along different axes. A view is blind to surfaces that it sees edge-on.
    views: u32 = 3; OptionKind::Integer(1, 3), "views", "linear";
    /// Side of the lists, and of the image that rays are drawn or marched over.
    resolution: u32 = 128; OptionKind::Integer(16, 1024), "texels", "quadratic for lists, linear for rays";
    /// How photons become irradiance.
    splat: PhotonSplatting = PhotonSplatting::Auto, paper = PhotonSplatting::Discs; OptionKind::Choice(PhotonSplatting::NAMES), "", "";
    /// Pixels to a side of a texel of that irradiance. Beyond 1 it is upsampled.
    downscale: u32 = 1, draft = 2, paper = 4; OptionKind::OneOf(&[1, 2, 4]), "pixels", "falls quadratically";
    /// How a photon's flux is spread.
    kernel: PhotonKernel = PhotonKernel::Gaussian; OptionKind::Choice(PhotonKernel::NAMES), "", "";
    /// What decides the radius of its disc.
    footprint: PhotonFootprint = PhotonFootprint::Beam, paper = PhotonFootprint::Way; OptionKind::Choice(PhotonFootprint::NAMES), "", "";
    /// C₀ of the radius. `way`: h = C₀·√(A/N)·d/(R·√cosθ), A the scene's area in m², N the photons' number, d the way from the
    /// light in metres, R the scene's radius, θ the angle of incidence. `beam`: h = C₀·√2·s along each axis of an
    /// ellipse, s the way to the neighbouring photon, wider by what the lobe spreads.
    radius: f64 = 1.0; OptionKind::Number(0.01, 100.0), "", "quadratic";
}
