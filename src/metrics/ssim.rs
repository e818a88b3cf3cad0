//! Structural similarity (Wang, Bovik, Sheikh & Simoncelli 2004): whether neighbourhoods have the same mean, contrast and structure.

use rayon::prelude::*;

use super::display::{self, Pair};

/// Side of the window in pixels.
const WINDOW: usize = 11;
/// Standard deviation of the window's Gaussian, pixels.
const SIGMA: f64 = 1.5;
/// (K₁L)² and (K₂L)² of the paper, for values up to L = 1.
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Weighted means over a window: x, r, x², r², x·r.
type Moments = [f64; 5];

/// Mean over all windows that lie within the image, as the authors' program has it. An image smaller than a window has the largest
/// window of odd side that fits.
pub(super) fn ssim([width, height]: [usize; 2], shown: &Pair) -> f64 {
    let (image, reference) = (display::luma(&shown.image), display::luma(&shown.reference));
    let (across, down) = (window(width), window(height));
    let (columns, rows) = (width + 1 - across.len(), height + 1 - down.len());
    let row_sum = |row: usize| {
        let mut stacked = vec![Moments::default(); width];
        for (offset, weight) in down.iter().enumerate() {
            let start = (row + offset) * width;
            for (column, moments) in stacked.iter_mut().enumerate() {
                let (x, r) = (image[start + column], reference[start + column]);
                add(moments, *weight, [x, r, x * x, r * r, x * r]);
            }
        }
        let similarity_at = |column: usize| {
            let mut moments = Moments::default();
            for (weight, stack) in across.iter().zip(&stacked[column..]) {
                add(&mut moments, *weight, *stack);
            }
            similarity(moments)
        };
        (0..columns).map(similarity_at).sum::<f64>()
    };
    // Rows are added up in their order, whichever thread took them.
    let row_sums: Vec<f64> = (0..rows).into_par_iter().map(row_sum).collect();
    row_sums.iter().sum::<f64>() / (rows * columns) as f64
}

fn add(sum: &mut Moments, weight: f64, values: Moments) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

/// Weights of the window along one side of an image, which sum to 1.
fn window(side: usize) -> Vec<f64> {
    let radius = (WINDOW.min(side) - 1) / 2;
    let weight = |index: usize| (-0.5 * ((index as f64 - radius as f64) / SIGMA).powi(2)).exp();
    let weights: Vec<f64> = (0..2 * radius + 1).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}

/// Eq. 13 of the paper.
fn similarity([x, r, xx, rr, xr]: Moments) -> f64 {
    let (variance_x, variance_r, covariance) = (xx - x * x, rr - r * r, xr - x * r);
    (2.0 * x * r + C1) * (2.0 * covariance + C2) / ((x * x + r * r + C1) * (variance_x + variance_r + C2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(values: impl Iterator<Item = f64>) -> Vec<[f32; 3]> {
        values.map(|value| [value as f32; 3]).collect()
    }

    #[test]
    fn constant_images_differ_in_their_means_alone() {
        for size in [[16, 13], [11, 11], [3, 2], [1, 1]] {
            let constant = |value: f64| grey(std::iter::repeat_n(value, size[0] * size[1]));
            for (a, b) in [(0.25, 0.5), (0.0, 1.0), (0.75, 0.75)] {
                let found = ssim(size, &Pair { image: constant(a), reference: constant(b) });
                let expected = (2.0 * a * b + C1) / (a * a + b * b + C1);
                assert!((found - expected).abs() < 1e-9, "{size:?}, {a} and {b}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn an_inverted_pattern_is_its_opposite() {
        // Stripes one pixel wide about a mean of one half: means are almost the same, and the covariance is minus the variance.
        let size = [40, 30];
        let stripes = |sign: f64| {
            grey(
                (0..size[0] * size[1])
                    .map(move |index| 0.5 + sign * if index % size[0] % 2 == 0 { 0.25 } else { -0.25 }),
            )
        };
        let found = ssim(size, &Pair { image: stripes(1.0), reference: stripes(-1.0) });
        let variance = 0.25 * 0.25;
        let expected = (C2 - 2.0 * variance) / (C2 + 2.0 * variance);
        assert!((found - expected).abs() < 1e-3, "{found}, not {expected}");
        assert_eq!(ssim(size, &Pair { image: stripes(1.0), reference: stripes(1.0) }), 1.0);
    }

    #[test]
    fn windows_are_those_of_the_definition() {
        let size = [17, 14];
        let pattern =
            |factor: usize| grey((0..size[0] * size[1]).map(move |index| (index * factor % 101) as f64 / 101.0));
        let shown = Pair { image: pattern(37), reference: pattern(59) };
        let weight =
            |x: usize, y: usize| (-((x as f64 - 5.0).powi(2) + (y as f64 - 5.0).powi(2)) / (2.0 * 1.5 * 1.5)).exp();
        let window = || (0..11).flat_map(|y| (0..11).map(move |x| (x, y)));
        let total: f64 = window().map(|(x, y)| weight(x, y)).sum();
        let mut similarities = Vec::new();
        for (left, top) in (0..4).flat_map(|top| (0..7).map(move |left| (left, top))) {
            let value = |of: &[[f32; 3]], (x, y): (usize, usize)| f64::from(of[(top + y) * size[0] + left + x][0]);
            let mean = |of: &dyn Fn((usize, usize)) -> f64| {
                window().map(|at| weight(at.0, at.1) * of(at)).sum::<f64>() / total
            };
            let (x, r) = (|at| value(&shown.image, at), |at| value(&shown.reference, at));
            let (mean_x, mean_r) = (mean(&x), mean(&r));
            let covariance = mean(&|at| (x(at) - mean_x) * (r(at) - mean_r));
            let variances = mean(&|at| (x(at) - mean_x).powi(2)) + mean(&|at| (r(at) - mean_r).powi(2));
            let luminance = (2.0 * mean_x * mean_r + C1) / (mean_x.powi(2) + mean_r.powi(2) + C1);
            similarities.push(luminance * (2.0 * covariance + C2) / (variances + C2));
        }
        let expected = similarities.iter().sum::<f64>() / similarities.len() as f64;
        let found = ssim(size, &shown);
        assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
    }

    #[test]
    fn windows_fit_and_weigh_one() {
        for (side, length) in [(1, 1), (2, 1), (3, 3), (10, 9), (11, 11), (12, 11), (4000, 11)] {
            let weights = window(side);
            assert_eq!(weights.len(), length, "{side}");
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
        // The paper's circularly symmetric window: neighbours of the middle weigh e^(-1/4.5) of it.
        let weights = window(11);
        assert!((weights[6] / weights[5] - (-1.0_f64 / 4.5).exp()).abs() < 1e-15);
    }
}
