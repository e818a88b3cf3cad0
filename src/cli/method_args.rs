//! The methods of a command: technique, methods in its stead, preset, settings.

use anyhow::Result;
use clap::Args;
use irradia::renderer::{Preset, Settings, Slot, Technique};
use irradia::slot::PixelFilter;

use super::values::{self, Setting};

/// Everything but the technique and the preset, of which a bench takes several.
#[derive(Debug, Args)]
#[command(next_help_heading = "Methods")]
pub(crate) struct OptionArgs {
    /// The method of the direct slot, instead of the technique's
    #[arg(long, value_name = "METHOD", value_parser = values::method(Slot::Direct))]
    direct: Option<String>,
    /// The method of the diffuse slot, instead of the technique's
    #[arg(long, value_name = "METHOD", value_parser = values::method(Slot::Diffuse))]
    diffuse: Option<String>,
    /// The method of the caustics slot, instead of the technique's
    #[arg(long, value_name = "METHOD", value_parser = values::method(Slot::Caustics))]
    caustics: Option<String>,
    /// The method of the specular slot, instead of the technique's
    #[arg(long, value_name = "METHOD", value_parser = values::method(Slot::Specular))]
    specular: Option<String>,
    /// Samples a pixel of traced paths or passes of photons, the same as --set path.spp=N or sppm.spp=N
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    spp: Option<u32>,
    /// Scatterings between the light and the first visible surface at most; 0: direct light alone. The same as --set PIECE.bounces=N for every piece
    /// that has such a setting, as far as it takes so many [default: each method's own]
    #[arg(long, value_name = "N")]
    bounces: Option<u32>,
    /// Which of the equally good sequences of samples is taken
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
    /// Where in a pixel traced paths sample light [default: box for render --technique path, else center, as rasterisation does]
    #[arg(long, value_name = "FILTER", value_parser = values::pixel_filter())]
    filter: Option<PixelFilter>,
    /// A setting to change after the preset, repeatable
    #[arg(long, value_name = "PIECE.KEY=VALUE", value_parser = values::setting)]
    set: Vec<Setting>,
}

impl OptionArgs {
    fn chooses_filter(&self) -> bool {
        self.filter.is_some() || self.set.iter().any(|setting| setting.key.ends_with(".filter"))
    }

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
        let filter = self.filter.map(|filter| filter.name().to_owned());
        let numbers = [("spp", self.spp), ("bounces", self.bounces), ("seed", self.seed)];
        let numbers = numbers.into_iter().filter_map(|(name, number)| Some((name, number?.to_string())));
        for (name, value) in numbers.chain(filter.map(|name| ("filter", name))) {
            settings.set_everywhere(name, &value)?;
        }
        for Setting { key, value } in &self.set {
            settings.set(key, value)?;
        }
        if self.bounces.is_some() && settings.bounces() != self.bounces {
            tracing::warn!(
                "--bounces {} is not what {} can do; it has {} by its methods",
                self.bounces.unwrap_or_default(),
                technique.name(),
                settings.bounces().map_or("no limit".to_owned(), |bounces| bounces.to_string()),
            );
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

    /// The same, with pixels that are filtered where nothing but traced paths makes them.
    pub(crate) fn settings_of_pictures(&self) -> Result<Settings> {
        let mut settings = self.settings()?;
        if [Technique::Path, Technique::Sppm].contains(&self.technique) && !self.options.chooses_filter() {
            settings.set_everywhere("filter", PixelFilter::Box.name())?;
        }
        Ok(settings)
    }
}
