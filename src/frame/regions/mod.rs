//! Regions of several sizes in place of pixels (Quyen 2014, section 3.2.2): irradiance is found once for each, and interpolated between them.

mod interpolate;
mod pyramid;
mod rule;
mod stencil;

pub(crate) use self::interpolate::interpolate;
pub(crate) use self::pyramid::{Pyramid, level_count, pyramid, signed};
pub(crate) use self::rule::RegionRule;
pub(crate) use self::stencil::{VALID, flattened_size, mark};
