//! Options of what stands for the lights.

use super::options::{OptionKind, options};
use crate::frame::light_set::LightDetail;

options! {
    /// What stands for the scene's lights, and the resolution of their views.
    LightOptions, "lights":
    /// Side of a spot, directional or point-face light view.
    resolution: u32 = 512, draft = 256, high = 1024; OptionKind::Integer(16, 4096), "texels", "quadratic";
    /// Cosine emitters that stand for all emissive surfaces together.
    emitter_samples: u32 = 8, draft = 4, high = 32; OptionKind::Integer(0, 256), "views", "linear";
    /// Side of an emitter sample's hemicube top.
    emitter_resolution: u32 = 128, draft = 64, high = 256; OptionKind::Integer(16, 1024), "texels", "quadratic";
    /// Directional lights that stand for a `--sky`.
    sky_samples: u32 = 16, draft = 8, high = 64; OptionKind::Integer(1, 256), "views", "linear";
}

impl LightOptions {
    /// For views that are filtered over `filter_radius` texels.
    pub(crate) fn detail(&self, filter_radius: u32) -> LightDetail {
        let LightOptions { resolution, emitter_samples, emitter_resolution, sky_samples } = *self;
        LightDetail { resolution, emitter_samples, emitter_resolution, sky_samples, filter_radius }
    }
}
