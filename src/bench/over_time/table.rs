//! The sequences of a scene as a table: a row for every technique.

use super::record::FrameRecord;
use crate::bench::errors::COVERED;
use crate::bench::report::Run;
use crate::bench::rows::contender;
use crate::bench::statistics::Spread;
use crate::bench::tables::table;
use crate::bench::units;

const HEADER: [&str; 9] =
    ["over time", "frame ms", "worst", "rrmse", "worst", "late", "worst", "arrived", "flicker (truth)"];

/// What stands below the table.
const NOTE: &str =
    "Medians over the frames, and the worst frame. rrmse: of what is filled, against each frame's reference.
late: what is missing of the picture that is shown once the frame stands. arrived: of what was to change.
flicker: change of diffuse where the truth changes by less than 1 %, beside the truth's own there.";

/// The runs of one scene that were played; empty if there are none.
pub fn over_time_text(runs: &[&Run]) -> String {
    let played: Vec<(&Run, &[FrameRecord])> =
        runs.iter().filter_map(|run| Some((*run, &*run.over_time.as_ref()?.frames))).collect();
    if played.is_empty() {
        return String::new();
    }
    let mut table = table(&HEADER, &(1..HEADER.len()).collect::<Vec<_>>());
    for (run, frames) in played {
        table.add_row(cells(run, frames));
    }
    format!("{}\n{NOTE}\n", table.trim_fmt())
}

fn cells(run: &Run, frames: &[FrameRecord]) -> Vec<String> {
    let spread = |value: &dyn Fn(&FrameRecord) -> Option<f64>| {
        let values: Vec<f64> = frames.iter().filter_map(value).filter(|value| value.is_finite()).collect();
        let worst = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Spread::of(&values).map(|spread| (spread, worst))
    };
    let both = |found: Option<(Spread, f64)>, written: fn(f64) -> String| {
        let cells = found.map(|(spread, worst)| [spread.median, worst].map(written));
        cells.unwrap_or_default()
    };
    let percent = |share: f64| format!("{} %", units::error(100.0 * share));
    let times = both(spread(&|frame| Some(frame.frame_ms)), units::milliseconds);
    let errors = both(spread(&|frame| Some(frame.error.as_ref()?.get(COVERED)?.rrmse)), percent);
    let late = both(spread(&|frame| Some(frame.lag.as_ref()?.get(COVERED)?.late)), percent);
    let [arrived, _] = both(spread(&|frame| frame.lag.as_ref()?.get(COVERED)?.arrived), percent);
    let [flicker, _] = both(spread(&|frame| Some(frame.flicker?.change)), percent);
    let [truth, _] = both(spread(&|frame| Some(frame.flicker?.reference)), percent);
    let flickers = if flicker.is_empty() { flicker } else { format!("{flicker} ({truth})") };
    [contender(run)].into_iter().chain(times).chain(errors).chain(late).chain([arrived, flickers]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::record::tests::example;
    use super::*;
    use crate::bench::tables::TEXT_WIDTH;

    #[test]
    fn a_run_is_a_row_and_what_was_not_measured_is_empty() {
        let mut bare = Run { technique: "volumes".to_owned(), ..example(2) };
        for frame in &mut bare.over_time.as_mut().expect("played").frames {
            (frame.error, frame.lag, frame.flicker) = (None, None, None);
        }
        let text = over_time_text(&[&example(3), &bare, &Run::default()]);
        let row =
            |name: &str| text.lines().find(|line| line.contains(name)).unwrap_or_else(|| panic!("{name}: {text}"));
        for words in ["2.000", "30.0 %", "55.0 %", "25.0 %", "50.0 %", "2.00 % (0.100 %)"] {
            assert!(row("lightmaps (default)").contains(words), "{words} is not in {text}");
        }
        assert!(row("volumes (default)").contains("2.000") && !row("volumes (default)").contains('%'), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= usize::from(TEXT_WIDTH)), "{text}");
        assert_eq!(over_time_text(&[&Run::default()]), "");
    }
}
