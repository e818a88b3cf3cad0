//! A plot of where the time of every frame goes, as SVG: passes stacked in the order in which they run (Reich 2015, figures 5.2 and 5.3), and a counter over them (5.4 and 5.5).

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

use super::axis::{LinearAxis, label};
use super::frames_axis::{LEFT, RIGHT, WIDTH, frames_axis};
use super::layers::{Layer, layers};
use crate::bench::report::Run;
use crate::bench::rows::contender;
use crate::bench::sweep::canvas::{Canvas, Drawn, INK, Point, body, colour};
use crate::bench::sweep::chart::Area;
use crate::bench::units;

const HEIGHT: i32 = 520;
const BOTTOM: i32 = HEIGHT - 58;
const LEGEND_TOP: i32 = 88;
const LEGEND_ROW: i32 = 20;
const LEGEND_GAP: i32 = 16;
const OTHERS: RGBColor = RGBColor(190, 190, 190);

/// The plot of a run; `counter` is the full name of one of its work counters, drawn over the times with an axis of its own. The same run gives the same bytes.
/// `None` if it was not played frame by frame, or no pass took time.
pub fn passes_plot(run: &Run, counter: Option<&str>) -> Option<String> {
    let frames = &run.over_time.as_ref()?.frames;
    let layers = layers(run);
    let most = frames.iter().map(|frame| frame.serialised_ms).fold(0.0, f64::max);
    if frames.is_empty() || layers.is_empty() || most <= 0.0 {
        return None;
    }
    let counts = counter.and_then(|name| {
        let counts: Vec<f64> =
            frames.iter().map(|frame| frame.counts.get(name).copied().unwrap_or_default() as f64).collect();
        counts.iter().any(|count| *count > 0.0).then_some((name, counts))
    });
    let legend = legend(&layers, counts.as_ref().map(|(name, _)| *name));
    let top = legend.last().map_or(LEGEND_TOP, |entry| entry.at.1) + LEGEND_GAP;
    let panel = Area { left: LEFT, top, right: RIGHT, bottom: BOTTOM };
    let (x, y) = (frames_axis(frames.len()), LinearAxis::from_zero(std::iter::once(most), [BOTTOM, top]));
    let mut text = String::new();
    let canvas = Canvas::new(&mut text, (WIDTH, HEIGHT.unsigned_abs()));
    let what =
        format!("Times of the passes of {}, stacked; the line above is the frame with its barriers", contender(run));
    let total: Vec<Point> =
        frames.iter().enumerate().map(|(index, frame)| (x.place(index as f64), y.place(frame.serialised_ms))).collect();
    let ticks = y.ticks(false).into_iter().map(|value| (y.place(value), label(value)));
    let drawn = canvas
        .blank()
        .and_then(|()| canvas.sequence_head(run, &what))
        .and_then(|()| canvas.value_ticks(&panel, ticks, "GPU time, ms"))
        .and_then(|()| canvas.stacked(&layers, &x, &y))
        .and_then(|()| canvas.path(&total, INK, 1))
        .and_then(|()| canvas.frame_ticks(&panel, &x, true))
        .and_then(|()| counts.map_or(Ok(()), |(_, counts)| canvas.counter(&counts, &panel, &x)))
        .and_then(|()| canvas.layer_legend(&legend))
        .and_then(|()| canvas.present());
    drawn.expect("a string takes whatever is written to it");
    drop(canvas);
    Some(text)
}

struct Entry {
    at: Point,
    /// The colour of a layer; `None`: the counter.
    fill: Option<RGBColor>,
    name: String,
}

fn fill(index: usize, name: &str) -> RGBColor {
    if name.ends_with(" others") { OTHERS } else { colour(index) }
}

fn legend(layers: &[Layer], counter: Option<&str>) -> Vec<Entry> {
    let mut at = (LEFT + 2, LEGEND_TOP);
    let layers = layers.iter().enumerate().map(|(index, layer)| (Some(fill(index, &layer.name)), layer.name.clone()));
    let counter = counter.map(|name| (None, format!("{name} (right)")));
    let entry = |(fill, name): (Option<RGBColor>, String)| {
        let width = 40 + (6.8 * name.chars().count() as f64) as i32;
        if at.0 + width > RIGHT && at.0 > LEFT + 2 {
            at = (LEFT + 2, at.1 + LEGEND_ROW);
        }
        let place = at;
        at.0 += width;
        Entry { at: place, fill, name }
    };
    layers.chain(counter).map(entry).collect()
}

impl Canvas<'_> {
    /// Each layer on those before it; two points a frame.
    fn stacked(&self, layers: &[Layer], x: &LinearAxis, y: &LinearAxis) -> Drawn {
        let mut below = vec![0.0; layers.first().map_or(0, |layer| layer.ms.len())];
        for (index, layer) in layers.iter().enumerate() {
            let above: Vec<f64> = below.iter().zip(&layer.ms).map(|(below, ms)| below + ms).collect();
            let edge = |values: &[f64]| -> Vec<Point> {
                values.iter().enumerate().map(|(frame, value)| (x.place(frame as f64), y.place(*value))).collect()
            };
            let mut corners = edge(&above);
            corners.extend(edge(&below).into_iter().rev());
            self.area(&corners, fill(index, &layer.name))?;
            below = above;
        }
        Ok(())
    }

    fn counter(&self, counts: &[f64], panel: &Area, x: &LinearAxis) -> Drawn {
        let y = LinearAxis::from_zero(counts.iter().copied(), [panel.bottom, panel.top]);
        let points: Vec<Point> =
            counts.iter().enumerate().map(|(frame, count)| (x.place(frame as f64), y.place(*count))).collect();
        self.path(&points, INK, 2)?;
        for count in y.ticks(true) {
            let at = y.place(count);
            self.path(&[(panel.right, at), (panel.right + 5, at)], INK, 1)?;
            self.text((panel.right + 9, at), &units::count(count as u64), &body(INK), HPos::Left)?;
        }
        Ok(())
    }

    fn layer_legend(&self, legend: &[Entry]) -> Drawn {
        for Entry { at: (x, y), fill, name } in legend {
            match fill {
                Some(fill) => self.area(&[(*x, y - 5), (x + 14, y - 5), (x + 14, y + 5), (*x, y + 5)], *fill)?,
                None => self.path(&[(*x, *y), (x + 14, *y)], INK, 2)?,
            }
            self.text((x + 20, *y), name, &body(INK), HPos::Left)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use roxmltree::Document;

    use super::super::record::tests::example;
    use super::*;

    #[test]
    fn layers_are_stacked_with_two_points_a_frame() {
        let run = example(9);
        let counter = "diffuse/a/one/x.texels";
        let text = passes_plot(&run, Some(counter)).expect("frames with times");
        let document = Document::parse(&text).expect("well-formed");
        let points = |tag: &str| -> Vec<usize> {
            let nodes = document.descendants().filter(|node| node.has_tag_name(tag));
            nodes.filter_map(|node| node.attribute("points")).map(|all| all.split_whitespace().count()).collect()
        };
        let areas = points("polygon");
        // Seven layers, and their pieces in the legend.
        assert_eq!((areas[..7].to_vec(), areas[7..].to_vec()), (vec![18; 7], vec![4; 7]));
        assert_eq!(points("polyline").iter().filter(|count| **count == 9).count(), 2, "the frame and the counter");
        assert!(text.contains(&format!("{counter} (right)")) && text.contains("2 others"), "{text}");
        assert_eq!(passes_plot(&run, Some(counter)), Some(text.clone()), "the same bytes");
        let without = passes_plot(&run, Some("no such counter")).expect("frames with times");
        assert!(!without.contains("(right)"));
        assert_eq!(passes_plot(&Run::default(), None), None);
    }
}
