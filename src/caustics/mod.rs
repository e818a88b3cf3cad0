//! Methods of the `caustics` slot.

pub(crate) mod photons;
