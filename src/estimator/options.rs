//! Options of the estimators.

use crate::method::{OptionKind, options};
use crate::slot::PixelFilter;

options! {
    /// Options of the methods that trace paths.
    PathOptions, "path":
    /// Samples a pixel of one frame. Noise: its inverse square root.
    spp: u32 = 64, draft = 16, high = 256; OptionKind::Integer(1, 1 << 20), "samples", "linear";
    /// Scatterings between the light and the first visible surface at most; 0: direct light alone; null: no limit.
    bounces: Option<u32> = None; OptionKind::Limit(0, u32::MAX), "scatterings", "sublinear";
    /// Where in a pixel light is sampled.
    filter: PixelFilter = PixelFilter::Center; OptionKind::Choice(PixelFilter::NAMES), "", "";
    /// Which of the equally good sequences of samples is taken.
    seed: u32 = 0; OptionKind::Integer(0, u32::MAX), "", "";
}

options! {
    /// Options of the methods that map photons progressively.
    SppmOptions, "sppm":
    /// Passes of one frame: camera paths of each pixel, and as many light paths as there are pixels. Noise and blur fall with it.
    spp: u32 = 64, draft = 16, high = 256; OptionKind::Integer(1, 1 << 20), "passes", "linear";
    /// Scatterings between the light and the first visible surface at most; 0: direct light alone; null: no limit.
    bounces: Option<u32> = None; OptionKind::Limit(0, u32::MAX), "scatterings", "sublinear";
    /// Where in a pixel light is sampled.
    filter: PixelFilter = PixelFilter::Center; OptionKind::Choice(PixelFilter::NAMES), "", "";
    /// Which of the equally good sequences of samples is taken.
    seed: u32 = 0; OptionKind::Integer(0, u32::MAX), "", "";
}
