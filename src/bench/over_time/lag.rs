//! How late a picture is, and how it flickers.

use super::record::{Flicker, Lag};
use crate::image::{ColorImage, LUMINANCE_WEIGHTS};

/// Below this share of the settled picture, root mean squares, there was nothing to change.
const NOTHING: f64 = 1e-3;

/// A pixel is still whose truth changes by less than this share of the truth's mean.
const STILL: f64 = 0.01;

/// How late `shown` is against the `settled` picture of the same frame; `before` is what was shown in the frame before.
pub(super) fn lag(shown: &ColorImage, settled: &ColorImage, before: Option<&ColorImage>) -> Lag {
    let sum = |image: &ColorImage| values(image).map(f64::abs).sum::<f64>();
    let brighter = sum(shown).max(sum(settled));
    let missing: f64 = values(shown).zip(values(settled)).map(|(shown, settled)| (shown - settled).abs()).sum();
    let late = if brighter > 0.0 { missing / brighter } else { 0.0 };
    Lag { late, arrived: before.and_then(|before| arrived(shown, settled, before)) }
}

/// The step from `before` to `shown` along that from `before` to `settled`, over its length.
fn arrived(shown: &ColorImage, settled: &ColorImage, before: &ColorImage) -> Option<f64> {
    let steps = values(before).zip(values(settled)).zip(values(shown));
    let (mut along, mut whole) = (0.0, 0.0);
    for ((before, settled), shown) in steps {
        along += (shown - before) * (settled - before);
        whole += (settled - before) * (settled - before);
    }
    let squares: f64 = values(settled).chain(values(before)).map(|value| value * value).sum();
    (whole > NOTHING * NOTHING * squares).then(|| along / whole)
}

/// How pictures change from one frame to the next, each pair being of two frames, where the truth does not. `None` if the truth is black or nowhere still.
pub(super) fn flicker([before, now]: [&ColorImage; 2], [true_before, true_now]: [&ColorImage; 2]) -> Option<Flicker> {
    let mean = luminances(true_now).sum::<f64>() / true_now.pixels.len() as f64;
    let changes = luminances(before).zip(luminances(now)).map(|(before, now)| (now - before).abs());
    let true_changes = luminances(true_before).zip(luminances(true_now)).map(|(before, now)| (now - before).abs());
    let still = changes.zip(true_changes).filter(|(_, truth)| *truth < STILL * mean);
    let (count, change, reference) = still.fold((0_usize, 0.0, 0.0), |(count, change, truth), (more, more_truth)| {
        (count + 1, change + more, truth + more_truth)
    });
    let over = |sum: f64| sum / (count as f64 * mean);
    let still = count as f64 / true_now.pixels.len() as f64;
    (count > 0).then(|| Flicker { change: over(change), reference: over(reference), still })
}

fn values(image: &ColorImage) -> impl Iterator<Item = f64> {
    image.pixels.as_flattened().iter().map(|value| f64::from(*value))
}

fn luminances(image: &ColorImage) -> impl Iterator<Item = f64> {
    let luminance = |pixel: &[f32; 3]| {
        pixel.iter().zip(LUMINANCE_WEIGHTS).map(|(value, weight)| f64::from(*value) * f64::from(weight)).sum::<f64>()
    };
    image.pixels.iter().map(luminance)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(values: [f32; 4]) -> ColorImage {
        ColorImage { size: [2, 2], pixels: values.map(|value| [value; 3]).to_vec() }
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }

    #[test]
    fn what_has_arrived_is_a_share_of_what_there_was_to_change() {
        let (before, settled) = (image([1.0, 1.0, 0.0, 2.0]), image([3.0, 1.0, 0.0, 2.0]));
        let half = image([2.0, 1.0, 0.0, 2.0]);
        let found = lag(&half, &settled, Some(&before));
        close(found.late, 1.0 / 6.0);
        close(found.arrived.expect("there was a change"), 0.5);
        close(lag(&settled, &settled, Some(&before)).arrived.expect("there was a change"), 1.0);
        assert_eq!(lag(&settled, &settled, Some(&settled)), Lag { late: 0.0, arrived: None });
        assert_eq!(lag(&half, &half, None), Lag::default());
        let black = image([0.0; 4]);
        assert_eq!(lag(&black, &black, Some(&black)), Lag::default());
        close(lag(&half, &black, Some(&before)).late, 1.0);
    }

    #[test]
    fn only_what_stands_still_flickers() {
        let (truth, moved) = (image([1.0, 1.0, 1.0, 1.0]), image([1.0, 1.0, 1.0, 1.5]));
        let (before, now) = (image([1.0, 1.0, 1.0, 0.0]), image([1.1, 0.9, 1.0, 9.0]));
        let found = flicker([&before, &now], [&truth, &moved]).expect("three are still");
        close(found.change, 0.2 / 3.0 / 1.125);
        assert_eq!((found.reference, found.still), (0.0, 0.75));
        let still = flicker([&before, &before], [&truth, &truth]).expect("all are still");
        assert_eq!(still, Flicker { change: 0.0, reference: 0.0, still: 1.0 });
        let black = image([0.0; 4]);
        assert_eq!(flicker([&before, &now], [&black, &black]), None);
        assert_eq!(flicker([&before, &now], [&truth, &image([2.0; 4])]), None);
    }
}
