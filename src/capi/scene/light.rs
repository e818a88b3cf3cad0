//! Punctual lights.

use std::ffi::c_char;

use super::super::border::call;
use super::super::descriptor::{Descriptor, descriptors, read, zero};
use super::super::status::{Fault, Status};
use super::super::text::optional_text;
use super::handle::{Id, SceneHandle, add, index_of};
use crate::scene::{Light, LightId, LightKind};

/// Shines alike in all directions; intensity in W/sr.
pub const IRRADIA_LIGHT_POINT: u32 = 0;
/// Shines along the -Z of its node, fully within `inner_angle`, not outside `outer_angle`; intensity on its axis in W/sr.
pub const IRRADIA_LIGHT_SPOT: u32 = 1;
/// Parallel light along the -Z of its node; intensity across it in W/m².
pub const IRRADIA_LIGHT_DIRECTIONAL: u32 = 2;

/// A light without area. Surfaces shine by their materials' `emissive`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct LightDescriptor {
    /// sizeof(irradia_light_descriptor).
    pub size: usize,
    /// Null: none.
    pub name: *const c_char,
    /// One of IRRADIA_LIGHT_….
    pub kind: u32,
    /// Linear red, green, blue, finite and at least 0; the unit is the kind's.
    pub intensity: [f32; 3],
    /// Half angle of a spot, radians, 0 to `outer_angle`.
    pub inner_angle: f32,
    /// Half angle of a spot, radians, above 0 to π/2. Between the two it falls off as glTF says.
    pub outer_angle: f32,
    /// Distance in metres beyond which the light may be ignored; 0: none.
    pub range: f32,
    /// Zero.
    pub reserved: u32,
}

descriptors! {
    LightDescriptor = "light descriptor", size_of::<LightDescriptor>();
}

/// # Safety
/// `descriptor` is null, which is a fault, or a descriptor.
unsafe fn light(descriptor: *const LightDescriptor) -> Result<Light, Fault> {
    // SAFETY: the caller's.
    let given = unsafe { read(descriptor) }?;
    zero(given.reserved, LightDescriptor::NAME)?;
    let kind = match given.kind {
        IRRADIA_LIGHT_POINT => LightKind::Point,
        IRRADIA_LIGHT_SPOT => LightKind::Spot { inner_angle: given.inner_angle, outer_angle: given.outer_angle },
        IRRADIA_LIGHT_DIRECTIONAL => LightKind::Directional,
        other => return Err(Fault::argument(format!("the light's kind is {other}; write one of IRRADIA_LIGHT_…"))),
    };
    if !(given.range.is_finite() && given.range >= 0.0) {
        return Err(Fault::argument("the light's range is negative or not finite"));
    }
    // SAFETY: the caller's.
    let name = unsafe { optional_text(given.name, "the light's name") }?.unwrap_or_default().to_owned();
    let range = (given.range > 0.0).then_some(given.range);
    Ok(Light { name, kind, intensity: given.intensity, range })
}

/// Adds a light; a node must place it before it shines.
///
/// `id`: receives its identifier; may be null.
///
/// Errors: IRRADIA_ERROR_SCENE for an intensity or angles out of range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_add_light(
    scene: *mut SceneHandle,
    descriptor: *const LightDescriptor,
    id: *mut Id,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    unsafe { add(scene, id, |state| Ok(state.scene.add_light(light(descriptor)?)?.0)) }
}

/// Replaces a light. One that stays the same costs nothing in the next frame.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_set_light(
    scene: *mut SceneHandle,
    id: Id,
    descriptor: *const LightDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let (state, light) = unsafe { (border.enter(scene)?, light(descriptor)?) };
        Ok(state.scene.set_light(LightId(index_of(id, "light")?), light)?)
    })
}
