//! Options of `shadow-map`.

use crate::method::{OptionKind, options};

options! {
    /// Shadow-map filtering of the `shadow-map` direct method.
    ShadowOptions, "shadow":
    /// Half width of the percentage-closer filter, in texels of the light view; 0 is one bilinear tap.
    filter_radius: u32 = 1, high = 2; OptionKind::Integer(0, 4), "texels", "quadratic";
    /// Offset of the receiver along its normal, in texel widths at the receiver.
    normal_offset: f64 = 0.05; OptionKind::Number(0.0, 16.0), "texels", "";
}
