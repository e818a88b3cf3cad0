//! Reports as CSV (RFC 4180), a row for every row of the tables, numbers in full and units in the header.

use crate::bench::error_rows::{ErrorRow, Measured, error_rows};
use crate::bench::report::{ImageErrors, Report, Run};
use crate::bench::rows::{self, Row};

const HEADER: [&str; 21] = [
    "scene",
    "technique",
    "preset",
    "width",
    "height",
    "kind",
    "name",
    "median_ms",
    "min_ms",
    "p95_ms",
    "share",
    "skipped",
    "text",
    "rrmse",
    "relmse",
    "flip",
    "noise",
    "rrmse_full",
    "relmse_full",
    "flip_full",
    "noise_full",
];

/// The whole report. A number that a row does not have is empty; rows of the kind `error` have no times, and others no errors.
pub fn csv(report: &Report) -> String {
    let mut out = line(HEADER.map(str::to_owned));
    let empty = |count: usize| std::iter::repeat_n(String::new(), count);
    for run in &report.runs {
        for row in rows::rows(run) {
            out += &line(run_cells(run).into_iter().chain(row_cells(&row)).chain(empty(8)));
        }
        for row in error_rows(run) {
            let named = ["error".to_owned(), row.part.to_owned()];
            out += &line(run_cells(run).into_iter().chain(named).chain(empty(6)).chain(error_cells(&row)));
        }
    }
    out
}

fn run_cells(run: &Run) -> [String; 5] {
    let [width, height] = run.size.map(|side| side.to_string());
    [run.scene.clone(), run.technique.clone(), run.preset.clone(), width, height]
}

fn row_cells(row: &Row) -> [String; 8] {
    let (min, p95) = row.range_ms.unzip();
    [
        row.kind.name().to_owned(),
        row.name.clone(),
        number(row.ms),
        number(min),
        number(p95),
        number(row.share),
        row.skipped.to_string(),
        row.text.clone(),
    ]
}

fn error_cells(row: &ErrorRow<'_>) -> impl Iterator<Item = String> {
    [row.equal, row.full].into_iter().flat_map(|Measured { errors, noise }| {
        let of = |value: fn(&ImageErrors) -> f64| errors.map(value);
        [of(|errors| errors.rrmse), of(|errors| errors.relmse), of(|errors| errors.flip), noise].map(number)
    })
}

fn number(value: Option<f64>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

/// A row of CSV with its line end.
pub(crate) fn line(cells: impl IntoIterator<Item = String>) -> String {
    cells.into_iter().map(quoted).collect::<Vec<_>>().join(",") + "\r\n"
}

/// Quoted if it holds a comma, a quote or a line end.
fn quoted(cell: String) -> String {
    if cell.contains([',', '"', '\r', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::error_rows::tests::compared_run;
    use crate::bench::samples::tests::example_run;
    use crate::renderer::DeviceReport;

    #[test]
    fn rows_hold_the_numbers_in_full() {
        let mut report = Report::new(&DeviceReport::default());
        report.runs.push(Run { scene: "a, \"b\"".to_owned(), ..example_run() });
        let text = csv(&report);
        let lines: Vec<&str> = text.split_terminator("\r\n").collect();
        assert_eq!(lines[0], HEADER.join(","));
        assert_eq!(lines.len(), 1 + rows::rows(&report.runs[0]).len());
        let share = report.runs[0].passes[0].share;
        let expected = format!(
            "\"a, \"\"b\"\"\",rsm,default,1024,768,pass,gbuffer/draw,4.5,4,5,{share},false,262 k triangles,,,,,,,,"
        );
        assert_eq!(lines[1], expected);
        assert!(text.contains("pass,light-views/reduce,1,1,1,"), "a pass below its piece has its full name");
        report.runs = vec![compared_run()];
        let compared = csv(&report);
        let error = compared.lines().find(|line| line.contains(",error,diffuse,")).expect("a row");
        assert!(error.ends_with(",error,diffuse,,,,,,,0.125,0.0625,0.03125,0.004,0.5,0.25,0.125,0.002"), "{error}");
        assert!(compared.lines().all(|line| line.starts_with("scene,") || line.contains(",1024,768,")));
        assert!(text.contains("caustics/photons,,,,,true,no specular surface"), "{text}");
    }
}
