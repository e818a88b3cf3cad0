//! Options of `rsm`.

use crate::method::{OptionKind, options};

options! {
    /// Options of the `rsm` diffuse method. Preset `paper`: Dachsbacher & Stamminger 2005, section 5.
    RsmOptions, "rsm":
    /// VPLs gathered at every pixel, shared among the lights by reflected flux.
    vpls: u32 = 256, draft = 64, high = 1024, paper = 400; OptionKind::Integer(0, 32768), "VPLs", "linear";
}
