//! FLIP: the difference that a person sees who flips between two images on a screen (Andersson et al. 2020), by its authors' code.

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8};
use rayon::prelude::*;

use super::display::{self, Pair};

/// Rows of a band that one thread takes. The code has one thread; bands let all cores work.
const BAND_ROWS: usize = 64;

/// The radius in pixels of the largest of FLIP's filters at 67 pixels per degree, 3·√(0.04/(2π²))·67 rounded up: so many rows beyond
/// a band have a say in it.
const HALO_ROWS: usize = 10;

/// Mean of FLIP over all pixels, at its authors' 67 pixels per degree: a 0.7 m wide screen of 3840 pixels seen from 0.7 m.
pub(super) fn mean_flip(size: [usize; 2], shown: &Pair) -> f64 {
    let bands = flip_bands(size, &display::levels(&shown.image), &display::levels(&shown.reference), BAND_ROWS);
    let sums = bands.iter().map(|band| band.iter().copied().map(f64::from).sum::<f64>());
    sums.sum::<f64>() / (size[0] * size[1]) as f64
}

/// FLIP of every pixel, in bands of rows. The bands are computed apart, each with its halo, and are the same to the bit
/// however many rows they have.
fn flip_bands([width, height]: [usize; 2], image: &[u8], reference: &[u8], band_rows: usize) -> Vec<Vec<f32>> {
    let band = |index: usize| {
        let (first, last) = (index * band_rows, ((index + 1) * band_rows).min(height));
        let (top, bottom) = (first.saturating_sub(HALO_ROWS), (last + HALO_ROWS).min(height));
        let bytes = 3 * width * top..3 * width * bottom;
        let (image, reference) = (&image[bytes.clone()], &reference[bytes]);
        if image == reference {
            return vec![0.0; width * (last - first)];
        }
        let rows = |pixels: &[u8]| FlipImageRgb8::with_data(width as u32, (bottom - top) as u32, pixels);
        let errors = nv_flip::flip(rows(reference), rows(image), DEFAULT_PIXELS_PER_DEGREE).to_vec();
        errors[width * (first - top)..width * (last - top)].to_vec()
    };
    (0..height.div_ceil(band_rows)).into_par_iter().map(band).collect()
}

#[cfg(test)]
mod tests {
    use rand_pcg::rand_core::Rng;

    use super::*;

    #[test]
    fn rows_that_do_not_differ_are_left_out_and_have_no_error() {
        let size = [9, 60];
        let reference: Vec<u8> = (0..3 * size[0] * size[1]).map(|index| (index * 7 % 251) as u8).collect();
        let mut image = reference.clone();
        image[3 * size[0] * 50 + 4] ^= 128;
        let whole = &flip_bands(size, &image, &reference, size[1])[0];
        assert!(flip_bands(size, &image, &reference, 5).concat() == *whole);
        assert!(whole[..size[0] * (50 - HALO_ROWS)].iter().all(|error| *error == 0.0));
        assert!(whole.iter().any(|error| *error > 0.1));
    }

    #[test]
    fn bands_are_parts_of_the_whole() {
        let size = [23, 47];
        let mut random = rand_pcg::Pcg32::new(3, 5);
        let mut noise = || -> Vec<u8> { (0..3 * size[0] * size[1]).map(|_| random.next_u32() as u8).collect() };
        let (image, reference) = (noise(), noise());
        let whole = flip_bands(size, &image, &reference, size[1]);
        assert_eq!(whole.len(), 1);
        for rows in [1, 7, 24] {
            assert!(flip_bands(size, &image, &reference, rows).concat() == whole[0], "in bands of {rows} rows");
        }
    }
}
