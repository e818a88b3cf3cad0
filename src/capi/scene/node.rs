//! Nodes: what stands where.

use std::ffi::c_char;

use super::super::border::call;
use super::super::descriptor::{descriptors, read, slice};
use super::super::matrix::affine;
use super::super::status::{Fault, Status};
use super::super::text::optional_text;
use super::handle::{Id, SceneHandle, SceneState, add, index_of};
use crate::scene::{CameraId, LightId, MeshId, Node, NodeId};

/// A place in the scene, and what stands there.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct NodeDescriptor {
    /// sizeof(irradia_node_descriptor).
    pub size: usize,
    /// Null: none.
    pub name: *const c_char,
    /// The node in whose space `local` is; 0: the world. It must be there already.
    pub parent: Id,
    /// The mesh that stands here; 0: none.
    pub mesh: Id,
    /// The light that shines from here along -Z; 0: none.
    pub light: Id,
    /// The camera that looks from here along -Z; 0: none.
    pub camera: Id,
    /// Node space to parent space, metres: 4×4, column after column, the last row 0 0 0 1. All zero: the identity.
    pub local: [f64; 16],
}

descriptors! {
    NodeDescriptor = "node descriptor", size_of::<NodeDescriptor>();
}

fn optional(id: Id) -> Option<usize> {
    id.checked_sub(1).map(|index| index as usize)
}

/// Adds a node, and so whatever it places.
///
/// `id`: receives its identifier; may be null.
///
/// Errors: IRRADIA_ERROR_SCENE if its parent or what it places is not there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_add_node(
    scene: *mut SceneHandle,
    descriptor: *const NodeDescriptor,
    id: *mut Id,
) -> Status {
    let place = |state: &mut SceneState| {
        // SAFETY: the host's pointers are what the header asks for.
        let given = unsafe { read(descriptor) }?;
        // SAFETY: as above.
        let name = unsafe { optional_text(given.name, "the node's name") }?.unwrap_or_default().to_owned();
        let node = Node {
            name,
            parent: optional(given.parent).map(NodeId),
            local: affine(&given.local, "the node's matrix")?,
            mesh: optional(given.mesh).map(MeshId),
            light: optional(given.light).map(LightId),
            camera: optional(given.camera).map(CameraId),
        };
        Ok(state.scene.add_node(node)?.0)
    };
    // SAFETY: as above.
    unsafe { add(scene, id, place) }
}

/// Moves nodes, and with them all that hangs below them. What stays where it is costs nothing in the next frame; where render space has its zero, and how large
/// the scene counts for settings that follow its size, stays as it was when it was first shown.
///
/// `ids`: `count` nodes. `locals`: as many matrices of 16 numbers, as `local` of irradia_node_descriptor.
///
/// Errors: IRRADIA_ERROR_ARGUMENT and IRRADIA_ERROR_SCENE; nothing moves then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_set_transforms(
    scene: *mut SceneHandle,
    ids: *const Id,
    locals: *const f64,
    count: usize,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(scene) }?;
        // SAFETY: as above.
        let (ids, locals) =
            unsafe { (slice(ids, count, "nodes")?, slice(locals.cast::<[f64; 16]>(), count, "matrices")?) };
        let moved = ids
            .iter()
            .zip(locals)
            .map(|(&id, local)| Ok((NodeId(index_of(id, "node")?), affine(local, "a node's matrix")?)));
        let moved = moved.collect::<Result<Vec<_>, Fault>>()?;
        state.work(|scene| scene.animate(&moved))?;
        Ok(())
    })
}
