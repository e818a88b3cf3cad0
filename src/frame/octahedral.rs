//! Unit vectors in 32 bits, as shaders unpack them (`glsl/lib/octahedral.glsl`).

use glam::{Vec2, Vec3};

/// A unit vector on the unfolded octahedron, both coordinates in −1 … 1 (`lib/octahedral.glsl`).
#[must_use]
pub(crate) fn octahedral_encode(direction: Vec3) -> Vec2 {
    let square = Vec2::new(direction.x, direction.y) / direction.abs().element_sum();
    if direction.z >= 0.0 { square } else { (Vec2::ONE - Vec2::new(square.y, square.x).abs()) * sign_not_zero(square) }
}

/// A unit vector in 2 × snorm16, x in the low half (`lib/octahedral.glsl`).
#[must_use]
pub(crate) fn pack_direction(direction: Vec3) -> u32 {
    let square = octahedral_encode(direction);
    let snorm16 = |x: f32| u32::from(((x.clamp(-1.0, 1.0) * 32767.0).round() as i16).cast_unsigned());
    snorm16(square.y) << 16 | snorm16(square.x)
}

pub(crate) fn sign_not_zero(v: Vec2) -> Vec2 {
    Vec2::new(if v.x >= 0.0 { 1.0 } else { -1.0 }, if v.y >= 0.0 { 1.0 } else { -1.0 })
}
