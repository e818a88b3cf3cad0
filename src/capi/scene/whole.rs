//! Scenes as a whole: made empty, looked through, lit by a sky, put to a time.

use std::ffi::c_char;

use super::super::border::{call, take};
use super::super::context::ContextHandle;
use super::super::descriptor::slice;
use super::super::status::{Fault, Status};
use super::super::text::{self, optional_text, text};
use super::handle::{Id, SceneHandle, create_scene, index_of};
use crate::scene::Scene;

/// Meshes.
pub const IRRADIA_KIND_MESH: u32 = 1;
/// Materials.
pub const IRRADIA_KIND_MATERIAL: u32 = 2;
/// Textures.
pub const IRRADIA_KIND_TEXTURE: u32 = 3;
/// Nodes.
pub const IRRADIA_KIND_NODE: u32 = 4;
/// Punctual lights.
pub const IRRADIA_KIND_LIGHT: u32 = 5;
/// Cameras that nodes place.
pub const IRRADIA_KIND_CAMERA: u32 = 6;
/// What loading had to leave out or change: sentences, which stand for names here.
pub const IRRADIA_KIND_WARNING: u32 = 7;

/// Makes a scene without anything in it.
///
/// `context`: whose threads and log the scene uses; null: the calling thread's process-wide ones, and no log. A scene can be shown on any context.
/// `name`: what messages call it; null: "scene".
/// `scene`: receives the scene, which irradia_scene_destroy() ends.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_create(
    context: *const ContextHandle,
    name: *const c_char,
    scene: *mut *mut SceneHandle,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    let name = unsafe { optional_text(name, "the scene's name") };
    // SAFETY: as above.
    unsafe { create_scene(context, scene, move || Ok(Scene::empty(name?.unwrap_or("scene")))) }
}

/// Ends a scene. What a renderer keeps of it stays on the device until the renderer shows another one or is destroyed. Null is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_destroy(scene: *mut SceneHandle) {
    // SAFETY: the host gives back what it was given.
    unsafe { take(scene) };
}

/// How many things of a kind the scene has: their identifiers are 1 to this number.
///
/// `kind`: one of IRRADIA_KIND_….
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_count(scene: *const SceneHandle, kind: u32, count: *mut u32) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(scene) }?;
        let names = names_of(&state.scene, kind)?;
        if count.is_null() {
            return Err(Fault::argument("the place for the count is a null pointer"));
        }
        // SAFETY: as above.
        unsafe { count.write(u32::try_from(names.len()).unwrap_or(u32::MAX)) };
        Ok(())
    })
}

/// Copies the name of a thing, empty if it has none.
///
/// `buffer`, `capacity`, `needed`: as for irradia_renderer_settings().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_name(
    scene: *const SceneHandle,
    kind: u32,
    id: Id,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(scene) }?;
        let names = names_of(&state.scene, kind)?;
        let name = names.get(index_of(id, "thing")?).ok_or_else(|| {
            Fault::argument(format!("the scene has {} things of kind {kind}, none with identifier {id}", names.len()))
        })?;
        // SAFETY: as above.
        unsafe { text::copy(name, buffer, capacity, needed) }
    })
}

/// The first thing of a kind that goes by a name; 0 if none does, which is no error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_find(
    scene: *const SceneHandle,
    kind: u32,
    name: *const c_char,
    id: *mut Id,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(scene) }?;
        // SAFETY: as above.
        let wanted = unsafe { text(name, "the name") }?;
        let found = names_of(&state.scene, kind)?.iter().position(|name| *name == wanted);
        if id.is_null() {
            return Err(Fault::argument("the place for the identifier is a null pointer"));
        }
        // SAFETY: as above.
        unsafe { id.write(found.map_or(0, |index| u32::try_from(index + 1).unwrap_or(u32::MAX))) };
        Ok(())
    })
}

fn names_of(scene: &Scene, kind: u32) -> Result<Vec<&str>, Fault> {
    let names = match kind {
        IRRADIA_KIND_MESH => scene.meshes().iter().map(|thing| &*thing.name).collect(),
        IRRADIA_KIND_MATERIAL => scene.materials().iter().map(|thing| &*thing.name).collect(),
        IRRADIA_KIND_TEXTURE => scene.textures().iter().map(|thing| &*thing.name).collect(),
        IRRADIA_KIND_NODE => scene.nodes().iter().map(|thing| &*thing.name).collect(),
        IRRADIA_KIND_LIGHT => scene.lights().iter().map(|thing| &*thing.name).collect(),
        IRRADIA_KIND_CAMERA => scene.cameras().iter().map(|thing| &*thing.name).collect(),
        IRRADIA_KIND_WARNING => scene.warnings.iter().map(|sentence| &**sentence).collect(),
        _ => return Err(Fault::argument(format!("the kind is {kind}; write one of IRRADIA_KIND_…"))),
    };
    Ok(names)
}

/// Sets the sky's radiance, alike from all directions.
///
/// `radiance`: linear red, green, blue, W/(m² sr), finite and at least 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_set_sky(scene: *mut SceneHandle, radiance: *const f32) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(scene) }?;
        // SAFETY: as above: three numbers.
        let radiance = unsafe { slice(radiance, 3, "the sky's radiance") }?;
        if !radiance.iter().all(|channel| channel.is_finite() && *channel >= 0.0) {
            return Err(Fault::argument("the sky's radiance is negative or not finite"));
        }
        state.scene.set_sky([radiance[0], radiance[1], radiance[2]]);
        Ok(())
    })
}

/// Puts everything that the scene's file animates where it is at a time.
///
/// `seconds`: finite; before the first and after the last keyframe things stand still.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_set_time(scene: *mut SceneHandle, seconds: f64) -> Status {
    call(|border| {
        // SAFETY: the host's pointer is what the header asks for.
        let state = unsafe { border.enter(scene) }?;
        if !seconds.is_finite() {
            return Err(Fault::argument("the time is not finite"));
        }
        state.work(|scene| scene.set_time(seconds));
        Ok(())
    })
}
