//! The points of a scene as lines: what a series traces while one of its settings runs.

use std::collections::BTreeMap;

use serde_json::Value;

use super::grid::Series;
use super::pareto::pareto_front;
use super::points::written;
use super::result::{Measured, Sweep};

/// Points of one series between which one setting runs while the others stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Line<'a> {
    /// Which of the grid's series.
    pub series: usize,
    /// The series' name.
    pub name: &'a str,
    /// The setting that runs; `None` if the series is a single point.
    pub key: Option<&'a str>,
    /// The values that stand, of a series in which several settings vary.
    pub fixed: BTreeMap<&'a str, &'a Value>,
    /// The points, in the order of the grid.
    pub marks: Vec<Mark<'a>>,
}

/// A point of a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark<'a> {
    /// What was measured.
    pub measured: &'a Measured,
    /// The value of the setting that runs.
    pub value: Option<&'a Value>,
    /// Median GPU time of a frame made anew, milliseconds.
    pub time_ms: f64,
    /// The error that the grid asks for.
    pub error: Option<f64>,
    /// Whether it is on the Pareto front of all points of the scene.
    pub pareto: bool,
}

impl Line<'_> {
    /// Time and error of the points that have both.
    pub fn pairs(&self) -> Vec<(f64, f64)> {
        self.marks.iter().filter_map(|mark| Some((mark.time_ms, mark.error?))).collect()
    }

    /// Value and a time of the points whose value is a number.
    pub fn value_times(&self, ms: impl Fn(&Mark<'_>) -> f64) -> Vec<(f64, f64)> {
        self.marks.iter().filter_map(|mark| Some((mark.value?.as_f64()?, ms(mark)))).collect()
    }

    /// What distinguishes it from others of the series: `preset high, shadow.filter_radius 1`; empty if nothing does.
    pub fn fixed_words(&self) -> String {
        let words: Vec<String> = self.fixed.iter().map(|(key, value)| format!("{key} {}", written(value))).collect();
        words.join(", ")
    }
}

/// The lines of a scene, series by series. Of several settings that vary, the one with the most values runs along the
/// lines; of several such the last one.
pub fn lines<'a>(sweep: &'a Sweep, scene: &str) -> Vec<Line<'a>> {
    let measured: Vec<&Measured> = sweep.points.iter().filter(|measured| measured.scene == scene).collect();
    let pairs: Vec<Option<(f64, f64)>> = measured
        .iter()
        .map(|measured| Some((measured.run.frame_ms.median, sweep.grid.error(&measured.run)?)))
        .collect();
    let front = pareto_front(&pairs);
    let mut lines: Vec<Line<'a>> = Vec::new();
    for (measured, pareto) in measured.into_iter().zip(front) {
        let Some(series) = sweep.grid.series.iter().position(|series| series.name == measured.series) else { continue };
        let key = running(&sweep.grid.series[series]);
        let mut fixed: BTreeMap<&str, &Value> =
            measured.values.iter().map(|(key, value)| (key.as_str(), value)).collect();
        let value = key.and_then(|key| fixed.remove(key));
        let mark = Mark {
            measured,
            value,
            time_ms: measured.run.frame_ms.median,
            error: sweep.grid.error(&measured.run),
            pareto,
        };
        match lines.iter_mut().find(|line| line.series == series && line.fixed == fixed) {
            Some(line) => line.marks.push(mark),
            None => lines.push(Line { series, name: &measured.series, key, fixed, marks: vec![mark] }),
        }
    }
    lines.sort_by_key(|line| line.series);
    lines
}

/// The setting that runs along the lines of a series.
fn running(series: &Series) -> Option<&str> {
    let presets = (series.preset.len() > 1).then_some(("preset", series.preset.len()));
    let varied = series.vary.iter().map(|(key, values)| (key.as_str(), values.len()));
    presets.into_iter().chain(varied).max_by_key(|(_, count)| *count).map(|(key, _)| key)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::bench::report::Device;
    use crate::bench::sweep::execute::tests::whole;
    use crate::bench::sweep::{Grid, Point, Sweep};

    #[test]
    fn a_series_is_a_line() {
        let sweep = whole();
        let lines = lines(&sweep, "corridor");
        let names: Vec<(&str, Option<&str>, usize)> =
            lines.iter().map(|line| (line.name, line.key, line.marks.len())).collect();
        assert_eq!(names, [("gathered", Some("rsm.vpls"), 5), ("shadows", Some("lights.resolution"), 2)]);
        assert_eq!(lines[0].value_times(|mark| mark.time_ms)[4].0, 4096.0);
        assert!(lines[0].pairs().windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 > pair[1].1));
        assert!(lines.iter().flat_map(|line| &line.marks).any(|mark| mark.pareto));
        assert!(super::lines(&sweep, "maze").is_empty());
    }

    #[test]
    fn a_product_is_several_lines_along_the_longest_list() {
        let text = "scenes = [\"ring\"]\n[[series]]\ntechnique = \"rsm\"\npreset = [\"draft\", \"high\"]\n\
            vary = { \"rsm.vpls\" = [16, 64, 256] }\n";
        let grid = Grid::parse(text, Path::new("x.toml")).expect("sound");
        let mut sweep = Sweep::new(grid, Device::default());
        let points = sweep.grid.points().expect("sound");
        let measured = |point: &Point| Measured {
            id: point.id.clone(),
            scene: "ring".to_owned(),
            series: "rsm".to_owned(),
            values: point.values.clone(),
            run: Default::default(),
        };
        sweep.points = points.iter().map(measured).collect();
        let lines = lines(&sweep, "ring");
        assert_eq!(lines.iter().map(Line::fixed_words).collect::<Vec<_>>(), ["preset draft", "preset high"]);
        assert!(lines.iter().all(|line| line.marks.len() == 3 && line.key == Some("rsm.vpls")));
    }
}
