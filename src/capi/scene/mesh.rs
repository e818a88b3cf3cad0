//! Meshes from the host's memory.

use std::ffi::{c_char, c_void};
use std::mem::MaybeUninit;

use rayon::prelude::*;

use super::super::border::call;
use super::super::descriptor::{Descriptor, descriptors, read, slice, zero};
use super::super::status::{Fault, Status};
use super::super::text::optional_text;
use super::handle::{Id, SceneHandle, SceneState, add, index_of};
use crate::scene::{
    CHUNK, MaterialId, Mesh, MeshId, Primitive, Scene, SceneError, all_finite, all_unit, first_endless, largest_index,
};

/// 32-bit floats.
pub const IRRADIA_FORMAT_FLOAT32: u32 = 0;
/// Bytes that stand for 0 to 1.
pub const IRRADIA_FORMAT_UNORM8: u32 = 1;
/// 16-bit whole numbers that stand for 0 to 1.
pub const IRRADIA_FORMAT_UNORM16: u32 = 2;

/// 32-bit indices.
pub const IRRADIA_INDEX_UINT32: u32 = 0;
/// 16-bit indices.
pub const IRRADIA_INDEX_UINT16: u32 = 1;

/// One attribute of all vertices.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct VertexAttribute {
    /// The first vertex's; null: the vertices do not have it.
    pub data: *const c_void,
    /// Bytes from one vertex to the next; 0: they lie one behind the other.
    pub stride: usize,
    /// One of IRRADIA_FORMAT_…; positions, normals and tangents are floats.
    pub format: u32,
    /// Zero.
    pub reserved: u32,
}

/// A list of triangles with one material.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct PrimitiveDescriptor {
    /// sizeof(irradia_primitive_descriptor), in each of an array.
    pub size: usize,
    /// The material; not 0.
    pub material: Id,
    /// One of IRRADIA_INDEX_….
    pub index_format: u32,
    /// Three indices a triangle, counter-clockwise as its front is seen; null: vertices in their order.
    pub indices: *const c_void,
    /// How many.
    pub index_count: usize,
    /// How many vertices.
    pub vertex_count: usize,
    /// x, y, z; metres after the node's transform. Finite.
    pub positions: VertexAttribute,
    /// x, y, z; made unit vectors. Without them triangles are flat.
    pub normals: VertexAttribute,
    /// x, y, z along +u, and ±1: the bitangent is that times normal × tangent. Where a normal texture needs them and they are not given, they are made. They are kept
    /// where the material has a normal texture when the mesh is given: set the material first, or the mesh again.
    pub tangents: VertexAttribute,
    /// u, v of the sets 0 and 1; v grows downwards in the image.
    pub texcoords: [VertexAttribute; 2],
    /// Linear red, green, blue, alpha, which multiply the base colour.
    pub colors: VertexAttribute,
}

/// Primitives that nodes place together.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct MeshDescriptor {
    /// sizeof(irradia_mesh_descriptor).
    pub size: usize,
    /// Null: none.
    pub name: *const c_char,
    /// An array; its elements are as far apart as the size of the first one says.
    pub primitives: *const PrimitiveDescriptor,
    /// How many.
    pub primitive_count: usize,
}

descriptors! {
    PrimitiveDescriptor = "primitive descriptor", size_of::<PrimitiveDescriptor>();
    MeshDescriptor = "mesh descriptor", size_of::<MeshDescriptor>();
}

/// Values of the host's, and whether all of them were found to be what they must while they were copied, a part at a time, while a near cache had it.
struct Copied<T> {
    values: T,
    sound: bool,
}

/// N numbers of each vertex.
///
/// # Safety
/// `attribute` is what the header asks for, of `count` vertices.
unsafe fn vertices<const N: usize>(
    attribute: &VertexAttribute,
    count: usize,
    (what, formats): (&str, &[u32]),
    sound: fn(&[[f32; N]]) -> bool,
) -> Result<Copied<Option<Vec<[f32; N]>>>, Fault> {
    zero(attribute.reserved, what)?;
    if attribute.data.is_null() || count == 0 {
        return Ok(Copied { values: None, sound: true });
    }
    if !formats.contains(&attribute.format) {
        return Err(Fault::argument(format!("{what} cannot be of format {}", attribute.format)));
    }
    let width = match attribute.format {
        IRRADIA_FORMAT_UNORM8 => N,
        IRRADIA_FORMAT_UNORM16 => 2 * N,
        _ => 4 * N,
    };
    let stride = if attribute.stride == 0 { width } else { attribute.stride };
    if stride < width {
        return Err(Fault::argument(format!("{what} are {stride} bytes apart and {width} bytes long")));
    }
    let bytes = stride.checked_mul(count - 1).and_then(|bytes| bytes.checked_add(width));
    let bytes = bytes.ok_or_else(|| Fault::argument(format!("{count} {what} do not fit into memory")))?;
    // SAFETY: the caller's.
    let bytes = unsafe { slice(attribute.data.cast::<u8>(), bytes, what) }?;
    let value: fn(&[u8]) -> f32 = match attribute.format {
        IRRADIA_FORMAT_UNORM8 => |bytes| f32::from(bytes[0]) / 255.0,
        IRRADIA_FORMAT_UNORM16 => |bytes| f32::from(u16::from_ne_bytes([bytes[0], bytes[1]])) / 65535.0,
        _ => |bytes| f32::from_ne_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    };
    let number = width / N;
    if attribute.format == IRRADIA_FORMAT_FLOAT32 && stride == width {
        let Copied { values, sound } = copied(bytes, sound);
        return Ok(Copied { values: Some(values), sound });
    }
    let vertex = |vertex: &[u8]| std::array::from_fn(|axis| value(&vertex[axis * number..]));
    let values: Vec<_> = bytes.par_chunks(stride).map(vertex).collect();
    let sound = values.par_chunks(CHUNK).all(sound);
    Ok(Copied { values: Some(values), sound })
}

/// All values in their order, on all threads: what takes longest is that the system hands out fresh memory. It is not filled with zeros first, which memory that was used before would have to be.
fn copied<T: bytemuck::AnyBitPattern + Send + Sync>(
    bytes: &[u8],
    sound: impl Fn(&[T]) -> bool + Sync,
) -> Copied<Vec<T>> {
    let count = bytes.len() / size_of::<T>();
    let mut values: Vec<T> = Vec::with_capacity(count);
    let fresh = &mut values.spare_capacity_mut()[..count];
    ask_for_large_pages(fresh);
    let (chunks, parts) = (fresh.par_chunks_mut(CHUNK), bytes.par_chunks(CHUNK * size_of::<T>()));
    let copy = |(values, bytes): (&mut [MaybeUninit<T>], &[u8])| {
        assert!(bytes.len() >= size_of_val(values));
        // SAFETY: there are as many bytes as values take, and the two do not overlap: `values` was made in this call. Any bytes are a T, so that all of them are one then.
        let values = unsafe {
            bytes.as_ptr().copy_to_nonoverlapping(values.as_mut_ptr().cast(), size_of_val(values));
            std::slice::from_raw_parts(values.as_ptr().cast::<T>(), values.len())
        };
        sound(values)
    };
    let sound = chunks.zip(parts).map(copy).reduce(|| true, |one, other| one & other);
    // SAFETY: chunks and parts are as many, and so all values were copied.
    unsafe { values.set_len(count) };
    Copied { values, sound }
}

/// Most of what a copy into fresh memory takes is the system's, which hands it out by pages of 4 KiB unless it is asked for larger ones.
fn ask_for_large_pages<T>(values: &mut [T]) {
    #[cfg(target_os = "linux")]
    {
        const LARGE: usize = 2 << 20;
        let bytes = size_of_val(values);
        let before = values.as_ptr().cast::<u8>().align_offset(LARGE);
        let whole = bytes.saturating_sub(before) / LARGE * LARGE;
        if whole > 0 {
            let start = values.as_mut_ptr().wrapping_byte_add(before).cast();
            // SAFETY: these bytes are of `values`; the advice changes nothing of what they hold. A system that knows no such pages refuses it, which loses nothing.
            let _ = unsafe { rustix::mm::madvise(start, whole, rustix::mm::Advice::LinuxHugepage) };
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = values;
}

/// N finite numbers of each vertex, if it has them.
///
/// # Safety
/// As [`vertices`].
unsafe fn finite<const N: usize>(
    attribute: &VertexAttribute,
    count: usize,
    what: &str,
) -> Result<Option<Vec<[f32; N]>>, Fault> {
    let any = &[IRRADIA_FORMAT_FLOAT32, IRRADIA_FORMAT_UNORM8, IRRADIA_FORMAT_UNORM16];
    // SAFETY: the caller's.
    let Copied { values, sound } = unsafe { vertices(attribute, count, (what, any), all_finite) }?;
    let bad = values.as_ref().filter(|_| !sound).and_then(|values| first_endless(values));
    bad.map_or(Ok(values), |vertex| Err(Fault::argument(format!("{what} of vertex {vertex} are not finite"))))
}

/// # Safety
/// `given` is what the header asks for.
unsafe fn primitive(given: &PrimitiveDescriptor) -> Result<Copied<Primitive>, Fault> {
    let (count, floats) = (given.vertex_count, &[IRRADIA_FORMAT_FLOAT32][..]);
    let material = MaterialId(index_of(given.material, "material")?);
    // SAFETY: the caller's.
    let placed = unsafe { vertices::<3>(&given.positions, count, ("positions", floats), all_finite) }?;
    let positions = placed.values.ok_or_else(|| Fault::argument("a primitive has no positions"))?;
    let vertex_count = u32::try_from(count).map_err(|_| Fault::argument("a primitive has more than 2³² vertices"))?;
    let within = |indices: &[u32]| largest_index(indices) < vertex_count;
    let indices = match (given.indices.is_null(), given.index_format) {
        (true, _) => Copied { values: (0..vertex_count).collect(), sound: true },
        (_, IRRADIA_INDEX_UINT32) => {
            // SAFETY: the caller's.
            let long = unsafe { slice(given.indices.cast::<u32>(), given.index_count, "indices") }?;
            copied(bytemuck::cast_slice(long), within)
        }
        (_, IRRADIA_INDEX_UINT16) => {
            // SAFETY: the caller's.
            let short = unsafe { slice(given.indices.cast::<u16>(), given.index_count, "indices") }?;
            let long: Vec<u32> = short.iter().map(|&index| u32::from(index)).collect();
            let sound = within(&long);
            Copied { values: long, sound }
        }
        (_, other) => {
            return Err(Fault::argument(format!("the index format is {other}; write one of IRRADIA_INDEX_…")));
        }
    };
    // SAFETY: the caller's.
    let normals = unsafe { vertices(&given.normals, count, ("normals", floats), all_unit) }?;
    // SAFETY: the caller's.
    let values = unsafe {
        Primitive {
            positions,
            normals: normals.values,
            // Where they are used they are looked at.
            tangents: vertices(&given.tangents, count, ("tangents", floats), |_| true)?.values,
            texcoords: [
                finite(&given.texcoords[0], count, "texture coordinates")?,
                finite(&given.texcoords[1], count, "texture coordinates")?,
            ],
            colors: finite(&given.colors, count, "colours")?,
            indices: indices.values,
            material,
            source_bytes: 0,
        }
    };
    Ok(Copied { values, sound: placed.sound && normals.sound && indices.sound })
}

/// # Safety
/// `descriptor` is what the header asks for, or null, which is a fault.
unsafe fn take_mesh(
    state: &mut SceneState,
    descriptor: *const MeshDescriptor,
    take: impl FnOnce(&mut Scene, Mesh, bool) -> Result<MeshId, SceneError> + Send,
) -> Result<usize, Fault> {
    // SAFETY: the caller's.
    let given = unsafe { read(descriptor) }?;
    // SAFETY: the caller's.
    let name = unsafe { optional_text(given.name, "the mesh's name") }?.unwrap_or_default().to_owned();
    if given.primitive_count == 0 {
        return Err(Fault::argument(format!("the mesh {name:?} has no primitives")));
    }
    // SAFETY: the caller's: the first one is there.
    let stride = unsafe { read(given.primitives) }?.size;
    let descriptors = (0..given.primitive_count).map(|index| {
        let pointer = given.primitives.wrapping_byte_add(index * stride);
        // SAFETY: the caller's: elements are as far apart as the first one is large.
        let descriptor = unsafe { read(pointer) }?;
        if descriptor.size == stride {
            Ok(descriptor)
        } else {
            let sentence = format!(
                "{} {index} has {} bytes and the first one {stride}",
                PrimitiveDescriptor::NAME,
                descriptor.size
            );
            Err(Fault::argument(sentence))
        }
    });
    let descriptors = descriptors.collect::<Result<Vec<_>, Fault>>()?;
    let shared = Sent(descriptors);
    state.work(move |scene| {
        let Sent(descriptors) = { shared };
        let (mut primitives, mut sound) = (Vec::with_capacity(descriptors.len()), true);
        for descriptor in &descriptors {
            // SAFETY: the caller's; the host's memory stays as it is during the call.
            let Copied { values, sound: well } = unsafe { primitive(descriptor) }?;
            primitives.push(values);
            sound &= well;
        }
        Ok(take(scene, Mesh { name, primitives }, sound)?.0)
    })
}

/// Descriptors on their way to another thread.
struct Sent(Vec<PrimitiveDescriptor>);

// SAFETY: their pointers are read during the call alone, as the header says, by whichever thread.
unsafe impl Send for Sent {}

/// Adds a mesh; a node must place it before it is seen. Everything is copied.
///
/// `id`: receives its identifier; may be null.
///
/// Errors: IRRADIA_ERROR_ARGUMENT and IRRADIA_ERROR_SCENE for numbers that are not finite, indices beyond the vertices, materials that are not there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_add_mesh(
    scene: *mut SceneHandle,
    descriptor: *const MeshDescriptor,
    id: *mut Id,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    unsafe { add(scene, id, |state| take_mesh(state, descriptor, Scene::add_host_mesh)) }
}

/// Replaces a mesh wherever it stands, for instance by one whose vertices moved. It has as many primitives as before; anything else may differ.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_set_mesh(
    scene: *mut SceneHandle,
    id: Id,
    descriptor: *const MeshDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(scene) }?;
        let id = MeshId(index_of(id, "mesh")?);
        let replace = |scene: &mut Scene, mesh, sound| scene.set_host_mesh(id, mesh, sound).map(|()| id);
        // SAFETY: as above.
        unsafe { take_mesh(state, descriptor, replace) }.map(|_| ())
    })
}
