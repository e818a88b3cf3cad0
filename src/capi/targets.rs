//! Images and buffers of the host's that frames are left in.

use std::sync::Arc;

use super::context::Shared;
use super::descriptor::{Descriptor, boolean, descriptors, read};
use super::slots::{IRRADIA_SLOT_IMAGE, slot_of};
use super::status::Fault;
use crate::renderer::Handed;
use crate::slot::Slot;
use crate::vulkan::{ForeignPlace, ForeignTarget, ForeignUse, SharedBuffer, TimelinePoint};

/// Of a resource that no other queue family owns.
pub const IRRADIA_FAMILY_SAME: u32 = 0xFFFF_FFFF;

/// How the host uses a resource before or after the copy: a half of its barrier.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ResourceUse {
    /// VkImageLayout; before, VK_IMAGE_LAYOUT_UNDEFINED if what it holds is of no interest. Without meaning for buffers.
    pub layout: u32,
    /// The queue family that owns it, which then has the other half of the barrier; IRRADIA_FAMILY_SAME: that of the context's queue.
    pub family: u32,
    /// VkPipelineStageFlags2 of the uses before, or after.
    pub stages: u64,
    /// VkAccessFlags2 of these.
    pub access: u64,
}

/// Where a slot is left on the device: an image or a buffer of the host's device, or a shared buffer of the context. The copy is one command; nothing of it passes through
/// the host's memory.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TargetDescriptor {
    /// sizeof(irradia_target_descriptor), in each of an array.
    pub size: usize,
    /// One of IRRADIA_SLOT_… but IRRADIA_SLOT_DISPLAY. Radiance in W/(m² sr), linear Rec. 709; a fourth channel of no meaning.
    pub slot: u32,
    /// 1: `resource` is a VkBuffer with VK_BUFFER_USAGE_TRANSFER_DST_BIT, four floats a pixel. 0: a VkImage with VK_IMAGE_USAGE_TRANSFER_DST_BIT, of two dimensions, at least as
    /// large as the frame, of which the first layer of the first mip level is filled.
    pub is_buffer: u32,
    /// The handle.
    pub resource: u64,
    /// Of an image, its VkFormat. VK_FORMAT_R32G32B32A32_SFLOAT is copied; other colours in floats, in parts of 1 or in sRGB are converted as vkCmdBlitImage does, if the
    /// device can.
    pub format: u32,
    /// Of a buffer, pixels from one row to the next; 0: the frame's width.
    pub row_pixels: u32,
    /// Of a buffer, bytes to the first pixel, a multiple of 16.
    pub offset: u64,
    /// How the host used it until now.
    pub before: ResourceUse,
    /// How the host will use it.
    pub after: ResourceUse,
}

/// A timeline semaphore of the context's device, and a value of it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SemaphorePoint {
    /// VkSemaphore of type VK_SEMAPHORE_TYPE_TIMELINE.
    pub semaphore: u64,
    /// Its value.
    pub value: u64,
}

descriptors! {
    TargetDescriptor = "target descriptor", size_of::<TargetDescriptor>();
}

fn foreign_use(given: ResourceUse) -> ForeignUse {
    let ResourceUse { layout, family, stages, access } = given;
    // Layouts of extensions are above the range of neither.
    ForeignUse { layout: layout.cast_signed(), family, stages, access }
}

fn target(given: &TargetDescriptor, width: u32) -> Result<(Option<Slot>, ForeignTarget), Fault> {
    let slot = match given.slot {
        IRRADIA_SLOT_IMAGE => None,
        bit => Some(slot_of(bit).ok_or_else(|| {
            Fault::argument(format!("a target's slot is {bit}, which is not one of IRRADIA_SLOT_… with radiance"))
        })?),
    };
    if given.resource == 0 {
        return Err(Fault::argument("a target has no resource"));
    }
    let place = if boolean(given.is_buffer, "is_buffer")? {
        if !given.offset.is_multiple_of(16) || (given.row_pixels != 0 && given.row_pixels < width) {
            let sentence = format!(
                "a target begins at byte {} and has rows of {} pixels: the one is a multiple of 16, the other at least the frame's width",
                given.offset, given.row_pixels
            );
            return Err(Fault::argument(sentence));
        }
        ForeignPlace::Buffer { buffer: given.resource, offset: given.offset, row_pixels: given.row_pixels }
    } else {
        if given.format == 0 {
            return Err(Fault::argument("a target is an image without a VkFormat"));
        }
        ForeignPlace::Image { image: given.resource, format: given.format.cast_signed() }
    };
    let (before, after) = (foreign_use(given.before), foreign_use(given.after));
    if after.layout == 0 && !boolean(given.is_buffer, "is_buffer")? {
        return Err(Fault::argument("a target's layout after the copy cannot be VK_IMAGE_LAYOUT_UNDEFINED"));
    }
    Ok((slot, ForeignTarget { place, before, after }))
}

/// All targets of a frame `width` pixels wide.
///
/// # Safety
/// `pointer` is what the header asks for.
pub(super) unsafe fn targets(
    pointer: *const TargetDescriptor,
    count: usize,
    width: u32,
) -> Result<Vec<(Option<Slot>, ForeignTarget)>, Fault> {
    if count == 0 {
        return Ok(Vec::new());
    }
    // SAFETY: the caller's: the first one is there.
    let stride = unsafe { read(pointer) }?.size;
    let one = |index: usize| {
        // SAFETY: the caller's: elements are as far apart as the first one is large.
        let given = unsafe { read(pointer.wrapping_byte_add(index * stride)) }?;
        if given.size != stride {
            let sentence =
                format!("{} {index} has {} bytes and the first one {stride}", TargetDescriptor::NAME, given.size);
            return Err(Fault::argument(sentence));
        }
        target(&given, width)
    };
    (0..count).map(one).collect()
}

/// The shared buffers among targets of a context on a device of its own, which knows no other resources.
pub(super) fn shared_targets(
    shared: &Shared,
    handed: &Handed,
    [width, height]: [u32; 2],
) -> Result<Vec<Arc<SharedBuffer>>, Fault> {
    let known = shared.buffers();
    let one = |(_, target): &(Option<Slot>, ForeignTarget)| {
        let ForeignPlace::Buffer { buffer, offset, row_pixels } = target.place else {
            return Err(Fault::argument(
                "an image is of a host's device; this context, on one of its own, fills shared buffers",
            ));
        };
        let found = known.get(&buffer).cloned().ok_or_else(|| {
            Fault::argument("a target is no shared buffer of this context, which is on a device of its own")
        })?;
        let row = u64::from(if row_pixels == 0 { width } else { row_pixels });
        let pixels = row * u64::from(height.saturating_sub(1)) + u64::from(width);
        let end = pixels.checked_mul(16).and_then(|bytes| bytes.checked_add(offset));
        if end.is_none_or(|end| end > found.bytes) {
            let sentence = format!(
                "a shared buffer of {} bytes does not hold {width}×{height} pixels of 16 bytes in rows of {row} from byte {offset} on",
                found.bytes
            );
            return Err(Fault::argument(sentence));
        }
        Ok(found)
    };
    handed.targets.iter().map(one).collect()
}

/// Points as the engine has them.
pub(super) fn points(given: &[SemaphorePoint]) -> Result<Vec<TimelinePoint>, Fault> {
    if given.iter().any(|point| point.semaphore == 0) {
        return Err(Fault::argument("a semaphore is null"));
    }
    Ok(given.iter().map(|&SemaphorePoint { semaphore, value }| TimelinePoint { semaphore, value }).collect())
}
