//! Accessors: typed arrays in the file's buffers, read with every offset, stride and count checked before anything is
//! allocated. Integer components are turned to floats here, so that the rest of the loader sees only floats and indices.

use super::container::Storage;
use super::document::{self, Document, get};
use std::sync::atomic::{AtomicU64, Ordering};

/// Bytes that may be kept for each byte that was read from disk.
const KEEP_RATIO: u64 = 16;
/// Bytes that may be unpacked for each byte read. More than are kept, since many primitives may share one large vertex array
/// of which each uses, and keeps, a small part.
const UNPACK_RATIO: u64 = 256;
/// Both may be exceeded by this much, so that tiny files with sparse accessors have room.
const ALLOWANCE: u64 = 16 << 20;

#[derive(Clone, Copy, PartialEq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn from_code(code: u64) -> Option<Self> {
        Some(match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }
}

/// `count` elements, `stride` bytes apart; `bytes` holds them all.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a [u8]> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).map(move |element| &bytes[element * stride..element * stride + size])
    }
}

/// Whether integers without `normalized` count as normalised all the same.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Integers {
    AsDeclared,
    Normalized,
}

/// Reads accessors and keeps account of how much they unpack to.
pub(super) struct Accessors<'a> {
    document: &'a Document,
    storage: &'a Storage<'a>,
    unpacked: AtomicU64,
    kept: AtomicU64,
}

impl<'a> Accessors<'a> {
    pub(super) fn new(document: &'a Document, storage: &'a Storage<'a>) -> Self {
        Accessors { document, storage, unpacked: AtomicU64::new(0), kept: AtomicU64::new(0) }
    }

    /// Components per element (1 to 4) that accessor `index` declares.
    pub(super) fn width(&self, index: usize) -> Result<usize, String> {
        let shape = &get(&self.document.accessors, index, "accessor")?.shape;
        match shape.as_str() {
            "SCALAR" => Ok(1),
            "VEC2" => Ok(2),
            "VEC3" => Ok(3),
            "VEC4" => Ok(4),
            _ => Err(format!("accessor {index} has type {shape:?} where a scalar or a vector belongs")),
        }
    }

    /// Bytes that the accessor's elements occupy in the file, gaps of a stride not counted. Zero for an invalid accessor.
    pub(super) fn stored_bytes(&self, index: usize) -> u64 {
        let Ok(accessor) = get(&self.document.accessors, index, "accessor") else {
            return 0;
        };
        let component = Component::from_code(accessor.component_type).map_or(0, Component::size) as u64;
        accessor.count.saturating_mul(component * self.width(index).unwrap_or(0) as u64)
    }

    /// Elements of exactly `N` components as floats.
    pub(super) fn vectors<const N: usize>(&self, index: usize, integers: Integers) -> Result<Vec<[f32; N]>, String> {
        if self.width(index)? != N {
            return Err(format!("accessor {index} has {} components per element where {N} belong", self.width(index)?));
        }
        let accessor = get(&self.document.accessors, index, "accessor")?;
        let component = component(accessor.component_type, index)?;
        let normalized = accessor.normalized || integers == Integers::Normalized;
        self.read(index, accessor, component, N, |bytes| {
            std::array::from_fn(|lane| float(&bytes[lane * component.size()..], component, normalized))
        })
    }

    /// Scalar elements as floats.
    pub(super) fn scalars(&self, index: usize) -> Result<Vec<f32>, String> {
        Ok(self.vectors::<1>(index, Integers::AsDeclared)?.into_iter().map(|[value]| value).collect())
    }

    /// Vertex indices: unsigned scalars of 1, 2 or 4 bytes.
    pub(super) fn indices(&self, index: usize) -> Result<Vec<u32>, String> {
        let accessor = get(&self.document.accessors, index, "accessor")?;
        let component = component(accessor.component_type, index)?;
        if self.width(index)? != 1 || !matches!(component, Component::U8 | Component::U16 | Component::U32) {
            return Err(format!("accessor {index} holds indices but is not a scalar of 1, 2 or 4 unsigned bytes"));
        }
        self.read(index, accessor, component, 1, |bytes| unsigned(bytes, component))
    }

    fn read<T: Clone + Zero>(
        &self,
        index: usize,
        accessor: &document::Accessor,
        component: Component,
        width: usize,
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, String> {
        let size = component.size() * width;
        let base = match accessor.buffer_view {
            Some(view) => Some(self.elements(index, view, accessor.byte_offset, accessor.count, size)?),
            None => None,
        };
        self.charge(index, accessor.count.saturating_mul(size_of::<T>() as u64))?;
        let mut values = match &base {
            Some(elements) => elements.iter().map(&decode).collect(),
            // Without a buffer view all elements are zero; `charge` has bounded how many.
            None => vec![T::zero(); accessor.count as usize],
        };
        if let Some(sparse) = &accessor.sparse {
            let index_component = sparse.indices.component_type.and_then(Component::from_code);
            let index_component =
                index_component.filter(|c| matches!(c, Component::U8 | Component::U16 | Component::U32));
            let index_component =
                index_component.ok_or(format!("the sparse indices of accessor {index} are not unsigned integers"))?;
            let indices = self.elements(
                index,
                sparse.indices.buffer_view,
                sparse.indices.byte_offset,
                sparse.count,
                index_component.size(),
            )?;
            let replaced =
                self.elements(index, sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, size)?;
            for (at, value) in indices.iter().zip(replaced.iter()) {
                let at = unsigned(at, index_component) as usize;
                let slot = values.get_mut(at).ok_or(format!(
                    "a sparse index of accessor {index} is {at}, past its {} elements",
                    accessor.count
                ))?;
                *slot = decode(value);
            }
        }
        Ok(values)
    }

    /// Takes the bytes of `count` elements from a view, or says what reaches past what.
    fn elements(
        &self,
        accessor: usize,
        view: usize,
        offset: u64,
        count: u64,
        size: usize,
    ) -> Result<Elements<'_>, String> {
        let stride = get(&self.document.buffer_views, view, "buffer view")?.byte_stride.filter(|&stride| stride != 0);
        let stride = stride.unwrap_or(size as u64);
        if stride < size as u64 {
            return Err(format!(
                "buffer view {view} has a stride of {stride} bytes, less than the {size} of an element of accessor {accessor}"
            ));
        }
        let bytes = self.storage.view(self.document, view)?;
        let length = match count {
            0 => Some(0),
            _ => (count - 1).checked_mul(stride).and_then(|length| length.checked_add(size as u64)),
        };
        let end = length.and_then(|length| length.checked_add(offset)).filter(|&end| end <= bytes.len() as u64);
        if end.is_none() {
            let held = bytes.len();
            return Err(format!(
                "accessor {accessor} ({count} elements, {stride} bytes apart, from byte {offset}) reaches past the {held} bytes of buffer view {view}"
            ));
        }
        // The checks above bound all of these by the length of a slice, so they fit.
        Ok(Elements {
            bytes: bytes.get(offset as usize..).unwrap_or_default(),
            stride: stride as usize,
            size,
            count: count as usize,
        })
    }

    /// Accounts for unpacking an accessor, before it is done.
    fn charge(&self, index: usize, bytes: u64) -> Result<(), String> {
        self.spend(&self.unpacked, UNPACK_RATIO, bytes)
            .map_err(|limit| format!("accessor {index} brings the data to unpack to more than {limit}"))
    }

    /// Accounts for data that stays in the scene.
    pub(super) fn keep(&self, bytes: usize) -> Result<(), String> {
        self.spend(&self.kept, KEEP_RATIO, bytes as u64)
            .map_err(|limit| format!("it brings the scene's data to more than {limit}"))
    }

    fn spend(&self, spent: &AtomicU64, ratio: u64, bytes: u64) -> Result<(), String> {
        let file_bytes = self.storage.total_bytes;
        let limit = file_bytes.saturating_mul(ratio).saturating_add(ALLOWANCE);
        // What is refused counts too, as far as it cannot overflow: the file is not loaded anyway.
        let before = spent.fetch_add(bytes.min(limit), Ordering::Relaxed);
        if before.saturating_add(bytes) > limit {
            return Err(format!("{ratio} times the file's {file_bytes} bytes; such a file is not loaded"));
        }
        Ok(())
    }
}

/// What an element is where a sparse accessor has no base.
pub(super) trait Zero {
    fn zero() -> Self;
}

impl Zero for u32 {
    fn zero() -> Self {
        0
    }
}

impl<const N: usize> Zero for [f32; N] {
    fn zero() -> Self {
        [0.0; N]
    }
}

fn component(code: u64, index: usize) -> Result<Component, String> {
    Component::from_code(code).ok_or(format!("accessor {index} has the unknown component type {code}"))
}

fn unsigned(bytes: &[u8], component: Component) -> u32 {
    match component.size() {
        1 => bytes[0].into(),
        2 => u16::from_le_bytes([bytes[0], bytes[1]]).into(),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}

/// One component as a float; normalised integers by the equations of the glTF specification, section 3.6.2.2.
fn float(bytes: &[u8], component: Component, normalized: bool) -> f32 {
    let (value, largest) = match component {
        Component::F32 => return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        Component::I8 => (f32::from(bytes[0] as i8), 127.0),
        Component::U8 => (f32::from(bytes[0]), 255.0),
        Component::I16 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0),
        Component::U16 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0),
        Component::U32 => (unsigned(bytes, component) as f32, u32::MAX as f32),
    };
    if normalized { (value / largest).max(-1.0) } else { value }
}
