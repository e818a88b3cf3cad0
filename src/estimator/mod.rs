//! Estimators: unbiased or consistent sums of samples that fill several slots in one run.
//!
//! `path` traces paths from the camera and from lights, `sppm` photons; both walk them by the passes of `paths`.

mod camera_paths;
mod cost;
mod estimate;
mod light_paths;
mod noise;
pub(crate) mod options;
pub(crate) mod path;
mod paths;
mod photon_map;
mod source;
pub(crate) mod sppm;
mod sums;
mod view;

pub(crate) use self::cost::TraceCost;
pub(crate) use self::estimate::{Estimating, Estimator, Samples};
pub use self::noise::Noise;
pub(crate) use self::source::RequestSource;
pub use self::sums::{SampleSource, SlotSums};
pub(crate) use self::view::EstimateRequest;
