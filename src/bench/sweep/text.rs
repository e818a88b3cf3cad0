//! A scene's points as a table for a terminal, and what they come to.

use super::fit::{EqualTime, equal_time, slope};
use super::grid::{Compare, FRAME_COLUMN, Metric};
use super::lines::{Line, Mark, lines};
use super::points::written;
use super::result::Sweep;
use crate::bench::report::{Pass as PassRow, Run};
use crate::bench::tables::{TEXT_WIDTH, table};
use crate::bench::units;

/// All points of a scene, and below them the slopes of its lines; empty if there are none.
pub fn scene_text(sweep: &Sweep, scene: &str) -> String {
    let lines = lines(sweep, scene);
    let Some(first) = lines.iter().flat_map(|line| &line.marks).next() else { return String::new() };
    let [width, height] = first.measured.run.size;
    let shown = match sweep.grid.reference {
        Some(_) => sweep.grid.error_words(),
        None => "no reference".to_owned(),
    };
    let mut out = format!("{scene}: {width}x{height}, {shown}\n{}\n", points_table(sweep, &lines));
    if lines.iter().any(|line| line.marks.len() > 1) {
        out += &format!("\n{}\n", lines_table(sweep, &lines));
    }
    out
}

/// The columns of a sweep that has references.
const ERROR_COLUMNS: [&str; 7] = ["rrmse equal", "rrmse full", "8×8", "its noise", "mean", "flip", "Pareto"];

/// Characters for each column of the grid's own, and how many of these a table of the usual width has room for.
const OWN_COLUMN: u16 = 14;
const OWN_COLUMNS_THAT_FIT: u16 = 1;

/// Of a table with so many columns that a grid asks for. They stand side by side: numbers that are broken in two cannot be read.
pub(super) fn width(own_columns: usize) -> u16 {
    TEXT_WIDTH + OWN_COLUMN * (own_columns as u16).saturating_sub(OWN_COLUMNS_THAT_FIT)
}

fn points_table(sweep: &Sweep, lines: &[Line<'_>]) -> String {
    let columns: Vec<String> = sweep.grid.columns.keys().map(|name| format!("{name} ms")).collect();
    let mut header = vec!["series", "values"];
    header.extend(sweep.grid.counts.keys().map(String::as_str));
    header.extend(columns.iter().map(String::as_str));
    header.push("frame ms");
    if sweep.grid.reference.is_some() {
        header.extend(ERROR_COLUMNS);
    }
    let numbers: Vec<usize> = (2..3 + sweep.grid.counts.len() + columns.len() + ERROR_COLUMNS.len() - 1).collect();
    let mut table = table(&header, &numbers);
    table.set_width(width(sweep.grid.counts.len() + columns.len()));
    for line in lines {
        for mark in &line.marks {
            table.add_row(point_cells(sweep, mark));
        }
    }
    table.trim_fmt()
}

/// Milliseconds, and in brackets what somebody published of the same point.
fn time_cell(ours: f64, published: Option<f64>) -> String {
    let ours = units::milliseconds(ours);
    published.map_or(ours.clone(), |theirs| format!("{ours} ({theirs})"))
}

/// The passes whose full names begin so, added up, milliseconds.
pub(super) fn column_ms(run: &Run, beginnings: &[String]) -> f64 {
    let is_of = |row: &&PassRow| {
        let name = row.full_name();
        beginnings.iter().any(|beginning| name.starts_with(beginning))
    };
    run.passes.iter().filter(is_of).fold(0.0, |sum, row| sum + row.ms.median)
}

fn point_cells(sweep: &Sweep, mark: &Mark<'_>) -> Vec<String> {
    let measured = mark.measured;
    let errors = |compare| sweep.grid.errors(&measured.run, compare);
    let values = measured.values.iter().map(|(key, value)| format!("{key} {}", written(value)));
    let published = sweep.grid.published_of((&measured.scene, &measured.series), &measured.values);
    let theirs = |column: &str| published.and_then(|ms| ms.get(column)).copied();
    let columns = sweep.grid.columns.iter();
    let columns = columns.map(|(name, passes)| time_cell(column_ms(&measured.run, passes), theirs(name)));
    let mut cells = vec![measured.series.clone(), values.collect::<Vec<_>>().join(", ")];
    let count = |name: &String| measured.run.counts.get(name).map(u64::to_string).unwrap_or_default();
    cells.extend(sweep.grid.counts.values().map(count));
    cells.extend(columns);
    cells.push(time_cell(mark.time_ms, theirs(FRAME_COLUMN)));
    if sweep.grid.reference.is_some() {
        cells.extend([
            optional(errors(Compare::Equal).map(|errors| errors.rrmse)),
            optional(errors(Compare::Full).map(|errors| errors.rrmse)),
            optional(errors(sweep.grid.compare).map(|errors| errors.block_rrmse)),
            optional(sweep.grid.noise(&measured.run, sweep.grid.compare, Metric::Blocks)),
            optional(errors(sweep.grid.compare).map(|errors| errors.mean_ratio)),
            optional(errors(sweep.grid.compare).map(|errors| errors.flip)),
            if mark.pareto { "*" } else { "" }.to_owned(),
        ]);
    }
    cells
}

fn lines_table(sweep: &Sweep, lines: &[Line<'_>]) -> String {
    let equal = equal_time(lines);
    let at = equal.as_ref().map(|equal| format!("error at {} ms", units::milliseconds(equal.time_ms)));
    let columns: Vec<String> = sweep.grid.columns.keys().map(|name| format!("{name} ~ value^")).collect();
    let mut header = vec!["line", "error ~ time^", "time ~ value^"];
    header.extend(columns.iter().map(String::as_str));
    header.extend(at.as_deref());
    let mut table = table(&header, &(1..header.len()).collect::<Vec<_>>());
    table.set_width(width(columns.len()));
    for (index, line) in lines.iter().enumerate() {
        let mut cells = vec![label(line), exponent(slope(&line.pairs()))];
        let of_values = |ms: &dyn Fn(&Mark<'_>) -> f64| exponent(slope(&line.value_times(ms)));
        cells.push(of_values(&|mark| mark.time_ms));
        cells
            .extend(sweep.grid.columns.values().map(|passes| of_values(&|mark| column_ms(&mark.measured.run, passes))));
        if let Some(EqualTime { errors, .. }) = &equal {
            cells.push(optional(errors[index]));
        }
        table.add_row(cells);
    }
    table.trim_fmt()
}

/// With two decimals; nothing if there is none.
pub(super) fn exponent(slope: Option<f64>) -> String {
    slope.map(|slope| format!("{slope:.2}")).unwrap_or_default()
}

/// `rsm` or `rsm (preset high)`.
fn label(line: &Line<'_>) -> String {
    if line.fixed.is_empty() { line.name.to_owned() } else { format!("{} ({})", line.name, line.fixed_words()) }
}

/// An error with three digits that count.
fn optional(error: Option<f64>) -> String {
    let Some(error) = error else { return String::new() };
    let decimals = if error > 0.0 && error < 1.0 { (2 - error.log10().floor() as i32).clamp(3, 9) as usize } else { 3 };
    format!("{error:.decimals$}")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde_json::Value;

    use super::*;
    use crate::bench::statistics::Spread;
    use crate::bench::sweep::Published;
    use crate::bench::sweep::execute::tests::whole;

    #[test]
    fn a_scene_is_a_row_a_point_and_a_row_a_line() {
        let sweep = whole();
        let text = scene_text(&sweep, "ring");
        assert!(text.starts_with("ring: 256x256, relative RMSE of the image against full light transport\n"), "{text}");
        let rows: Vec<&str> = text.lines().filter(|line| line.contains("rsm.vpls ")).collect();
        assert_eq!(rows.len(), 5, "{text}");
        // 16 VPLs of maps of 512²: 0.01 · 8192^0.9 ms; errors 10 · 8192^-0.5, and 0.05 more.
        for words in ["rsm.vpls 16", "33.27", "0.110", "0.160", "*"] {
            assert!(rows[0].contains(words), "{words} is not in {}", rows[0]);
        }
        let slopes: Vec<&str> =
            text.lines().filter(|line| line.starts_with(" gathered") && !line.contains("vpls")).collect();
        assert!(slopes.len() == 1 && slopes[0].contains("0.90"), "{text}");
        assert_eq!(scene_text(&sweep, "maze"), "");
    }

    #[test]
    fn published_times_stand_beside_those_of_their_point() {
        let mut sweep = whole();
        let pass = |piece: &str, pass: &str, median: f64| PassRow {
            piece: piece.to_owned(),
            pass: pass.to_owned(),
            ms: Spread { median, ..Spread::default() },
            ..PassRow::default()
        };
        for measured in &mut sweep.points {
            measured.run.passes =
                vec![pass("diffuse/rsm", "scan", 1.5), pass("diffuse/rsm", "vpls", 2.0), pass("direct", "rest", 9.0)];
        }
        sweep.grid.columns = BTreeMap::from([("gather".to_owned(), vec!["diffuse/rsm".to_owned()])]);
        sweep.grid.published = vec![Published {
            scene: "ring".to_owned(),
            series: None,
            values: BTreeMap::from([("rsm.vpls".to_owned(), Value::from(64))]),
            ms: BTreeMap::from([("gather".to_owned(), 7.25)]),
        }];
        sweep.grid.counts = BTreeMap::from([("sent".to_owned(), "diffuse/rsm/vpls.VPLs".to_owned())]);
        sweep.points[0].run.counts = BTreeMap::from([("diffuse/rsm/vpls.VPLs".to_owned(), 12_345)]);
        let text = scene_text(&sweep, "ring");
        assert!(text.contains("sent") && text.contains("12345"), "{text}");
        let row = |words: &str| text.lines().find(|line| line.contains(words)).expect("a row").to_owned();
        assert!(row("rsm.vpls 64").contains("3.500 (7.25)"), "{text}");
        assert!(row("rsm.vpls 16").contains("3.500") && !row("rsm.vpls 16").contains('('), "{text}");
        sweep.grid.published[0].series = Some("another".to_owned());
        assert!(!scene_text(&sweep, "ring").contains("(7.25)"));
    }

    #[test]
    fn columns_have_slopes_of_their_own() {
        let mut sweep = whole();
        sweep.grid.columns = BTreeMap::from([("gather".to_owned(), vec!["diffuse/rsm/gather".to_owned()])]);
        for measured in &mut sweep.points {
            let value = measured.values.values().next().and_then(Value::as_f64).expect("a number");
            let ms = Spread { median: 0.5 * value.powf(1.5), ..Spread::default() };
            let (piece, pass) = ("diffuse/rsm".to_owned(), "gather".to_owned());
            measured.run.passes = vec![PassRow { piece, pass, ms, ..PassRow::default() }];
        }
        let text = scene_text(&sweep, "ring");
        let row = text.lines().rfind(|line| line.starts_with(" gathered")).expect("a row");
        let cells: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(cells[2..4], ["0.90", "1.50"], "{text}");
    }

    #[test]
    fn without_a_reference_there_are_times_alone() {
        let mut sweep = whole();
        for measured in &mut sweep.points {
            (measured.run.error, measured.run.error_full) = (None, None);
        }
        sweep.grid.reference = None;
        let text = scene_text(&sweep, "ring");
        assert!(text.contains("no reference") && text.contains("0.90") && !text.contains('*'), "{text}");
    }

    #[test]
    fn errors_have_three_digits() {
        let texts = [Some(1.23456), Some(0.0123456), Some(0.000123456), Some(0.0), None].map(optional);
        assert_eq!(texts, ["1.235", "0.0123", "0.000123", "0.000", ""]);
    }
}
