//! What the frames of one technique measured, frame by frame, and the run that it comes to.

use std::collections::BTreeMap;

use super::report::{Pass, Piece, Run};
use super::statistics::{Spread, median};
use crate::graph::{joined, levels, lies_in};
use crate::renderer::FrameTimings;

/// The measurements of one technique on one scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct Samples {
    first_frame_ms: f64,
    upload_ms: f64,
    pipeline_ms: f64,
    /// GPU and host time of whole frames made anew.
    frame_ms: Vec<f64>,
    host_ms: Vec<f64>,
    unchanged_ms: Vec<f64>,
    unchanged_host_ms: Vec<f64>,
    cold_ms: Vec<f64>,
    serialised_ms: Vec<f64>,
    unexplained_ms: Vec<f64>,
    passes: Vec<PassSamples>,
    memory: BTreeMap<String, u64>,
    memory_parts: BTreeMap<String, BTreeMap<String, u64>>,
}

/// The measurements of one pass; passes of the same name count as one.
#[derive(Clone, Debug, Default)]
struct PassSamples {
    piece: String,
    pass: String,
    /// One for every round; zero in rounds in which the pass was skipped.
    ms: Vec<f64>,
    /// Whether any round ran it.
    ran: bool,
    /// Why a round did not.
    reason: Option<String>,
    /// Of the latest round.
    work: BTreeMap<String, u64>,
}

/// A pass ran but the device gave no times for it.
#[derive(Debug, thiserror::Error)]
#[error(
    "the device gave no time for the pass {0}, and the bench has nothing to say without; choose another with --device"
)]
pub(crate) struct Untimed(String);

impl Samples {
    /// The very first frame, which holds the driver's compilation.
    pub(crate) fn add_first(&mut self, timings: &FrameTimings) {
        self.first_frame_ms = timings.host_ms;
        self.upload_ms = timings.upload_ms;
        self.add_warmup(timings);
    }

    /// Whether nothing was measured yet.
    pub(crate) fn is_empty(&self) -> bool {
        self.first_frame_ms == 0.0
    }

    /// A frame of which only the pipelines count that it made.
    pub(crate) fn add_warmup(&mut self, timings: &FrameTimings) {
        self.pipeline_ms += timings.pipeline_ms;
    }

    /// A frame made anew, timed as a whole.
    pub(crate) fn add_frame(&mut self, timings: &FrameTimings) {
        self.add_warmup(timings);
        self.frame_ms.push(timings.gpu_ms);
        self.host_ms.push(timings.host_ms);
        self.memory = timings.memory_bytes.clone();
        self.memory_parts = timings.memory_parts.clone();
    }

    /// A frame in which nothing changed, timed as a whole.
    pub(crate) fn add_unchanged(&mut self, timings: &FrameTimings) {
        self.unchanged_ms.push(timings.gpu_ms);
        self.unchanged_host_ms.push(timings.host_ms);
    }

    /// A frame made anew without a past, timed as a whole.
    pub(crate) fn add_cold(&mut self, timings: &FrameTimings) {
        self.add_warmup(timings);
        self.cold_ms.push(timings.gpu_ms);
    }

    /// A frame made anew, timed pass by pass.
    pub(crate) fn add_passes(&mut self, timings: &FrameTimings) -> Result<(), Untimed> {
        self.add_warmup(timings);
        let round = self.serialised_ms.len();
        let mut explained = 0.0;
        for timing in &timings.passes {
            let pass = self.pass(&timing.piece, &timing.pass);
            if pass.ms.len() <= round {
                pass.ms.resize(round + 1, 0.0);
                pass.work.clear();
            }
            for (name, count) in &timing.work {
                *pass.work.entry(name.clone()).or_default() += count;
            }
            if let Some(reason) = &timing.skipped {
                pass.reason = Some(reason.clone());
                continue;
            }
            let Some(ms) = timing.ms else { return Err(Untimed(timing.full_name())) };
            pass.ran = true;
            pass.ms[round] += ms;
            explained += ms;
        }
        self.serialised_ms.push(timings.gpu_ms);
        self.unexplained_ms.push(timings.gpu_ms - explained);
        // A pass that this round did not declare took no time in it.
        for pass in &mut self.passes {
            pass.ms.resize(round + 1, 0.0);
        }
        Ok(())
    }

    /// The samples of a pass, empty ones if this is the first time that it is met.
    fn pass(&mut self, piece: &str, pass: &str) -> &mut PassSamples {
        let known = self.passes.iter().position(|samples| samples.piece == piece && samples.pass == pass);
        let index = known.unwrap_or_else(|| {
            let (piece, pass) = (piece.to_owned(), pass.to_owned());
            self.passes.push(PassSamples { piece, pass, ..PassSamples::default() });
            self.passes.len() - 1
        });
        &mut self.passes[index]
    }

    /// Fills in what was measured; the rest of `run` stays as it is.
    pub(crate) fn finish(&self, run: Run) -> Run {
        let serialised_ms = spread(&self.serialised_ms);
        let share = |ms: Spread| if serialised_ms.median > 0.0 { ms.median / serialised_ms.median } else { 0.0 };
        let passes: Vec<Pass> = self.passes.iter().map(|pass| pass.finish(share)).collect();
        let counts = passes
            .iter()
            .flat_map(|pass| pass.work.iter().map(|(name, count)| (format!("{}.{name}", pass.full_name()), *count)));
        Run {
            frames: self.serialised_ms.len() as u32,
            frame_ms: spread(&self.frame_ms),
            serialised_ms,
            unchanged_ms: spread(&self.unchanged_ms),
            cold_ms: Spread::of(&self.cold_ms),
            host_ms: spread(&self.host_ms),
            unchanged_host_ms: spread(&self.unchanged_host_ms),
            upload_ms: self.upload_ms,
            first_frame_ms: self.first_frame_ms,
            pipeline_ms: self.pipeline_ms,
            compile_ms: (self.first_frame_ms - self.upload_ms - median(&self.host_ms).unwrap_or_default()).max(0.0),
            counts: counts.collect(),
            pieces: self.pieces(share),
            passes,
            unexplained_ms: median(&self.unexplained_ms).unwrap_or_default(),
            memory_bytes: self.memory.values().sum(),
            memory: self.memory.clone(),
            memory_parts: self.memory_parts.clone(),
            ..run
        }
    }

    /// The pieces and their levels in the order of their first pass, a piece before its levels.
    fn pieces(&self, share: impl Fn(Spread) -> f64) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::new();
        for pass in &self.passes {
            let mut within: Option<String> = None;
            for piece in levels(&pass.piece, &pass.pass) {
                if pieces.iter().all(|known| known.piece != piece) {
                    let ms = self.piece_ms(&piece);
                    let outer = |known: &Piece| within.as_ref().is_some_and(|outer| lies_in(&known.piece, outer));
                    let place = pieces.iter().rposition(outer).map_or(pieces.len(), |last| last + 1);
                    pieces.insert(place, Piece { piece: piece.clone(), within, ms, share: share(ms) });
                }
                within = Some(piece);
            }
        }
        pieces
    }

    /// What the passes of a piece or level take within the frame.
    pub(crate) fn piece_ms(&self, piece: &str) -> Spread {
        spread(&self.rounds_of(piece))
    }

    /// The sum of the passes that lie in a piece or level, round by round.
    fn rounds_of(&self, piece: &str) -> Vec<f64> {
        let mut sums = vec![0.0; self.serialised_ms.len()];
        for pass in self.passes.iter().filter(|pass| lies_in(&joined(&pass.piece, &pass.pass), piece)) {
            sums.iter_mut().zip(&pass.ms).for_each(|(sum, ms)| *sum += ms);
        }
        sums
    }
}

impl PassSamples {
    fn finish(&self, share: impl Fn(Spread) -> f64) -> Pass {
        let ms = spread(&self.ms);
        let (piece, pass) = (self.piece.clone(), self.pass.clone());
        let skipped = if self.ran { None } else { self.reason.clone() };
        Pass { piece, pass, ms, share: share(ms), skipped, work: self.work.clone() }
    }
}

fn spread(measurements: &[f64]) -> Spread {
    Spread::of(measurements).unwrap_or_default()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::renderer::{PassTiming, Preset, Settings, Slot, Technique};

    fn pass(piece: &str, pass: &str, ms: f64, work: &[(&str, u64)]) -> PassTiming {
        let work = work.iter().map(|(name, count)| ((*name).to_owned(), *count)).collect();
        PassTiming { piece: piece.to_owned(), pass: pass.to_owned(), ms: Some(ms), skipped: None, work }
    }

    fn skipped(piece: &str, name: &str, reason: &str) -> PassTiming {
        PassTiming { ms: None, skipped: Some(reason.to_owned()), ..pass(piece, name, 0.0, &[]) }
    }

    fn frame(gpu_ms: f64, passes: Vec<PassTiming>) -> FrameTimings {
        let memory_bytes = BTreeMap::from([("scene".to_owned(), 80 << 20), ("gbuffer".to_owned(), 20 << 20)]);
        let parts = [("gbuffer.depth", 12 << 20), ("gbuffer.normal", 8 << 20), ("gbuffer.counts", 64)];
        let parts = parts.map(|(name, bytes)| (name.to_owned(), bytes)).into();
        let memory_parts = BTreeMap::from([("gbuffer".to_owned(), parts)]);
        FrameTimings { gpu_ms, host_ms: gpu_ms + 1.0, passes, memory_bytes, memory_parts, ..FrameTimings::default() }
    }

    /// Three rounds of a technique with a piece of two passes, one of which comes twice, and a skipped piece.
    fn example_samples() -> Samples {
        let mut samples = Samples::default();
        samples.add_first(&FrameTimings { host_ms: 500.0, pipeline_ms: 300.0, ..frame(40.0, Vec::new()) });
        for slower in [0.0, 1.0, 0.5] {
            samples.add_frame(&frame(18.0 + slower, Vec::new()));
            let passes = vec![
                pass("gbuffer", "draw", 4.0 + slower, &[("triangles", 262_267)]),
                pass("light-views", "draw", 2.0, &[("triangles", 1000)]),
                pass("light-views", "draw", 3.0, &[("triangles", 500)]),
                pass("light-views", "reduce", 1.0, &[]),
                pass("rsm", "gather", 9.5, &[("vpls", 1_200_000_000), ("invocations", 786_432)]),
                skipped("caustics/photons", "", "no specular surface"),
            ];
            samples.add_passes(&frame(20.0 + slower, passes)).expect("all timed");
            samples.add_unchanged(&frame(0.25, Vec::new()));
        }
        samples.add_cold(&frame(30.0, Vec::new()));
        samples
    }

    /// A run as the bench would report it, for the tests of what is made of runs.
    pub(crate) fn example_run() -> Run {
        let settings = Settings::new(Technique::Rsm, Preset::Default);
        let methods = Slot::ALL.into_iter().map(|slot| (slot, settings.methods.name_of(slot).to_owned()));
        example_samples().finish(Run {
            scene: "sponza".to_owned(),
            technique: "rsm".to_owned(),
            methods: methods.collect(),
            preset: "default".to_owned(),
            settings: settings.options(),
            camera: "main".to_owned(),
            size: [1024, 768],
            warmup: 2,
            load_ms: 812.0,
            ..Run::default()
        })
    }

    #[test]
    fn passes_explain_the_serialised_frame() {
        let run = example_run();
        assert_eq!(run.frames, 3);
        assert_eq!(run.frame_ms, Spread { min: 18.0, median: 18.5, p95: 19.0 });
        assert_eq!(run.serialised_ms, Spread { min: 20.0, median: 20.5, p95: 21.0 });
        assert_eq!(run.unchanged_ms.median, 0.25);
        assert_eq!(run.unexplained_ms, 0.5);
        assert_eq!(
            run.cold_ms,
            Some(Spread { min: 30.0, median: 30.0, p95: 30.0 }),
            "a cold frame is none of the steady ones"
        );
        let names: Vec<String> = run.passes.iter().map(Pass::full_name).collect();
        assert_eq!(names, ["gbuffer/draw", "light-views/draw", "light-views/reduce", "rsm/gather", "caustics/photons"]);
        assert_eq!(run.passes[1].ms, Spread { min: 5.0, median: 5.0, p95: 5.0 });
        assert!((run.passes[3].share - 9.5 / 20.5).abs() < 1e-12);
        assert_eq!(run.pieces[1].piece, "light-views");
        assert_eq!(run.pieces[1].ms.median, 6.0);
        assert_eq!(run.memory_bytes, 100 << 20);
    }

    /// Two rounds of a piece with two levels whose passes take turns, and a pass without a level.
    #[test]
    fn levels_are_added_up_round_by_round_and_counted_once() {
        let mut samples = Samples::default();
        for [march, land] in [[3.0, 1.0], [1.0, 5.0]] {
            let passes = vec![
                pass("gbuffer", "draw", 1.0, &[]),
                pass("caustics/photons", "lists/clear", 0.5, &[]),
                pass("caustics/photons", "trace/march.0", march, &[]),
                pass("caustics/photons", "lists/draw", 0.25, &[]),
                skipped("caustics/photons", "lists/draw-masked", "no surface cut out by its alpha"),
                pass("caustics/photons", "trace/land/first", land, &[]),
                pass("caustics/photons", "clear", 2.0, &[]),
                pass("compose", "image", 0.5, &[]),
            ];
            samples.add_passes(&frame(5.0 + march + land, passes)).expect("all timed");
        }
        let run = samples.finish(Run::default());
        let pieces: Vec<_> = run
            .pieces
            .iter()
            .map(|piece| (&*piece.piece, piece.within.as_deref(), piece.ms.min, piece.ms.p95))
            .collect();
        let photons = Some("caustics/photons");
        assert_eq!(
            pieces,
            [
                ("gbuffer", None, 1.0, 1.0),
                ("caustics/photons", None, 6.75, 8.75),
                ("caustics/photons/lists", photons, 0.75, 0.75),
                ("caustics/photons/trace", photons, 4.0, 6.0),
                ("caustics/photons/trace/land", Some("caustics/photons/trace"), 1.0, 5.0),
                ("compose", None, 0.5, 0.5),
            ]
        );
        let whole: f64 = run.pieces.iter().filter(|piece| piece.within.is_none()).map(|piece| piece.ms.median).sum();
        assert_eq!(whole + run.unexplained_ms, run.serialised_ms.median);
    }

    #[test]
    fn the_first_frame_stands_apart() {
        let run = example_run();
        assert_eq!((run.first_frame_ms, run.pipeline_ms), (500.0, 300.0));
        assert_eq!(run.compile_ms, 500.0 - 19.5);
    }

    #[test]
    fn counters_are_those_of_one_frame() {
        let run = example_run();
        assert_eq!(run.counts["light-views/draw.triangles"], 1500);
        assert_eq!(run.counts["rsm/gather.vpls"], 1_200_000_000);
        assert_eq!(run.counts.len(), 4);
    }

    #[test]
    fn a_pass_is_skipped_if_no_round_ran_it() {
        let run = example_run();
        assert_eq!(run.passes[4].skipped.as_deref(), Some("no specular surface"));
        assert_eq!(run.passes[4].ms, Spread::default());
        let mut samples = Samples::default();
        samples.add_passes(&frame(1.0, vec![skipped("a", "b", "nothing to do")])).expect("skipped");
        samples.add_passes(&frame(1.0, vec![pass("a", "b", 1.0, &[])])).expect("timed");
        let run = samples.finish(Run::default());
        assert_eq!(run.passes[0].skipped, None);
        assert_eq!(run.passes[0].ms.median, 0.5);
    }

    #[test]
    fn a_pass_without_a_time_is_an_error() {
        let timing = PassTiming { ms: None, ..pass("rsm", "gather", 0.0, &[]) };
        let error = Samples::default().add_passes(&frame(1.0, vec![timing])).expect_err("no time").to_string();
        assert!(error.contains("rsm/gather"), "{error}");
    }
}
