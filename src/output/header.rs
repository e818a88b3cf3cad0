//! The header of an EXR file as its bytes, for what the crate that writes them does not do.

use std::ops::Range;

/// Puts the attributes of a single-part file's header in the order of their names. The crate keeps them in a hash map and
/// writes them in another order every time; the same frame shall make the same file. Nothing else moves.
pub(super) fn sort_attributes(bytes: &mut [u8]) {
    let Some(ranges) = attribute_ranges(bytes) else { return };
    let mut attributes: Vec<&[u8]> = ranges.iter().map(|range| &bytes[range.clone()]).collect();
    attributes.sort_unstable();
    let sorted = attributes.concat();
    bytes[ATTRIBUTES_START..][..sorted.len()].copy_from_slice(&sorted);
}

/// Where the attributes of a file's first header begin.
const ATTRIBUTES_START: usize = 8;

/// Where the attributes of a single-part file lie. An attribute is its name, its type's name, both ended by a zero, the size of
/// its value, and the value; a zero ends the list. `None` if it is not so.
pub(super) fn attribute_ranges(bytes: &[u8]) -> Option<Vec<Range<usize>>> {
    let mut ranges = Vec::new();
    let mut at = ATTRIBUTES_START;
    while *bytes.get(at)? != 0 {
        let after_zero =
            |from: usize| bytes.get(from..)?.iter().position(|&byte| byte == 0).map(|length| from + length + 1);
        let value_size = after_zero(after_zero(at)?)?;
        let size = bytes.get(value_size..value_size + 4)?;
        let end = value_size + 4 + u32::from_le_bytes([size[0], size[1], size[2], size[3]]) as usize;
        bytes.get(at..end)?;
        ranges.push(at..end);
        at = end;
    }
    Some(ranges)
}
