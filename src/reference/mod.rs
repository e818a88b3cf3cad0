//! The truth: images by unbiased light transport, split into slots by their definition, with an honest estimate of their noise.
//!
//! A reference is made of samples of two independent halves, A and B, which differ in the scrambling of their sample sequences. The
//! image is the mean over all samples; half the difference of the halves' means has the variance of that mean, which is the
//! noise that reports state.
//!
//! ```text
//! source ──▶ blocks ──▶ file ──▶ cache, shards
//! (samples)  (exact      └────▶ result (images, noise)
//!             sums)
//! ```

mod about;
mod blocks;
mod cache;
mod camera_paths;
mod emitters;
mod error;
mod file;
mod key;
mod light_paths;
mod noise;
mod obtain;
mod paths;
mod photon_map;
mod result;
mod shard;
mod sobol;
pub(crate) mod sppm;
#[cfg(test)]
mod tests;
mod texels;
pub(crate) mod traced_scene;
pub(crate) mod tracer;

use serde::{Deserialize, Serialize};

pub use self::blocks::CHUNK_SAMPLES;
pub use self::cache::{Cache, Entry, EntryContent};
pub use self::error::ReferenceError;
pub use self::file::ReferenceFile;
pub use self::key::{REFERENCE_VERSION, ReferenceKey, caustics_name, estimator_name, filter_name};
pub use self::noise::Noise;
pub use self::obtain::{Goal, Job, MAX_SPP, Progress, obtain};
pub(crate) use self::result::sum;
pub use self::result::{IMAGE, Reference};
pub use self::shard::{Shard, merge};
use crate::renderer::{Context, Error};
use crate::scene::{CameraView, Scene};

/// How light transport is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Estimator {
    /// Path tracing with next-event estimation, and light tracing for what it finds badly.
    Path,
    /// Stochastic progressive photon mapping, for caustics that are seen in mirrors or through glass.
    Sppm,
}

/// Where in a pixel light is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PixelFilter {
    /// At its centre, as rasterisation does.
    #[default]
    Center,
    /// Evenly all over it.
    Box,
}

/// Which light the slot `caustics` shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CausticPaths {
    /// All that reaches a diffuse lobe from a specular vertex, L (D|S)* S D E: the slot's definition.
    #[default]
    All,
    /// Only what met nothing but specular lobes on its way from the light, L S⁺ D E: what photons from specular surfaces can find.
    Specular,
}

/// What a reference shows; the samples to come do not change it, they only lessen its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceRequest {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Where the picture is taken from.
    pub camera: CameraView,
    /// How light transport is estimated.
    pub estimator: Estimator,
    /// Scatterings between the light and the first visible surface at most; 0: direct light alone; `None`: no limit.
    pub bounces: Option<u32>,
    /// Which light the slot `caustics` shows.
    pub caustics: CausticPaths,
    /// Where in a pixel light is sampled.
    pub filter: PixelFilter,
    /// Which of the equally good sequences of samples is taken.
    pub seed: u32,
}

/// Sums of radiance over some samples of every pixel, W/(m² sr).
#[derive(Clone, Debug, PartialEq)]
pub struct SlotSums {
    /// Samples of each pixel that were added up.
    pub samples: u32,
    /// One row-major image for each of [`crate::renderer::Slot::ALL`].
    pub slots: [Vec<[f32; 3]>; 5],
}

/// Whoever can add up samples of a reference.
pub trait SampleSource {
    /// The sums over the samples `first .. first + count` of half `half`, 0 or 1. The same arguments give the same bits.
    ///
    /// # Errors
    /// Exhausted device memory, a lost device.
    fn sums(&mut self, half: u32, first: u32, count: u32) -> Result<SlotSums, Error>;

    /// Rays traced so far; 0 if they are not counted.
    fn rays(&self) -> u64 {
        0
    }
}

/// Sets the seeds of references apart from those of techniques: a technique that takes some of the very samples that it is
/// compared with would look better than it is.
const SEEDS_OF_REFERENCES: u32 = 0x2545_F491;

/// Who adds up the samples of what `request` asks of `scene`.
///
/// # Errors
/// An estimator that there is not; a scene that does not fit the device.
fn source<'a>(
    context: &'a Context,
    scene: &'a Scene,
    request: &'a ReferenceRequest,
) -> Result<Box<dyn SampleSource + 'a>, Error> {
    let request = ReferenceRequest { seed: request.seed ^ SEEDS_OF_REFERENCES, ..request.clone() };
    match request.estimator {
        Estimator::Path => Ok(Box::new(tracer::PathSource::new(context, scene, &request)?)),
        Estimator::Sppm if request.caustics != CausticPaths::All => Err(Error::SppmCaustics),
        Estimator::Sppm => Ok(Box::new(sppm::SppmSource::new(context, scene, &request)?)),
    }
}
