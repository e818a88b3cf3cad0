//! Why two images cannot be compared.

use crate::image::ColorImage;

/// Which of the two images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Side {
    /// The one that is measured.
    Image,
    /// The one that it is measured against.
    Reference,
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Side::Image => "image",
            Side::Reference => "reference",
        })
    }
}

/// Why two images cannot be compared: one sentence.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MetricsError {
    /// The images are of different size.
    #[error(
        "the image has {}x{} pixels and the reference {}x{}; make both of the same size",
        .image[0], .image[1], .reference[0], .reference[1]
    )]
    Sizes {
        /// Width and height of the image.
        image: [u32; 2],
        /// Width and height of the reference.
        reference: [u32; 2],
    },
    /// An image does not hold the pixels that its size promises, or its size is zero.
    #[error("the {side} of {}x{} holds {pixels} pixels; it needs one at least, and as many as its size says", .size[0], .size[1])]
    Pixels {
        /// Which image.
        side: Side,
        /// Its width and height.
        size: [u32; 2],
        /// The pixels that it holds.
        pixels: usize,
    },
    /// A pixel is not a number or infinite.
    #[error(
        "the {side} holds {value:?} in pixel ({}, {}), counted from the top left, and no error can be given for that; \
         make the {side} again, with --validation gpu if irradia made it, or repair the pixel",
        .pixel[0], .pixel[1]
    )]
    NotFinite {
        /// Which image.
        side: Side,
        /// Column and row of the first such pixel, from the top left.
        pixel: [u32; 2],
        /// Its red, green and blue.
        value: [f32; 3],
    },
}

/// Whether the images have the same size, and pixels.
pub(super) fn check_sizes(image: &ColorImage, reference: &ColorImage) -> Result<(), MetricsError> {
    if image.size != reference.size {
        return Err(MetricsError::Sizes { image: image.size, reference: reference.size });
    }
    for (side, ColorImage { size, pixels }) in [(Side::Image, image), (Side::Reference, reference)] {
        if pixels.is_empty() || pixels.len() as u64 != u64::from(size[0]) * u64::from(size[1]) {
            return Err(MetricsError::Pixels { side, size: *size, pixels: pixels.len() });
        }
    }
    Ok(())
}

/// The first pixel that is not finite, of the image or else of the reference.
pub(super) fn find_unsound(image: &ColorImage, reference: &ColorImage) -> Option<MetricsError> {
    [(Side::Image, image), (Side::Reference, reference)].into_iter().find_map(|(side, ColorImage { size, pixels })| {
        let index = pixels.iter().position(|pixel| !pixel.iter().all(|value| value.is_finite()))?;
        let width = size[0] as usize;
        let pixel = [(index % width) as u32, (index / width) as u32];
        Some(MetricsError::NotFinite { side, pixel, value: pixels[index] })
    })
}
