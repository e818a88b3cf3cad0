//! Sequences as CSV (RFC 4180): a row for every frame of every run, a column for everything that any of them has.

use std::collections::{BTreeMap, BTreeSet};

use super::record::FrameRecord;
use crate::bench::report::Run;
use crate::bench::tables::csv_line;

const FIRST: [&str; 10] = [
    "scene",
    "technique",
    "preset",
    "camera",
    "frame",
    "seconds",
    "frame_ms",
    "host_ms",
    "serialised_ms",
    "unexplained_ms",
];

/// The frames of all runs that were played; what a frame does not have is empty. Errors are `rrmse.PART`, their noise `noise.PART`; then `late.PART`, `arrived.PART`, flicker, times by pass and counters.
pub fn csv(runs: &[Run]) -> String {
    let frames = || {
        let played = runs.iter().filter_map(|run| Some((run, run.over_time.as_ref()?)));
        played.flat_map(|(run, over_time)| over_time.frames.iter().map(move |frame| (run, frame)))
    };
    let names: BTreeSet<(u8, String)> = frames().flat_map(|(_, frame)| values(frame)).map(|(name, _)| name).collect();
    let header = FIRST.iter().map(|name| (*name).to_owned()).chain(names.iter().map(|(_, name)| name.clone()));
    let mut out = csv_line(header);
    for (run, frame) in frames() {
        let numbers = [frame.seconds, frame.frame_ms, frame.host_ms, frame.serialised_ms, frame.unexplained_ms]
            .map(|it| it.to_string());
        let first =
            [run.scene.clone(), run.technique.clone(), run.preset.clone(), run.camera.clone(), frame.frame.to_string()];
        let own: BTreeMap<(u8, String), f64> = values(frame).collect();
        let others = names.iter().map(|name| own.get(name).map(f64::to_string).unwrap_or_default());
        out += &csv_line(first.into_iter().chain(numbers).chain(others));
    }
    out
}

/// What a frame has, named; the numbers say which columns come first.
fn values(frame: &FrameRecord) -> impl Iterator<Item = ((u8, String), f64)> {
    let errors = frame.error.iter().flatten().map(|(part, errors)| ((0, format!("rrmse.{part}")), errors.rrmse));
    let blocks = frame.error.iter().flatten().map(|(part, errors)| ((1, format!("8x8.{part}")), errors.block_rrmse));
    let means =
        frame.error.iter().flatten().map(|(part, errors)| ((2, format!("mean_ratio.{part}")), errors.mean_ratio));
    let noises = frame.noise.iter().flatten().map(|(part, noise)| ((3, format!("noise.{part}")), *noise));
    let late = frame.lag.iter().flatten().map(|(part, lag)| ((4, format!("late.{part}")), lag.late));
    let lags = frame.lag.iter().flatten();
    let arrived = lags.filter_map(|(part, lag)| Some(((5, format!("arrived.{part}")), lag.arrived?)));
    let flicker = frame.flicker.iter().flat_map(|flicker| {
        let named =
            [("flicker", flicker.change), ("flicker.reference", flicker.reference), ("flicker.still", flicker.still)];
        named.map(|(name, value)| ((6, name.to_owned()), value))
    });
    let passes = frame.passes_ms.iter().map(|(pass, ms)| ((7, format!("{pass} ms")), *ms));
    let counts = frame.counts.iter().map(|(name, count)| ((8, name.clone()), *count as f64));
    errors
        .chain(blocks)
        .chain(means)
        .chain(noises)
        .chain(late)
        .chain(arrived)
        .chain(flicker)
        .chain(passes)
        .chain(counts)
}

#[cfg(test)]
mod tests {
    use super::super::record::tests::example;
    use super::*;

    #[test]
    fn every_frame_is_a_row_and_every_value_has_its_column() {
        let bare = {
            let mut run = example(2);
            run.over_time.as_mut().expect("played").frames.iter_mut().for_each(|frame| {
                *frame = FrameRecord { frame: frame.frame, ..FrameRecord::default() };
            });
            run
        };
        let text = csv(&[example(3), bare, Run::default()]);
        let rows: Vec<Vec<&str>> = text.split_terminator("\r\n").map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), 1 + 3 + 2);
        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{text}");
        let column = |name: &str| {
            rows[0].iter().position(|column| *column == name).unwrap_or_else(|| panic!("{name} is not in {text}"))
        };
        assert_eq!(rows[2][column("rrmse.covered")], "0.55");
        assert_eq!((rows[2][column("late.diffuse")], rows[1][column("arrived.diffuse")]), ("0.5", ""));
        assert_eq!((rows[3][column("diffuse/a/one/x.texels")], rows[1][column("flicker")]), ("102", ""));
        assert_eq!((rows[4][column("frame")], rows[4][column("gbuffer/draw ms")]), ("0", ""));
    }
}
