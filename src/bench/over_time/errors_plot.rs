//! A plot of what changes from frame to frame, as SVG: the error of every technique, how late its picture is, how it flickers; a panel each.

use plotters::style::text_anchor::HPos;

use super::axis::{LinearAxis, label};
use super::frames_axis::{LEFT, RIGHT, WIDTH, frames_axis};
use super::record::FrameRecord;
use crate::bench::errors::COVERED;
use crate::bench::report::Run;
use crate::bench::rows::contender;
use crate::bench::statistics::median;
use crate::bench::sweep::canvas::{Canvas, Drawn, FAINT_INK, INK, Point, body, colour};
use crate::bench::sweep::chart::{Area, LogAxis, number_label};

/// The first line of the legend, the height of each, and from its last to the first panel.
const LEGEND_TOP: i32 = 88;
const LEGEND_ROW: i32 = 22;
const LEGEND_GAP: i32 = 16;
/// Heights of the first panel, of each other one, and between them.
const FIRST: i32 = 260;
const OTHER: i32 = 130;
const GAP: i32 = 42;
/// Markers along a line, so that series differ in shape too.
const MARKERS: usize = 8;

/// What a panel shows of a frame.
type Value = fn(&FrameRecord) -> Option<f64>;

/// The panels in their order; a panel of which no run has a value is left out.
const PANELS: [(&str, Value); 3] = [
    ("relative error (rrmse)", |frame| Some(frame.error.as_ref()?.get(COVERED)?.rrmse)),
    ("late, %", |frame| Some(100.0 * frame.lag.as_ref()?.get(COVERED)?.late)),
    ("flicker, %", |frame| Some(100.0 * frame.flicker?.change)),
];

/// The plot of the runs of one scene; the same runs give the same bytes. `None` if no frame was compared.
pub fn errors_plot(runs: &[&Run]) -> Option<String> {
    let runs: Vec<(&Run, &[FrameRecord])> =
        runs.iter().filter_map(|run| Some((*run, &*run.over_time.as_ref()?.frames))).collect();
    let frames = runs.iter().map(|(_, frames)| frames.len()).max()?;
    let has = |value: Value| runs.iter().any(|(_, frames)| frames.iter().any(|frame| value(frame).is_some()));
    let panels: Vec<(&str, Value)> = PANELS.into_iter().filter(|(_, value)| has(*value)).collect();
    let first = runs.first().filter(|_| !panels.is_empty())?.0;
    let legend = legend(&runs);
    let top = legend.last().map_or(LEGEND_TOP, |(at, _)| at.1) + LEGEND_GAP;
    let height = top + FIRST + (panels.len() as i32 - 1) * (OTHER + GAP) + 56;
    let x = frames_axis(frames);
    let mut text = String::new();
    let canvas = Canvas::new(&mut text, (WIDTH, height.unsigned_abs()));
    let mut panel = Area { left: LEFT, top, right: RIGHT, bottom: top + FIRST };
    let mut drawn = canvas
        .blank()
        .and_then(|()| canvas.sequence_head(first, "What each technique fills, against the reference of each frame"))
        .and_then(|()| canvas.technique_legend(&legend));
    for (index, (name, value)) in panels.iter().enumerate() {
        let last = index + 1 == panels.len();
        drawn = drawn.and_then(|()| canvas.panel(&panel, &x, (name, *value), &runs, last));
        panel = Area { top: panel.bottom + GAP, bottom: panel.bottom + GAP + OTHER, ..panel };
    }
    drawn.and_then(|()| canvas.present()).expect("a string takes whatever is written to it");
    drop(canvas);
    Some(text)
}

/// A name for every run, and where it begins.
fn legend(runs: &[(&Run, &[FrameRecord])]) -> Vec<(Point, String)> {
    let mut at = (LEFT + 2, LEGEND_TOP);
    let entry = |(run, _): &(&Run, &[FrameRecord])| {
        let name = contender(run);
        let width = 56 + (6.6 * name.chars().count() as f64) as i32;
        if at.0 + width > RIGHT && at.0 > LEFT + 2 {
            at = (LEFT + 2, at.1 + LEGEND_ROW);
        }
        let place = at;
        at.0 += width;
        (place, name)
    };
    runs.iter().map(entry).collect()
}

/// An axis of values: errors by their logarithm where all are above 0, else from zero up.
enum Values {
    Log(LogAxis),
    Linear(LinearAxis),
}

impl Values {
    fn of(values: &[f64], panel: &Area, logarithmic: bool) -> Values {
        let log = LogAxis::around(values.iter().copied(), panel.bottom, panel.top);
        match log.filter(|_| logarithmic && values.iter().all(|value| *value > 0.0)) {
            Some(log) => Values::Log(log),
            None => Values::Linear(LinearAxis::from_zero(values.iter().copied(), [panel.bottom, panel.top])),
        }
    }

    fn place(&self, value: f64) -> i32 {
        match self {
            Values::Log(axis) => axis.place(value),
            Values::Linear(axis) => axis.place(value),
        }
    }

    fn ticks(&self) -> Vec<(i32, String)> {
        match self {
            Values::Log(axis) => {
                axis.ticks().iter().filter_map(|tick| Some((tick.at, number_label(tick.label?)))).collect()
            }
            Values::Linear(axis) => {
                axis.ticks(false).into_iter().map(|value| (axis.place(value), label(value))).collect()
            }
        }
    }
}

impl Canvas<'_> {
    fn technique_legend(&self, legend: &[(Point, String)]) -> Drawn {
        for (series, ((x, y), name)) in legend.iter().enumerate() {
            self.path(&[(*x, *y), (x + 32, *y)], colour(series), 2)?;
            self.marker((x + 16, *y), series)?;
            self.text((x + 40, *y), name, &body(INK), HPos::Left)?;
        }
        Ok(())
    }

    /// A line for every run that has values, a point a frame.
    fn panel(
        &self,
        panel: &Area,
        x: &LinearAxis,
        (name, value): (&str, Value),
        runs: &[(&Run, &[FrameRecord])],
        last: bool,
    ) -> Drawn {
        let all = runs.iter().flat_map(|(_, frames)| frames.iter().filter_map(value));
        let noise = if name == PANELS[0].0 { noise_of(runs) } else { None };
        let all: Vec<f64> = all.filter(|value| value.is_finite()).chain(noise).collect();
        let axis = Values::of(&all, panel, name == PANELS[0].0);
        self.value_ticks(panel, axis.ticks().into_iter(), name)?;
        self.frame_ticks(panel, x, last)?;
        for (series, (_, frames)) in runs.iter().enumerate() {
            let values = frames.iter().map(|frame| value(frame).filter(|value| value.is_finite()));
            let points: Vec<Option<Point>> = values
                .enumerate()
                .map(|(index, value)| value.map(|value| (x.place(index as f64), axis.place(value))))
                .collect();
            for stretch in points.split(Option::is_none) {
                let stretch: Vec<Point> = stretch.iter().flatten().copied().collect();
                self.path(&stretch, colour(series), 2)?;
            }
            // Each series has its markers at other frames, so that lines that lie over each other show.
            let step = frames.len().div_ceil(MARKERS).max(1);
            let shift = series * step / runs.len();
            for at in points.iter().skip(shift).step_by(step).flatten() {
                self.marker(*at, series)?;
            }
        }
        let Some(at) = noise.map(|noise| axis.place(noise)) else { return Ok(()) };
        self.dashed(&[(panel.left, at), (panel.right, at)], FAINT_INK)?;
        self.text((panel.right - 4, at - 9), "noise of the references", &body(FAINT_INK), HPos::Right)
    }
}

/// The noise of the references, in the middle of all frames: below it no error can honestly be.
fn noise_of(runs: &[(&Run, &[FrameRecord])]) -> Option<f64> {
    let frames = runs.iter().flat_map(|(_, frames)| frames.iter());
    let noises: Vec<f64> = frames.filter_map(|frame| frame.noise.as_ref()?.get(COVERED).copied()).collect();
    median(&noises).filter(|noise| *noise > 0.0)
}

#[cfg(test)]
mod tests {
    use roxmltree::Document;

    use super::super::record::tests::example;
    use super::*;

    fn lines(text: &str) -> Vec<usize> {
        let document = Document::parse(text).expect("well-formed");
        let lines = document.descendants().filter(|node| node.has_tag_name("polyline"));
        let coloured = lines.filter(|node| node.attribute("stroke-width") == Some("2"));
        coloured.filter_map(|node| node.attribute("points")).map(|points| points.split_whitespace().count()).collect()
    }

    #[test]
    fn a_line_has_a_point_a_frame() {
        let (run, other) = (example(12), Run { technique: "a & b".to_owned(), ..example(12) });
        let text = errors_plot(&[&run, &other]).expect("frames with errors");
        // Of the legend, then error, lateness, and flicker, which begins with the second frame.
        assert_eq!(lines(&text), [2, 2, 12, 12, 12, 12, 11, 11]);
        let document = Document::parse(&text).expect("well-formed");
        let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).map(str::trim).collect();
        for words in ["a & b (default)", "late, %", "flicker, %", "noise of the references", "12 frames, 30 a second"] {
            assert!(texts.iter().any(|text| text.contains(words)), "{words} is not in {texts:?}");
        }
        assert_eq!(errors_plot(&[&run, &other]), Some(text), "the same bytes");
    }

    #[test]
    fn what_was_not_measured_is_no_panel_and_one_frame_is_a_marker() {
        let mut run = example(1);
        fn only(run: &mut Run) -> &mut FrameRecord {
            &mut run.over_time.as_mut().expect("played").frames[0]
        }
        (only(&mut run).error, only(&mut run).noise) = (None, None);
        let text = errors_plot(&[&run]).expect("lateness");
        assert!(text.contains("late, %") && !text.contains("rrmse") && !text.contains("NaN"), "{text}");
        only(&mut run).lag = None;
        assert_eq!(errors_plot(&[&run]), None);
        assert_eq!(errors_plot(&[&Run::default()]), None);
    }
}
