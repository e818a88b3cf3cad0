//! Where an image is wrong: the error of every pixel as a colour.

use rayon::prelude::*;

use super::MetricsError;
use super::error::{check_sizes, find_unsound};
use crate::image::{ColorImage, luminance};

/// The relative errors that the colours span: the lower one and all below are black, the upper one and all above almost white.
pub const HEAT_MAP_RANGE: [f64; 2] = [1e-3, 10.0];

/// Rows of black between the map and the legend.
const GAP_ROWS: usize = 2;
/// Rows of the legend.
const LEGEND_ROWS: usize = 10;
/// Rows of a tick, at the foot of the legend.
const TICK_ROWS: usize = 4;

/// The error of every pixel as a colour, and a legend below.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeatMap {
    /// Width and height in pixels; the height is the images' and 12 more.
    pub size: [u32; 2],
    /// `size[0] * size[1]` sRGB-encoded pixels in rows from the top left.
    pub pixels: Vec<[u8; 3]>,
}

/// The difference of luminance, whichever its sign, over the mean luminance of the reference, on a logarithmic scale over
/// [`HEAT_MAP_RANGE`] in the colours of magma: black, purple, red, yellow. Against a black reference every difference has the top
/// colour. The legend is a bar of all colours, with a white tick at every power of ten.
///
/// # Errors
/// The images differ in size, have no pixels, or hold values that are not finite.
pub fn heat_map(image: &ColorImage, reference: &ColorImage) -> Result<HeatMap, MetricsError> {
    check_sizes(image, reference)?;
    if let Some(error) = find_unsound(image, reference) {
        return Err(error);
    }
    let colours = nv_flip::magma_lut().to_vec();
    let colour = |share: f64| {
        let index = 3 * (share.clamp(0.0, 1.0) * 255.0).round() as usize;
        [colours[index], colours[index + 1], colours[index + 2]]
    };
    let mean =
        reference.pixels.iter().map(|pixel| f64::from(luminance(pixel))).sum::<f64>() / reference.pixels.len() as f64;
    let error = |(x, r): (&[f32; 3], &[f32; 3])| {
        let difference = (f64::from(luminance(x)) - f64::from(luminance(r))).abs();
        if difference == 0.0 { 0.0 } else { position(difference / mean.max(0.0)) }
    };
    let mut pixels: Vec<[u8; 3]> =
        image.pixels.par_iter().zip(&reference.pixels).map(|pair| colour(error(pair))).collect();

    let width = image.size[0] as usize;
    let mut bar: Vec<[u8; 3]> = (0..width).map(|column| colour(column as f64 / (width - 1).max(1) as f64)).collect();
    pixels.extend(std::iter::repeat_n([0; 3], GAP_ROWS * width));
    pixels.extend(bar.repeat(LEGEND_ROWS - TICK_ROWS));
    for column in ticks(width) {
        bar[column] = [255; 3];
    }
    pixels.extend(bar.repeat(TICK_ROWS));
    Ok(HeatMap { size: [image.size[0], image.size[1] + (GAP_ROWS + LEGEND_ROWS) as u32], pixels })
}

/// Where on the scale a relative error above zero lies: 0 at its lower end, 1 at its upper end.
fn position(error: f64) -> f64 {
    let [low, high] = HEAT_MAP_RANGE.map(f64::log10);
    (error.log10() - low) / (high - low)
}

/// The columns of the legend where powers of ten lie.
fn ticks(width: usize) -> impl Iterator<Item = usize> {
    let [low, high] = HEAT_MAP_RANGE.map(|end| end.log10().round() as i32);
    (low..=high).map(move |power| (position(10_f64.powi(power)).clamp(0.0, 1.0) * (width - 1) as f64).round() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(size: [u32; 2], values: &[f32]) -> ColorImage {
        ColorImage { size, pixels: values.iter().map(|value| [*value; 3]).collect() }
    }

    fn magma(index: usize) -> [u8; 3] {
        let colours = nv_flip::magma_lut().to_vec();
        [colours[3 * index], colours[3 * index + 1], colours[3 * index + 2]]
    }

    #[test]
    fn colours_follow_the_logarithm_of_the_relative_error() {
        let reference = grey([5, 1], &[2.0; 5]);
        // Relative errors 0, 10⁻⁴, 0.2 (0.575 of the scale), 10 and 500.
        let map = heat_map(&grey([5, 1], &[2.0, 2.0002, 1.6, 22.0, 1002.0]), &reference).expect("sound");
        assert_eq!(map.size, [5, 13]);
        assert_eq!(map.pixels.len(), 5 * 13);
        assert_eq!(map.pixels[..5], [magma(0), magma(0), magma(147), magma(255), magma(255)]);
        assert_eq!(map.pixels[5..15], [[0; 3]; 10], "the gap");
        assert_eq!(map.pixels[15..20], [magma(0), magma(64), magma(128), magma(191), magma(255)], "the legend");
        assert_eq!(map.pixels[60..], [[255; 3]; 5], "a tick at each of 10⁻³, 10⁻², 10⁻¹, 1 and 10");
    }

    #[test]
    fn a_black_reference_shows_every_difference() {
        let map = heat_map(&grey([2, 1], &[0.0, 1e-6]), &grey([2, 1], &[0.0; 2])).expect("sound");
        assert_eq!(map.pixels[..2], [magma(0), magma(255)]);
        assert!(heat_map(&grey([1, 1], &[1.0]), &grey([1, 1], &[2.0])).is_ok(), "a legend of one column");
    }
}
