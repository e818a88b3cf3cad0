//! Presets: trades of time against error.

use serde::{Deserialize, Serialize};

/// There is no preset of this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no preset {0:?}; presets: {known}", known = Preset::ALL.map(Preset::name).join(", "))]
pub struct UnknownPreset(pub String);

/// A trade of time against error, fixed per method by measurement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Preset {
    /// Fast, for looking around.
    Draft,
    /// The default.
    #[default]
    Default,
    /// Slower, closer to the truth.
    High,
    /// The settings of the method's paper.
    Paper,
}

impl Preset {
    /// All presets.
    pub const ALL: [Preset; 4] = [Preset::Draft, Preset::Default, Preset::High, Preset::Paper];

    /// The name used on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Preset::Draft => "draft",
            Preset::Default => "default",
            Preset::High => "high",
            Preset::Paper => "paper",
        }
    }

    /// The preset called `name`.
    ///
    /// # Errors
    /// Another name; the message lists those there are.
    pub fn from_name(name: &str) -> Result<Preset, UnknownPreset> {
        let found = Preset::ALL.into_iter().find(|preset| preset.name() == name);
        found.ok_or_else(|| UnknownPreset(name.to_owned()))
    }
}
