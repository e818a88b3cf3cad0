//! Scenes from files, and from bytes of a host that has a file system of its own.

use std::ffi::{CString, c_char, c_void};
use std::sync::{Mutex, PoisonError};

use super::super::context::ContextHandle;
use super::super::descriptor::{boolean, descriptors, read, read_optional, slice};
use super::super::status::{Fault, Status};
use super::super::text::{optional_text, text};
use super::handle::{SceneHandle, create_scene};
use crate::scene::{LoadOptions, Scene};

/// What loading may do. Zeros are the defaults, which are safe for scenes of unknown origin.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct LoadDescriptor {
    /// sizeof(irradia_load_descriptor).
    pub size: usize,
    /// 1: the glTF file may name files outside of its own folder. 0: not.
    pub allow_outside_files: u32,
    /// Longest side of an image, texels; 0: 16384.
    pub image_side: u32,
    /// Bytes of all textures at four a texel; 0: 4 GiB.
    pub texture_bytes: u64,
    /// Bytes of the scene's files together; 0: 8 GiB.
    pub file_bytes: u64,
}

/// Reads a file of the host's that a glTF file names.
///
/// `uri`: its name as the glTF file has it, percent-encoding undone, UTF-8.
/// `buffer`: null: only the length is asked for. Otherwise `capacity` bytes to fill.
/// `length`: to be set to the file's length in bytes.
///
/// Returns 0, or anything else where there is no such file. It may be called from threads of the library's own, one call at a time, while the scene is being
/// loaded. It must not call the library.
pub type ReadFunction = Option<
    unsafe extern "C" fn(
        user: *mut c_void,
        uri: *const c_char,
        buffer: *mut c_void,
        capacity: usize,
        length: *mut usize,
    ) -> u32,
>;

/// A glTF file in memory.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SceneBytes {
    /// sizeof(irradia_scene_bytes).
    pub size: usize,
    /// What messages call the scene; null: "scene".
    pub name: *const c_char,
    /// The bytes of a .gltf or .glb file; not needed any more once the call returns.
    pub bytes: *const c_void,
    /// How many.
    pub byte_count: usize,
    /// Reads the files that it names; null: a file that names others is an error.
    pub read: ReadFunction,
    /// Given to `read`.
    pub read_user: *mut c_void,
}

descriptors! {
    LoadDescriptor = "load descriptor", size_of::<LoadDescriptor>();
    SceneBytes = "descriptor of the scene's bytes", size_of::<SceneBytes>();
}

/// # Safety
/// `descriptor` is null or a descriptor.
unsafe fn load_options(descriptor: *const LoadDescriptor) -> Result<LoadOptions, Fault> {
    // SAFETY: the caller's.
    let Some(given) = (unsafe { read_optional(descriptor) })? else { return Ok(LoadOptions::default()) };
    let allow = boolean(given.allow_outside_files, "allow_outside_files")?;
    Ok(LoadOptions::default().with(|options| {
        options.allow_outside_files = allow;
        if given.image_side > 0 {
            options.image_side = given.image_side;
        }
        if given.texture_bytes > 0 {
            options.texture_bytes = given.texture_bytes;
        }
        if given.file_bytes > 0 {
            options.file_bytes = given.file_bytes;
        }
    }))
}

/// Opens a scene by its name: a .gltf or .glb file's path, or a built-in scene such as "cornell-point".
///
/// `context`, `scene`: as for irradia_scene_create(). `load`: null for the defaults.
///
/// Errors: IRRADIA_ERROR_SCENE if there is none, or the file cannot be read or is not one. What was left out or changed is told as IRRADIA_KIND_WARNING.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_open(
    context: *const ContextHandle,
    name_or_path: *const c_char,
    load: *const LoadDescriptor,
    scene: *mut *mut SceneHandle,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    let given = unsafe { (text(name_or_path, "the scene's name"), load_options(load)) };
    // SAFETY: as above.
    unsafe { create_scene(context, scene, move || Ok(Scene::open_with(given.0?, &given.1?)?)) }
}

/// Reads a scene from the bytes of a .gltf or .glb file, and the files that it names through the host.
///
/// As irradia_scene_open(); `allow_outside_files` means nothing here: what a name leads to is the host's affair.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_from_bytes(
    context: *const ContextHandle,
    source: *const SceneBytes,
    load: *const LoadDescriptor,
    scene: *mut *mut SceneHandle,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    let given = unsafe { (given_bytes(source), load_options(load)) };
    let make = move || {
        let (GivenBytes { name, bytes, files }, options) = (given.0?, given.1?);
        let files = files.map(Mutex::new);
        let Some(files) = &files else { return Ok(Scene::from_bytes_with(name, bytes, None, &options)?) };
        let read = |uri: &str| files.lock().unwrap_or_else(PoisonError::into_inner).read(uri, options.file_bytes);
        Ok(Scene::from_bytes_by(name, bytes, &read, &options)?)
    };
    // SAFETY: as above.
    unsafe { create_scene(context, scene, make) }
}

struct GivenBytes<'a> {
    name: &'a str,
    bytes: &'a [u8],
    files: Option<HostFiles>,
}

/// # Safety
/// `source` is null, which is a fault, or what the header asks for.
unsafe fn given_bytes<'a>(source: *const SceneBytes) -> Result<GivenBytes<'a>, Fault> {
    // SAFETY: the caller's.
    let source = unsafe { read(source) }?;
    // SAFETY: as above.
    let name = unsafe { optional_text(source.name, "the scene's name") }?.unwrap_or("scene");
    // SAFETY: as above.
    let bytes = unsafe { slice(source.bytes.cast::<u8>(), source.byte_count, "the scene's bytes") }?;
    let files = source.read.is_some().then_some(HostFiles { read: source.read, user: source.read_user });
    Ok(GivenBytes { name, bytes, files })
}

struct HostFiles {
    read: ReadFunction,
    user: *mut c_void,
}

// SAFETY: the header says that the function is called from threads of the library's own, one call at a time.
unsafe impl Send for HostFiles {}

impl HostFiles {
    fn read(&mut self, uri: &str, most: u64) -> Result<Vec<u8>, String> {
        let missing = || format!("the host has no file {uri:?}");
        let (Some(read), Ok(name)) = (self.read, CString::new(uri)) else { return Err(missing()) };
        let mut length = 0;
        // SAFETY: the host's function with the host's pointer; without a buffer it writes the length alone.
        let status = unsafe { read(self.user, name.as_ptr(), std::ptr::null_mut(), 0, &mut length) };
        if status != 0 {
            return Err(missing());
        }
        if length as u64 > most {
            return Err(format!("the file {uri:?} has {length} bytes, more than the {most} that may be read"));
        }
        let mut bytes = vec![0_u8; length];
        let mut filled = 0;
        // SAFETY: as above, with a buffer of as many bytes.
        let status = unsafe { read(self.user, name.as_ptr(), bytes.as_mut_ptr().cast(), length, &mut filled) };
        if status != 0 || filled != length {
            return Err(format!("the host could not read {uri:?}: {filled} of {length} bytes"));
        }
        Ok(bytes)
    }
}
