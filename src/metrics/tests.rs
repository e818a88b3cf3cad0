use rand_pcg::rand_core::Rng;

use super::*;
use crate::image::{Adaptation, aces, srgb_encode};

fn image(size: [u32; 2], pixel: impl FnMut(usize) -> [f32; 3]) -> ColorImage {
    ColorImage { size, pixels: (0..size[0] as usize * size[1] as usize).map(pixel).collect() }
}

fn constant(size: [u32; 2], pixel: [f32; 3]) -> ColorImage {
    image(size, |_| pixel)
}

/// A smooth picture with a bright spot.
fn scene(size: [u32; 2]) -> ColorImage {
    image(size, |index| {
        let (x, y) = ((index as u32 % size[0]) as f32, (index as u32 / size[0]) as f32);
        let spot = 4.0 * (-0.02 * ((x - 20.0).powi(2) + (y - 15.0).powi(2))).exp();
        [0.2 + 0.01 * x + spot, 0.3 + 0.005 * y + spot, 0.25 + spot]
    })
}

/// Adds independent normal numbers of mean 0, by Box & Muller.
fn with_noise(clean: &ColorImage, deviation: f64) -> ColorImage {
    let mut random = rand_pcg::Pcg32::new(1, 1);
    let mut uniform = || (f64::from(random.next_u32()) + 0.5) / 2_f64.powi(32);
    let mut normal = || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos();
    let pixels = clean.pixels.iter().map(|pixel| pixel.map(|value| (f64::from(value) + deviation * normal()) as f32));
    ColorImage { size: clean.size, pixels: pixels.collect() }
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found}, not {expected}");
}

#[test]
fn constant_images_by_hand() {
    // r = (1, 2, 3), x = (1.5, 2, 2): squares ¼ + 0 + 1 over three; mean 2, ε 0.02.
    let (x, r) = (constant([7, 5], [1.5, 2.0, 2.0]), constant([7, 5], [1.0, 2.0, 3.0]));
    let Comparison { errors, bias } = compare(&x, &r).expect("sound");
    assert_near(errors.rmse, (1.25_f64 / 3.0).sqrt(), 1e-12, "rmse");
    assert_near(errors.rrmse, (1.25_f64 / 3.0).sqrt() / 2.0, 1e-12, "rrmse");
    let relative = 0.25 / (1.0 + 0.02 * 0.02) + 1.0 / (9.0 + 0.02 * 0.02);
    assert_near(errors.relmse, relative / 3.0, 1e-12, "relmse");
    let ratio = (0.2126 * 1.5 + 0.7152 * 2.0 + 0.0722 * 2.0) / (0.2126 + 0.7152 * 2.0 + 0.0722 * 3.0);
    assert_near(errors.mean_ratio, ratio, 1e-7, "mean ratio");
    assert_eq!(bias, [0.5, 0.0, -1.0]);
    assert_eq!(rmse(&x, &r).expect("sound"), errors.rmse);
}

#[test]
fn blocks_average_over_eight_pixels_a_side() {
    let reference = constant([20, 12], [2.0; 3]);
    let of = |x: &ColorImage| compare(x, &reference).expect("sound").errors;
    // What changes its sign from pixel to pixel is gone in blocks of even sides, which at the edges have 4 pixels a side.
    let checks = image([20, 12], |index| [if (index % 20 + index / 20) % 2 == 0 { 2.5 } else { 1.5 }; 3]);
    assert_near(of(&checks).rrmse, 0.25, 1e-12, "pixels");
    assert_near(of(&checks).block_rrmse, 0.0, 1e-12, "blocks");
    // One block of 4 × 8 pixels that is off by one, of 240 pixels; then the same squares over two blocks, each half off.
    let off = |columns: std::ops::Range<usize>| {
        let x = image([20, 12], |index| [if columns.contains(&(index % 20)) && index < 160 { 3.0 } else { 2.0 }; 3]);
        of(&x)
    };
    assert_near(off(16..20).block_rrmse, (32.0_f64 / 240.0).sqrt() / 2.0, 1e-12, "one block");
    assert_near(off(16..20).rrmse, off(16..20).block_rrmse, 1e-12, "a constant difference");
    assert_near(off(6..10).block_rrmse, (2.0 * 64.0 * 0.0625_f64 / 240.0).sqrt() / 2.0, 1e-12, "two blocks");
    let black = constant([20, 12], [0.0; 3]);
    assert_eq!(compare(&reference, &black).expect("sound").errors.block_rrmse, f64::INFINITY);
}

#[test]
fn both_are_exposed_for_the_reference() {
    // The reference's log-average is its 2; exposed for itself the image would look the same.
    let (x, r) = (constant([16, 16], [5.0; 3]), constant([16, 16], [2.0; 3]));
    let errors = compare(&x, &r).expect("sound").errors;
    let adaptation = Adaptation { log_average: 2.0, max_luminance: 2.0 };
    let shown = [5.0, 2.0].map(|value| f64::from(srgb_encode(aces([value; 3], adaptation)[0])));
    assert_near(errors.psnr, -20.0 * (shown[0] - shown[1]).log10(), 1e-3, "psnr");
    let similarity = (2.0 * shown[0] * shown[1] + 1e-4) / (shown[0].powi(2) + shown[1].powi(2) + 1e-4);
    assert_near(errors.ssim, similarity, 1e-6, "ssim");
    assert!(errors.flip > 0.1, "flip: {}", errors.flip);
}

#[test]
fn a_mean_squared_difference_of_a_hundredth_is_20_db() {
    let shown = display::Pair { image: vec![[0.6, 0.2, 1.0]; 9], reference: vec![[0.5, 0.3, 0.9]; 9] };
    assert_near(display::psnr(&shown), 20.0, 1e-5, "psnr");
}

#[test]
fn the_same_image_has_no_error() {
    for size in [[40, 30], [3, 2], [1, 1]] {
        let same = scene(size);
        let Comparison { errors, bias } = compare(&same, &same).expect("sound");
        let none = ImageErrors { psnr: f64::INFINITY, ssim: 1.0, mean_ratio: 1.0, ..ImageErrors::default() };
        assert_eq!((errors, bias), (none, [0.0; 3]), "{size:?}");
    }
}

#[test]
fn every_measure_grows_with_the_noise() {
    let clean = scene([48, 32]);
    let errors = [0.01, 0.03, 0.1, 0.3].map(|noise| compare(&with_noise(&clean, noise), &clean).expect("sound").errors);
    let ascends = |measure: fn(&ImageErrors) -> f64| errors.is_sorted_by(|a, b| measure(a) < measure(b));
    assert!(ascends(|errors| errors.rmse) && ascends(|errors| errors.rrmse) && ascends(|errors| errors.relmse));
    assert!(
        ascends(|errors| -errors.psnr) && ascends(|errors| -errors.ssim) && ascends(|errors| errors.flip),
        "{errors:?}"
    );
}

#[test]
fn the_rmse_of_noise_is_its_deviation() {
    let clean = scene([200, 150]);
    for deviation in [1e-3, 0.5, 1e4] {
        let found = rmse(&with_noise(&clean, deviation), &clean).expect("sound");
        assert_near(found / deviation, 1.0, 0.02, "rmse over deviation");
    }
}

#[test]
fn errors_do_not_depend_on_the_unit_of_radiance_nor_on_threads() {
    let (clean, noisy) = (scene([90, 70]), with_noise(&scene([90, 70]), 0.1));
    let errors = compare(&noisy, &clean).expect("sound");
    // A power of two scales without rounding.
    let scaled = |of: &ColorImage| image(of.size, |index| of.pixels[index].map(|value| value * 1024.0));
    let bright = compare(&scaled(&noisy), &scaled(&clean)).expect("sound");
    assert_eq!((bright.errors.rrmse, bright.errors.relmse), (errors.errors.rrmse, errors.errors.relmse));
    assert_near(bright.errors.psnr, errors.errors.psnr, 1e-3, "psnr");
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        assert_eq!(pool.install(|| compare(&noisy, &clean)), Ok(errors), "{threads} threads");
    }
}

#[test]
fn against_black_any_error_is_infinite_and_seen() {
    let black = constant([20, 20], [0.0; 3]);
    let lit = image([20, 20], |index| [if index == 210 { 0.5 } else { 0.0 }; 3]);
    let same = compare(&black, &black).expect("sound").errors;
    assert_eq!((same.rrmse, same.relmse, same.mean_ratio), (0.0, 0.0, 1.0));
    let leaked = compare(&lit, &black).expect("sound").errors;
    assert_near(leaked.rmse, 0.5 / 20.0, 1e-12, "rmse");
    assert_eq!((leaked.rrmse, leaked.relmse, leaked.mean_ratio), (f64::INFINITY, f64::INFINITY, f64::INFINITY));
    assert!(leaked.psnr < 60.0 && leaked.ssim < 0.999 && leaked.flip > 0.0, "{leaked:?}");
    let lost = compare(&black, &lit).expect("sound").errors;
    assert_eq!(lost.mean_ratio, 0.0);
    assert_near(lost.rrmse, 20.0, 1e-9, "rrmse of a lost highlight");

    let json = serde_json::to_string(&leaked).expect("plain data");
    assert!(json.contains("\"rrmse\":null"), "{json}");
    assert_eq!(serde_json::from_str::<ImageErrors>(&json).expect("its own"), leaked);
}

#[test]
fn unsound_images_are_named_with_the_place() {
    let sound = scene([6, 4]);
    let with = |index: usize, value: f32| {
        let mut unsound = sound.clone();
        unsound.pixels[index][2] = value;
        unsound
    };
    let message = |image: &ColorImage, reference: &ColorImage| {
        let errors = [compare(image, reference).err(), rmse(image, reference).err(), heat_map(image, reference).err()];
        let messages = errors.map(|error| error.expect("unsound").to_string());
        assert!(messages.iter().all(|message| *message == messages[0]), "{messages:?}");
        messages[0].clone()
    };
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let image = message(&with(15, value), &with(3, value));
        assert!(image.contains("the image holds") && image.contains("(3, 2)"), "{image}");
        let reference = message(&sound, &with(23, value));
        assert!(reference.contains("the reference holds") && reference.contains("(5, 3)"), "{reference}");
    }
    let sizes = message(&sound, &scene([4, 6]));
    assert!(sizes.contains("6x4") && sizes.contains("4x6"), "{sizes}");
    let empty = message(&scene([0, 3]), &scene([0, 3]));
    assert!(empty.contains("0x3 holds 0 pixels"), "{empty}");
    assert!(compare(&with(0, f32::MAX), &with(0, f32::MIN)).is_ok_and(|found| found.errors.rmse.is_finite()));
}
