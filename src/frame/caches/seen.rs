//! Which groups of lights each cache sees, as rays found: whoever looks first keeps it for the others.

use crate::graph::bindings::BufferRef;

/// An offer to make use of it, before methods declare their passes.
pub(crate) struct SeenWanted;

/// A bit for each group of lights, words for each cache.
#[derive(Clone, Copy)]
pub(crate) struct SeenLights {
    pub(crate) bits: BufferRef<u32>,
    /// Of a cache.
    pub(crate) words: u32,
}
