//! The methods of a command: technique, methods in its stead, preset, settings.

use anyhow::Result;
use clap::Args;
use irradia::renderer::{
    CausticsMethod, DiffuseMethod, DirectMethod, Preset, Settings, Slot, SpecularMethod, Technique,
};

use super::values::{self, Setting};

/// Everything but the technique and the preset, of which a bench takes several.
#[derive(Debug, Args)]
#[command(next_help_heading = "Methods")]
pub(crate) struct OptionArgs {
    /// The method of the direct slot, instead of the technique's
    #[arg(long, value_name = "METHOD", value_parser = clap::builder::PossibleValuesParser::new(DirectMethod::NAMES))]
    direct: Option<String>,
    /// The method of the diffuse slot, instead of the technique's
    #[arg(long, value_name = "METHOD", value_parser = clap::builder::PossibleValuesParser::new(DiffuseMethod::NAMES))]
    diffuse: Option<String>,
    /// The method of the caustics slot, instead of the technique's
    #[arg(long, value_name = "METHOD", value_parser = clap::builder::PossibleValuesParser::new(CausticsMethod::NAMES))]
    caustics: Option<String>,
    /// The method of the specular slot, instead of the technique's
    #[arg(long, value_name = "METHOD", value_parser = clap::builder::PossibleValuesParser::new(SpecularMethod::NAMES))]
    specular: Option<String>,
    /// A setting to change after the preset, repeatable
    #[arg(long, value_name = "PIECE.KEY=VALUE", value_parser = values::setting)]
    set: Vec<Setting>,
}

impl OptionArgs {
    /// The settings of `technique` at `preset`, with what the arguments change.
    pub(crate) fn settings(&self, technique: Technique, preset: Preset) -> Result<Settings> {
        let mut settings = Settings::new(technique, preset);
        let methods = [
            (Slot::Direct, &self.direct),
            (Slot::Diffuse, &self.diffuse),
            (Slot::Caustics, &self.caustics),
            (Slot::Specular, &self.specular),
        ];
        for (slot, method) in methods {
            if let Some(method) = method {
                settings.methods.set(slot, method)?;
            }
        }
        for Setting { key, value } in &self.set {
            settings.set(key, value)?;
        }
        Ok(settings)
    }
}

/// One technique at one preset.
#[derive(Debug, Args)]
#[command(next_help_heading = "Methods")]
pub(crate) struct MethodArgs {
    /// The technique: a named set of methods
    #[arg(long, value_parser = values::technique(), default_value = Technique::Rsm.name())]
    technique: Technique,
    /// How time is traded against error
    #[arg(long, value_parser = values::preset(), default_value = Preset::Default.name())]
    preset: Preset,
    #[command(flatten)]
    options: OptionArgs,
}

impl MethodArgs {
    /// The settings that the arguments choose.
    pub(crate) fn settings(&self) -> Result<Settings> {
        self.options.settings(self.technique, self.preset)
    }
}
