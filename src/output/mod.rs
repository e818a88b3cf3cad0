//! Images to files: layered OpenEXR, PNG, and the tone maps that turn radiance into display values.
//!
//! Files appear whole or not at all ([`Target`]), and carry what they show as attributes, so that a picture found
//! a year later still says which scene, settings and device made it.

mod attributes;
mod error;
mod exr;
mod format;
mod header;
mod layers;
mod png;
mod seal;
mod supersample;
pub(crate) mod target;

pub use self::attributes::Attributes;
pub use self::error::OutputError;
pub use self::exr::{ExrImage, read_exr, write_exr};
pub use self::format::ImageFormat;
pub(crate) use self::layers::{SealedError, read_attributes, read_sealed_layers, write_sealed_layers};
pub use self::png::write_png;
pub use self::supersample::box_reduced;
pub use self::target::{Staged, Target};
