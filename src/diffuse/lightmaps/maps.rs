//! The maps that a frame has.

use crate::graph::bindings::BufferRef;

/// What texels hold, irradiance in W/m².
pub(super) struct Maps {
    /// The indirect illumination map, as it is shown.
    pub(super) gathered: BufferRef<[f32; 4]>,
    /// The approximated one, where a frame makes it.
    pub(super) received: Option<BufferRef<[f32; 4]>>,
}
