//! Errors of blocks of pixels: what is wrong over some area, with the noise of single pixels averaged away.

use crate::image::ColorImage;

/// Pixels along a side of a block. Blocks at the right and the bottom edge hold what is left.
pub const BLOCK_SIDE: usize = 8;

/// Root of the mean square of the blocks' means over the channels, each block counting by its pixels; `value` gives a pixel's channels.
pub(crate) fn block_rms([width, height]: [u32; 2], value: impl Fn(usize) -> [f64; 3]) -> f64 {
    let [width, height] = [width, height].map(|side| side as usize);
    let mut squares = 0.0;
    for top in (0..height).step_by(BLOCK_SIDE) {
        for left in (0..width).step_by(BLOCK_SIDE) {
            let (bottom, right) = ((top + BLOCK_SIDE).min(height), (left + BLOCK_SIDE).min(width));
            let mut sums = [0.0; 3];
            for pixel in (top..bottom).flat_map(|row| (left..right).map(move |column| row * width + column)) {
                let value = value(pixel);
                (0..3).for_each(|channel| sums[channel] += value[channel]);
            }
            let pixels = ((bottom - top) * (right - left)) as f64;
            squares += sums.iter().map(|sum| sum * sum).sum::<f64>() / pixels;
        }
    }
    (squares / (3 * width * height) as f64).sqrt()
}

/// That of the difference of two images of one size over the mean of the second; infinite if that one is black and the first is not.
pub(super) fn block_rrmse(image: &ColorImage, reference: &ColorImage) -> f64 {
    let difference = |pixel: usize| {
        let [x, r] = [image, reference].map(|of| of.pixels[pixel].map(f64::from));
        std::array::from_fn(|channel| x[channel] - r[channel])
    };
    let rms = block_rms(reference.size, difference);
    let values = reference.pixels.as_flattened();
    let mean = values.iter().map(|value| f64::from(*value)).sum::<f64>() / values.len() as f64;
    match (rms == 0.0, mean > 0.0) {
        (true, _) => 0.0,
        (false, true) => rms / mean,
        (false, false) => f64::INFINITY,
    }
}
