//! `irradia compare`: how far one picture is from another.

use std::path::PathBuf;

use anyhow::{Context as _, Result};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use irradia::bench::comparison::{ComparisonReport, IMAGE_LAYER, NamedImage, layer, layers};
use irradia::bench::tables;
use irradia::metrics::{self, HEAT_MAP_RANGE};
use irradia::output::{self, Attributes, ExrImage, ImageFormat, Target};
use irradia::renderer::ColorImage;

use super::invocation::Invocation;

/// Measure how far a picture is from a reference: the image, and every slot that both files have
#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The picture that is measured, an .exr file
    #[arg(value_name = "A", value_parser = radiance_path)]
    image: PathBuf,
    /// The reference that it is measured against, an .exr file
    #[arg(value_name = "B", value_parser = radiance_path)]
    reference: PathBuf,
    /// Write the errors as JSON, schema irradia-compare/1
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a PNG that shows where the errors are: the difference of luminance over the reference's mean luminance, from
    /// 0.001 (black) to 10 (pale yellow), with a tick in the bar at every power of ten
    #[arg(long, value_name = "FILE.png", value_parser = png_path)]
    heatmap: Option<PathBuf>,
    /// What the heat map shows
    #[arg(long, requires = "heatmap", value_parser = layer_name(), default_value = IMAGE_LAYER)]
    slot: &'static str,
}

/// Prints the table, then writes the files asked for.
pub(crate) fn run(args: &CompareArgs, invocation: &Invocation<'_>) -> Result<()> {
    let open = |path: &Option<PathBuf>| path.as_deref().map(Target::open).transpose();
    let (json, heatmap) = (open(&args.json)?, open(&args.heatmap)?);
    let (image, reference) = (output::read_exr(&args.image)?, output::read_exr(&args.reference)?);
    let names = [&args.image, &args.reference].map(|path| path.display().to_string());
    warn_of_lone_layers([(&names[0], &image), (&names[1], &reference)]);
    let report = ComparisonReport::new(
        NamedImage { name: &names[0], content: &image },
        NamedImage { name: &names[1], content: &reference },
    )?;
    let find = |name, file| {
        let known = layers().filter(|name| report.errors.contains_key(*name)).collect::<Vec<_>>().join(", ");
        layer(file, args.slot).with_context(|| format!("{name} has no slot {}; both files have {known}", args.slot))
    };
    let heat_map = match heatmap {
        Some(target) => Some((target, find(&names[0], &image)?, find(&names[1], &reference)?)),
        None => None,
    };
    invocation.terminal.print(&tables::comparison_text(&report))?;
    if let Some(target) = json {
        target.write((serde_json::to_string_pretty(&report)? + "\n").as_bytes())?;
    }
    if let Some((target, image, reference)) = heat_map {
        write_heat_map(&target, image, reference, &report, args.slot)?;
    }
    Ok(())
}

/// Says which slots stand in one file alone.
fn warn_of_lone_layers(files: [(&str, &ExrImage); 2]) {
    for [(name, file), (other_name, other)] in [files, [files[1], files[0]]] {
        let lone: Vec<&str> =
            layers().filter(|name| layer(file, name).is_some() && layer(other, name).is_none()).collect();
        if !lone.is_empty() {
            tracing::warn!("{name} alone has {}, which {other_name} lacks; not compared", lone.join(", "));
        }
    }
}

fn write_heat_map(
    target: &Target,
    image: &ColorImage,
    reference: &ColorImage,
    report: &ComparisonReport,
    slot: &str,
) -> Result<()> {
    let map = metrics::heat_map(image, reference)?;
    let [low, high] = HEAT_MAP_RANGE;
    let shows = format!("difference of luminance over the reference's mean luminance, logarithmic, {low} to {high}");
    let attributes = [
        ("irradia", &*report.irradia),
        ("image", &report.image),
        ("reference", &report.reference),
        ("slot", slot),
        ("heatmap", &shows),
    ];
    let attributes: Attributes = attributes.map(|(name, value)| (name.to_owned(), value.to_owned())).into();
    Ok(output::write_png(target, map.size, &map.pixels, &attributes)?)
}

/// A file of linear radiance. Whatever is not known for display values is tried as EXR.
fn radiance_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match ImageFormat::from_path(&path) {
        Ok(ImageFormat::Png) => {
            Err("a PNG holds display values, exposed picture by picture, and errors are measured on linear \
                                     radiance; render to .exr and compare those"
                .to_owned())
        }
        _ => Ok(path),
    }
}

fn png_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match ImageFormat::from_path(&path) {
        Ok(ImageFormat::Png) => Ok(path),
        _ => Err("a heat map is a .png".to_owned()),
    }
}

/// The name of a slot, or `image`.
fn layer_name() -> impl TypedValueParser<Value = &'static str> {
    PossibleValuesParser::new(layers())
        .try_map(|name| layers().find(|known| *known == name).ok_or_else(|| format!("there is no slot {name:?}")))
}
