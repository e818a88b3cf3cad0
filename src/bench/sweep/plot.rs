//! A plot of time against error, as SVG: a line for every series, the Pareto front ringed.

use plotters::style::FontTransform;
use plotters::style::text_anchor::HPos;

use super::canvas::{Canvas, Drawn, FAINT_GRID, FAINT_INK, GRID, INK, Point, body, colour, darker, small, title};
use super::chart::{Area, LogAxis, Places, number_label, time_label};
use super::lines::{Line, lines};
use super::points::written;
use super::result::Sweep;

const SIZE: (u32, u32) = (800, 560);
const LEFT: i32 = 78;
const RIGHT: i32 = 776;
const BOTTOM: i32 = 496;
/// The first line of the legend, the height of each, and from its last line to the plot.
const LEGEND_TOP: i32 = 88;
const LEGEND_ROW: i32 = 22;
const LEGEND_GAP: i32 = 18;

/// The plot of a scene; the same result gives the same bytes. `None` if no point has both a time and an error.
pub fn plot(sweep: &Sweep, scene: &str) -> Option<String> {
    let lines = lines(sweep, scene);
    let noise = noise(sweep, &lines);
    let pairs: Vec<(f64, f64)> = lines.iter().flat_map(|line| line.pairs()).filter(|pair| drawable(*pair)).collect();
    let legend = Legend::of(&lines);
    let top = LEGEND_TOP + LEGEND_ROW * (legend.rows - 1) + LEGEND_GAP;
    let x = LogAxis::around(pairs.iter().map(|pair| pair.0), LEFT, RIGHT)?;
    let y = LogAxis::around(pairs.iter().map(|pair| pair.1).chain(noise), BOTTOM, top)?;
    let frame = Area { left: LEFT, top, right: RIGHT, bottom: BOTTOM };
    let y_of_noise = noise.map(|noise| y.place(noise));
    let label_of_noise = y_of_noise.map(|at| Area { left: RIGHT - 150, top: at - 17, right: RIGHT, bottom: at + 1 });
    let places = Places::new(frame, label_of_noise.into_iter().collect(), Vec::new());
    let mut text = String::new();
    let canvas = Canvas::new(&mut text, SIZE);
    let drawn = canvas
        .blank()
        .and_then(|()| canvas.head(sweep, scene))
        .and_then(|()| canvas.axes(sweep, &frame, &x, &y))
        .and_then(|()| canvas.noise(&frame, y_of_noise))
        .and_then(|()| canvas.lines(&lines, places, &x, &y))
        .and_then(|()| canvas.legend(&legend))
        .and_then(|()| canvas.present());
    drawn.expect("a string takes whatever is written to it");
    drop(canvas);
    Some(text)
}

/// The error that the references have by their own noise, the largest of them. It is known as a relative RMSE alone, of pixels or of blocks.
fn noise(sweep: &Sweep, lines: &[Line<'_>]) -> Option<f64> {
    let runs = lines.iter().flat_map(|line| &line.marks).map(|mark| &mark.measured.run);
    let noises = runs.filter_map(|run| sweep.grid.noise(run, sweep.grid.compare, sweep.grid.metric));
    noises.filter(|noise| drawable((1.0, *noise))).max_by(f64::total_cmp)
}

/// Whether a pair has a place on logarithmic axes.
fn drawable((time, error): (f64, f64)) -> bool {
    time > 0.0 && error > 0.0 && time.is_finite() && error.is_finite()
}

/// The entries of the legend and where they begin.
struct Legend {
    entries: Vec<(Point, Option<usize>, String)>,
    rows: i32,
}

impl Legend {
    /// An entry for each series that is drawn, and one for the rings; as many rows as that takes.
    fn of(lines: &[Line<'_>]) -> Legend {
        let mut names: Vec<(Option<usize>, String)> = Vec::new();
        for line in lines.iter().filter(|line| line.pairs().into_iter().any(drawable)) {
            let name = line.key.map_or_else(|| line.name.to_owned(), |key| format!("{} ({key})", line.name));
            if names.last().is_none_or(|(series, _)| *series != Some(line.series)) {
                names.push((Some(line.series), name));
            }
        }
        names.push((None, "Pareto front".to_owned()));
        let (mut at, mut entries) = ((LEFT + 2, LEGEND_TOP), Vec::new());
        for (series, name) in names {
            let width = 44 + (6.6 * name.chars().count() as f64) as i32;
            if at.0 + width > RIGHT && at.0 > LEFT + 2 {
                at = (LEFT + 2, at.1 + LEGEND_ROW);
            }
            entries.push((at, series, name));
            at.0 += width + 12;
        }
        Legend { entries, rows: (at.1 - LEGEND_TOP) / LEGEND_ROW + 1 }
    }
}

impl Canvas<'_> {
    /// The title, what is shown, and what measured it.
    fn head(&self, sweep: &Sweep, scene: &str) -> Drawn {
        let of_scene = sweep.grid.scenes.iter().find(|known| known.name == scene);
        let [width, height] = of_scene.map_or(sweep.grid.size, |scene| sweep.grid.size_of(scene));
        let spp = sweep.grid.reference.map(|spp| format!(", reference of {spp} samples per pixel")).unwrap_or_default();
        self.text((LEFT, 24), &format!("{scene}, {width} × {height} pixels"), &title(), HPos::Left)?;
        self.text((LEFT, 45), &format!("Error: {}{spp}", sweep.grid.error_words()), &body(INK), HPos::Left)?;
        self.text((LEFT, 63), &shortened(&sweep.measured_by()), &small(FAINT_INK), HPos::Left)
    }

    fn axes(&self, sweep: &Sweep, frame: &Area, x: &LogAxis, y: &LogAxis) -> Drawn {
        let colour = |decade: bool| if decade { GRID } else { FAINT_GRID };
        // Decades last, so that no fainter line crosses them.
        for decade in [false, true] {
            for tick in x.ticks().iter().filter(|tick| tick.decade == decade) {
                self.path(&[(tick.at, frame.top), (tick.at, frame.bottom)], colour(decade), 1)?;
            }
            for tick in y.ticks().iter().filter(|tick| tick.decade == decade) {
                self.path(&[(frame.left, tick.at), (frame.right, tick.at)], colour(decade), 1)?;
            }
        }
        for tick in x.ticks() {
            let length = if tick.label.is_some() { 6 } else { 3 };
            self.path(&[(tick.at, frame.bottom), (tick.at, frame.bottom + length)], INK, 1)?;
            if let Some(value) = tick.label {
                self.text((tick.at, frame.bottom + 17), &time_label(value), &body(INK), HPos::Center)?;
            }
        }
        for tick in y.ticks() {
            let length = if tick.label.is_some() { 6 } else { 3 };
            self.path(&[(frame.left - length, tick.at), (frame.left, tick.at)], INK, 1)?;
            if let Some(value) = tick.label {
                self.text((frame.left - 10, tick.at), &number_label(value), &body(INK), HPos::Right)?;
            }
        }
        self.path(&[(frame.left, frame.top), (frame.left, frame.bottom), (frame.right, frame.bottom)], INK, 1)?;
        let middle = (frame.left + frame.right) / 2;
        self.text((middle, frame.bottom + 44), "GPU time of a frame (median)", &body(INK), HPos::Center)?;
        let upright = body(INK).transform(FontTransform::Rotate270);
        let middle = (frame.top + frame.bottom) / 2;
        self.text((20, middle), sweep.grid.metric_words(), &upright, HPos::Center)
    }

    /// What no error can honestly be below.
    fn noise(&self, frame: &Area, at: Option<i32>) -> Drawn {
        let Some(at) = at else { return Ok(()) };
        self.dashed(&[(frame.left, at), (frame.right, at)], FAINT_INK)?;
        self.text((frame.right - 4, at - 9), "noise of the reference", &small(FAINT_INK), HPos::Right)
    }

    /// The front below, then the lines, their markers, and what varies beside them.
    fn lines(&self, lines: &[Line<'_>], mut places: Places, x: &LogAxis, y: &LogAxis) -> Drawn {
        let place = |pair: (f64, f64)| (x.place(pair.0), y.place(pair.1));
        let (mut markers, mut segments, mut labels, mut front) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for line in lines {
            let mut path: Vec<Point> = Vec::new();
            for mark in &line.marks {
                let Some(pair) = mark.error.map(|error| (mark.time_ms, error)).filter(|pair| drawable(*pair)) else {
                    continue;
                };
                let at = place(pair);
                segments.extend(path.last().map(|last| [*last, at]));
                path.push(at);
                markers.push((at, line.series, mark.pareto));
                labels.push((at, line.series, mark.value.map(written).unwrap_or_default()));
                if mark.pareto {
                    front.push(at);
                }
            }
            if let Some((_, _, label)) = labels.last_mut().filter(|_| !line.fixed.is_empty() && !path.is_empty()) {
                *label = format!("{label} ({})", line.fixed_words());
            }
            self.path(&path, colour(line.series), 2)?;
        }
        front.sort();
        let front = stairs(&front);
        segments.extend(front.windows(2).map(|pair| [pair[0], pair[1]]));
        self.dashed(&front, FAINT_INK)?;
        // All rings before all markers: none hides a neighbour.
        for (at, _, _) in markers.iter().filter(|(_, _, pareto)| *pareto) {
            self.ring(*at)?;
        }
        for (at, series, _) in &markers {
            self.marker(*at, *series)?;
        }
        let areas = markers.iter().map(|(at, _, pareto)| Area::around(*at, if *pareto { 9 } else { 5 }));
        places.take(areas, segments);
        for (at, series, label) in labels.iter().filter(|(_, _, label)| !label.is_empty()) {
            self.text(places.find(*at, label), label, &small(darker(colour(*series))), HPos::Center)?;
        }
        Ok(())
    }

    fn legend(&self, legend: &Legend) -> Drawn {
        for ((x, y), series, name) in &legend.entries {
            match series {
                Some(series) => {
                    self.path(&[(*x, *y), (x + 32, *y)], colour(*series), 2)?;
                    self.marker((x + 16, *y), *series)?;
                }
                None => {
                    self.dashed(&[(*x, *y), (x + 32, *y)], FAINT_INK)?;
                    self.ring((x + 16, *y))?;
                }
            }
            self.text((x + 40, *y), name, &body(INK), HPos::Left)?;
        }
        Ok(())
    }
}

/// What the points of a front leave to none: up to the next point's time, the error of this one is the least there is.
fn stairs(front: &[Point]) -> Vec<Point> {
    let steps = front.windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1)]);
    steps.chain(front.last().copied()).collect()
}

/// No longer than the plot is wide.
fn shortened(text: &str) -> String {
    const MOST: usize = 112;
    let shorter = || text.chars().take(MOST - 1).chain(['…']).collect();
    if text.chars().count() > MOST { shorter() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use plotters::style::RGBColor;
    use roxmltree::Document;

    use super::*;
    use crate::bench::sweep::Metric;
    use crate::bench::sweep::execute::tests::whole;

    fn strokes<'a>(document: &'a Document<'_>, series: usize) -> Vec<&'a str> {
        let RGBColor(red, green, blue) = colour(series);
        let stroke = format!("#{red:02X}{green:02X}{blue:02X}");
        let lines = document.descendants().filter(|node| node.has_tag_name("polyline"));
        let own = lines.filter(|node| node.attribute("stroke") == Some(stroke.as_str()));
        own.map(|node| node.attribute("points").expect("a line has points")).collect()
    }

    fn texts(document: &Document<'_>) -> Vec<String> {
        let texts = document.descendants().filter(|node| node.has_tag_name("text"));
        texts.filter_map(|node| node.text()).map(|text| text.trim().to_owned()).collect()
    }

    #[test]
    fn a_plot_has_a_line_for_every_series_and_labels_its_points() {
        let mut sweep = whole();
        for measured in &mut sweep.points {
            measured.run.noise_full = Some(BTreeMap::from([("image".to_owned(), 0.03)]));
        }
        sweep.device.name = "A <device> & \"more\"".to_owned();
        let text = plot(&sweep, "ring").expect("points with errors");
        let document = Document::parse(&text).expect("well-formed");
        // The line itself and its piece in the legend.
        for (series, count) in [(0, 5), (1, 2)] {
            let strokes = strokes(&document, series);
            assert_eq!(strokes.len(), 2, "{strokes:?}");
            assert_eq!(strokes[0].split_whitespace().count(), count);
        }
        let texts = texts(&document);
        let title = "ring, 256 × 256 pixels";
        for words in [title, "gathered (rsm.vpls)", "Pareto front", "noise of the reference", "4096", "100 ms"] {
            assert!(texts.iter().any(|text| text == words), "{words} is not in {texts:?}");
        }
        assert!(texts.iter().any(|text| text.contains("A <device> & \"more\"")), "{texts:?}");
        assert!(texts.iter().any(|text| text.contains("full light transport, reference of 64 samples")), "{texts:?}");
        sweep.grid.metric = Metric::Rmse;
        assert!(!plot(&sweep, "ring").expect("points").contains("noise of the reference"), "it is relative");
    }

    #[test]
    fn the_same_result_is_the_same_plot() {
        let text = serde_json::to_string(&whole()).expect("plain data");
        let again: Sweep = serde_json::from_str(&text).expect("its own");
        assert_eq!(plot(&again, "ring"), plot(&whole(), "ring"));
    }

    #[test]
    fn points_without_a_place_are_left_out() {
        let mut sweep = whole();
        for (measured, rrmse) in sweep.points.iter_mut().zip([f64::NAN, 0.0, -1.0, f64::INFINITY]) {
            measured.run.error_full.as_mut().expect("compared").get_mut("image").expect("there").rrmse = rrmse;
        }
        sweep.points[5].run.error_full = None;
        let text = plot(&sweep, "ring").expect("two points are left");
        let document = Document::parse(&text).expect("well-formed");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        assert_eq!(strokes(&document, 0).len(), 1, "a single point is no line");
        assert_eq!(plot(&sweep, "maze"), None);
    }
}
