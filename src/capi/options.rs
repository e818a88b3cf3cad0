//! What there is to be set, as data.

use std::ffi::{CString, c_char};

use super::descriptor::descriptors;
use super::text::owned;
use crate::renderer::{OptionInfo, OptionKind, Settings};

/// A whole number, `least` to `most`.
pub const IRRADIA_OPTION_INTEGER: u32 = 1;
/// The same, or "null" for no limit.
pub const IRRADIA_OPTION_LIMIT: u32 = 2;
/// One of some whole numbers, which `takes` lists.
pub const IRRADIA_OPTION_ONE_OF: u32 = 3;
/// A number, `least` to `most`.
pub const IRRADIA_OPTION_NUMBER: u32 = 4;
/// One of some names, which `takes` lists.
pub const IRRADIA_OPTION_CHOICE: u32 = 5;
/// A text; `takes` says which.
pub const IRRADIA_OPTION_TEXT: u32 = 6;

/// One setting: what irradia_renderer_set() takes. The texts stand as long as the renderer does.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct OptionDescriptor {
    /// sizeof(irradia_option_descriptor).
    pub size: usize,
    /// "piece.name".
    pub key: *const c_char,
    /// One of IRRADIA_OPTION_….
    pub kind: u32,
    /// Zero.
    pub reserved: u32,
    /// The least number; 0 where none are taken.
    pub least: f64,
    /// The greatest number; 0 where none are taken.
    pub most: f64,
    /// What it takes, in words.
    pub takes: *const c_char,
    /// What it is counted in; empty for names and shares.
    pub unit: *const c_char,
    /// How a frame's time grows with it; empty where it does not.
    pub cost: *const c_char,
    /// What it means.
    pub documentation: *const c_char,
}

descriptors! {
    OptionDescriptor = "option descriptor", size_of::<OptionDescriptor>();
}

/// The texts of one option.
pub(super) struct OptionTexts {
    kind: u32,
    range: [f64; 2],
    key: CString,
    takes: CString,
    unit: CString,
    cost: CString,
    documentation: CString,
}

impl OptionTexts {
    fn new(piece: &str, info: &OptionInfo) -> OptionTexts {
        let (kind, range) = match info.kind {
            OptionKind::Integer(least, most) => (IRRADIA_OPTION_INTEGER, [least.into(), most.into()]),
            OptionKind::Limit(least, most) => (IRRADIA_OPTION_LIMIT, [least.into(), most.into()]),
            OptionKind::OneOf(choices) => {
                let ends = [choices.iter().min(), choices.iter().max()];
                (IRRADIA_OPTION_ONE_OF, ends.map(|end| end.copied().unwrap_or(0).into()))
            }
            OptionKind::Number(least, most) => (IRRADIA_OPTION_NUMBER, [least, most]),
            OptionKind::Choice(_) => (IRRADIA_OPTION_CHOICE, [0.0; 2]),
            OptionKind::Text(_) => (IRRADIA_OPTION_TEXT, [0.0; 2]),
        };
        OptionTexts {
            kind,
            range,
            key: owned(&format!("{piece}.{}", info.name)),
            takes: owned(&info.kind.to_string()),
            unit: owned(info.unit),
            cost: owned(info.cost),
            documentation: owned(info.doc.trim()),
        }
    }

    /// What the host sees of it.
    pub(super) fn descriptor(&self) -> OptionDescriptor {
        let [least, most] = self.range;
        OptionDescriptor {
            size: size_of::<OptionDescriptor>(),
            key: self.key.as_ptr(),
            kind: self.kind,
            reserved: 0,
            least,
            most,
            takes: self.takes.as_ptr(),
            unit: self.unit.as_ptr(),
            cost: self.cost.as_ptr(),
            documentation: self.documentation.as_ptr(),
        }
    }

    /// Of all settings.
    pub(super) fn all(settings: &Settings) -> Vec<OptionTexts> {
        let tables = settings.tables().into_iter();
        tables.flat_map(|(piece, table)| table.iter().map(move |info| OptionTexts::new(piece, info))).collect()
    }
}
