//! Colour images, and the tone maps that turn linear radiance into 8-bit sRGB display values on the host. The device's passes compute the same.
//!
//! `aces` first exposes the image: radiance is scaled so that its log-average luminance becomes [`KEY`] (Reinhard et al.
//! 2002, eq. 1 and 2). `drago` takes the log-average as the luminance that the eye is adapted to, and luminances in units
//! of it. So both give the same picture for a scene ten times as bright, and `linear` does not: it shows radiance 1 as
//! white. All map [0, ∞) to [0, 1], ascending, and 0 to 0.

use rayon::prelude::*;
use serde::Serialize;

/// How linear radiance becomes display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum ToneMap {
    /// Drago et al. 2003, adaptive logarithmic mapping.
    Drago,
    /// The ACES filmic fit of Narkowicz 2015, after exposure to the log-average luminance.
    #[default]
    Aces,
    /// Radiance 1 is white; values are clamped. No exposure.
    Linear,
}

/// An RGB image in row-major order from the top left, linear Rec.709 radiance, W/(m² sr).
#[derive(Clone, Debug, PartialEq)]
pub struct ColorImage {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// `size[0] * size[1]` pixels.
    pub pixels: Vec<[f32; 3]>,
}

impl ColorImage {
    /// A black image.
    pub fn black(size: [u32; 2]) -> ColorImage {
        ColorImage { size, pixels: vec![[0.0; 3]; size[0] as usize * size[1] as usize] }
    }

    /// The sum of some images of one size; black if there are none.
    pub fn sum<'a>(size: [u32; 2], images: impl IntoIterator<Item = &'a ColorImage>) -> ColorImage {
        let mut sum = ColorImage::black(size);
        for image in images {
            for (sum, pixel) in sum.pixels.iter_mut().zip(&image.pixels) {
                *sum = std::array::from_fn(|channel| sum[channel] + pixel[channel]);
            }
        }
        sum
    }
}

/// The luminance that `aces` exposes the scene's log-average to: a mid-grey of 18 %.
pub const KEY: f32 = 0.18;

/// Pixels darker than this share of the mean luminance, an empty background or a black shadow, do not count in the
/// log-average: a picture is exposed for what can be seen in it, whatever its scale.
pub const DARK_SHARE_OF_MEAN: f64 = 1e-3;

/// Bias of Drago's mapping: how strongly highlights are compressed, 0.5 to 1; 0.85 is the paper's choice.
const DRAGO_BIAS: f32 = 0.85;
/// Luminance of the display's white in cd/m², the paper's reference display.
const DRAGO_DISPLAY_LUMINANCE: f32 = 100.0;

/// What the tone maps need to know of the image as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Adaptation {
    /// The log-average luminance in W/(m² sr), see [`log_average_luminance`]; 0 for a black image.
    pub log_average: f32,
    /// The largest luminance in W/(m² sr).
    pub max_luminance: f32,
}

impl Adaptation {
    /// Measures an image. Values that are negative or not finite count as black.
    pub fn of(pixels: &[[f32; 3]]) -> Adaptation {
        let max_luminance = pixels.iter().map(sound_luminance).fold(0.0, f32::max);
        Adaptation { log_average: log_average_luminance(pixels) as f32, max_luminance }
    }

    /// `value` in units of the log-average; 0 in a black image.
    fn relative(&self, value: f32) -> f32 {
        if self.log_average > 0.0 { value / self.log_average } else { 0.0 }
    }
}

/// Display values of a whole image, exposed for itself: `pixels.len()` of them, in the same order.
pub fn tone_map(image: &ColorImage, map: ToneMap) -> Vec<[u8; 3]> {
    let adaptation = if map == ToneMap::Linear { Adaptation::default() } else { Adaptation::of(&image.pixels) };
    tone_map_pixels(&image.pixels, map, adaptation).into_iter().map(|pixel| pixel.map(quantize)).collect()
}

/// sRGB-encoded display values in [0, 1], not yet rounded to levels, of pixels that are exposed as `adaptation` says: with the
/// adaptation of another image, the two can be compared.
pub fn tone_map_pixels(pixels: &[[f32; 3]], map: ToneMap, adaptation: Adaptation) -> Vec<[f32; 3]> {
    let shown = |pixel: &[f32; 3]| match map {
        ToneMap::Linear => linear(*pixel),
        ToneMap::Aces => aces(*pixel, adaptation),
        ToneMap::Drago => drago(*pixel, adaptation),
    };
    pixels.par_iter().map(|pixel| shown(pixel).map(srgb_encode)).collect()
}

/// Radiance as it is, clamped to [0, 1].
pub fn linear(radiance: [f32; 3]) -> [f32; 3] {
    radiance.map(|value| sound(value).min(1.0))
}

/// The filmic curve that Narkowicz fitted to the ACES reference ("ACES Filmic Tone Mapping Curve", 2015), on every
/// channel of the exposed radiance. It reaches 1 at about 12 times white and is clamped there.
pub fn aces(radiance: [f32; 3], adaptation: Adaptation) -> [f32; 3] {
    radiance.map(|value| {
        // Beyond 10⁴ the curve is 1; the bound keeps the squares finite.
        let x = (KEY * adaptation.relative(sound(value))).min(1e4);
        ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0)
    })
}

/// Adaptive logarithmic mapping (Drago, Myszkowski, Annen & Chiba 2003, eq. 4): luminance is compressed by a
/// logarithm whose base slides from 2 in the shadows to 10 at the image's maximum, which becomes white. As in the paper,
/// both are divided by the world adaptation luminance, the log-average, and by nothing else: no middle grey comes in.
/// Channels keep their ratio to the luminance and are clamped to [0, 1].
pub fn drago(radiance: [f32; 3], adaptation: Adaptation) -> [f32; 3] {
    let luminance = adaptation.relative(sound_luminance(&radiance));
    let maximum = adaptation.relative(adaptation.max_luminance);
    if luminance <= 0.0 || maximum <= 0.0 {
        return [0.0; 3];
    }
    let base = 2.0 + 8.0 * (luminance / maximum).powf(DRAGO_BIAS.ln() / 0.5_f32.ln());
    let white = 0.01 * DRAGO_DISPLAY_LUMINANCE / (maximum + 1.0).log10();
    let displayed = white * luminance.ln_1p() / base.ln();
    let scale = displayed / luminance;
    radiance.map(|value| (adaptation.relative(sound(value)) * scale).min(1.0))
}

/// What red, green and blue contribute to luminance, linear Rec.709.
pub const LUMINANCE_WEIGHTS: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Luminance of linear Rec.709 radiance.
pub fn luminance(radiance: &[f32; 3]) -> f32 {
    let [red, green, blue] = LUMINANCE_WEIGHTS;
    red * radiance[0] + green * radiance[1] + blue * radiance[2]
}

/// exp of the mean of ln of the luminances above [`DARK_SHARE_OF_MEAN`] times their mean; 0 for a black image.
pub fn log_average_luminance(pixels: &[[f32; 3]]) -> f64 {
    let luminances = || pixels.iter().map(|pixel| f64::from(sound_luminance(pixel)));
    let mean = luminances().sum::<f64>() / pixels.len().max(1) as f64;
    let counted = || luminances().filter(|luminance| *luminance > DARK_SHARE_OF_MEAN * mean);
    if mean > 0.0 { (counted().map(f64::ln).sum::<f64>() / counted().count() as f64).exp() } else { 0.0 }
}

/// The sRGB transfer function (IEC 61966-2-1): a linear display value in [0, 1] to its encoding in [0, 1].
pub fn srgb_encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The inverse of [`srgb_encode`].
pub fn srgb_decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The nearest of 256 levels to a value in [0, 1].
pub fn quantize(encoded: f32) -> u8 {
    (encoded.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

fn sound(value: f32) -> f32 {
    if value.is_finite() { value.max(0.0) } else { 0.0 }
}

fn sound_luminance(radiance: &[f32; 3]) -> f32 {
    luminance(&radiance.map(sound))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAPS: [ToneMap; 3] = [ToneMap::Linear, ToneMap::Aces, ToneMap::Drago];

    fn image(pixels: Vec<[f32; 3]>) -> ColorImage {
        ColorImage { size: [pixels.len() as u32, 1], pixels }
    }

    /// Greys over eight decades, and black.
    fn ramp(scale: f32) -> ColorImage {
        let grey = |step: i32| [scale * 10_f32.powf(step as f32 / 16.0); 3];
        image([[0.0; 3]].into_iter().chain((-64..=64).map(grey)).collect())
    }

    #[test]
    fn all_maps_ascend_from_black() {
        for map in MAPS {
            let shown = tone_map(&ramp(1.0), map);
            assert_eq!(shown[0], [0; 3], "{map:?}");
            assert!(shown.is_sorted_by_key(|pixel| pixel[0]), "{map:?}: {shown:?}");
            let levels: std::collections::BTreeSet<u8> = shown.iter().map(|pixel| pixel[0]).collect();
            assert!(levels.len() > 30, "{map:?} shows only {levels:?}");
            assert_eq!(shown.last(), Some(&[255; 3]), "{map:?}");
        }
    }

    #[test]
    fn exposed_maps_do_not_depend_on_the_scale_of_radiance() {
        for map in [ToneMap::Aces, ToneMap::Drago] {
            let shown = tone_map(&ramp(1.0), map);
            for scale in [1e-6, 1e-2, 37.0, 1e6] {
                let scaled = tone_map(&ramp(scale), map);
                let worst = shown.iter().zip(&scaled).map(|(a, b)| a[0].abs_diff(b[0])).max();
                assert!(worst <= Some(1), "{map:?} × {scale}: {worst:?} levels apart");
            }
        }
        assert_ne!(tone_map(&ramp(1.0), ToneMap::Linear), tone_map(&ramp(37.0), ToneMap::Linear));
    }

    #[test]
    fn a_black_image_stays_black() {
        for map in MAPS {
            assert_eq!(tone_map(&image(vec![[0.0; 3]; 5]), map), [[0; 3]; 5], "{map:?}");
            assert!(tone_map(&image(Vec::new()), map).is_empty());
        }
    }

    #[test]
    fn unsound_pixels_are_black_and_spoil_no_other() {
        let sound = image(vec![[0.1, 0.2, 0.3], [0.0; 3], [0.0; 3], [0.0; 3]]);
        let unsound = image(vec![[0.1, 0.2, 0.3], [f32::NAN; 3], [-4.0; 3], [f32::INFINITY; 3]]);
        for map in MAPS {
            assert_eq!(tone_map(&sound, map), tone_map(&unsound, map), "{map:?}");
        }
    }

    #[test]
    fn the_log_average_of_an_even_image_is_its_luminance() {
        let even = [[0.5; 3]; 7];
        assert!((log_average_luminance(&even) - 0.5).abs() < 1e-6);
        let adaptation = Adaptation::of(&even);
        assert!((adaptation.log_average - 0.5).abs() < 1e-6);
        assert!((adaptation.max_luminance - 0.5).abs() < 1e-6);
        let half = [[0.5; 3], [0.0; 3]];
        assert!((log_average_luminance(&half) - 0.5).abs() < 1e-6, "black pixels do not count");
    }

    #[test]
    fn curves_pass_through_published_points() {
        let unexposed = Adaptation { log_average: 1.0, max_luminance: 9.0 };
        // Narkowicz's fit at 1: 2.54 / 3.16.
        assert!((aces([1.0 / KEY; 3], unexposed)[0] - 2.54 / 3.16).abs() < 1e-6);
        assert_eq!(aces([1e30; 3], unexposed), [1.0; 3]);
        // Drago's eq. 4 at 1 of at most 9 adaptation luminances, where log10(9 + 1) = 1.
        let expected = 2_f32.ln() / (2.0 + 8.0 * (1.0_f32 / 9.0).powf(0.85_f32.ln() / 0.5_f32.ln())).ln();
        assert!((drago([1.0; 3], unexposed)[0] - expected).abs() < 1e-6);
        // Drago's mapping sends the maximum to white, and its base there is 10.
        assert!((drago([9.0; 3], unexposed)[1] - 1.0).abs() < 1e-5);
        let red = drago([1.0, 0.0, 0.0], unexposed);
        assert!(red[0] > 0.0 && red[1] == 0.0 && red[2] == 0.0);
    }

    #[test]
    fn srgb_has_round_numbers() {
        let encoded = |linear: f32| quantize(srgb_encode(linear));
        assert_eq!([0.0, 0.003_130_8, 0.18, 0.215_860_5, 0.5, 1.0].map(encoded), [0, 10, 118, 128, 188, 255]);
        for level in 0..=255_u8 {
            assert_eq!(encoded(srgb_decode(f32::from(level) / 255.0)), level);
        }
    }
}
