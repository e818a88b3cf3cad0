//! What a host asks to be left in its images and buffers.

use crate::slot::Slot;
use crate::vulkan::{ForeignTarget, TimelinePoint};

/// Targets and semaphores of a host.
#[derive(Clone, Debug, Default)]
pub(crate) struct Handed {
    /// A slot, or the image, and where it goes.
    pub(crate) targets: Vec<(Option<Slot>, ForeignTarget)>,
    /// Reached before a target is touched.
    pub(crate) waits: Vec<TimelinePoint>,
    /// How long they are waited for, seconds.
    pub(crate) patience: f64,
    /// Signalled when all targets are filled.
    pub(crate) signals: Vec<TimelinePoint>,
}

impl Handed {
    pub(super) fn wants(&self, slot: Slot) -> bool {
        self.targets.iter().any(|(wanted, _)| wanted.is_none_or(|wanted| wanted == slot))
    }

    pub(super) fn shows(&self, slot: Slot) -> bool {
        self.targets.iter().any(|(wanted, _)| *wanted == Some(slot))
    }

    pub(super) fn wants_image(&self) -> bool {
        self.targets.iter().any(|(wanted, _)| wanted.is_none())
    }
}
