//! A sweep as CSV (RFC 4180), a row for every point, numbers in full and units in the header.

use std::collections::BTreeSet;

use super::grid::{Compare, Metric};
use super::lines::{Mark, lines};
use super::points::written;
use super::result::Sweep;
use crate::bench::report::ImageErrors;
use crate::bench::tables::csv_line;

/// The columns before those of the settings that vary.
const LEADING: [&str; 7] = ["id", "scene", "series", "technique", "preset", "width", "height"];
/// The columns of what was measured.
const MEASURED: [&str; 8] = [
    "frames",
    "frame_median_ms",
    "frame_min_ms",
    "frame_p95_ms",
    "serialised_median_ms",
    "unchanged_median_ms",
    "memory_bytes",
    "pareto",
];
const ERRORS: [&str; 10] = [
    "rmse",
    "rrmse",
    "block_rrmse",
    "relmse",
    "psnr_db",
    "ssim",
    "flip",
    "mean_ratio",
    "reference_rrmse",
    "reference_block_rrmse",
];

/// All points, scene by scene. A number that a point does not have is empty; so is a setting that its series leaves alone.
pub fn csv(sweep: &Sweep) -> String {
    let keys: BTreeSet<&str> =
        sweep.grid.series.iter().flat_map(|series| series.vary.keys()).map(String::as_str).collect();
    let errors = ["equal", "full"].into_iter().flat_map(|prefix| ERRORS.map(|name| format!("{prefix}_{name}")));
    let names = LEADING.into_iter().chain(keys.iter().copied()).chain(MEASURED).map(str::to_owned);
    let counts = sweep.grid.counts.keys().cloned();
    let mut out = csv_line(names.chain(errors).chain(counts));
    for scene in &sweep.grid.scenes {
        for mark in lines(sweep, &scene.name).iter().flat_map(|line| &line.marks) {
            out += &csv_line(cells(sweep, &keys, mark));
        }
    }
    out
}

fn cells(sweep: &Sweep, keys: &BTreeSet<&str>, mark: &Mark<'_>) -> Vec<String> {
    let (measured, run) = (mark.measured, &mark.measured.run);
    let [width, height] = run.size.map(|side| side.to_string());
    let mut cells = vec![measured.id.clone(), measured.scene.clone(), measured.series.clone()];
    cells.extend([run.technique.clone(), run.preset.clone(), width, height]);
    cells.extend(keys.iter().map(|key| measured.values.get(*key).map(written).unwrap_or_default()));
    cells.push(run.frames.to_string());
    let times = [run.frame_ms.median, run.frame_ms.min, run.frame_ms.p95];
    let times = times.into_iter().chain([run.serialised_ms.median, run.unchanged_ms.median]);
    cells.extend(times.map(|ms| ms.to_string()));
    cells.extend([run.memory_bytes.to_string(), mark.pareto.to_string()]);
    for compare in [Compare::Equal, Compare::Full] {
        cells.extend(error_cells(sweep.grid.errors(run, compare)));
        for metric in [Metric::Rrmse, Metric::Blocks] {
            let noise = sweep.grid.noise(run, compare, metric);
            cells.push(noise.map(|noise| noise.to_string()).unwrap_or_default());
        }
    }
    cells.extend(sweep.grid.counts.values().map(|name| run.counts.get(name).map(u64::to_string).unwrap_or_default()));
    cells
}

fn error_cells(errors: Option<&ImageErrors>) -> [String; 8] {
    let Some(errors) = errors else { return Default::default() };
    let ImageErrors { rmse, rrmse, block_rrmse, relmse, psnr, ssim, flip, mean_ratio } = errors;
    [rmse, rrmse, block_rrmse, relmse, psnr, ssim, flip, mean_ratio].map(f64::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::sweep::execute::tests::whole;

    #[test]
    fn every_point_is_a_row_of_as_many_cells() {
        let mut sweep = whole();
        sweep.points[6].run.error = None;
        sweep.grid.counts = [("sent".to_owned(), "a/b.photons".to_owned())].into();
        sweep.points[0].run.counts = [("a/b.photons".to_owned(), 17_021)].into();
        let text = csv(&sweep);
        let rows: Vec<Vec<&str>> = text.split_terminator("\r\n").map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), 15);
        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{text}");
        let cell = |row: usize, name: &str| {
            let column = rows[0].iter().position(|header| *header == name).expect("a column of this name");
            rows[row][column]
        };
        assert_eq!((cell(3, "rsm.vpls"), cell(3, "lights.resolution"), cell(3, "scene")), ("256", "", "ring"));
        assert_eq!((cell(7, "rsm.vpls"), cell(7, "lights.resolution"), cell(7, "series")), ("", "256", "shadows"));
        assert_eq!((cell(7, "equal_rrmse"), cell(1, "pareto"), cell(1, "width")), ("", "true", "256"));
        assert_eq!((cell(1, "sent"), cell(2, "sent")), ("17021", ""));
        let error = sweep.points[0].run.error_full.as_ref().expect("compared")["image"].rrmse;
        assert_eq!(cell(1, "full_rrmse"), error.to_string());
    }
}
