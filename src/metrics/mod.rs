//! Errors of images: how far an image is from a reference, by several measures that see different things.
//!
//! On linear radiance, over all pixels and channels: `rmse`, `rrmse`, the same of blocks of pixels, `relmse`, the ratio of the mean luminances, the bias of each
//! channel. On display values, which is what people see: `psnr`, `ssim` and `flip`; there both images are exposed for the reference,
//! so an image that is too bright counts as too bright. Sums are 64-bit and their order is fixed: the same images
//! give the same bits on any number of cores.
//!
//! ```
//! use irradia::metrics::{compare, rmse};
//! use irradia::image::ColorImage;
//!
//! # fn main() -> Result<(), irradia::metrics::MetricsError> {
//! let reference = ColorImage { size: [2, 1], pixels: vec![[1.0; 3], [3.0; 3]] };
//! let image = ColorImage { size: [2, 1], pixels: vec![[1.0; 3], [5.0; 3]] };
//! assert_eq!(rmse(&image, &reference)?, 2_f64.sqrt());
//! let comparison = compare(&image, &reference)?;
//! assert_eq!(comparison.errors.rrmse, 2_f64.sqrt() / 2.0);
//! assert_eq!(comparison.bias, [1.0; 3]);
//! # Ok(())
//! # }
//! ```

mod blocks;
mod display;
mod error;
#[cfg(feature = "flip")]
mod flip;
#[cfg(feature = "flip")]
mod heat_map;
mod infinity;
mod radiance;
mod ssim;

use serde::{Deserialize, Serialize};

pub use self::blocks::BLOCK_SIDE;
pub(crate) use self::blocks::block_rms;
pub use self::error::{MetricsError, Side};
#[cfg(feature = "flip")]
pub use self::heat_map::{HEAT_MAP_RANGE, HeatMap, heat_map};
pub use self::radiance::{RadianceErrors, radiance_errors, rmse};
use crate::image::ColorImage;

/// How far an image is from a reference. The names are those of the JSON reports, which write infinity as null.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ImageErrors {
    /// Root of the mean squared difference of linear radiance, W/(m² sr), over pixels and channels.
    pub rmse: f64,
    /// `rmse` over the mean of the reference; infinite if the reference is black and the image is not.
    #[serde(with = "infinity")]
    pub rrmse: f64,
    /// The same of the means of blocks of 8×8 pixels: what is wrong over some area, nearly without the noise of single pixels.
    #[serde(with = "infinity", default)]
    pub block_rrmse: f64,
    /// Mean of (x − r)²/(r² + ε²), with ε = 1 % of the mean of the reference; infinite where `rrmse` is.
    #[serde(with = "infinity")]
    pub relmse: f64,
    /// Peak signal-to-noise ratio of the display values, dB; infinite if they are the same.
    #[serde(with = "infinity")]
    pub psnr: f64,
    /// Structural similarity of the luma of the display values, −1 to 1; 1 for the same image.
    pub ssim: f64,
    /// Mean FLIP of the display values, 0 to 1; 0 for the same image.
    #[cfg(feature = "flip")]
    pub flip: f64,
    /// Mean luminance of the image over that of the reference; 1 if both are black, infinite if the reference alone is.
    #[serde(with = "infinity")]
    pub mean_ratio: f64,
}

/// All that is measured of an image against a reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The errors.
    #[serde(flatten)]
    pub errors: ImageErrors,
    /// Mean of the image less mean of the reference, channel by channel, W/(m² sr).
    pub bias: [f64; 3],
}

/// Measures everything. Where less is needed, [`rmse`] and [`radiance_errors`] cost a hundredth of it.
///
/// # Errors
/// The images differ in size, have no pixels, or hold values that are not finite.
pub fn compare(image: &ColorImage, reference: &ColorImage) -> Result<Comparison, MetricsError> {
    let RadianceErrors { rmse, rrmse, relmse, mean_ratio, bias } = radiance_errors(image, reference)?;
    let size = reference.size.map(|side| side as usize);
    let shown = display::Pair::of(image, reference);
    let errors = ImageErrors {
        rmse,
        rrmse,
        block_rrmse: blocks::block_rrmse(image, reference),
        relmse,
        psnr: display::psnr(&shown),
        ssim: ssim::ssim(size, &shown),
        #[cfg(feature = "flip")]
        flip: flip::mean_flip(size, &shown),
        mean_ratio,
    };
    Ok(Comparison { errors, bias })
}

#[cfg(test)]
mod tests;
