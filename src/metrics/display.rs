//! Display values of both images under one exposure, and their peak signal-to-noise ratio.

use rayon::prelude::*;

#[cfg(feature = "flip")]
use crate::image::quantize;
use crate::image::{Adaptation, ColorImage, ToneMap, tone_map_pixels};

/// Weights of Rec.709's luma, a weighted sum of encoded values.
const LUMA_WEIGHTS: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// sRGB-encoded display values in [0, 1], not rounded, of both images.
pub(super) struct Pair {
    pub(super) image: Vec<[f32; 3]>,
    pub(super) reference: Vec<[f32; 3]>,
}

impl Pair {
    /// Maps both by the ACES fit with the exposure of the reference. A black reference has none, and under none all is black; then
    /// the exposure is that of the image.
    pub(super) fn of(image: &ColorImage, reference: &ColorImage) -> Pair {
        let mut adaptation = Adaptation::of(&reference.pixels);
        if adaptation.log_average <= 0.0 {
            adaptation = Adaptation::of(&image.pixels);
        }
        let shown = |image: &ColorImage| tone_map_pixels(&image.pixels, ToneMap::Aces, adaptation);
        Pair { image: shown(image), reference: shown(reference) }
    }
}

/// The luma of display values.
pub(super) fn luma(pixels: &[[f32; 3]]) -> Vec<f64> {
    let luma =
        |pixel: &[f32; 3]| pixel.iter().zip(LUMA_WEIGHTS).map(|(value, weight)| f64::from(*value) * weight).sum();
    pixels.par_iter().map(luma).collect()
}

/// Display values as a screen shows them, in 256 levels, three bytes a pixel.
#[cfg(feature = "flip")]
pub(super) fn levels(pixels: &[[f32; 3]]) -> Vec<u8> {
    pixels.as_flattened().iter().copied().map(quantize).collect()
}

/// −10·log₁₀ of the mean squared difference over pixels and channels, 1 being white; infinite if there is none.
pub(super) fn psnr(shown: &Pair) -> f64 {
    let pairs = shown.image.as_flattened().iter().zip(shown.reference.as_flattened());
    let squares: f64 = pairs.map(|(x, r)| (f64::from(*x) - f64::from(*r)).powi(2)).sum();
    let mse = squares / (3 * shown.image.len()) as f64;
    if mse > 0.0 { -10.0 * mse.log10() } else { f64::INFINITY }
}
