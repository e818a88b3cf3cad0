//! Two files compared: the JSON of `irradia compare`, schema `irradia-compare/1`. Other programs read it: names stay what they are.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::metrics::{self, Comparison, MetricsError};
use crate::output::{Attributes, ExrImage};
use crate::renderer::{ColorImage, Slot};

/// The schema that [`ComparisonReport`] writes.
pub const COMPARISON_SCHEMA: &str = "irradia-compare/1";

/// The name of the whole image among the layers of a file.
pub const IMAGE_LAYER: &str = "image";

/// An error below so many times the reference's own noise says nothing but that it is so small.
pub const NOISE_BOUND: f64 = 2.0;

/// How far the image and each slot in one file are from those in another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparisonReport {
    /// [`COMPARISON_SCHEMA`].
    pub schema: String,
    /// The version of irradia.
    pub irradia: String,
    /// The file that is measured.
    pub image: String,
    /// The file that it is measured against.
    pub reference: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What was measured, by slot and `image`.
    pub errors: BTreeMap<String, Comparison>,
    /// Root of the mean variance of the reference's pixels, W/(m² sr), by slot and `image`, where the reference states it.
    pub noise: BTreeMap<String, f64>,
}

/// Two layers that cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{image} cannot be compared with {reference} ({layer}): {reason}")]
pub struct ComparisonError {
    /// The file that was to be measured.
    pub image: String,
    /// The file to measure it against.
    pub reference: String,
    /// A slot or `image`.
    pub layer: String,
    /// Why.
    pub reason: MetricsError,
}

/// A file by its name.
#[derive(Clone, Copy, Debug)]
pub struct NamedImage<'a> {
    /// As people call it.
    pub name: &'a str,
    /// What it holds.
    pub content: &'a ExrImage,
}

impl ComparisonReport {
    /// Measures the image and all slots that both files have.
    ///
    /// # Errors
    /// The files differ in size or hold values that are not finite.
    pub fn new(image: NamedImage<'_>, reference: NamedImage<'_>) -> Result<ComparisonReport, ComparisonError> {
        let shared =
            layers().filter_map(|name| Some((name, layer(image.content, name)?, layer(reference.content, name)?)));
        let compare = |(name, x, r): (&str, &ColorImage, &ColorImage)| {
            let failed = |reason| ComparisonError {
                image: image.name.to_owned(),
                reference: reference.name.to_owned(),
                layer: name.to_owned(),
                reason,
            };
            Ok((name.to_owned(), metrics::compare(x, r).map_err(failed)?))
        };
        let errors: BTreeMap<String, Comparison> = shared.map(compare).collect::<Result<_, _>>()?;
        let attributes = &reference.content.attributes;
        let noise = errors.keys().filter_map(|layer| Some((layer.clone(), noise(attributes, layer)?))).collect();
        Ok(ComparisonReport {
            schema: COMPARISON_SCHEMA.to_owned(),
            irradia: env!("CARGO_PKG_VERSION").to_owned(),
            image: image.name.to_owned(),
            reference: reference.name.to_owned(),
            size: reference.content.image.size,
            errors,
            noise,
        })
    }
}

/// The names of all layers that a file may have: `image`, then the slots.
pub fn layers() -> impl Iterator<Item = &'static str> {
    [IMAGE_LAYER].into_iter().chain(Slot::ALL.map(Slot::name))
}

/// The layer called `name`, if the file has it.
pub fn layer<'a>(file: &'a ExrImage, name: &str) -> Option<&'a ColorImage> {
    if name == IMAGE_LAYER { Some(&file.image) } else { file.slots.get(&Slot::from_name(name)?) }
}

/// What a file states of a layer's noise in the attribute `noise.LAYER.rmse`. What cannot be noise is warned of and counts as not
/// stated.
fn noise(attributes: &Attributes, layer: &str) -> Option<f64> {
    let name = format!("noise.{layer}.rmse");
    let value = attributes.get(&name)?;
    let noise = value.trim().parse().ok().filter(|noise: &f64| noise.is_finite() && *noise >= 0.0);
    if noise.is_none() {
        tracing::warn!("the reference's attribute {name} is {value:?}, which is no noise, and is left out");
    }
    noise
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    fn constant(value: f32) -> ColorImage {
        ColorImage { size: [4, 3], pixels: vec![[value; 3]; 12] }
    }

    /// An image of 1.5 and a slot that is off by a little, against 1 and a noise of a tenth.
    pub(crate) fn example() -> ComparisonReport {
        let slots = |diffuse: f32, other: Slot| {
            BTreeMap::from([
                (Slot::Diffuse, constant(diffuse)),
                (Slot::Caustics, constant(0.0)),
                (other, constant(1.0)),
            ])
        };
        let image =
            ExrImage { image: constant(1.5), slots: slots(0.5625, Slot::Direct), attributes: Attributes::new() };
        let noise = [("image", "0.1"), ("diffuse", "0.05"), ("caustics", "loud"), ("specular", "1")];
        let attributes = noise.map(|(layer, noise)| (format!("noise.{layer}.rmse"), noise.to_owned()));
        let reference =
            ExrImage { image: constant(1.0), slots: slots(0.5, Slot::Specular), attributes: attributes.into() };
        let named = |name, content| NamedImage { name, content };
        ComparisonReport::new(named("a.exr", &image), named("b.exr", &reference)).expect("sound images")
    }

    #[test]
    fn layers_that_both_files_have_are_compared() {
        let report = example();
        assert_eq!(report.errors.keys().collect::<Vec<_>>(), ["caustics", "diffuse", "image"]);
        assert_eq!(report.errors["image"].errors.rmse, 0.5);
        assert_eq!(report.errors["diffuse"].errors.mean_ratio, 1.125);
        assert_eq!(report.errors["caustics"].errors.rrmse, 0.0);
        assert_eq!(report.noise, BTreeMap::from([("image".to_owned(), 0.1), ("diffuse".to_owned(), 0.05)]));
    }

    #[test]
    fn the_schema_keeps_its_names_and_reads_back() {
        let report = example();
        let json = serde_json::to_value(&report).expect("plain data");
        assert_eq!(json["schema"], "irradia-compare/1");
        assert_eq!((&json["image"], &json["reference"]), (&"a.exr".into(), &"b.exr".into()));
        assert_eq!(json["size"], serde_json::json!([4, 3]));
        let image = json["errors"]["image"].as_object().expect("an object");
        for name in ["rmse", "rrmse", "block_rrmse", "relmse", "psnr", "ssim", "flip", "mean_ratio", "bias"] {
            assert!(image.contains_key(name), "{name} is not in {image:?}");
        }
        assert!(
            json["errors"]["caustics"]["psnr"].is_null(),
            "two black layers are the same, and JSON has no infinity"
        );
        let text = serde_json::to_string_pretty(&report).expect("plain data");
        assert_eq!(serde_json::from_str::<ComparisonReport>(&text).expect("its own"), report);
    }

    #[test]
    fn an_error_names_files_and_layer() {
        let mut slots = BTreeMap::from([(Slot::Direct, constant(1.0))]);
        let sound = ExrImage { image: constant(1.0), slots: slots.clone(), attributes: Attributes::new() };
        slots.entry(Slot::Direct).and_modify(|layer| layer.pixels[6][1] = f32::NAN);
        let unsound = ExrImage { slots, ..sound.clone() };
        let (a, b) = (NamedImage { name: "a.exr", content: &sound }, NamedImage { name: "b.exr", content: &unsound });
        let message = ComparisonReport::new(a, b).expect_err("a pixel is no number").to_string();
        let start = "a.exr cannot be compared with b.exr (direct): the reference holds [1.0, NaN, 1.0] in pixel (2, 1)";
        assert!(message.starts_with(start), "{message}");
    }
}
