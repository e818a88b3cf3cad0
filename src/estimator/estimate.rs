//! What an estimator is: whoever can add up samples of several slots of a picture.

use std::sync::Arc;

use super::cost::TraceCost;
use super::sums::SlotSums;
use super::view::EstimateRequest;
use crate::frame::rays::TracedScene;
use crate::graph::{Executed, GraphDescription, ReadBack, Store, Timing};
use crate::method::Options;
use crate::scene::CameraView;
use crate::slot::{CausticPaths, LightPaths, PixelFilter, Slot};
use crate::vulkan::{Pipelines, VulkanError};

/// One way to fill several slots in one run, by unbiased or consistent sums of samples.
pub(crate) trait Estimator {
    /// The name on the command line.
    const NAME: &'static str;
    const SLOTS: &'static [Slot] = &Slot::ALL;
    /// Piece and name of the pass that a frame begins with: the row that says that nothing changed.
    const FIRST_PASS: [&'static str; 2];
    /// The programs that it may run, by their names below `glsl/`, or how these begin before a star.
    const SHADERS: &'static [&'static str];
    type Options: Options;

    /// What a frame asks of it.
    fn samples(options: &Self::Options) -> Samples;

    /// Which light it can find: what it is compared with.
    fn light_paths(options: &Self::Options) -> LightPaths {
        LightPaths::up_to(Self::samples(options).bounces)
    }

    /// Where in a pixel it samples light.
    fn filter(options: &Self::Options) -> PixelFilter {
        Self::samples(options).filter
    }

    /// One that has no scene yet.
    ///
    /// # Errors
    /// Exhausted device memory.
    fn open(pipelines: &Arc<Pipelines>) -> Result<Box<dyn Estimating>, VulkanError>;
}

/// What is asked of an estimator, whatever the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Samples {
    /// Of every pixel.
    pub(crate) spp: u32,
    pub(crate) bounces: Option<u32>,
    pub(crate) caustics: CausticPaths,
    pub(crate) filter: PixelFilter,
    pub(crate) seed: u32,
}

impl Samples {
    /// The same of a picture.
    pub(crate) fn of(self, size: [u32; 2], camera: &CameraView) -> EstimateRequest {
        let Samples { spp: _, bounces, caustics, filter, seed } = self;
        EstimateRequest { size, camera: camera.clone(), bounces, caustics, mirrors: None, filter, seed }
    }
}

/// What an estimator works with.
pub(crate) struct Work {
    pub(crate) store: Store,
    /// Share of the frame that the samples asked for now begin and end at.
    pub(crate) span: [f64; 2],
    pub(super) scene: Option<Arc<TracedScene>>,
    pub(super) timing: Timing,
    pub(super) cost: TraceCost,
}

impl Work {
    pub(super) fn new(pipelines: &Arc<Pipelines>) -> Result<Work, VulkanError> {
        let (store, span, cost) = (Store::new(pipelines)?, [0.0, 1.0], TraceCost::default());
        Ok(Work { store, span, scene: None, timing: Timing::Frame, cost })
    }

    /// Takes down what a submission cost that advanced paths. How many go on.
    pub(super) fn add_step(&mut self, executed: Executed, totals: ReadBack) -> u32 {
        self.cost.note_memory(&self.store);
        self.cost.add_step(executed, totals)
    }

    /// Takes down how much of the samples asked for is done, 0 to 1.
    pub(super) fn reached(&mut self, part: f64) {
        let [from, to] = self.span;
        self.store.interrupt.done = from + (to - from) * part;
    }

    pub(super) fn scene(&self) -> Arc<TracedScene> {
        self.scene.clone().expect("set before anything is asked for")
    }
}

/// An estimator at work on a device.
pub(crate) trait Estimating: Send {
    fn work(&mut self) -> &mut Work;

    /// Works on this scene from now on.
    fn set_scene(&mut self, scene: Arc<TracedScene>) {
        self.work().scene = Some(scene);
    }

    /// Gives its memory back, until a scene is set again.
    fn release_scene(&mut self) {
        self.work().scene = None;
    }

    /// How the passes to come are timed.
    fn set_timing(&mut self, timing: Timing) {
        self.work().timing = timing;
    }

    /// The sums over samples `first .. first + count` of half `half`, 0 or 1, of every pixel.
    ///
    /// # Errors
    /// Exhausted device memory, a lost device.
    fn add_up(&mut self, request: &EstimateRequest, half: u32, first: u32, count: u32)
    -> Result<SlotSums, VulkanError>;

    /// What was spent since this was last asked.
    fn take_cost(&mut self) -> TraceCost {
        std::mem::take(&mut self.work().cost)
    }

    /// The passes that some samples take.
    ///
    /// # Errors
    /// Exhausted device memory.
    fn describe(&mut self, request: &EstimateRequest) -> Result<GraphDescription, VulkanError>;
}
