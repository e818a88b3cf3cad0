//! Samples of every pixel, added up slot by slot, and the seeds that tell them apart.

use crate::method::Error;
use crate::slot::Slot;

/// Sums of radiance over some samples of every pixel, W/(m² sr).
#[derive(Clone, Debug, PartialEq)]
pub struct SlotSums {
    /// Samples of each pixel that were added up.
    pub samples: u32,
    /// One row-major image for each of [`crate::slot::Slot::ALL`].
    pub slots: [Vec<[f32; 3]>; 5],
}

/// Whoever can add up samples of a reference.
pub trait SampleSource {
    /// The sums over the samples `first .. first + count` of half `half`, 0 or 1. The same arguments give the same bits.
    ///
    /// # Errors
    /// Exhausted device memory, a lost device.
    fn sums(&mut self, half: u32, first: u32, count: u32) -> Result<SlotSums, Error>;

    /// Rays traced so far; 0 if they are not counted.
    fn rays(&self) -> u64 {
        0
    }
}

pub(super) fn seed_of_half(seed: u32, half: u32) -> u32 {
    seed.wrapping_mul(2).wrapping_add(half)
}

/// A seed for each sample of a half, different from those of the pixels' sequences.
pub(super) fn seed_of_sample(seed: u32, sample: u32) -> u32 {
    let mixed = (u64::from(seed) << 32 | u64::from(sample)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    ((mixed ^ mixed >> 29) >> 32) as u32 ^ sample.rotate_left(16)
}

/// Puts the sums of a run of blocks where their pixels are (glsl/path/pixels.glsl).
pub(super) fn scatter_sums(
    sums: &mut SlotSums,
    texels: &[[f32; 4]],
    size: [u32; 2],
    [first_block, block_count]: [u32; 2],
) {
    let [width, height] = size;
    let blocks_per_row = width.div_ceil(8);
    let paths = 64 * block_count;
    for place in 0..paths {
        let block = first_block + place / 64;
        let (lane, part) = (place & 7, place >> 3 & 7);
        let x = block % blocks_per_row * 8 + (part & 1) * 4 + (lane & 3);
        let y = block / blocks_per_row * 8 + (part >> 1) * 2 + (lane >> 2);
        if x < width && y < height {
            let pixel = y as usize * width as usize + x as usize;
            for slot in 0..Slot::ALL.len() {
                let [red, green, blue, _] = texels[slot * paths as usize + place as usize];
                sums.slots[slot][pixel] = [red, green, blue];
            }
        }
    }
}
