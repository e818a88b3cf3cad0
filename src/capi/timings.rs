//! What a frame cost, pass by pass, and what its pieces hold.

use std::ffi::c_char;

use super::border::call;
use super::descriptor::{descriptors, write};
use super::frame::FrameHandle;
use super::status::{Fault, Status};

/// What a frame cost as a whole.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TimingsDescriptor {
    /// sizeof(irradia_timings_descriptor).
    pub size: usize,
    /// Milliseconds on the device, from the frame's start to its end.
    pub gpu_ms: f64,
    /// Milliseconds of the call.
    pub host_ms: f64,
    /// Of these: bringing what changed of the scene onto the device.
    pub upload_ms: f64,
    /// Of these: compiling pipelines; 0 once they exist.
    pub pipeline_ms: f64,
    /// How many passes irradia_frame_pass() tells of, the skipped ones included.
    pub pass_count: usize,
    /// How many pieces irradia_frame_memory() tells of.
    pub memory_count: usize,
    /// Samples of every pixel, of `path` and `sppm`; otherwise 0.
    pub samples: u32,
    /// Zero.
    pub reserved: u32,
    /// Rays that these took.
    pub rays: u64,
    /// Bytes of `upload_ms`: vertices, instances, materials, textures, as rasterisers read them.
    pub upload_bytes: u64,
}

/// One pass. The texts stand as long as the frame does.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct PassDescriptor {
    /// sizeof(irradia_pass_descriptor).
    pub size: usize,
    /// Its piece and its name, "diffuse/vpl/gather".
    pub name: *const c_char,
    /// Milliseconds on the device; negative if it was not timed or did not run.
    pub ms: f64,
    /// Why it did not run; null: it did.
    pub skipped: *const c_char,
}

/// What one piece holds on the device. The text stands as long as the frame does.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct MemoryDescriptor {
    /// sizeof(irradia_memory_descriptor).
    pub size: usize,
    /// The piece; "scene" is the scene itself.
    pub piece: *const c_char,
    /// Bytes.
    pub bytes: u64,
}

descriptors! {
    TimingsDescriptor = "timings descriptor", size_of::<TimingsDescriptor>();
    PassDescriptor = "pass descriptor", size_of::<PassDescriptor>();
    MemoryDescriptor = "memory descriptor", size_of::<MemoryDescriptor>();
}

/// Fills a descriptor, whose size is set, with what the frame cost.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_frame_timings(frame: *const FrameHandle, timings: *mut TimingsDescriptor) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(frame) }?;
        let (cost, estimate) = (&state.frame.timings, state.frame.estimate.as_ref());
        let descriptor = TimingsDescriptor {
            size: size_of::<TimingsDescriptor>(),
            gpu_ms: cost.gpu_ms,
            host_ms: cost.host_ms,
            upload_ms: cost.upload_ms,
            pipeline_ms: cost.pipeline_ms,
            pass_count: cost.passes.len(),
            memory_count: state.texts.pieces.len(),
            samples: estimate.map_or(0, |estimate| estimate.spp),
            reserved: 0,
            rays: estimate.map_or(0, |estimate| estimate.rays),
            upload_bytes: cost.upload_bytes,
        };
        // SAFETY: as above.
        unsafe { write(timings, &descriptor) }
    })
}

/// Fills a descriptor, whose size is set, with one pass; `index` below `pass_count`, in the order in which passes run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_frame_pass(
    frame: *const FrameHandle,
    index: usize,
    pass: *mut PassDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(frame) }?;
        let Some((name, skipped)) = state.texts.passes.get(index) else {
            return Err(Fault::argument(format!(
                "the frame has {} passes, none of index {index}",
                state.texts.passes.len()
            )));
        };
        let descriptor = PassDescriptor {
            size: size_of::<PassDescriptor>(),
            name: name.as_ptr(),
            ms: state.frame.timings.passes[index].ms.unwrap_or(-1.0),
            skipped: skipped.as_ref().map_or(std::ptr::null(), |reason| reason.as_ptr()),
        };
        // SAFETY: as above.
        unsafe { write(pass, &descriptor) }
    })
}

/// Fills a descriptor, whose size is set, with what one piece holds; `index` below `memory_count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_frame_memory(
    frame: *const FrameHandle,
    index: usize,
    memory: *mut MemoryDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(frame) }?;
        let pieces = &state.texts.pieces;
        let Some((piece, bytes)) = pieces.get(index) else {
            return Err(Fault::argument(format!("the frame tells of {} pieces, none of index {index}", pieces.len())));
        };
        let size = size_of::<MemoryDescriptor>();
        let descriptor = MemoryDescriptor { size, piece: piece.as_ptr(), bytes: *bytes };
        // SAFETY: as above.
        unsafe { write(memory, &descriptor) }
    })
}
