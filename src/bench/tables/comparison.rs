//! Two files compared, as a table for a terminal.

use super::text::table;
use crate::bench::comparison::{ComparisonReport, NOISE_BOUND, layers};
use crate::bench::units;
use crate::metrics::Comparison;

const HEADER: [&str; 10] =
    ["layer", "rmse", "rrmse", "8×8", "relmse", "psnr dB", "ssim", "flip", "mean ratio", "noise rmse"];

/// A row for the image and each slot. The last column, the noise that the reference states of itself, is left out if it states
/// none; an error below [`NOISE_BOUND`] times that noise stands as a bound, `< x`.
pub fn comparison_text(report: &ComparisonReport) -> String {
    let columns = if report.noise.is_empty() { HEADER.len() - 1 } else { HEADER.len() };
    let mut table = table(&HEADER[..columns], &(1..columns).collect::<Vec<_>>());
    for (layer, errors) in layers().filter_map(|layer| Some((layer, report.errors.get(layer)?))) {
        let cells = cells(layer, errors, report.noise.get(layer).copied());
        table.add_row(cells.into_iter().take(columns));
    }
    let ComparisonReport { image, reference, size: [width, height], .. } = report;
    let mut text = format!("{image} against {reference}: {width}x{height}\n{}\n", table.trim_fmt());
    if bounded(report) {
        text += "<: less than twice the noise of the reference; what else the row says is about that noise\n";
    }
    text
}

fn cells(layer: &str, Comparison { errors, .. }: &Comparison, noise: Option<f64>) -> [String; 10] {
    let bound = noise.map(|noise| NOISE_BOUND * noise).filter(|bound| errors.rmse < *bound);
    // Both are the same difference in two units.
    let bounded = |error: f64| match bound {
        Some(bound) if errors.rmse > 0.0 => format!("< {}", units::error(error * (bound / errors.rmse))),
        _ => units::error(error),
    };
    let decimals = |value: f64, decimals: usize| {
        if value.is_infinite() { units::error(value) } else { format!("{value:.decimals$}") }
    };
    [
        layer.to_owned(),
        bounded(errors.rmse),
        bounded(errors.rrmse),
        units::error(errors.block_rrmse),
        units::error(errors.relmse),
        decimals(errors.psnr, 2),
        decimals(errors.ssim, 4),
        decimals(errors.flip, 4),
        decimals(errors.mean_ratio, 4),
        noise.map(units::error).unwrap_or_default(),
    ]
}

fn bounded(report: &ComparisonReport) -> bool {
    let rows = report.errors.iter().filter_map(|(layer, row)| Some((row.errors.rmse, report.noise.get(layer)?)));
    rows.into_iter().any(|(rmse, noise)| rmse > 0.0 && rmse < NOISE_BOUND * noise)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::comparison::tests::example;

    fn row<'a>(text: &'a str, layer: &str) -> Vec<&'a str> {
        let line = text.lines().find(|line| line.trim_start().starts_with(layer)).expect("the layer has a row");
        line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect()
    }

    #[test]
    fn rows_are_layers_and_errors_within_the_noise_are_bounds() {
        let text = comparison_text(&example());
        assert!(text.starts_with("a.exr against b.exr: 4x3\n"), "{text}");
        let image = row(&text, "image");
        assert_eq!(image[..5], ["image", "0.500", "0.500", "0.500", "0.250"], "{text}");
        assert_eq!(image[8..], ["1.5000", "0.100"], "{text}");
        let diffuse = row(&text, "diffuse");
        // 0.0625 is below twice 0.05; the mean is one half.
        assert_eq!(diffuse[..3], ["diffuse", "< 0.100", "< 0.200"], "{text}");
        assert_eq!(
            row(&text, "caustics"),
            ["caustics", "0", "0", "0", "0", "∞", "1.0000", "0.0000", "1.0000"],
            "{text}"
        );
        assert!(text.contains("twice the noise"), "{text}");
        let positions = ["image", "diffuse", "caustics"].map(|layer| text.find(&format!("\n {layer}")));
        assert!(positions.is_sorted() && positions[0].is_some(), "the order of slots: {text}");
    }

    #[test]
    fn a_reference_that_states_no_noise_has_no_column_for_it() {
        let mut report = example();
        report.noise.clear();
        let text = comparison_text(&report);
        assert!(!text.contains("noise") && !text.contains('<'), "{text}");
    }
}
