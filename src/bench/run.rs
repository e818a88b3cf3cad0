//! The rounds: every contender renders in every round, in turn, so that drift of the machine hits all alike.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use super::alone::{not_repeated, repeated};
use super::leaks::leaks;
use super::report::{Failure, PieceAlone, Run};
use super::samples::Samples;
use crate::renderer::{
    ColorImage, Context, Frame, FrameRequest, PassTiming, Renderer, RepeatError, Settings, Slot, Timing, ToneMap,
    check_piece,
};
use crate::scene::{CameraView, Scene};

/// How the contenders' pictures are tone-mapped.
pub const PICTURE_TONE_MAP: ToneMap = ToneMap::Aces;

/// The scene that the contenders render.
#[derive(Debug)]
pub struct Subject<'a> {
    /// Its name in the report.
    pub name: &'a str,
    /// The scene.
    pub scene: &'a Scene,
    /// Where it is seen from.
    pub camera: &'a CameraView,
    /// Host time that loading it took, milliseconds.
    pub load_ms: f64,
}

/// How the contenders are measured.
#[derive(Clone, Debug)]
pub struct Options {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Rounds.
    pub frames: u32,
    /// Frames of each contender before the rounds, after its first one.
    pub warmup: u32,
    /// Frames of each contender before those, so that what it keeps over frames has settled; `None`: what its methods need.
    pub lead_in: Option<u32>,
    /// A contender begins no frame of warm-up and no round after it has rendered for this long, seconds; its first round it
    /// always has. `None`: all of them.
    pub max_seconds: Option<f64>,
    /// Whether a picture is wanted of every contender, made after the rounds.
    pub pictures: bool,
    /// Whether the slots that a contender fills are wanted as images, made after the rounds.
    pub slots: bool,
    /// Pieces to be timed on their own after the rounds, by their full names: pieces, levels, or passes.
    pub pieces: Vec<String>,
}

impl Options {
    /// How often one contender reports progress: for each frame of its timings, and for each piece.
    pub fn frames_per_contender(&self) -> u64 {
        1 + u64::from(self.warmup) + 3 * u64::from(self.frames) + self.pieces.len() as u64
    }

    fn lead_in(&self, settings: &Settings) -> u32 {
        self.lead_in.unwrap_or(settings.lead_in())
    }

    /// Whether a contender that has rendered for so long has had its time.
    fn over(&self, rendered: Duration) -> bool {
        self.max_seconds.is_some_and(|seconds| rendered.as_secs_f64() > seconds)
    }
}

/// A contender that came through.
#[derive(Clone, Debug)]
pub struct Finished {
    /// What was measured.
    pub run: Run,
    /// The tone-mapped picture, if pictures were wanted.
    pub picture: Option<Vec<[u8; 3]>>,
    /// The image and the slots that its methods fill, if they were wanted.
    pub images: Option<SlotImages>,
}

/// The radiance that a contender found.
#[derive(Clone, Debug, PartialEq)]
pub struct SlotImages {
    /// The sum of all slots.
    pub image: ColorImage,
    /// The slots that its methods fill; emission is always one.
    pub slots: BTreeMap<Slot, ColorImage>,
}

/// One set of settings and what became of it.
type Outcome = Result<Finished, Failure>;

/// A contender during the rounds.
struct Contender {
    settings: Settings,
    state: Result<(Renderer, Samples), String>,
    /// The passes of its first frame.
    passes: Vec<PassTiming>,
    /// Host time of all its frames.
    rendered: Duration,
}

/// Measures `contenders` on one scene. Each has a renderer of its own, all alive at once. First each renders one frame
/// that is timed apart, for it holds the driver's compilation, and the frames of warm-up. Then in each round each renders
///
/// 1. a frame made anew, timed as a whole;
/// 2. a frame made anew, timed pass by pass;
/// 3. a frame in which nothing has changed, timed as a whole.
///
/// No image is read back in these. Then come the pictures, pieces are repeated on their own, as often as there are rounds, dark rooms are looked into, and last, where something
/// is kept over frames, as many frames are made without a past. `progress` is called after every frame of the rounds and every piece. A contender that fails does not stop the others; a piece that none of them has fails them all.
pub fn run(
    context: &Context,
    subject: &Subject<'_>,
    contenders: &[Settings],
    options: &Options,
    progress: &mut dyn FnMut(),
) -> Vec<Outcome> {
    let mut contenders: Vec<Contender> = contenders.iter().map(|settings| Contender::new(context, settings)).collect();
    for contender in &mut contenders {
        let mut passes = Vec::new();
        contender.proceed(|renderer, samples| {
            passes = warm_up(renderer, samples, subject, options, progress)?;
            Ok(())
        });
        contender.passes = passes;
    }
    for piece in &options.pieces {
        refuse_unknown(piece, &mut contenders);
    }
    for index in 0..options.frames {
        for contender in contenders.iter_mut().filter(|contender| index == 0 || !options.over(contender.rendered)) {
            contender.proceed(|renderer, samples| round(renderer, samples, subject, options, progress));
        }
    }
    contenders.into_iter().map(|contender| contender.finish(subject, options, progress)).collect()
}

/// Stops all contenders that run if none of them has the piece.
fn refuse_unknown(piece: &str, contenders: &mut [Contender]) {
    let lacks = |contender: &Contender| match check_piece(&contender.passes, piece) {
        Err(error @ RepeatError::Unknown { .. }) => Some(error.to_string()),
        _ => None,
    };
    let running: Vec<&mut Contender> = contenders.iter_mut().filter(|contender| contender.state.is_ok()).collect();
    if running.iter().all(|contender| lacks(contender).is_some()) {
        for contender in running {
            contender.state = Err(lacks(contender).unwrap_or_default());
        }
    }
}

/// Why a contender dropped out, as a sentence.
type Stopped = Box<dyn std::error::Error>;

impl Contender {
    fn new(context: &Context, settings: &Settings) -> Contender {
        let renderer = Renderer::new(context, settings.clone());
        let state = renderer.map(|renderer| (renderer, Samples::default())).map_err(|error| sentence(&error));
        Contender { settings: settings.clone(), state, passes: Vec::new(), rendered: Duration::ZERO }
    }

    /// Renders on unless the contender has failed before.
    fn proceed(&mut self, step: impl FnOnce(&mut Renderer, &mut Samples) -> Result<(), Stopped>) {
        let Ok((renderer, samples)) = &mut self.state else { return };
        let start = Instant::now();
        if let Err(error) = step(renderer, samples) {
            self.state = Err(sentence(&*error));
        }
        self.rendered += start.elapsed();
    }

    fn finish(self, subject: &Subject<'_>, options: &Options, progress: &mut dyn FnMut()) -> Outcome {
        let settings = &self.settings;
        let failure = |error: String| Failure {
            scene: subject.name.to_owned(),
            technique: Some(settings.technique.name().to_owned()),
            preset: Some(settings.preset.name().to_owned()),
            error,
        };
        let (mut renderer, mut samples) = self.state.map_err(failure)?;
        let (picture, images) = if options.pictures || options.slots {
            let filled = Slot::ALL.into_iter().filter(|slot| options.slots && settings.methods.fills(*slot));
            let request = FrameRequest {
                slots: filled.collect(),
                tonemap: options.pictures.then_some(PICTURE_TONE_MAP),
                read_back: true,
                ..request(subject, options, Timing::Frame)
            };
            let Frame { image, slots, display, .. } =
                renderer.render(subject.scene, &request).map_err(|error| failure(sentence(&error)))?;
            (display, image.filter(|_| options.slots).map(|image| SlotImages { image, slots }))
        } else {
            (None, None)
        };
        let mut piece_alone = Vec::new();
        for piece in &options.pieces {
            let alone = alone(&mut renderer, &samples, subject, options, piece);
            piece_alone.push(alone.map_err(|error| failure(sentence(&error)))?);
            progress();
        }
        let lead_in = options.lead_in(settings);
        let leaks = leaks(&mut renderer, subject.scene, lead_in).map_err(|error| failure(sentence(&*error)))?;
        if lead_in > 0 {
            cold(&mut renderer, &mut samples, subject, options).map_err(|error| failure(sentence(&*error)))?;
        }
        let methods = Slot::ALL.into_iter().map(|slot| (slot, settings.methods.name_of(slot).to_owned()));
        let run = samples.finish(Run {
            scene: subject.name.to_owned(),
            technique: settings.technique.name().to_owned(),
            methods: methods.collect(),
            preset: settings.preset.name().to_owned(),
            settings: settings.options(),
            camera: subject.camera.name.clone(),
            size: options.size,
            warmup: options.warmup,
            lead_in,
            load_ms: subject.load_ms,
            triangles: subject.scene.facts().triangles,
            piece_alone,
            leaks,
            ..Run::default()
        });
        Ok(Finished { run, picture, images })
    }
}

/// A piece on its own.
fn alone(
    renderer: &mut Renderer,
    samples: &Samples,
    subject: &Subject<'_>,
    options: &Options,
    piece: &str,
) -> Result<PieceAlone, RepeatError> {
    let request = request(subject, options, Timing::Passes);
    match renderer.repeat_piece(subject.scene, &request, piece, options.frames) {
        Ok(repetitions) => Ok(repeated(piece, &repetitions, samples.piece_ms(piece))),
        Err(RepeatError::Frame(error)) => Err(error.into()),
        Err(RepeatError::Skipped { reason, .. }) => Ok(not_repeated(piece, &reason)),
        Err(error) => Ok(not_repeated(piece, &error.to_string())),
    }
}

/// The first frame, whose passes it returns, and the frames of warm-up; these in turn as they come in a round.
fn warm_up(
    renderer: &mut Renderer,
    samples: &mut Samples,
    subject: &Subject<'_>,
    options: &Options,
    progress: &mut dyn FnMut(),
) -> Result<Vec<PassTiming>, Stopped> {
    let start = Instant::now();
    let first = render(renderer, subject, options, Timing::Frame, progress)?.timings;
    samples.add_first(&first);
    for _ in 0..options.lead_in(renderer.settings()) {
        samples.add_warmup(&render(renderer, subject, options, Timing::Frame, &mut || ())?.timings);
    }
    for index in 0..options.warmup {
        if options.over(start.elapsed()) {
            break;
        }
        renderer.invalidate();
        let timing = if index % 2 == 0 { Timing::Passes } else { Timing::Frame };
        samples.add_warmup(&render(renderer, subject, options, timing, progress)?.timings);
    }
    Ok(first.passes)
}

fn round(
    renderer: &mut Renderer,
    samples: &mut Samples,
    subject: &Subject<'_>,
    options: &Options,
    progress: &mut dyn FnMut(),
) -> Result<(), Stopped> {
    renderer.invalidate();
    samples.add_frame(&render(renderer, subject, options, Timing::Frame, progress)?.timings);
    renderer.invalidate();
    samples.add_passes(&render(renderer, subject, options, Timing::Passes, progress)?.timings)?;
    samples.add_unchanged(&render(renderer, subject, options, Timing::Frame, progress)?.timings);
    Ok(())
}

/// Frames made anew of nothing but the scene.
fn cold(
    renderer: &mut Renderer,
    samples: &mut Samples,
    subject: &Subject<'_>,
    options: &Options,
) -> Result<(), Stopped> {
    for _ in 0..options.frames {
        renderer.invalidate();
        renderer.reset_history();
        samples.add_cold(&render(renderer, subject, options, Timing::Frame, &mut || ())?.timings);
    }
    Ok(())
}

fn render(
    renderer: &mut Renderer,
    subject: &Subject<'_>,
    options: &Options,
    timing: Timing,
    progress: &mut dyn FnMut(),
) -> Result<Frame, Stopped> {
    let frame = renderer.render(subject.scene, &request(subject, options, timing))?;
    progress();
    Ok(frame)
}

/// The image alone: what a host shows, before its tone mapping.
fn request(subject: &Subject<'_>, options: &Options, timing: Timing) -> FrameRequest {
    FrameRequest { timing, read_back: false, ..FrameRequest::new(options.size, subject.camera.clone()) }
}

/// An error and its causes, `a: b: c`.
pub(super) fn sentence(error: &(dyn std::error::Error + 'static)) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    causes.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}
