//! Methods of the `diffuse` slot.

pub(crate) mod rsm;
