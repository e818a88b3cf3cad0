//! Who hears how far a frame is while it is made, and may stop it between two submissions.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::vulkan::VulkanError;

/// Stops a frame from another thread.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Stops the frame that is being made at the end of what the device is doing, or else the next one. That frame is an error.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Hears how far a frame is.
#[derive(Clone)]
pub struct Progress(Arc<dyn Fn(f64) -> bool + Send + Sync>);

impl Progress {
    /// Calls `hear` before each submission with how much is done, 0 to 1; an answer of `false` stops the frame.
    pub fn new(hear: impl Fn(f64) -> bool + Send + Sync + 'static) -> Progress {
        Progress(Arc::new(hear))
    }
}

impl std::fmt::Debug for Progress {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Progress")
    }
}

#[derive(Clone, Default)]
pub(crate) struct Interrupt {
    pub(crate) cancel: Cancel,
    pub(crate) progress: Option<Progress>,
    /// Share of the frame that is done, as far as anybody knows.
    pub(crate) done: f64,
}

impl Interrupt {
    /// Before a submission.
    pub(super) fn check(&self) -> Result<(), VulkanError> {
        let goes_on = self.progress.as_ref().is_none_or(|Progress(hear)| hear(self.done));
        // Who asked once is answered once.
        let asked = self.cancel.0.swap(false, Ordering::Relaxed);
        if goes_on && !asked { Ok(()) } else { Err(VulkanError::Cancelled) }
    }
}
