//! What the method of the slot `direct` offers to the others.

use crate::graph::bindings::ImageRef;

/// Direct light at the centres of pixels, as far as it has sharp shadows and no noise: where it jumps, so does the picture.
pub(crate) struct SharpLight(pub(crate) ImageRef);
