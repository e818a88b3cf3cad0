//! A piece of the frame run again and again on its own.

use super::declare::{Prepared, declare};
use super::frame::FrameRequest;
use super::render::{Renderer, want};
use crate::graph::{FrameTimings, Graph, PassTiming, Timing, levels, lies_in};
use crate::method::Error;
use crate::scene::Scene;

/// A piece that was run once more, twice: with its passes one by one, and as they come.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Repetition {
    /// Every pass alone, between full barriers. Those that ran and do not lie in the piece had to be repeated with it: they make what it reads
    /// and later passes change in place.
    pub passes: FrameTimings,
    /// The same passes, overlapping as the driver likes.
    pub whole: FrameTimings,
}

/// Why a piece cannot be repeated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RepeatError {
    /// The frame has no such piece.
    #[error("there is no piece {piece:?}; pieces: {known}")]
    Unknown {
        /// The piece asked for.
        piece: String,
        /// Those that there are.
        known: String,
    },
    /// No pass of it runs.
    #[error("{piece} does not run: {reason}")]
    Skipped {
        /// The piece asked for.
        piece: String,
        /// Why.
        reason: String,
    },
    /// It is no piece of the frame's graph: random samples take as many graphs as there are samples.
    #[error("{0} makes samples and cannot be repeated alone; give it fewer or more of them with --spp")]
    Samples(String),
    /// The frame cannot be made.
    #[error(transparent)]
    Frame(#[from] Error),
}

impl Renderer {
    /// Makes a frame, then runs one piece of it again, `rounds` times after one that does not count: `caustics/photons`, a level such as
    /// `caustics/photons/lists`, or one pass. What the piece reads is not made again, unless passes beyond the piece have changed it in place; those
    /// are then repeated with it. Everything is forgotten afterwards, for what was made again need not have the order that the rest of the frame was
    /// made of: the next frame is made anew. Where the piece changes what is kept over frames, that starts anew too, for it has gone on in frames
    /// that were none.
    ///
    /// # Errors
    /// A piece that the frame does not have, or that it skips; and as [`Renderer::render`].
    pub fn repeat_piece(
        &mut self,
        scene: &Scene,
        request: &FrameRequest,
        piece: &str,
        rounds: u32,
    ) -> Result<Vec<Repetition>, RepeatError> {
        let request = FrameRequest { timing: Timing::Passes, read_back: false, ..request.clone() };
        self.invalidate();
        let first = self.render(scene, &request)?;
        check_piece(&first.timings.passes, piece)?;
        let past = self.store.past();
        let repeated = self.repeat_rounds(scene, &request, piece, rounds);
        self.invalidate();
        if self.store.past() != past {
            self.reset_history();
        }
        repeated
    }

    fn repeat_rounds(
        &mut self,
        scene: &Scene,
        request: &FrameRequest,
        piece: &str,
        rounds: u32,
    ) -> Result<Vec<Repetition>, RepeatError> {
        // This one settles what memory holds: later ones find what they leave themselves.
        let settled = self.repeat_once(scene, request, piece)?;
        if !settled.passes.iter().any(|pass| pass.skipped.is_none() && pass.lies_in(piece)) {
            return Err(RepeatError::Samples(piece.to_owned()));
        }
        let mut repeated = Vec::new();
        for _ in 0..rounds {
            let passes = self.repeat_once(scene, request, piece)?;
            let whole = self.repeat_once(scene, &FrameRequest { timing: Timing::Frame, ..request.clone() }, piece)?;
            repeated.push(Repetition { passes, whole });
        }
        Ok(repeated)
    }

    fn repeat_once(&mut self, scene: &Scene, request: &FrameRequest, piece: &str) -> Result<FrameTimings, Error> {
        let mut timings = FrameTimings { timing: request.timing, ..FrameTimings::default() };
        // Those of the frame before: nothing has changed.
        let means = self.estimate(scene, request, &mut FrameTimings::default())?;
        let traced = self.prepare(scene, request)?;
        let data = self.data.as_ref().expect("prepared above");
        let prepared =
            Prepared { scene, data, lights: &self.lights, traced: traced.as_deref(), means: means.as_deref() };
        let mut graph = Graph::new(&mut self.store);
        let declared = declare(&mut graph, &prepared, &self.settings, request)?;
        want(&mut graph, &declared, request);
        let executed = graph.run_again(piece, request.timing)?;
        (timings.gpu_ms, timings.pipeline_ms, timings.passes) =
            (executed.gpu_ms, executed.pipeline_ms, executed.passes);
        Ok(timings)
    }
}

/// Whether `piece` can be repeated in a frame that had these passes when it was made anew.
///
/// # Errors
/// A piece that the frame does not have, or that it skips.
pub fn check_piece(passes: &[PassTiming], piece: &str) -> Result<(), RepeatError> {
    // A piece that is skipped as a whole does not name its levels.
    let skips = |pass: &PassTiming| pass.skipped.is_some() && lies_in(piece, &pass.full_name());
    let about = |pass: &&PassTiming| pass.lies_in(piece) || skips(pass);
    let reasons: Vec<Option<&str>> = passes.iter().filter(about).map(|pass| pass.skipped.as_deref()).collect();
    let piece = piece.to_owned();
    if reasons.is_empty() {
        return Err(RepeatError::Unknown { piece, known: pieces_of(passes).join(", ") });
    }
    let mut reasons = reasons.into_iter().collect::<Option<Vec<&str>>>().unwrap_or_default();
    reasons.dedup();
    if reasons.is_empty() { Ok(()) } else { Err(RepeatError::Skipped { piece, reason: reasons.join("; ") }) }
}

/// The pieces and levels of some passes, in the order of their first pass.
fn pieces_of(passes: &[PassTiming]) -> Vec<String> {
    let mut known: Vec<String> = Vec::new();
    for piece in passes.iter().flat_map(|pass| levels(&pass.piece, &pass.pass)) {
        if !known.contains(&piece) {
            known.push(piece);
        }
    }
    known
}
