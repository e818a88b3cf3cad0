//! A checksum in a file's own header: whoever reads the file knows that every byte of it is as it was written.
//!
//! The attribute [`ATTRIBUTE`] holds the BLAKE3 hash of the whole file, as hexadecimal digits; of the file as it is with zeros in
//! their place.

use std::ops::Range;

use super::header::attribute_ranges;

/// The attribute's name.
pub(super) const ATTRIBUTE: &str = "checksum";

/// What stands in place of the digits while they are computed.
pub(super) const OPEN: &str = "0000000000000000000000000000000000000000000000000000000000000000";

/// Computes the checksum of a file that has [`OPEN`] for one.
pub(super) fn close(bytes: &mut [u8]) {
    if let Some(digits) = digits(bytes) {
        let hash = blake3::hash(bytes).to_hex();
        bytes[digits].copy_from_slice(hash.as_bytes());
    }
}

/// Whether the checksum of a file is right; `None` if it has none. The checksum is [`OPEN`] afterwards.
pub(super) fn open(bytes: &mut [u8]) -> Option<bool> {
    let digits = digits(bytes)?;
    let said = bytes[digits.clone()].to_vec();
    bytes[digits].copy_from_slice(OPEN.as_bytes());
    Some(blake3::hash(bytes).to_hex().as_bytes() == said)
}

/// The value's digits are the attribute's last bytes.
fn digits(bytes: &[u8]) -> Option<Range<usize>> {
    let begins = |range: &Range<usize>| {
        bytes[range.clone()].strip_prefix(ATTRIBUTE.as_bytes()).is_some_and(|rest| rest.first() == Some(&0))
    };
    let attribute = attribute_ranges(bytes)?.into_iter().find(begins)?;
    let start = attribute.end.checked_sub(OPEN.len()).filter(|start| *start > attribute.start + ATTRIBUTE.len())?;
    Some(start..attribute.end)
}
