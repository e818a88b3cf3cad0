//! The noise that is stated is the noise that there is.

use super::*;

/// Relative standard error of the mean of `samples` samples of a slot.
fn predicted(slot: usize, samples: u32) -> f64 {
    let values = (0..384).flat_map(|pixel| (0..3).map(move |channel| expected(slot, pixel, channel)));
    let mean = values.sum::<f64>() / (384.0 * 3.0);
    DEVIATION / f64::from(samples).sqrt() / mean
}

#[test]
fn it_is_the_standard_error_of_the_mean_and_falls_with_the_root_of_the_samples() {
    for samples in [16, 64, 256] {
        let reference = Maker::new().make(samples, None).reference();
        for (index, slot) in Slot::ALL.into_iter().enumerate().filter(|(index, _)| *index != 3) {
            let noise = reference.noise[slot.name()];
            let ratio = noise.rrmse / predicted(index, samples);
            // 1152 values: one standard deviation is 2 %.
            assert!((ratio - 1.0).abs() < 0.08, "{slot} at {samples}: {ratio}");
            let own = reference.slots[&slot]
                .pixels
                .as_flattened()
                .iter()
                .enumerate()
                .map(|(at, value)| (f64::from(*value) - expected(index, at / 3, at % 3)).powi(2));
            let actual = (own.sum::<f64>() / 1152.0).sqrt();
            assert!((noise.rmse / actual - 1.0).abs() < 0.12, "{slot} at {samples}: {} {actual}", noise.rmse);
        }
        assert_eq!(reference.noise["caustics"], Noise::default(), "black is not noisy");
        let image = reference.image_noise();
        assert!((image.rmse / (2.0 * DEVIATION / f64::from(samples).sqrt()) - 1.0).abs() < 0.08, "{image:?}");
        let two = reference.noise_of(&[Slot::Emission, Slot::Diffuse]);
        assert!((two.rmse / (2_f64.sqrt() * DEVIATION / f64::from(samples).sqrt()) - 1.0).abs() < 0.08, "{two:?}");
    }
}

#[test]
fn samples_end_when_the_noise_is_low_enough() {
    let maker = Maker::new();
    let enough = Maker::new().make(64, None).reference().image_noise().rrmse;
    let file = maker.make(Goal { spp: 4096, noise: Some(1.001 * enough) }, None);
    assert_eq!(file.spp(), 64);
    assert_eq!(maker.made.borrow().len(), 8, "nothing is made twice");
    let most = maker.make(Goal { spp: 100, noise: Some(1e-9) }, None);
    assert_eq!(most.spp(), 112, "as many as the goal allows, in whole chunks");
}
