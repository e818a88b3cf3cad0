//! Methods of the `diffuse` slot.

pub(crate) mod rsm;
pub(crate) mod vpl;
