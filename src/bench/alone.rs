//! Pieces timed on their own, beside what they take within the frame.

use super::report::{PassAlone, PieceAlone};
use super::statistics::Spread;
use crate::renderer::{FrameTimings, Repetition};

/// A piece that was not repeated, and why.
pub(crate) fn not_repeated(piece: &str, reason: &str) -> PieceAlone {
    PieceAlone { piece: piece.to_owned(), skipped: Some(reason.to_owned()), ..PieceAlone::default() }
}

/// What the repetitions of a piece come to; within the frame it took `in_frame_ms`.
pub(crate) fn repeated(piece: &str, repetitions: &[Repetition], in_frame_ms: Spread) -> PieceAlone {
    let passes: Vec<&FrameTimings> = repetitions.iter().map(|repetition| &repetition.passes).collect();
    let whole: Vec<f64> = repetitions.iter().map(|repetition| repetition.whole.gpu_ms).collect();
    summed(piece, &passes, &whole, in_frame_ms)
}

/// Passes by their full names, each with its time in every repetition.
type Rows = Vec<(String, Vec<f64>)>;

fn summed(piece: &str, repetitions: &[&FrameTimings], whole: &[f64], in_frame_ms: Spread) -> PieceAlone {
    let mut of_piece = vec![0.0; repetitions.len()];
    let (mut own, mut others) = (Rows::new(), Rows::new());
    for (round, timings) in repetitions.iter().enumerate() {
        for pass in timings.passes.iter().filter(|pass| pass.skipped.is_none()) {
            let (name, ms) = (pass.full_name(), pass.ms.unwrap_or_default());
            let mine = pass.lies_in(piece);
            if mine {
                of_piece[round] += ms;
            }
            let rows = if mine { &mut own } else { &mut others };
            let known = rows.iter().position(|(known, _)| *known == name).unwrap_or_else(|| {
                rows.push((name, vec![0.0; repetitions.len()]));
                rows.len() - 1
            });
            rows[known].1[round] += ms;
        }
    }
    let spread = |ms: &[f64]| Spread::of(ms).unwrap_or_default();
    let finish = |rows: Rows| rows.into_iter().map(|(pass, ms)| PassAlone { pass, ms: spread(&ms) }).collect();
    PieceAlone {
        piece: piece.to_owned(),
        ms: spread(&of_piece),
        in_frame_ms,
        whole_ms: spread(whole),
        passes: finish(own),
        also: finish(others),
        skipped: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::renderer::PassTiming;

    #[test]
    fn passes_beyond_the_piece_stand_apart() {
        let pass = |pass: &str, ms: f64, skipped: Option<&str>| PassTiming {
            piece: "caustics/photons".to_owned(),
            pass: pass.to_owned(),
            ms: skipped.is_none().then_some(ms),
            skipped: skipped.map(str::to_owned),
            work: Default::default(),
        };
        let round = |slower: f64| FrameTimings {
            passes: vec![
                pass("choose/list", 0.5, None),
                pass("trace/emit", 1.0 + slower, None),
                pass("trace/land.0", 2.0, None),
                pass("splat/sort", 9.0, Some("unchanged")),
            ],
            ..FrameTimings::default()
        };
        let rounds = [round(0.0), round(2.0), round(1.0)];
        let in_frame = Spread { min: 4.0, median: 4.0, p95: 4.0 };
        let alone = summed("caustics/photons/trace", &rounds.iter().collect::<Vec<_>>(), &[3.0, 5.0, 4.0], in_frame);
        assert_eq!(alone.ms, Spread { min: 3.0, median: 4.0, p95: 5.0 });
        assert_eq!((alone.in_frame_ms, alone.whole_ms.median), (in_frame, 4.0));
        let names = |passes: &[PassAlone]| passes.iter().map(|row| row.pass.clone()).collect::<Vec<_>>();
        assert_eq!(names(&alone.passes), ["caustics/photons/trace/emit", "caustics/photons/trace/land.0"]);
        assert_eq!(names(&alone.also), ["caustics/photons/choose/list"]);
        assert_eq!((alone.passes[0].ms.p95, alone.also[0].ms.median), (3.0, 0.5));
    }
}
