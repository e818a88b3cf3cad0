//! Options of `final-gather`.

use crate::method::{OptionKind, options};

options! {
    /// Options of the `final-gather` diffuse method.
    FinalGatherOptions, "final-gather":
    /// Rays that each pixel gathers by. Noise: at most its inverse square root.
    rays: u32 = 256, draft = 64, high = 1024, paper = 4096; OptionKind::Integer(1, 16_384), "rays", "linear";
    /// Photons that lights send out; each leaves its flux at every surface that it meets.
    photons: u32 = 200_000, draft = 50_000, high = 1_000_000, paper = 1_000_000; OptionKind::Integer(1000, 4_000_000), "photons", "linear";
    /// Photons in the disc that irradiance is estimated from, if each leaves one and they lie evenly on all surfaces: fewer are noisier, more blur.
    nearest: u32 = 64; OptionKind::Integer(4, 1024), "photons", "linear, of the map alone";
    /// Scatterings between the light and the first visible surface at most.
    bounces: Option<u32> = None; OptionKind::Limit(0, u32::MAX), "scatterings", "linear, of the map alone";
}
