//! Settings: which method fills each slot, and the options of every piece, addressed as `piece.key`.

use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::choices::{Methods, UnknownMethod};
use super::technique::{Technique, UnknownTechnique};
use crate::method::{
    LightOptions, OptionFault, OptionInfo, OptionKind, Options, Piece, Preset, UnknownPreset, for_all_methods, written,
};
use crate::slot::Slot;

/// A setting that does not exist or does not take the value given. One sentence: what, where, what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// No technique of this name.
    #[error(transparent)]
    UnknownTechnique(#[from] UnknownTechnique),
    /// No preset of this name.
    #[error(transparent)]
    UnknownPreset(#[from] UnknownPreset),
    /// The slot has no method of this name.
    #[error(transparent)]
    UnknownMethod(#[from] UnknownMethod),
    /// No setting of this name.
    #[error("there is no setting {key:?}; settings: {known}")]
    UnknownKey {
        /// The key asked for.
        key: String,
        /// The keys there are.
        known: String,
    },
    /// The value is of the wrong kind or outside its range.
    #[error(transparent)]
    BadValue(#[from] OptionFault),
    /// Text or JSON that is no settings at all.
    #[error("settings are a JSON object with a technique; {0}")]
    NoSettings(String),
}

macro_rules! settings {
    (
        direct { $($direct:ident => $_1:ident($direct_options:ident),)* }
        diffuse { $($diffuse:ident => $_2:ident($diffuse_options:ident),)* }
        caustics { $($caustics:ident => $_3:ident($caustics_options:ident),)* }
        specular { $($specular:ident => $_4:ident($specular_options:ident),)* }
        estimator { $($estimator:ident => $_5:ident($estimator_options:ident),)* }
    ) => {
        /// Everything that decides how a frame is made, apart from the scene, the view and the size.
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub struct Settings {
            /// The technique that the methods come from, before any was replaced.
            pub technique: Technique,
            /// The preset that the options come from, before any was changed.
            pub preset: Preset,
            /// The method of each slot.
            pub methods: Methods,
            /// What stands for the lights.
            pub lights: LightOptions,
            $(#[doc = concat!("Options of `", stringify!($direct), "`.")] pub $direct: crate::direct::$direct::options::$direct_options,)*
            $(#[doc = concat!("Options of `", stringify!($diffuse), "`.")] pub $diffuse: crate::diffuse::$diffuse::options::$diffuse_options,)*
            $(#[doc = concat!("Options of `", stringify!($caustics), "`.")] pub $caustics: crate::caustics::$caustics::options::$caustics_options,)*
            $(#[doc = concat!("Options of `", stringify!($specular), "`.")] pub $specular: crate::specular::$specular::options::$specular_options,)*
            $(#[doc = concat!("Options of the estimator `", stringify!($estimator), "`.")] pub $estimator: crate::estimator::options::$estimator_options,)*
        }

        impl Settings {
            /// The settings of `technique` at `preset`.
            pub fn new(technique: Technique, preset: Preset) -> Settings {
                let mut settings = Settings {
                    technique,
                    preset,
                    methods: technique.methods(),
                    lights: Options::preset(preset),
                    $($direct: Options::preset(preset),)*
                    $($diffuse: Options::preset(preset),)*
                    $($caustics: Options::preset(preset),)*
                    $($specular: Options::preset(preset),)*
                    $($estimator: Options::preset(preset),)*
                };
                for (key, value) in technique.adjustments(preset) {
                    settings.set_value(key, Value::from(*value)).expect("the list of techniques is tested");
                }
                settings
            }

            fn pieces(&self) -> Vec<&dyn Piece> {
                vec![
                    &self.lights,
                    $(&self.$direct,)* $(&self.$diffuse,)* $(&self.$caustics,)* $(&self.$specular,)* $(&self.$estimator,)*
                ]
            }

            fn pieces_mut(&mut self) -> Vec<&mut dyn Piece> {
                vec![
                    &mut self.lights,
                    $(&mut self.$direct,)* $(&mut self.$diffuse,)* $(&mut self.$caustics,)* $(&mut self.$specular,)*
                    $(&mut self.$estimator,)*
                ]
            }
        }

        /// The options of every piece and the choices among them.
        pub mod options {
            pub use crate::method::LightOptions;
            $(pub use crate::direct::$direct::options::*;)*
            $(pub use crate::diffuse::$diffuse::options::*;)*
            $(pub use crate::caustics::$caustics::options::*;)*
            $(pub use crate::specular::$specular::options::*;)*
            $(pub use crate::estimator::options::$estimator_options;)*
        }
    };
}
for_all_methods! { settings }

impl Settings {
    /// The same settings but for what `change` does to them.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut Settings)) -> Settings {
        change(&mut self);
        self
    }

    /// What there is to be set: each piece's name and its table.
    pub fn tables(&self) -> Vec<(&'static str, &'static [OptionInfo])> {
        self.pieces().into_iter().map(|piece| (piece.key(), piece.table())).collect()
    }

    /// All settings that `set` takes, as `piece.key`.
    pub fn keys(&self) -> Vec<String> {
        let keys = |(piece, table): (&str, &'static [OptionInfo])| {
            table.iter().map(|info| format!("{piece}.{}", info.name)).collect::<Vec<_>>()
        };
        self.tables().into_iter().flat_map(keys).collect()
    }

    /// Sets `piece.key` to a value written as on the command line.
    ///
    /// # Errors
    /// An unknown key lists the known ones; a bad value says what the setting takes.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), SettingsError> {
        self.set_value(key, serde_json::from_str(value).unwrap_or_else(|_| Value::String(value.to_owned())))
    }

    fn set_value(&mut self, key: &str, value: Value) -> Result<(), SettingsError> {
        let unknown = SettingsError::UnknownKey { key: key.to_owned(), known: self.keys().join(", ") };
        let Some((name, option)) = key.split_once('.') else { return Err(unknown) };
        let piece = self.pieces_mut().into_iter().find(|piece| piece.key() == name);
        let info = |piece: &&mut dyn Piece| piece.table().iter().find(|info| info.name == option).map(|info| info.kind);
        let (piece, kind) = piece.and_then(|piece| info(&piece).map(|kind| (piece, kind))).ok_or(unknown)?;
        // Choices go by names, also where these read like something else.
        let value = match (kind, value) {
            (OptionKind::Choice(_), Value::Bool(yes)) => Value::String(yes.to_string()),
            (_, value) => value,
        };
        Ok(piece.set(option, value)?)
    }

    /// Sets the option `name` of every piece that has one which takes the value; numbers as far as the piece takes them.
    ///
    /// # Errors
    /// A value that no piece takes.
    pub fn set_everywhere(&mut self, name: &str, value: &str) -> Result<(), SettingsError> {
        let (mut taken, mut refused) = (false, Ok(()));
        for piece in self.pieces_mut() {
            let Some(info) = piece.table().iter().find(|info| info.name == name) else { continue };
            let number = value.parse().map(|number| Value::from(info.kind.clamped(number)));
            match piece.set(name, number.unwrap_or_else(|_| Value::String(value.to_owned()))) {
                Ok(()) => taken = true,
                // Something else may have that name: paths are filtered over a pixel, points of caustics over a surface.
                Err(error) => refused = Err(error.into()),
            }
        }
        if taken { Ok(()) } else { refused }
    }

    /// Whether every option of every piece is within its range.
    ///
    /// # Errors
    /// The first one that is not.
    pub fn check(&self) -> Result<(), SettingsError> {
        self.pieces().into_iter().try_for_each(|piece| Ok(piece.check()?))
    }

    /// The options of every piece as one JSON object, `{"lights": {…}, …}`.
    pub fn options(&self) -> Map<String, Value> {
        self.pieces().into_iter().map(|piece| (piece.key().to_owned(), Value::Object(piece.values()))).collect()
    }

    /// Reads what serialising wrote, or a part of it: what is not given is that of the technique and the preset, so that settings written by an
    /// older version still load.
    ///
    /// # Errors
    /// No technique; unknown names; values out of range.
    pub fn from_json(json: &Value) -> Result<Settings, SettingsError> {
        let no_settings = |reason: &str| SettingsError::NoSettings(reason.to_owned());
        let given = json.as_object().ok_or_else(|| no_settings("this is none"))?;
        let text = |name: &str| given.get(name).map(written);
        let technique = Technique::from_name(&text("technique").ok_or_else(|| no_settings("this has none"))?)?;
        let preset = text("preset").map_or(Ok(Preset::Default), |name| Preset::from_name(&name))?;
        let mut settings = Settings::new(technique, preset);
        let methods = given.get("methods").map_or(Ok(Map::new()), |methods| {
            methods.as_object().cloned().ok_or_else(|| no_settings("its methods are no object"))
        })?;
        for (slot, method) in &methods {
            let slot = Slot::from_name(slot).ok_or_else(|| no_settings(&format!("{slot:?} is no slot")))?;
            settings.methods.set(slot, &written(method))?;
        }
        for (piece, options) in given.iter().filter(|(name, _)| !["technique", "preset", "methods"].contains(&&***name))
        {
            let options = options.as_object().ok_or_else(|| no_settings(&format!("{piece:?} is no object in this")))?;
            if options.is_empty() && !settings.pieces().iter().any(|known| known.key() == piece) {
                settings.set_value(piece, Value::Null)?;
            }
            for (option, value) in options {
                settings.set_value(&format!("{piece}.{option}"), value.clone())?;
            }
        }
        Ok(settings)
    }
}

impl Serialize for Settings {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("technique", &self.technique)?;
        map.serialize_entry("preset", &self.preset)?;
        map.serialize_entry("methods", &self.methods)?;
        for piece in self.pieces() {
            map.serialize_entry(piece.key(), &piece.values())?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Settings {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Settings, D::Error> {
        Settings::from_json(&Value::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::super::choices::{CausticsMethod, DiffuseMethod};
    use super::*;
    use crate::slot::PixelFilter;

    #[test]
    fn every_setting_can_be_set_to_its_own_value() {
        let mut settings = Settings::new(Technique::Rsm, Preset::Default);
        let before = settings.clone();
        for key in settings.keys() {
            let (piece, option) = key.split_once('.').expect("keys have a piece");
            let value = settings.options()[piece][option].to_string();
            settings.set(&key, &value).expect("its own value is within its range");
        }
        assert_eq!(settings, before);
    }

    #[test]
    fn one_name_may_take_other_choices_elsewhere() {
        let mut settings = Settings::new(Technique::Path, Preset::Default);
        let points = settings.points.clone();
        settings.set_everywhere("filter", "box").expect("paths take it");
        assert_eq!((settings.path.filter, settings.sppm.filter), (PixelFilter::Box, PixelFilter::Box));
        assert_eq!(settings.points, points);
        assert!(settings.set_everywhere("filter", "round").is_err());
        assert_eq!(settings.points, points);
    }

    #[test]
    fn what_buffers_do_not_hold_is_said() {
        let mut settings = Settings::new(Technique::Hybrid, Preset::Default);
        assert!(settings.reduced().is_empty());
        for (key, value) in
            [("photons.max", "4000000"), ("photons.bounces", "4"), ("vpl.visibility", "ism"), ("vpl.count", "65536")]
        {
            settings.set(key, value).expect("within its range");
        }
        let said = settings.reduced().join("\n");
        assert!(said.contains("4000000") && said.contains("699050"), "{said}");
        assert!(said.contains("vpl.ism_resolution is") && said.contains("of 65536 VPLs"), "{said}");
        // What another method has does not matter.
        settings.methods.caustics = CausticsMethod::None;
        settings.methods.diffuse = DiffuseMethod::None;
        assert!(settings.reduced().is_empty());
    }

    #[test]
    fn all_presets_of_all_techniques_are_within_their_ranges() {
        for technique in Technique::ALL {
            for preset in Preset::ALL {
                Settings::new(technique, preset).check().expect("a preset");
            }
        }
        let high = |technique| Settings::new(technique, Preset::High);
        assert_eq!((high(Technique::Rsm).lights.resolution, high(Technique::Hybrid).lights.resolution), (1024, 512));
    }

    #[test]
    fn wrong_settings_say_what_would_be_right() {
        let mut settings = Settings::new(Technique::Rsm, Preset::Default);
        let unknown = settings.set("rsm.vlps", "3").expect_err("no such key").to_string();
        assert!(unknown.contains("rsm.vpls"), "{unknown}");
        let range = settings.set("lights.resolution", "5").expect_err("too small").to_string();
        assert!(range.contains("16 to 4096"), "{range}");
        assert!(settings.set("rsm.vpls", "many").is_err());
        assert!(settings.set("methods.diffuse", "rsm").is_err());
        settings.set("rsm.vpls", "512").expect("within its range");
        assert_eq!(settings.rsm.vpls, 512);
        settings.photons.downscale = 3;
        let downscale = settings.check().expect_err("not a downscale").to_string();
        assert!(downscale.contains("photons.downscale") && downscale.contains("1, 2, 4"), "{downscale}");
    }

    #[test]
    fn settings_are_read_as_they_were_written() {
        let mut settings = Settings::new(Technique::Hybrid, Preset::Paper);
        settings.methods.diffuse = DiffuseMethod::Rsm;
        settings.photons.max = 7;
        settings.path.bounces = Some(2);
        let text = serde_json::to_string(&settings).expect("JSON");
        assert_eq!(serde_json::from_str::<Settings>(&text).expect("its own"), settings);
    }

    #[test]
    fn a_part_of_the_settings_is_laid_over_those_of_technique_and_preset() {
        let read = |text: &str| serde_json::from_str::<Settings>(text).map_err(|error| error.to_string());
        let some =
            read(r#"{"technique": "hybrid", "preset": "high", "methods": {"caustics": "none"}, "vpl": {"count": 9}}"#);
        let expected = Settings::new(Technique::Hybrid, Preset::High).with(|settings| {
            settings.methods.caustics = CausticsMethod::None;
            settings.vpl.count = 9;
        });
        assert_eq!(some, Ok(expected));
        let fault = |text: &str| read(text).expect_err("a fault");
        assert!(fault("[]").contains("a technique"));
        assert!(fault(r#"{"preset": "high"}"#).contains("a technique"));
        assert!(fault(r#"{"technique": "rms"}"#).contains("rsm"));
        assert!(fault(r#"{"technique": "rsm", "rsm": {"vlps": 3}}"#).contains("rsm.vlps"));
        assert!(fault(r#"{"technique": "rsm", "voxels": {}}"#).contains("voxels"));
        assert!(fault(r#"{"technique": "rsm", "rsm": {"vpls": 99999}}"#).contains("0 to 32768"));
        assert!(fault(r#"{"technique": "rsm", "methods": {"diffuse": "rms"}}"#).contains("rsm"));
    }
}
