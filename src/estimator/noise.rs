//! How noisy a reference is, by its two halves.
//!
//! The halves A and B are independent and have as many samples each, so half the difference of their means, (A − B)/2, has
//! expectation 0 and the variance of the mean of all samples, (A + B)/2, at every pixel. Its root mean square over the image
//! therefore estimates the standard deviation of the reference, averaged over the image the same way.
//!
//! It is one realisation. With n independent values of like variance its relative uncertainty is 1/√(2n), 0.1 % for 640×480
//! pixels of three channels; but few bright outliers (a path that found a small lamp by chance) can hold most of the variance, and
//! then so many values count as there are outliers. An effect that no sample has met yet is in neither half and not in the noise.

use serde::{Deserialize, Serialize};

/// The noise of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Root of the mean variance over all pixels and channels, W/(m² sr).
    pub rmse: f64,
    /// `rmse` over `mean`; 0 for an image that is black in all samples.
    pub rrmse: f64,
    /// Mean of the image over all pixels and channels, W/(m² sr).
    pub mean: f64,
}

impl Noise {
    /// Of a sum of images, by the images and half the differences of their halves, alike in number.
    pub(crate) fn of_sum(images: &[&[[f32; 3]]], half_differences: &[&[[f32; 3]]]) -> Noise {
        let count = images.first().map_or(0, |image| 3 * image.len());
        let values = |images: &[&[[f32; 3]]], index: usize| {
            images.iter().map(|image| f64::from(image.as_flattened()[index])).sum::<f64>()
        };
        let divisor = count.max(1) as f64;
        let mean = (0..count).map(|index| values(images, index)).sum::<f64>() / divisor;
        let squares = (0..count).map(|index| values(half_differences, index).powi(2)).sum::<f64>();
        let rmse = (squares / divisor).sqrt();
        let rrmse = if rmse == 0.0 { 0.0 } else { rmse / mean };
        Noise { rmse, rrmse, mean }
    }
}
