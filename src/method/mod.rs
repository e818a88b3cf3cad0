//! What a method is, and what all methods share: presets, choices by name, the error of a frame.

mod choices;
mod error;
mod preset;

pub(crate) use self::choices::choices;
pub use self::error::Error;
pub use self::preset::{Preset, UnknownPreset};
