//! Textures.

use std::ffi::{c_char, c_void};

use super::super::descriptor::{boolean, descriptors, read, slice};
use super::super::status::{Fault, Status};
use super::super::text::optional_text;
use super::handle::{Id, SceneHandle, SceneState, add};
use crate::scene::{Texture, Wrap};

/// Outside 0 to 1 the texture starts again.
pub const IRRADIA_WRAP_REPEAT: u32 = 0;
/// It turns back.
pub const IRRADIA_WRAP_MIRROR: u32 = 1;
/// Its border goes on.
pub const IRRADIA_WRAP_CLAMP: u32 = 2;

/// Texels, and how they are read.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TextureDescriptor {
    /// sizeof(irradia_texture_descriptor).
    pub size: usize,
    /// Null: none.
    pub name: *const c_char,
    /// Texels in a row, at least 1.
    pub width: u32,
    /// Rows, at least 1; the top one is first.
    pub height: u32,
    /// Four bytes a texel: red, green, blue, alpha. Copied by the call.
    pub texels: *const c_void,
    /// Bytes from one row to the next; 0: 4 · width.
    pub row_stride: usize,
    /// Along u and along v, IRRADIA_WRAP_….
    pub wrap: [u32; 2],
    /// 1: red, green and blue are sRGB-encoded, as base and emissive colours are; 0: linear. Alpha is always linear.
    pub srgb: u32,
    /// 1: magnified texels stay squares.
    pub nearest: u32,
}

descriptors! {
    TextureDescriptor = "texture descriptor", size_of::<TextureDescriptor>();
}

fn wrap(value: u32) -> Result<Wrap, Fault> {
    match value {
        IRRADIA_WRAP_REPEAT => Ok(Wrap::Repeat),
        IRRADIA_WRAP_MIRROR => Ok(Wrap::Mirror),
        IRRADIA_WRAP_CLAMP => Ok(Wrap::Clamp),
        _ => Err(Fault::argument(format!("the texture's wrap is {value}; write one of IRRADIA_WRAP_…"))),
    }
}

/// Adds a texture, for materials to use.
///
/// `id`: receives its identifier; may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_add_texture(
    scene: *mut SceneHandle,
    descriptor: *const TextureDescriptor,
    id: *mut Id,
) -> Status {
    let copy = |state: &mut SceneState| {
        // SAFETY: the host's pointers are what the header asks for.
        let given = unsafe { read(descriptor) }?;
        // SAFETY: as above.
        let name = unsafe { optional_text(given.name, "the texture's name") }?.unwrap_or_default().to_owned();
        let (row, rows) = (4 * given.width as usize, given.height as usize);
        let stride = if given.row_stride == 0 { row } else { given.row_stride };
        if row == 0 || rows == 0 || stride < row {
            let sentence = format!("{}×{} texels in rows of {stride} bytes are no texture", given.width, given.height);
            return Err(Fault::argument(sentence));
        }
        let bytes = stride.checked_mul(rows - 1).and_then(|bytes| bytes.checked_add(row));
        let bytes = bytes.ok_or_else(|| Fault::argument("the texture's rows do not fit into memory"))?;
        // SAFETY: as above.
        let texels = unsafe { slice(given.texels.cast::<u8>(), bytes, "bytes of the texture") }?;
        let texture = Texture {
            name,
            width: given.width,
            height: given.height,
            rgba8: texels.chunks(stride).flat_map(|line| &line[..row]).copied().collect(),
            wrap: [wrap(given.wrap[0])?, wrap(given.wrap[1])?],
            nearest: boolean(given.nearest, "nearest")?,
            srgb: boolean(given.srgb, "srgb")?,
        };
        Ok(state.scene.add_texture(texture)?.0)
    };
    // SAFETY: as above.
    unsafe { add(scene, id, copy) }
}
