//! Methods of the `direct` slot.

pub(crate) mod shadow_map;
pub(crate) mod traced;
