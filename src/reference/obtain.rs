//! Getting a reference: what the cache holds of it, and the samples that are still missing.

use std::ops::Range;
use std::time::{Duration, Instant};

use super::about::{About, Spent};
use super::blocks::{Block, CHUNK_SAMPLES, MAX_SPP, SAMPLES_PER_CHUNK};
use super::request::source;
use super::shard::chunks_of;
use super::{Cache, Reference, ReferenceError, ReferenceFile, ReferenceRequest, SampleSource, Shard};
use crate::method::Error;
use crate::output::{OutputError, Target};
use crate::renderer::Context;
use crate::scene::Scene;

/// How long samples may be in memory alone.
const SAVE_INTERVAL: Duration = Duration::from_secs(120);

/// Saving takes at most this share of the time.
const SAVE_SHARE: u32 = 20;

/// How good a reference shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Samples per pixel: as many or a few more are made. With a `noise` the most that are made.
    pub spp: u32,
    /// Relative noise of the image, of 1, at which fewer samples do.
    pub noise: Option<f64>,
}

impl From<u32> for Goal {
    fn from(spp: u32) -> Goal {
        Goal { spp, noise: None }
    }
}

/// How far the samples are that are missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Portions made by this call.
    pub done: u32,
    /// Portions that it makes at most.
    pub total: u32,
}

/// What to make a reference of, and on which device.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The device.
    pub context: &'a Context,
    /// The scene.
    pub scene: &'a Scene,
    /// Its name in files; it does not tell references apart.
    pub scene_name: &'a str,
    /// What of it.
    pub request: &'a ReferenceRequest,
}

impl<'a> Job<'a> {
    /// The reference as the cache has it, with as many samples more as the goal asks for. What is made goes into the cache at
    /// the end and every few minutes. A cached reference with more samples is given as it is.
    ///
    /// # Errors
    /// What keeps the samples from being made. A cache that cannot be written is no error: a warning says so once.
    pub fn make(
        &self,
        goal: impl Into<Goal>,
        cache: Option<&Cache>,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<ReferenceFile, ReferenceError> {
        self.work().make(goal.into(), cache, progress)
    }

    /// A shard of a reference of `spp` samples per pixel, in the file `path`: what is there of the same shard is kept, the rest
    /// is made and written, also every few minutes.
    ///
    /// # Errors
    /// What keeps the samples from being made, or the file from being written.
    pub fn make_shard(
        &self,
        spp: u32,
        shard: Shard,
        target: impl Into<Target>,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<ReferenceFile, ReferenceError> {
        self.work().make_shard(spp, shard, target, progress)
    }

    fn work(&self) -> Work<'a> {
        let Job { context, scene, scene_name, request } = *self;
        Work {
            about: About::new(scene, scene_name, request),
            device: context.device().name,
            source: Box::new(move || source(context, scene, request)),
        }
    }
}

/// The reference of what `request` asks of `scene`: see [`Job::make`].
///
/// # Errors
/// Those of [`Job::make`].
pub fn obtain(
    context: &Context,
    scene: &Scene,
    scene_name: &str,
    request: &ReferenceRequest,
    goal: impl Into<Goal>,
    cache: Option<&Cache>,
    progress: &mut dyn FnMut(Progress),
) -> Result<Reference, ReferenceError> {
    Ok(Job { context, scene, scene_name, request }.make(goal, cache, progress)?.reference())
}

/// A reference to be made by some source, which is not asked for before a sample is missing.
pub(crate) struct Work<'a> {
    pub(crate) about: About,
    pub(crate) device: String,
    pub(crate) source: Box<dyn FnMut() -> Result<Box<dyn SampleSource + 'a>, Error> + 'a>,
}

impl Work<'_> {
    pub(crate) fn make(
        mut self,
        goal: Goal,
        cache: Option<&Cache>,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<ReferenceFile, ReferenceError> {
        let most = chunk_limit(goal.spp)?;
        let cached = cache.and_then(|cache| cache.read(&self.about.key));
        let mut file = cached.unwrap_or_else(|| ReferenceFile::new(self.about.clone()));
        let mut saver = Saver::new(|file: &ReferenceFile| cache.map_or(Ok(()), |cache| cache.keep(file).map(drop)));
        let mut counted = Counted::new(&file.state.missing(0..most), progress);
        loop {
            let finished = file.state.chunk_count();
            let quiet = goal.noise.is_some_and(|noise| finished > 0 && file.reference().image_noise().rrmse <= noise);
            if quiet || finished >= most {
                break;
            }
            let next = if goal.noise.is_some() { most.min((2 * finished).max(1)) } else { most };
            let filled = self.fill(&mut file, 0..next, &mut saver, &mut counted);
            if filled.is_err() {
                saver.finish(&file);
            }
            filled?;
        }
        saver.finish(&file);
        Ok(file)
    }

    pub(crate) fn make_shard(
        mut self,
        spp: u32,
        shard: Shard,
        target: impl Into<Target>,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<ReferenceFile, ReferenceError> {
        let target = target.into();
        chunk_limit(spp)?;
        let chunks = shard.chunks(spp);
        if chunks.is_empty() {
            return Err(ReferenceError::EmptyShard { shard, spp, portion: SAMPLES_PER_CHUNK });
        }
        let mut file = ReferenceFile::new(self.about.clone());
        file.shard = Some((shard, spp));
        // A stream has nothing to go on with, and gets the shard once, when it is whole.
        let resumable = !target.is_stream();
        if resumable
            && let Ok(there) = ReferenceFile::read(target.path())
            && there.about.key == file.about.key
            && there.shard == file.shard
        {
            file = there;
        }
        let missing = file.state.missing(chunks.clone());
        let mut saver = Saver::new(|file: &ReferenceFile| if resumable { file.write(&target) } else { Ok(()) });
        let filled = self.fill(&mut file, chunks, &mut saver, &mut Counted::new(&missing, progress));
        if filled.is_err() {
            saver.finish(&file);
        }
        filled?;
        file.write(&target)?;
        Ok(file)
    }

    /// Makes the chunks of `wanted` that are missing.
    fn fill<S: FnMut(&ReferenceFile) -> Result<(), OutputError>>(
        &mut self,
        file: &mut ReferenceFile,
        wanted: Range<u32>,
        saver: &mut Saver<S>,
        counted: &mut Counted<'_>,
    ) -> Result<(), ReferenceError> {
        let mut source = None;
        for chunk in file.state.missing(wanted).into_iter().flatten() {
            let source = match &mut source {
                Some(source) => source,
                none => none.insert((self.source)()?),
            };
            let (start, rays) = (Instant::now(), source.rays());
            let first = chunk * CHUNK_SAMPLES;
            let halves = [source.sums(0, first, CHUNK_SAMPLES)?, source.sums(1, first, CHUNK_SAMPLES)?];
            file.spent.add(&Spent {
                seconds: start.elapsed().as_secs_f64(),
                rays: source.rays().saturating_sub(rays),
                devices: vec![self.device.clone()],
            });
            file.state.insert(Block::chunk(chunk, halves)).expect("only missing chunks are made");
            saver.changed(file);
            counted.step();
        }
        Ok(())
    }
}

/// The chunks of `spp` samples per pixel, if they can be counted.
fn chunk_limit(spp: u32) -> Result<u32, ReferenceError> {
    if spp > MAX_SPP { Err(ReferenceError::TooManySamples(spp)) } else { Ok(chunks_of(spp)) }
}

/// Tells the progress of the chunks that were missing at the start.
struct Counted<'a> {
    done: u32,
    total: u32,
    progress: &'a mut dyn FnMut(Progress),
}

impl<'a> Counted<'a> {
    fn new(missing: &[Range<u32>], progress: &'a mut dyn FnMut(Progress)) -> Counted<'a> {
        let total = missing.iter().map(|chunks| chunks.end - chunks.start).sum();
        progress(Progress { done: 0, total });
        Counted { done: 0, total, progress }
    }

    fn step(&mut self) {
        self.done += 1;
        (self.progress)(Progress { done: self.done, total: self.total });
    }
}

/// Saves what changed, but not all the time. Once saving has failed, a warning says so and nothing more is saved.
struct Saver<S> {
    save: S,
    saved: Instant,
    /// How long saving took.
    took: Duration,
    unsaved: bool,
    works: bool,
}

impl<S: FnMut(&ReferenceFile) -> Result<(), OutputError>> Saver<S> {
    fn new(save: S) -> Saver<S> {
        Saver { save, saved: Instant::now(), took: Duration::ZERO, unsaved: false, works: true }
    }

    fn changed(&mut self, file: &ReferenceFile) {
        self.unsaved = true;
        if self.saved.elapsed() > SAVE_INTERVAL.max(self.took * SAVE_SHARE) {
            self.finish(file);
        }
    }

    fn finish(&mut self, file: &ReferenceFile) {
        if !(self.works && self.unsaved) {
            return;
        }
        let start = Instant::now();
        if let Err(error) = (self.save)(file) {
            tracing::warn!("the reference is not kept: {error}");
            self.works = false;
        }
        (self.took, self.saved, self.unsaved) = (start.elapsed(), Instant::now(), false);
    }
}
