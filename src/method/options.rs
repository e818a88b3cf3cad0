//! Options: what a method can be told, as a struct and as data.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::preset::Preset;

/// The options of one piece, made by `options!`.
pub trait Options: Clone + PartialEq + Serialize + DeserializeOwned + Send + Sync {
    /// The piece's name in `piece.key`.
    const KEY: &'static str;

    /// The options at a preset.
    fn preset(preset: Preset) -> Self;

    /// What there is to be set, in the order of the fields.
    fn table() -> &'static [OptionInfo];

    /// Whether every option is within its range.
    ///
    /// # Errors
    /// The first one that is not.
    fn check(&self) -> Result<(), OptionFault> {
        let values = values_of(self);
        for info in Self::table() {
            let value = values.get(info.name).unwrap_or(&Value::Null);
            let fault =
                |reason| OptionFault { key: format!("{}.{}", Self::KEY, info.name), value: written(value), reason };
            info.kind.check(value).map_err(fault)?;
        }
        Ok(())
    }
}

/// One option of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OptionInfo {
    /// Its name after the piece's.
    pub name: &'static str,
    /// What it takes.
    pub kind: OptionKind,
    /// What it is counted in; empty for names and shares.
    pub unit: &'static str,
    /// How the frame's time grows with it; empty where it does not.
    pub cost: &'static str,
    /// What it means.
    pub doc: &'static str,
}

/// What an option takes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum OptionKind {
    /// A whole number from the first to the second.
    Integer(u32, u32),
    /// The same, or none for no limit.
    Limit(u32, u32),
    /// One of some whole numbers.
    OneOf(&'static [u32]),
    /// A number from the first to the second.
    Number(f64, f64),
    /// One of some names.
    Choice(&'static [&'static str]),
    /// What the sentence says.
    Text(&'static str),
}

impl OptionKind {
    fn check(self, value: &Value) -> Result<(), String> {
        let whole = value.as_u64().and_then(|value| u32::try_from(value).ok());
        let fits = match self {
            OptionKind::Integer(least, most) => whole.is_some_and(|value| (least..=most).contains(&value)),
            OptionKind::Limit(least, most) => {
                value.is_null() || whole.is_some_and(|value| (least..=most).contains(&value))
            }
            OptionKind::OneOf(choices) => whole.is_some_and(|value| choices.contains(&value)),
            OptionKind::Number(least, most) => value.as_f64().is_some_and(|value| (least..=most).contains(&value)),
            OptionKind::Choice(names) => value.as_str().is_some_and(|value| names.contains(&value)),
            OptionKind::Text(_) => value.is_string(),
        };
        if fits { Ok(()) } else { Err(format!("it takes {self}")) }
    }
}

impl OptionKind {
    /// The nearest whole number that is within the range.
    pub(crate) fn clamped(self, value: u32) -> u32 {
        match self {
            OptionKind::Integer(least, most) | OptionKind::Limit(least, most) => value.clamp(least, most),
            _ => value,
        }
    }
}

impl std::fmt::Display for OptionKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            OptionKind::Integer(least, most) => write!(f, "{least} to {most}"),
            OptionKind::Limit(least, u32::MAX) => write!(f, "a whole number from {least} on, or null"),
            OptionKind::Limit(least, most) => write!(f, "{least} to {most}, or null"),
            OptionKind::OneOf(choices) => {
                let all: Vec<String> = choices.iter().map(u32::to_string).collect();
                f.write_str(&all.join(", "))
            }
            OptionKind::Number(least, most) => write!(f, "{least} to {most}"),
            OptionKind::Choice(names) => f.write_str(&names.join(", ")),
            OptionKind::Text(sentence) => f.write_str(sentence),
        }
    }
}

/// An option with a value that it does not take.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("setting {key} cannot be {value:?}: {reason}")]
pub struct OptionFault {
    /// `piece.key`.
    pub key: String,
    /// The value given.
    pub value: String,
    /// What it takes.
    pub reason: String,
}

/// The options of any piece.
pub(crate) trait Piece {
    fn key(&self) -> &'static str;
    fn table(&self) -> &'static [OptionInfo];
    fn values(&self) -> Map<String, Value>;
    /// Sets the option `name`, which the table has.
    fn set(&mut self, name: &str, value: Value) -> Result<(), OptionFault>;
    fn check(&self) -> Result<(), OptionFault>;
}

impl<T: Options> Piece for T {
    fn key(&self) -> &'static str {
        T::KEY
    }

    fn table(&self) -> &'static [OptionInfo] {
        T::table()
    }

    fn values(&self) -> Map<String, Value> {
        values_of(self)
    }

    fn set(&mut self, name: &str, value: Value) -> Result<(), OptionFault> {
        let text = written(&value);
        let mut values = values_of(self);
        values.insert(name.to_owned(), value);
        let changed: T = serde_json::from_value(Value::Object(values)).map_err(|error| OptionFault {
            key: format!("{}.{name}", T::KEY),
            value: text,
            reason: error.to_string(),
        })?;
        Options::check(&changed)?;
        *self = changed;
        Ok(())
    }

    fn check(&self) -> Result<(), OptionFault> {
        Options::check(self)
    }
}

fn values_of<T: Options>(options: &T) -> Map<String, Value> {
    match serde_json::to_value(options) {
        Ok(Value::Object(values)) => values,
        _ => Map::new(),
    }
}

/// As on the command line.
pub(crate) fn written(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The options of a piece: a struct, its values at each preset, and its table.
///
/// ```text
/// options! {
///     /// Options of the `rsm` diffuse method.
///     RsmOptions, "rsm":
///     /// VPLs gathered at every pixel, shared among the lights by reflected flux.
///     vpls: u32 = 256, draft = 64, high = 1024, paper = 400; OptionKind::Integer(0, 32768), "VPLs", "linear";
/// }
/// ```
macro_rules! options {
    (
        $(#[$struct_doc:meta])*
        $name:ident, $key:literal:
        $(
            $(#[doc = $doc:literal])*
            $field:ident: $type:ty = $default:expr $(, $preset:ident = $value:expr)*; $kind:expr, $unit:literal, $cost:literal;
        )*
    ) => {
        $(#[$struct_doc])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        #[non_exhaustive]
        pub struct $name {
            $(
                $(#[doc = $doc])*
                #[doc = concat!("\n\n`", stringify!($kind), "`; unit: ", $unit, "; cost: ", $cost, ".")]
                pub $field: $type,
            )*
        }

        impl $name {
            /// The same options but for what `change` does to them.
            #[must_use]
            pub fn with(mut self, change: impl FnOnce(&mut $name)) -> $name {
                change(&mut self);
                self
            }
        }

        impl Default for $name {
            fn default() -> $name {
                <$name as $crate::method::Options>::preset($crate::method::Preset::Default)
            }
        }

        impl $crate::method::Options for $name {
            const KEY: &'static str = $key;

            fn preset(preset: $crate::method::Preset) -> $name {
                let mut options = $name { $($field: $default),* };
                $($(
                    if preset.name() == stringify!($preset) {
                        options.$field = $value;
                    }
                )*)*
                let _ = (&mut options, preset);
                options
            }

            fn table() -> &'static [$crate::method::OptionInfo] {
                &[$($crate::method::OptionInfo {
                    name: stringify!($field),
                    kind: $kind,
                    unit: $unit,
                    cost: $cost,
                    doc: concat!($($doc),*),
                }),*]
            }
        }
    };
}
pub(crate) use options;
