//! Frames: what is asked of one, and what comes back.

use std::ffi::{CString, c_char, c_void};

use super::border::{Guarded, call, give, handles, take};
use super::camera::{self, CameraDescriptor};
use super::descriptor::{descriptors, read};
use super::renderer::{RendererHandle, RendererState};
use super::scene::SceneHandle;
use super::status::{Fault, Status};
use super::text::owned;
use crate::image::ToneMap;
use crate::renderer::{Frame, FrameRequest, Timing};
use crate::slot::Slot;

/// What the surfaces themselves emit, and the sky where no surface is.
pub const IRRADIA_SLOT_EMISSION: u32 = 1;
/// Light from the lights, shadowed.
pub const IRRADIA_SLOT_DIRECT: u32 = 2;
/// Light that was scattered diffusely before.
pub const IRRADIA_SLOT_DIFFUSE: u32 = 4;
/// Light that was reflected or refracted before, on diffuse surfaces.
pub const IRRADIA_SLOT_CAUSTICS: u32 = 8;
/// What mirrors, metals and glass show, but for the lights.
pub const IRRADIA_SLOT_SPECULAR: u32 = 16;
/// The sum of all slots.
pub const IRRADIA_SLOT_IMAGE: u32 = 32;
/// The image for a display: sRGB, 8 bits, by the tone map of the frame.
pub const IRRADIA_SLOT_DISPLAY: u32 = 64;

/// The ACES filmic curve, after exposure to the log-average luminance.
pub const IRRADIA_TONE_MAP_ACES: u32 = 0;
/// Drago's adaptive logarithmic mapping.
pub const IRRADIA_TONE_MAP_DRAGO: u32 = 1;
/// Radiance 1 is white.
pub const IRRADIA_TONE_MAP_LINEAR: u32 = 2;

/// The frame as a whole is timed.
pub const IRRADIA_TIMING_FRAME: u32 = 0;
/// Every pass is timed alone, which takes longer.
pub const IRRADIA_TIMING_PASSES: u32 = 1;

/// Hears how far a frame is: `done` from 0 to 1. Returns 0 to go on, anything else to stop: the call then returns IRRADIA_ERROR_CANCELLED.
///
/// It is called from the thread that called irradia_render() or one of the library's own, one call at a time. It must not call the library, but for
/// irradia_renderer_cancel().
pub type ProgressFunction = Option<unsafe extern "C" fn(user: *mut c_void, done: f64) -> u32>;

/// What is asked of one frame.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FrameDescriptor {
    /// sizeof(irradia_frame_descriptor).
    pub size: usize,
    /// Pixels, at least 1.
    pub width: u32,
    /// Pixels, at least 1.
    pub height: u32,
    /// From where; null: from the scene's camera `camera_name`.
    pub camera: *const CameraDescriptor,
    /// As for irradia_scene_camera(); null: the scene's first, or a view that shows it.
    pub camera_name: *const c_char,
    /// What is wanted: a sum of IRRADIA_SLOT_…; 0: IRRADIA_SLOT_IMAGE. What nobody wants is not made.
    pub slots: u32,
    /// Of IRRADIA_SLOT_DISPLAY, one of IRRADIA_TONE_MAP_….
    pub tone_map: u32,
    /// The frame's number: what varies from frame to frame, such as the directions of samples, varies by it.
    pub index: u32,
    /// Seconds since the frame before, at least 0; 0: time stands still.
    pub time_step: f32,
    /// One of IRRADIA_TIMING_….
    pub timing: u32,
    /// Zero.
    pub reserved: u32,
    /// Hears how far the frame is; may be null.
    pub progress: ProgressFunction,
    /// Given to `progress`.
    pub progress_user: *mut c_void,
}

descriptors! {
    FrameDescriptor = "frame descriptor", size_of::<FrameDescriptor>();
}

/// Texts of a frame as the host sees them.
pub(super) struct FrameTexts {
    pub(super) passes: Vec<(CString, Option<CString>)>,
    pub(super) pieces: Vec<(CString, u64)>,
}

impl FrameTexts {
    fn of(frame: &Frame) -> FrameTexts {
        let passes = frame.timings.passes.iter();
        FrameTexts {
            passes: passes.map(|pass| (owned(&pass.full_name()), pass.skipped.as_deref().map(owned))).collect(),
            pieces: frame.timings.memory_bytes.iter().map(|(piece, &bytes)| (owned(piece), bytes)).collect(),
        }
    }
}

/// A frame, and texts that the host looks at.
pub struct FrameState {
    pub(super) frame: Frame,
    pub(super) texts: FrameTexts,
}

/// A finished frame: pixels, and what it cost. Needs neither the renderer nor the scene any more.
pub struct FrameHandle {
    guarded: Guarded<FrameState>,
}

handles! {
    FrameHandle(FrameState) = "frame";
}

/// A slot by its bit, among those that are images of radiance; the image itself is none of them.
pub(super) fn slot_of(bit: u32) -> Option<Slot> {
    let index = bit.is_power_of_two().then(|| bit.trailing_zeros() as usize)?;
    Slot::ALL.get(index).copied()
}

struct Progress {
    function: unsafe extern "C" fn(*mut c_void, f64) -> u32,
    user: *mut c_void,
}

// SAFETY: the header says that it is called from threads of the library's own, one call at a time.
unsafe impl Send for Progress {}
// SAFETY: as above.
unsafe impl Sync for Progress {}

impl Progress {
    fn goes_on(&self, done: f64) -> bool {
        // SAFETY: the host's function with the host's pointer.
        unsafe { (self.function)(self.user, done) == 0 }
    }
}

fn request_of(given: &FrameDescriptor, view: crate::scene::CameraView) -> Result<FrameRequest, Fault> {
    let all = 2 * IRRADIA_SLOT_DISPLAY - 1;
    let slots = if given.slots == 0 { IRRADIA_SLOT_IMAGE } else { given.slots };
    if slots & !all != 0 {
        return Err(Fault::argument(format!("slots is {slots}, which is no sum of IRRADIA_SLOT_…")));
    }
    let tone_map = match given.tone_map {
        IRRADIA_TONE_MAP_ACES => ToneMap::Aces,
        IRRADIA_TONE_MAP_DRAGO => ToneMap::Drago,
        IRRADIA_TONE_MAP_LINEAR => ToneMap::Linear,
        other => return Err(Fault::argument(format!("the tone map is {other}; write one of IRRADIA_TONE_MAP_…"))),
    };
    let timing = match given.timing {
        IRRADIA_TIMING_FRAME => Timing::Frame,
        IRRADIA_TIMING_PASSES => Timing::Passes,
        other => return Err(Fault::argument(format!("the timing is {other}; write one of IRRADIA_TIMING_…"))),
    };
    let progress = given.progress.map(|function| Progress { function, user: given.progress_user });
    Ok(FrameRequest::new([given.width, given.height], view).with(|request| {
        request.slots = (0..5).filter_map(|bit| slot_of(slots & 1 << bit)).collect();
        request.image = slots & IRRADIA_SLOT_IMAGE != 0;
        request.tonemap = (slots & IRRADIA_SLOT_DISPLAY != 0).then_some(tone_map);
        (request.index, request.time_step, request.timing) = (given.index, given.time_step, timing);
        request.progress = progress.map(|progress| crate::renderer::Progress::new(move |done| progress.goes_on(done)));
    }))
}

/// Makes a frame of a scene as it is now, and waits until it is done.
///
/// What the scene, its lights and the camera leave unchanged since the renderer's last frame is not made again. The scene may belong to another context.
/// `frame`: receives the frame, which irradia_frame_destroy() ends.
///
/// Errors: IRRADIA_ERROR_ARGUMENT, IRRADIA_ERROR_SCENE for a camera that the scene has not, IRRADIA_ERROR_MEMORY, IRRADIA_ERROR_DEVICE_LOST, IRRADIA_ERROR_CANCELLED.
/// The renderer can go on after each but a lost device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_render(
    renderer: *mut RendererHandle,
    scene: *const SceneHandle,
    descriptor: *const FrameDescriptor,
    frame: *mut *mut FrameHandle,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let (state, scene, given) = unsafe { (border.enter(renderer)?, border.enter(scene)?, read(descriptor)?) };
        let RendererState { renderer, shared, .. } = state;
        let size = [given.width, given.height];
        let scene = &scene.scene;
        // SAFETY: as above.
        let view = shared.workers.listen(|| unsafe { camera::choose(scene, given.camera, given.camera_name, size) })?;
        let request = request_of(&given, view)?;
        let make = || {
            let frame = shared.run(|| renderer.render(scene, &request))?;
            let texts = FrameTexts::of(&frame);
            Ok(FrameHandle { guarded: Guarded::new(FrameState { frame, texts }) })
        };
        // SAFETY: as above.
        unsafe { give(frame, make) }
    })
}

/// Ends a frame. Null is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_frame_destroy(frame: *mut FrameHandle) {
    // SAFETY: the host gives back what it was given.
    unsafe { take(frame) };
}
