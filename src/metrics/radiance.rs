//! Errors of linear radiance: sums over pixels and channels.

use rayon::prelude::*;

use super::MetricsError;
use super::error::{check_sizes, find_unsound};
use crate::image::{ColorImage, LUMINANCE_WEIGHTS};

/// ε of `relmse` over the mean of the reference: below a hundredth of the mean an error counts as if the reference were that bright.
const EPSILON_SHARE_OF_MEAN: f64 = 0.01;

/// Pixels that are added up in one go. Blocks are added in their order, so the sum does not depend on the number of threads.
const BLOCK_PIXELS: usize = 4096;

/// The errors of linear radiance alone, see [`super::ImageErrors`] and [`super::Comparison`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadianceErrors {
    /// Root of the mean squared difference, W/(m² sr).
    pub rmse: f64,
    /// `rmse` over the mean of the reference.
    pub rrmse: f64,
    /// Mean of (x − r)²/(r² + ε²), ε being 1 % of the mean of the reference.
    pub relmse: f64,
    /// Mean luminance of the image over that of the reference.
    pub mean_ratio: f64,
    /// Mean of the image less mean of the reference, channel by channel, W/(m² sr).
    pub bias: [f64; 3],
}

/// Root of the mean squared difference of linear radiance over pixels and channels, W/(m² sr).
///
/// # Errors
/// The images differ in size, have no pixels, or hold values that are not finite.
pub fn rmse(image: &ColorImage, reference: &ColorImage) -> Result<f64, MetricsError> {
    Ok(Sums::of(image, reference)?.rmse())
}

/// What [`super::compare`] says of linear radiance, without what takes its time.
///
/// # Errors
/// Those of [`rmse`].
pub fn radiance_errors(image: &ColorImage, reference: &ColorImage) -> Result<RadianceErrors, MetricsError> {
    let sums = Sums::of(image, reference)?;
    let rmse = sums.rmse();
    let mean = sums.reference.iter().sum::<f64>() / sums.value_count();
    let (rrmse, relmse) = if mean > 0.0 {
        (rmse / mean, relmse(image, reference, EPSILON_SHARE_OF_MEAN * mean))
    } else {
        // Against a black reference any error is infinitely large.
        let error = if rmse == 0.0 { 0.0 } else { f64::INFINITY };
        (error, error)
    };
    let luminance =
        |sums: [f64; 3]| sums.iter().zip(LUMINANCE_WEIGHTS).map(|(sum, weight)| sum * f64::from(weight)).sum();
    let mean_ratio = ratio(luminance(sums.image), luminance(sums.reference));
    let bias = std::array::from_fn(|channel| (sums.image[channel] - sums.reference[channel]) / sums.pixel_count as f64);
    Ok(RadianceErrors { rmse, rrmse, relmse, mean_ratio, bias })
}

/// 1 for zero over zero, infinite for all else over zero.
fn ratio(image: f64, reference: f64) -> f64 {
    match (image == 0.0, reference == 0.0) {
        (true, true) => 1.0,
        (false, true) => f64::INFINITY,
        _ => image / reference,
    }
}

fn relmse(image: &ColorImage, reference: &ColorImage, epsilon: f64) -> f64 {
    let sums =
        block_sums(image, reference, 0.0, |sum, x, r, _| *sum += (x - r) * (x - r) / (r * r + epsilon * epsilon));
    sums.iter().sum::<f64>() / (3 * image.pixels.len()) as f64
}

/// Sums over all pixels.
#[derive(Clone, Copy, Default)]
struct Sums {
    pixel_count: usize,
    /// Of the squared differences.
    squares: f64,
    /// Of the image, channel by channel.
    image: [f64; 3],
    /// Of the reference, channel by channel.
    reference: [f64; 3],
}

impl Sums {
    fn of(image: &ColorImage, reference: &ColorImage) -> Result<Sums, MetricsError> {
        check_sizes(image, reference)?;
        let blocks = block_sums(image, reference, Sums::default(), |sums, x, r, channel| {
            sums.squares += (x - r) * (x - r);
            sums.image[channel] += x;
            sums.reference[channel] += r;
        });
        let mut sums = Sums { pixel_count: image.pixels.len(), ..Sums::default() };
        for block in blocks {
            sums.squares += block.squares;
            for channel in 0..3 {
                sums.image[channel] += block.image[channel];
                sums.reference[channel] += block.reference[channel];
            }
        }
        // Squares of finite 32-bit values are finite in 64 bits, so one unsound pixel, and nothing else, makes this sum unsound.
        let unsound = if sums.squares.is_finite() { None } else { find_unsound(image, reference) };
        unsound.map_or(Ok(sums), Err)
    }

    fn value_count(&self) -> f64 {
        (3 * self.pixel_count) as f64
    }

    fn rmse(&self) -> f64 {
        (self.squares / self.value_count()).sqrt()
    }
}

/// Calls `add` for every value of each block of pixels, with the block's sum, the image's value, the reference's and the channel.
fn block_sums<S: Copy + Send + Sync>(
    image: &ColorImage,
    reference: &ColorImage,
    zero: S,
    add: impl Fn(&mut S, f64, f64, usize) + Sync,
) -> Vec<S> {
    let blocks = image.pixels.par_chunks(BLOCK_PIXELS).zip(reference.pixels.par_chunks(BLOCK_PIXELS));
    let block_sum = |(image, reference): (&[[f32; 3]], &[[f32; 3]])| {
        let mut sum = zero;
        for (x, r) in image.iter().zip(reference) {
            for channel in 0..3 {
                add(&mut sum, f64::from(x[channel]), f64::from(r[channel]), channel);
            }
        }
        sum
    };
    blocks.map(block_sum).collect()
}
