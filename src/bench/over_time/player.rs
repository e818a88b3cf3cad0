//! One contender of a sequence: what renders it, what it showed last, and what was measured so far.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::lag::{flicker, lag};
use super::record::{FrameRecord, Lag, OverTime};
use super::sequence::Sequence;
use crate::bench::errors::{COVERED, ErrorsUnknown, References};
use crate::bench::report::{Failure, Run};
use crate::bench::run::{Finished, Options, PICTURE_TONE_MAP, SlotImages, Subject, sentence};
use crate::bench::samples::Samples;
use crate::image::ColorImage;
use crate::reference::{IMAGE, Reference};
use crate::renderer::{Context, Frame, FrameRequest, FrameTimings, Renderer, Settings, Slot, Timing};
use crate::scene::{CameraView, Scene};

/// A frame of a sequence: the scene as it has it, and where it is seen from.
#[derive(Clone, Copy)]
pub(super) struct Shot<'a> {
    pub(super) scene: &'a Scene,
    pub(super) camera: &'a CameraView,
    pub(super) frame: u32,
    pub(super) options: &'a Options,
    pub(super) sequence: &'a Sequence<'a>,
}

impl Shot<'_> {
    fn request(&self, timing: Timing) -> FrameRequest {
        let time_step = if self.frame > 0 { (1.0 / self.sequence.fps) as f32 } else { 0.0 };
        FrameRequest {
            timing,
            time_step,
            index: self.frame,
            read_back: false,
            ..FrameRequest::new(self.options.size, self.camera.clone())
        }
    }

    fn last(&self) -> bool {
        self.frame + 1 == self.options.frames
    }
}

pub(super) struct Player {
    settings: Settings,
    /// Why it dropped out, as a sentence.
    stopped: Option<String>,
    renderer: Option<Renderer>,
    /// Makes frames without a past, once any are wanted.
    settled: Option<Renderer>,
    samples: Samples,
    frames: Vec<FrameRecord>,
    /// Of this frame and of the one before.
    shown: Option<Shown>,
    before: Option<Shown>,
    picture: Option<Vec<[u8; 3]>>,
}

/// What a frame showed, and the truth of its slot `diffuse`.
struct Shown {
    images: SlotImages,
    truth: Option<Rc<Reference>>,
}

type Step = Result<(), Box<dyn std::error::Error>>;

impl Player {
    pub(super) fn new(context: &Context, settings: &Settings) -> Player {
        let made = Renderer::new(context, settings.clone());
        let (renderer, stopped) = match made {
            Ok(renderer) => (Some(renderer), None),
            Err(error) => (None, Some(sentence(&error))),
        };
        let (settled, samples, frames, shown, before, picture) = Default::default();
        Player { settings: settings.clone(), stopped, renderer, settled, samples, frames, shown, before, picture }
    }

    pub(super) fn stop(&mut self, error: String) {
        self.stopped.get_or_insert(error);
    }

    pub(super) fn failure(&self, subject: &Subject<'_>, error: String) -> Failure {
        Failure {
            scene: subject.name.to_owned(),
            technique: Some(self.settings.technique.name().to_owned()),
            preset: Some(self.settings.preset.name().to_owned()),
            error,
        }
    }

    /// Goes on unless it has dropped out.
    fn proceed(&mut self, step: impl FnOnce(&mut Player, &mut Renderer) -> Step) {
        if self.stopped.is_some() {
            return;
        }
        let Some(mut renderer) = self.renderer.take() else { return };
        if let Err(error) = step(self, &mut renderer) {
            self.stop(sentence(&*error));
        }
        self.renderer = Some(renderer);
    }

    fn lead_in(&self, options: &Options) -> u32 {
        options.lead_in.unwrap_or(self.settings.lead_in())
    }

    /// Lets frame 0 stand until what is kept over frames has settled, and the driver has compiled what it compiles.
    pub(super) fn begin(&mut self, shot: &Shot<'_>) {
        let frames = self.lead_in(shot.options) + shot.options.warmup;
        self.proceed(|player, renderer| {
            let first_time = player.samples.is_empty();
            renderer.invalidate();
            renderer.reset_history();
            let first = renderer.render(shot.scene, &shot.request(Timing::Frame))?.timings;
            if first_time {
                player.samples.add_first(&first);
            }
            for _ in 0..frames {
                player.samples.add_warmup(&renderer.render(shot.scene, &shot.request(Timing::Frame))?.timings);
            }
            Ok(())
        });
    }

    /// A frame timed as a whole.
    pub(super) fn time(&mut self, shot: &Shot<'_>) {
        self.proceed(|player, renderer| {
            let timings = renderer.render(shot.scene, &shot.request(Timing::Frame))?.timings;
            player.samples.add_frame(&timings);
            let (frame, seconds) = (shot.frame, shot.sequence.seconds(shot.frame));
            let (frame_ms, host_ms) = (timings.gpu_ms, timings.host_ms);
            player.frames.push(FrameRecord { frame, seconds, frame_ms, host_ms, ..FrameRecord::default() });
            Ok(())
        });
    }

    /// A frame timed pass by pass, and its pictures.
    pub(super) fn show(&mut self, shot: &Shot<'_>, context: &Context) {
        self.proceed(|player, renderer| {
            let pictured = shot.sequence.lag || shot.sequence.compare.is_some();
            let tonemap = (shot.options.pictures && shot.last()).then_some(PICTURE_TONE_MAP);
            let request = shot.request(Timing::Passes).with(|request| {
                request.slots = if pictured { player.filled() } else { Vec::new() };
                request.read_back = pictured;
                request.tonemap = tonemap;
            });
            let Frame { image, slots, display, timings, .. } = renderer.render(shot.scene, &request)?;
            player.samples.add_passes(&timings)?;
            if let Some(record) = player.frames.get_mut(shot.frame as usize) {
                add_passes(record, &timings);
            }
            player.picture = display;
            player.shown =
                image.filter(|_| pictured).map(|image| Shown { images: SlotImages { image, slots }, truth: None });
            if shot.sequence.lag {
                player.measure_lag(shot, renderer.keeps_past(), context)?;
            }
            Ok(())
        });
    }

    fn filled(&self) -> Vec<Slot> {
        Slot::ALL.into_iter().filter(|slot| self.settings.methods.fills(*slot)).collect()
    }

    /// How late the frame is that was shown last. Without a past nothing is.
    fn measure_lag(&mut self, shot: &Shot<'_>, keeps_past: bool, context: &Context) -> Step {
        let settled = if keeps_past { Some(self.settled_images(shot, context)?) } else { None };
        let Some(shown) = &self.shown else { return Ok(()) };
        let (now, before) = (parts(&shown.images), self.before.as_ref().map(|before| parts(&before.images)));
        let settled = settled.as_ref().map_or_else(|| now.clone(), parts);
        let lags = now.iter().zip(&settled).enumerate().map(|(index, ((name, shown), (_, settled)))| {
            let before = before.as_ref().map(|before| &before[index].1);
            ((*name).to_owned(), lag(shown, settled, before))
        });
        let lags: BTreeMap<String, Lag> = lags.collect();
        if let Some(record) = self.frames.get_mut(shot.frame as usize) {
            record.lag = Some(lags);
        }
        Ok(())
    }

    /// What the frame shows without a past once it has stood.
    fn settled_images(&mut self, shot: &Shot<'_>, context: &Context) -> Result<SlotImages, Box<dyn std::error::Error>> {
        let (lead_in, slots) = (self.lead_in(shot.options), self.filled());
        let settled = match &mut self.settled {
            Some(settled) => settled,
            none => none.insert(Renderer::new(context, self.settings.clone())?),
        };
        settled.reset_history();
        let standing = shot.request(Timing::Frame).with(|request| request.time_step = 0.0);
        for _ in 0..lead_in {
            settled.render(shot.scene, &standing)?;
        }
        let shown = standing.with(|request| (request.read_back, request.slots) = (true, slots));
        let Frame { image, slots, .. } = settled.render(shot.scene, &shown)?;
        Ok(SlotImages { image: image.ok_or("the renderer gave back no image")?, slots })
    }

    /// The errors of the frame that was shown last, and its flicker.
    pub(super) fn compare(&mut self, frame: u32, references: &mut References<'_>) -> Result<(), ErrorsUnknown> {
        let (None, Some(shown), Some(record)) = (&self.stopped, &mut self.shown, self.frames.get_mut(frame as usize))
        else {
            return Ok(());
        };
        let (errors, truth) = references.against_equal(&shown.images, &self.settings)?;
        record.error = Some(errors.errors);
        record.noise = Some(errors.noise);
        shown.truth = Some(truth);
        record.flicker = self.before.as_ref().and_then(|before| {
            let diffuse = |shown: &Shown| {
                let truth = shown.truth.clone()?;
                Some((shown.images.slots.get(&Slot::Diffuse)?.clone(), truth.slots.get(&Slot::Diffuse)?.clone()))
            };
            let ((before, true_before), (now, true_now)) = (diffuse(before)?, diffuse(shown)?);
            flicker([&before, &now], [&true_before, &true_now])
        });
        Ok(())
    }

    /// The frame is done; the next one is compared with it.
    pub(super) fn keep(&mut self) {
        self.before = self.shown.take();
    }

    /// The run that it comes to, with a last frame in which nothing changes.
    pub(super) fn finish(mut self, shot: &Shot<'_>, subject: &Subject<'_>) -> Result<Finished, Failure> {
        self.proceed(|player, renderer| {
            let timings = renderer.render(shot.scene, &shot.request(Timing::Frame))?.timings;
            player.samples.add_unchanged(&timings);
            Ok(())
        });
        if let Some(error) = &self.stopped {
            return Err(self.failure(subject, error.clone()));
        }
        let settings = &self.settings;
        let methods = Slot::ALL.into_iter().map(|slot| (slot, settings.methods.name_of(slot).to_owned()));
        let flight = shot.sequence.flight.map(|flight| flight.name.clone());
        let run = self.samples.finish(Run {
            scene: subject.name.to_owned(),
            technique: settings.technique.name().to_owned(),
            methods: methods.collect(),
            preset: settings.preset.name().to_owned(),
            settings: settings.options(),
            camera: shot.camera.name.clone(),
            size: shot.options.size,
            warmup: shot.options.warmup,
            lead_in: self.lead_in(shot.options),
            load_ms: subject.load_ms,
            triangles: subject.scene.facts().triangles,
            over_time: Some(OverTime { fps: shot.sequence.fps, flight, frames: self.frames }),
            ..Run::default()
        });
        Ok(Finished { run, picture: self.picture, images: None })
    }
}

/// The parts of a picture that errors and lag are told of.
fn parts(images: &SlotImages) -> Vec<(&'static str, ColorImage)> {
    let slots = images.slots.iter().map(|(slot, image)| (slot.name(), image.clone()));
    let covered = ColorImage::sum(images.image.size, images.slots.values());
    slots.chain([(COVERED, covered), (IMAGE, images.image.clone())]).collect()
}

fn add_passes(record: &mut FrameRecord, timings: &FrameTimings) {
    for pass in &timings.passes {
        let name = pass.full_name();
        for (counter, count) in &pass.work {
            *record.counts.entry(format!("{name}.{counter}")).or_default() += count;
        }
        if let Some(ms) = pass.ms {
            *record.passes_ms.entry(name).or_default() += ms;
        }
    }
    record.serialised_ms = timings.gpu_ms;
    record.unexplained_ms = timings.gpu_ms - record.passes_ms.values().sum::<f64>();
}
