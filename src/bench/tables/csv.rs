//! Reports as CSV (RFC 4180), a row for every row of the tables, numbers in full and units in the header.

use crate::bench::report::{Report, Run};
use crate::bench::rows::{self, Row};

const HEADER: [&str; 13] = [
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
];

/// The whole report. A number that a row does not have is empty.
pub fn csv(report: &Report) -> String {
    let mut out = line(HEADER.map(str::to_owned));
    for run in &report.runs {
        for row in rows::rows(run) {
            out += &line(cells(run, &row));
        }
    }
    out
}

fn cells(run: &Run, row: &Row) -> [String; 13] {
    let number = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
    let (min, p95) = row.range_ms.unzip();
    let [width, height] = run.size.map(|side| side.to_string());
    [
        run.scene.clone(),
        run.technique.clone(),
        run.preset.clone(),
        width,
        height,
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
        let expected =
            format!("\"a, \"\"b\"\"\",rsm,default,1024,768,pass,gbuffer/draw,4.5,4,5,{share},false,262 k triangles");
        assert_eq!(lines[1], expected);
        assert!(text.contains("pass,light-views/reduce,1,1,1,"), "a pass below its piece has its full name");
        assert!(text.contains("caustics/splat,,,,,true,no specular surface"), "{text}");
    }
}
