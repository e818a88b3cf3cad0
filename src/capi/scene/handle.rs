//! The handle of a scene, and identifiers of what is in it.

use std::sync::Arc;

use super::super::border::{Guarded, call, create, handles};
use super::super::context::{ContextHandle, Shared, shared};
use super::super::status::{Fault, Status};
use crate::scene::Scene;

/// Names a thing in a scene: 1 for the first of its kind, 2 for the second. 0: none.
pub type Id = u32;

/// A scene, and the context whose threads and log it uses, if any.
pub struct SceneState {
    pub(crate) scene: Scene,
    shared: Option<Arc<Shared>>,
}

impl SceneState {
    /// Works on the scene, on the context's threads.
    pub(crate) fn work<R: Send>(&mut self, work: impl FnOnce(&mut Scene) -> R + Send) -> R {
        let SceneState { scene, shared } = self;
        match shared {
            Some(shared) => shared.run(|| work(scene)),
            None => work(scene),
        }
    }
}

/// What there is to light. One call at a time may use it; irradia_render() reads it during the call alone.
pub struct SceneHandle {
    guarded: Guarded<SceneState>,
}

handles! {
    SceneHandle(SceneState) = "scene";
}

/// Index of what an identifier names.
pub(crate) fn index_of(id: Id, what: &str) -> Result<usize, Fault> {
    let index =
        id.checked_sub(1).ok_or_else(|| Fault::argument(format!("the {what}'s identifier is 0, which names none")))?;
    Ok(index as usize)
}

/// The whole of a call that adds something to a scene: `add` returns its index.
///
/// # Safety
/// `scene` is null, which is a fault, or alive; `id` is null or may be written to.
pub(crate) unsafe fn add(
    scene: *mut SceneHandle,
    id: *mut Id,
    add: impl FnOnce(&mut SceneState) -> Result<usize, Fault>,
) -> Status {
    call(|border| {
        let give = |number: u32| {
            if !id.is_null() {
                // SAFETY: the caller's.
                unsafe { id.write(number) };
            }
        };
        // What could not be added is none.
        give(0);
        // SAFETY: the caller's.
        let index = add(unsafe { border.enter(scene) }?)?;
        give(u32::try_from(index + 1).unwrap_or(u32::MAX));
        Ok(())
    })
}

/// The whole of a call that makes a scene, on the context's threads.
///
/// # Safety
/// `context` is null or alive; `scene` as `create` wants it.
pub(super) unsafe fn create_scene(
    context: *const ContextHandle,
    scene: *mut *mut SceneHandle,
    make: impl FnOnce() -> Result<Scene, Fault> + Send,
) -> Status {
    let make = || {
        // SAFETY: the caller's.
        let shared = if context.is_null() { None } else { Some(unsafe { shared(context) }?) };
        let scene = match &shared {
            Some(shared) => shared.run(make),
            None => make(),
        };
        Ok(SceneHandle { guarded: Guarded::new(SceneState { scene: scene?, shared }) })
    };
    // SAFETY: the caller's.
    unsafe { create(scene, |_| make()) }
}
