//! Values of arguments: sizes, frame ranges, and names checked against those there are.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use irradia::output::ImageFormat;
use irradia::renderer::{Methods, Preset, Settings, Slot, Technique, ToneMap};
use irradia::slot::PixelFilter;

/// `WxH`, both at least 1.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).map(|(width, height)| (width.parse::<u32>(), height.parse::<u32>()));
    match sides {
        Some((Ok(width), Ok(height))) if width > 0 && height > 0 => Ok([width, height]),
        _ => Err("a size is WIDTHxHEIGHT in pixels, such as 1024x768".to_owned()),
    }
}

/// Frames from the first to the last, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FrameRange {
    pub(crate) first: u32,
    pub(crate) last: u32,
}

/// `A..B`, both included.
pub(crate) fn frame_range(text: &str) -> Result<FrameRange, String> {
    let ends = text.split_once("..").map(|(first, last)| (first.parse(), last.parse()));
    match ends {
        Some((Ok(first), Ok(last))) if first <= last => Ok(FrameRange { first, last }),
        _ => Err("a range is FIRST..LAST, both included, such as 0..29".to_owned()),
    }
}

/// A file to write an image to.
#[derive(Clone, Debug)]
pub(crate) struct ImagePath {
    pub(crate) path: PathBuf,
    pub(crate) format: ImageFormat,
}

/// A path whose extension names a format.
pub(crate) fn image_path(text: &str) -> Result<ImagePath, String> {
    let path = PathBuf::from(text);
    let format = ImageFormat::from_path(&path).map_err(|error| error.to_string())?;
    Ok(ImagePath { path, format })
}

/// `piece.key=value`, whose key exists and takes the value.
#[derive(Clone, Debug)]
pub(crate) struct Setting {
    pub(crate) key: String,
    pub(crate) value: String,
}

/// A setting. All settings have the same keys and ranges, so those of any technique can judge it.
pub(crate) fn setting(text: &str) -> Result<Setting, String> {
    let (key, value) = text.split_once('=').ok_or("a setting is piece.key=value, such as rsm.vpls=512")?;
    let mut settings = Settings::new(Technique::Rsm, Preset::Default);
    settings.set(key, value).map_err(|error| error.to_string())?;
    Ok(Setting { key: key.to_owned(), value: value.to_owned() })
}

/// A percentage above 0, with or without its sign, as a share of one.
pub(crate) fn percentage(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('%').unwrap_or(text).trim_end().parse().ok();
    let share = number.filter(|percent: &f64| percent.is_finite() && *percent > 0.0).map(|percent| 0.01 * percent);
    share.ok_or_else(|| "a percentage is a number above 0, such as 0.5%".to_owned())
}

/// Frames a second.
pub(crate) fn frame_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate: &f64| (1e-3..=1e6).contains(rate));
    rate.ok_or_else(|| "a number of frames a second, 0.001 to 1000000, such as 30".to_owned())
}

/// One of a list, or all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Choice<T> {
    All,
    One(T),
}

impl<T: Copy + PartialEq> Choice<T> {
    /// What is chosen, each once, in the order of the choices.
    pub(crate) fn expand(choices: &[Choice<T>], all: &[T]) -> Vec<T> {
        let mut chosen = Vec::new();
        for choice in choices {
            let named = match choice {
                Choice::All => all,
                Choice::One(one) => std::slice::from_ref(one),
            };
            for one in named {
                if !chosen.contains(one) {
                    chosen.push(*one);
                }
            }
        }
        chosen
    }
}

/// The word for everything in a list.
const ALL: &str = "all";

/// The name of a technique.
pub(crate) fn technique() -> impl TypedValueParser<Value = Technique> {
    PossibleValuesParser::new(Technique::names()).try_map(|name| Technique::from_name(&name))
}

/// The name of a technique, or `all`.
pub(crate) fn technique_choice() -> impl TypedValueParser<Value = Choice<Technique>> {
    PossibleValuesParser::new(Technique::names().into_iter().chain([ALL]))
        .try_map(|name| if name == ALL { Ok(Choice::All) } else { Technique::from_name(&name).map(Choice::One) })
}

/// The name of a preset.
pub(crate) fn preset() -> impl TypedValueParser<Value = Preset> {
    PossibleValuesParser::new(Preset::ALL.map(Preset::name)).try_map(|name| Preset::from_name(&name))
}

/// The name of a slot, or `all`.
pub(crate) fn slot_choice() -> impl TypedValueParser<Value = Choice<Slot>> {
    PossibleValuesParser::new(Slot::ALL.into_iter().map(Slot::name).chain([ALL])).try_map(|name| {
        if name == ALL {
            return Ok(Choice::All);
        }
        Slot::from_name(&name).map(Choice::One).ok_or_else(|| format!("there is no slot {name:?}"))
    })
}

pub(crate) fn pixel_filter() -> impl TypedValueParser<Value = PixelFilter> {
    PossibleValuesParser::new(PixelFilter::NAMES).try_map(|name| {
        let found = PixelFilter::ALL.into_iter().find(|filter| filter.name() == name);
        found.ok_or("there is no such filter")
    })
}

/// The name of a method of a slot.
pub(crate) fn method(slot: Slot) -> PossibleValuesParser {
    PossibleValuesParser::new(Methods::names(slot))
}

const TONE_MAPS: [(&str, ToneMap); 3] =
    [("drago", ToneMap::Drago), ("aces", ToneMap::Aces), ("linear", ToneMap::Linear)];

/// The name of a tone map.
pub(crate) fn tone_map() -> impl TypedValueParser<Value = ToneMap> {
    PossibleValuesParser::new(TONE_MAPS.map(|(name, _)| name)).try_map(|name| {
        let found = TONE_MAPS.into_iter().find(|(known, _)| *known == name);
        found.map(|(_, map)| map).ok_or_else(|| format!("there is no tone map {name:?}"))
    })
}

/// The name of a tone map as it is given.
pub(crate) fn tone_map_name(map: ToneMap) -> &'static str {
    TONE_MAPS.into_iter().find(|(_, known)| *known == map).map_or("", |(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("1024x768"), Ok([1024, 768]));
        assert_eq!(size("1X1"), Ok([1, 1]));
        for wrong in ["", "x", "1024", "0x5", "5x0", "-1x5", "1x2x3", "4294967296x1", "1024 x 768"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn frame_ranges() {
        assert_eq!(frame_range("0..29"), Ok(FrameRange { first: 0, last: 29 }));
        assert_eq!(frame_range("7..7"), Ok(FrameRange { first: 7, last: 7 }));
        for wrong in ["", "..", "3", "3..", "..3", "4..3", "1..=3", "-1..3", "a..b"] {
            assert!(frame_range(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn percentages() {
        assert_eq!(["50%", "50", "50 %"].map(percentage), [Ok(0.5), Ok(0.5), Ok(0.5)]);
        for wrong in ["", "%", "0", "-1%", "NaN", "inf%", "1%%"] {
            assert!(percentage(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn frame_rates() {
        assert_eq!(["30", "0.5"].map(frame_rate), [Ok(30.0), Ok(0.5)]);
        for wrong in ["", "0", "-1", "NaN", "inf", "30 fps"] {
            assert!(frame_rate(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn settings_are_checked_as_they_are_parsed() {
        assert!(setting("rsm.vpls=512").is_ok());
        assert!(setting("rsm.vpls").is_err_and(|error| error.contains("piece.key=value")));
        assert!(setting("rsm.vlps=512").is_err_and(|error| error.contains("rsm.vpls")));
        assert!(setting("rsm.vpls=-1").is_err());
    }

    #[test]
    fn choices_keep_their_order_and_name_nothing_twice() {
        let expand = |choices: &[Choice<u8>]| Choice::expand(choices, &[1, 2, 3]);
        assert_eq!(expand(&[Choice::One(3), Choice::One(1), Choice::One(3)]), [3, 1]);
        assert_eq!(expand(&[Choice::One(2), Choice::All]), [2, 1, 3]);
        assert!(expand(&[]).is_empty());
    }
}
