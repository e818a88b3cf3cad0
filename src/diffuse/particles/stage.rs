//! What the passes of the geometry stage share.

use super::kept::Kept;
use super::moved::Moved;
use super::place::Placed;
use crate::graph::bindings::BufferRef;

/// Of one declaration of the stage.
pub(super) struct Stage {
    pub(super) particle_count: u32,
    /// 1: some surface has a broad specular lobe.
    pub(super) broad_lobes: u32,
    pub(super) placed: Placed,
    pub(super) kept: Kept,
    /// Present if only what this is about is done, on what memory holds of an earlier frame.
    pub(super) moved: Option<Moved>,
    /// Points and link ends that no particle stands for.
    pub(super) lost: BufferRef<u32>,
}

impl Stage {
    pub(super) fn threads(&self) -> [u32; 3] {
        [self.particle_count, 1, 1]
    }
}
