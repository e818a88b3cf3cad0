//! The slots of a frame, as bits.

use crate::slot::Slot;

/// What the surfaces themselves emit, and the sky where no surface is.
pub const IRRADIA_SLOT_EMISSION: u32 = 1;
/// Light from the lights, shadowed.
pub const IRRADIA_SLOT_DIRECT: u32 = 2;
/// Light that was scattered diffusely before.
pub const IRRADIA_SLOT_DIFFUSE: u32 = 4;
/// Light that was reflected or refracted before, on diffuse surfaces.
pub const IRRADIA_SLOT_CAUSTICS: u32 = 8;
/// What mirrors, metals and glass show, but for the lights.
pub const IRRADIA_SLOT_SPECULAR: u32 = 16;
/// The sum of all slots.
pub const IRRADIA_SLOT_IMAGE: u32 = 32;
/// The image for a display: sRGB, 8 bits, by the tone map of the frame.
pub const IRRADIA_SLOT_DISPLAY: u32 = 64;

/// A slot by its bit, among those that are images of radiance; the image itself is none of them.
pub(super) fn slot_of(bit: u32) -> Option<Slot> {
    let index = bit.is_power_of_two().then(|| bit.trailing_zeros() as usize)?;
    Slot::ALL.get(index).copied()
}

/// The bit of a slot, or of the image.
pub(super) fn bit_of(slot: Option<Slot>) -> u32 {
    slot.map_or(IRRADIA_SLOT_IMAGE, |slot| 1 << Slot::ALL.iter().position(|known| *known == slot).unwrap_or_default())
}
