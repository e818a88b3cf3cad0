//! The samples of a reference, by any estimator.

use std::sync::Arc;

use super::estimate::Estimating;
use super::sums::{SampleSource, SlotSums};
use super::view::EstimateRequest;
use crate::frame::rays::TracedScene;
use crate::method::Error;

/// Whoever adds up the samples of one request.
pub(crate) struct RequestSource {
    running: Box<dyn Estimating>,
    request: EstimateRequest,
    rays: u64,
}

impl RequestSource {
    /// Lets `running` work on `scene`.
    pub(crate) fn new(
        mut running: Box<dyn Estimating>,
        scene: Arc<TracedScene>,
        request: EstimateRequest,
    ) -> RequestSource {
        running.set_scene(scene);
        RequestSource { running, request, rays: 0 }
    }
}

impl SampleSource for RequestSource {
    fn sums(&mut self, half: u32, first: u32, count: u32) -> Result<SlotSums, Error> {
        let sums = self.running.add_up(&self.request, half, first, count)?;
        self.rays += self.running.take_cost().rays;
        Ok(sums)
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
