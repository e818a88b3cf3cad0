//! What a reference is asked to show, and who adds up its samples.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::auto::AutoSource;
use crate::estimator::path::Path;
use crate::estimator::sppm::Sppm;
use crate::estimator::{EstimateRequest, Estimator as _, RequestSource, SampleSource};
use crate::frame::rays::TracedScene;
use crate::method::Error;
use crate::renderer::Context;
use crate::scene::{CameraView, Scene};
use crate::slot::{CausticPaths, PixelFilter};

/// How light transport is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Estimator {
    /// Path tracing with next-event estimation, and light tracing for what it finds badly.
    Path,
    /// Stochastic progressive photon mapping, for caustics that are seen in mirrors or through glass.
    Sppm,
    /// The slot `specular` by the one of these two that is less noisy at equal cost, all others by paths.
    Auto,
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
    /// Reflections and refractions at most between the eye and what mirrors and glass show, if these are no bounces
    /// ([`LightPaths::mirrors`](crate::slot::LightPaths::mirrors)).
    pub mirrors: Option<u32>,
    /// Where in a pixel light is sampled.
    pub filter: PixelFilter,
    /// Which of the equally good sequences of samples is taken.
    pub seed: u32,
}

/// Sets the seeds of references apart from those of techniques: a technique that takes some of the very samples that it is
/// compared with would look better than it is.
const SEEDS_OF_REFERENCES: u32 = 0x2545_F491;

/// Who adds up the samples of what `request` asks of `scene`.
///
/// # Errors
/// An estimator that there is not; a scene that does not fit the device.
pub(super) fn source<'a>(
    context: &Context,
    scene: &Scene,
    request: &ReferenceRequest,
) -> Result<Box<dyn SampleSource + 'a>, Error> {
    let ReferenceRequest { size, camera, estimator, bounces, caustics, mirrors, filter, seed } = request.clone();
    let device = context.shared_device();
    let request =
        EstimateRequest { size, camera, bounces, caustics, mirrors, filter, seed: seed ^ SEEDS_OF_REFERENCES };
    let scene = || TracedScene::new(device, scene).map(Arc::new);
    let running = match estimator {
        Estimator::Path => Path::open(context.pipelines())?,
        Estimator::Sppm if !matches!(caustics, CausticPaths::All | CausticPaths::Mirrored) || mirrors.is_some() => {
            return Err(Error::SppmCaustics);
        }
        Estimator::Sppm => Sppm::open(context.pipelines())?,
        Estimator::Auto => return Ok(Box::new(AutoSource::new(context, &scene()?, &request)?)),
    };
    Ok(Box::new(RequestSource::new(running, scene()?, request)))
}
