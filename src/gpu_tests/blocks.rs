//! Pictures of 64×48 pixels against truth: their means, and what is left where noise of single pixels is averaged out.

use glam::DVec3;

const SIZE: [usize; 2] = [64, 48];
/// Pixels along a side of a block.
const SIDE: usize = 8;

pub(super) fn mean(pixels: &[DVec3]) -> DVec3 {
    pixels.iter().sum::<DVec3>() / pixels.len() as f64
}

/// Of each block of 8×8 pixels the mean over pixels and channels.
fn blocks(pixels: &[DVec3]) -> Vec<f64> {
    let columns = SIZE[0] / SIDE;
    let block = |index: usize| {
        let [row, column] = [SIDE * (index / columns), SIDE * (index % columns)];
        let pixel = |p: usize| pixels[(row + p / SIDE) * SIZE[0] + column + p % SIDE];
        (0..SIDE * SIDE).map(|p| pixel(p).element_sum()).sum::<f64>() / (3 * SIDE * SIDE) as f64
    };
    (0..columns * SIZE[1] / SIDE).map(block).collect()
}

/// The ratio of the means, and the error of blocks over the root of their mean square: most of a picture may show nothing.
pub(super) fn against(found: &[DVec3], truth: &[DVec3]) -> (f64, f64) {
    assert!([found, truth].iter().all(|pixels| pixels.len() == SIZE[0] * SIZE[1]), "pictures of another size");
    let ratio = mean(found).element_sum() / mean(truth).element_sum();
    let (found, truth) = (blocks(found), blocks(truth));
    let squares: f64 = truth.iter().map(|block| block.powi(2)).sum();
    (ratio, (found.iter().zip(&truth).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / squares).sqrt())
}

/// `most`: of the means' ratio from 1; `noise`: of the error of blocks.
#[track_caller]
pub(super) fn assert_close(what: &str, found: &[DVec3], truth: &[DVec3], most: f64, noise: f64) {
    let (ratio, error) = against(found, truth);
    println!("{what}: mean {ratio:.4}, blocks {error:.4}");
    assert!((ratio - 1.0).abs() < most && error < noise, "{what}: mean {ratio}, blocks {error}");
}
