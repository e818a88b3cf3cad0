//! How times grow from scene to scene: with the pixels of the picture, or with the triangles.

use std::collections::BTreeMap;

use serde_json::Value;

use super::fit::slope;
use super::grid::GrowsWith;
use super::points::written;
use super::result::{Measured, Sweep};
use super::text::{column_ms, exponent, width};
use crate::bench::report::Run;
use crate::bench::tables::table;

/// What a run has of what scenes differ in.
fn abscissa(what: GrowsWith, run: &Run) -> f64 {
    match what {
        GrowsWith::Pixels => f64::from(run.size[0]) * f64::from(run.size[1]),
        GrowsWith::Triangles => run.triangles as f64,
    }
}

/// A series, and the values of its settings that vary.
type SeriesPoint<'a> = (&'a str, &'a BTreeMap<String, Value>);

/// The exponents by which the columns and the frame of every point grow over the scenes that the grid's `growth` names, a row a point; empty if
/// it names none or fewer than two of them have been measured.
pub fn growth_text(sweep: &Sweep) -> String {
    let columns = &sweep.grid.columns;
    let mut header = vec!["over", "series", "values"];
    header.extend(columns.keys().map(String::as_str));
    header.push("frame");
    let mut table = table(&header, &(3..header.len()).collect::<Vec<_>>());
    table.set_width(width(columns.len()));
    let mut empty = true;
    for (what, scenes) in &sweep.grid.growth {
        let of_scenes = |measured: &&Measured| scenes.contains(&measured.scene);
        let mut points: Vec<(SeriesPoint<'_>, Vec<&Run>)> = Vec::new();
        for measured in sweep.points.iter().filter(of_scenes) {
            let point = (measured.series.as_str(), &measured.values);
            match points.iter_mut().find(|(known, _)| *known == point) {
                Some((_, runs)) => runs.push(&measured.run),
                None => points.push((point, vec![&measured.run])),
            }
        }
        for ((series, values), runs) in points.into_iter().filter(|(_, runs)| runs.len() > 1) {
            let grown = |time: &dyn Fn(&Run) -> f64| {
                let pairs: Vec<(f64, f64)> = runs.iter().map(|run| (abscissa(*what, run), time(run))).collect();
                exponent(slope(&pairs))
            };
            let values = values.iter().map(|(key, value)| format!("{key} {}", written(value)));
            let mut cells = vec![what.name().to_owned(), series.to_owned(), values.collect::<Vec<_>>().join(", ")];
            cells.extend(columns.values().map(|passes| grown(&|run| column_ms(run, passes))));
            cells.push(grown(&|run| run.frame_ms.median));
            table.add_row(cells);
            empty = false;
        }
    }
    if empty { String::new() } else { format!("exponents of times over scenes\n{}\n", table.trim_fmt()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::report::Pass;
    use crate::bench::statistics::Spread;
    use crate::bench::sweep::execute::tests::whole;

    #[test]
    fn exponents_over_scenes_are_found_again() {
        let mut sweep = whole();
        sweep.grid.columns = BTreeMap::from([("draw".to_owned(), vec!["gbuffer/".to_owned()])]);
        for measured in &mut sweep.points {
            let side = if measured.scene == "ring" { 64 } else { 256 };
            let pixels = f64::from(side * side);
            let ms = |median: f64| Spread { min: median, median, p95: median };
            measured.run.size = [side, side];
            measured.run.triangles = if measured.scene == "ring" { 1000 } else { 8000 };
            measured.run.frame_ms = ms(5.0 * pixels.powf(0.5));
            let (piece, pass) = ("gbuffer".to_owned(), "draw".to_owned());
            measured.run.passes = vec![Pass { piece, pass, ms: ms(0.01 * pixels), ..Pass::default() }];
        }
        assert_eq!(growth_text(&sweep), "", "nothing was asked for");
        let scenes = ["ring", "corridor"].map(str::to_owned).to_vec();
        sweep.grid.growth = BTreeMap::from([(GrowsWith::Pixels, scenes.clone()), (GrowsWith::Triangles, scenes)]);
        let text = growth_text(&sweep);
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        let rows_of = |what: &str| rows.iter().filter(|row| row.first() == Some(&what)).count();
        assert_eq!((rows_of("pixels"), rows_of("triangles")), (7, 7), "{text}");
        assert!(rows.contains(&vec!["pixels", "gathered", "rsm.vpls", "64", "1.00", "0.50"]), "{text}");
        // Sixteen times the time is eight times the triangles to the power of 4/3, four times the time to that of 2/3.
        assert!(rows.contains(&vec!["triangles", "shadows", "lights.resolution", "64", "1.33", "0.67"]), "{text}");
        sweep.points.retain(|measured| measured.scene == "ring");
        assert_eq!(growth_text(&sweep), "", "one scene alone");
    }
}
