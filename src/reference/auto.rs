//! The estimator `auto`: the slot `specular` by the one of `path` and `sppm` that is less noisy at equal cost, all others by `path`.
//!
//! Paths from both ends find whatever ends in a diffuse lobe. Only what the eye sees of caustics in mirrors and through glass (L S D S E)
//! is beyond them: of lights without area altogether, and a few samples that happen to hold none look quiet, so that
//! such scenes need no pilot. Elsewhere some samples of a small picture tell. Cost is the number of rays, so that the choice does not
//! depend on what else the machine does.

use std::sync::Arc;

use crate::estimator::path::Path;
use crate::estimator::sppm::Sppm;
use crate::estimator::{EstimateRequest, Estimator as _, RequestSource, SampleSource, SlotSums};
use crate::frame::rays::TracedScene;
use crate::method::Error;
use crate::renderer::Context;
use crate::slot::{CausticPaths, Slot};

/// The place of [`Slot::Specular`] in [`Slot::ALL`].
const SPECULAR: usize = 4;
/// The longer side of the pilot's picture, pixels.
const PILOT_SIDE: u32 = 96;
/// Of each half.
const PILOT_SAMPLES: u32 = 4;
/// Photons blur what they show: they must be so much less noisy to be taken.
const MARGIN: f64 = 2.0;

/// Samples of paths, and of photons where they are better.
pub(super) struct AutoSource {
    paths: RequestSource,
    photons: Option<RequestSource>,
}

impl AutoSource {
    pub(super) fn new(
        context: &Context,
        scene: &Arc<TracedScene>,
        request: &EstimateRequest,
    ) -> Result<AutoSource, Error> {
        let by_photons = are_photons_better(context, scene, request)?;
        let name = if by_photons { Sppm::NAME } else { Path::NAME };
        tracing::info!("{} by {name}, the other slots by {}", Slot::Specular, Path::NAME);
        let photons = by_photons.then(|| photons(context, scene, request)).transpose()?;
        Ok(AutoSource { paths: paths(context, scene, request)?, photons })
    }
}

impl SampleSource for AutoSource {
    fn sums(&mut self, half: u32, first: u32, count: u32) -> Result<SlotSums, Error> {
        let mut sums = self.paths.sums(half, first, count)?;
        if let Some(photons) = &mut self.photons {
            let mut by_photons = photons.sums(half, first, count)?;
            std::mem::swap(&mut sums.slots[SPECULAR], &mut by_photons.slots[SPECULAR]);
        }
        Ok(sums)
    }

    fn rays(&self) -> u64 {
        self.paths.rays() + self.photons.as_ref().map_or(0, SampleSource::rays)
    }
}

fn paths(context: &Context, scene: &Arc<TracedScene>, request: &EstimateRequest) -> Result<RequestSource, Error> {
    Ok(RequestSource::new(Path::open(context.pipelines())?, scene.clone(), request.clone()))
}

fn photons(context: &Context, scene: &Arc<TracedScene>, request: &EstimateRequest) -> Result<RequestSource, Error> {
    Ok(RequestSource::new(Sppm::open(context.pipelines())?, scene.clone(), request.clone()))
}

/// Whether `specular` is left to them.
fn are_photons_better(context: &Context, scene: &Arc<TracedScene>, request: &EstimateRequest) -> Result<bool, Error> {
    // L S D S E scatters twice before the eye's surface.
    let caustics = scene.needs_light_paths(request.bounces) && request.bounces != Some(1);
    // Photons know no narrower caustics.
    let known = matches!(request.caustics, CausticPaths::All | CausticPaths::Mirrored);
    if !caustics || !known || request.mirrors.is_some() {
        return Ok(false);
    }
    if scene.punctual_count > 0 {
        return Ok(true);
    }
    let pilot = EstimateRequest { size: pilot_size(request.size), ..request.clone() };
    let by_paths = cost(&mut paths(context, scene, &pilot)?)?;
    let by_photons = cost(&mut photons(context, scene, &pilot)?)?;
    Ok(MARGIN * MARGIN * by_photons < by_paths)
}

/// Variance of `specular` times rays.
fn cost(source: &mut RequestSource) -> Result<f64, Error> {
    let halves = [source.sums(0, 0, PILOT_SAMPLES)?, source.sums(1, 0, PILOT_SAMPLES)?];
    let [a, b] = halves.each_ref().map(|half| half.slots[SPECULAR].as_flattened());
    let squares: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum();
    Ok(squares * source.rays() as f64)
}

/// The same shape, no larger than the pilot's side.
fn pilot_size(size: [u32; 2]) -> [u32; 2] {
    let longer = size[0].max(size[1]).max(1);
    size.map(|side| if longer > PILOT_SIDE { (side * PILOT_SIDE / longer).max(1) } else { side })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn specular_has_its_place() {
        assert_eq!(Slot::ALL[SPECULAR], Slot::Specular);
    }

    #[test]
    fn pilots_are_small_and_of_the_same_shape() {
        assert_eq!(pilot_size([512, 256]), [96, 48]);
        assert_eq!(pilot_size([64, 48]), [64, 48]);
        assert_eq!(pilot_size([4000, 3]), [96, 1]);
    }
}
