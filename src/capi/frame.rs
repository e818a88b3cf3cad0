//! Frames: what is asked of one, and what comes back.

use std::ffi::{CString, c_char, c_void};

use super::border::{Border, Guarded, create, handles, take};
use super::camera::{self, CameraDescriptor};
use super::descriptor::{Descriptor, boolean, descriptors, read, slice, zero};
use super::renderer::{RendererHandle, RendererState, Shown};
use super::scene::SceneHandle;
use super::slots::{IRRADIA_SLOT_DISPLAY, IRRADIA_SLOT_IMAGE, bit_of, slot_of};
use super::status::{Fault, Status};
use super::targets::{SemaphorePoint, TargetDescriptor, points, shared_targets, targets};
use super::text::{optional_text, owned};
use crate::image::ToneMap;
use crate::renderer::{Frame, FrameRequest, Handed, Timing};

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
    /// What is left on the device; an array whose elements are as far apart as the size of the first one says. Their slots need not be in `slots`.
    pub targets: *const TargetDescriptor,
    /// How many.
    pub target_count: usize,
    /// 1: nothing is copied to the host's memory; irradia_frame_copy() has nothing to copy then, and 0 of `slots` means none. Of `targets` the host reads how many
    /// pixels are not finite, a word each, and no pixel.
    pub stay_on_device: u32,
    /// How long points are waited for, seconds; 0: 10. A point that is not reached by then is IRRADIA_ERROR_DEVICE, and nothing is signalled.
    pub patience: f32,
    /// Points that must be reached before targets are touched. What signals them must have been submitted before this call, which blocks until they are, before it
    /// begins with the frame.
    pub waits: *const SemaphorePoint,
    /// How many.
    pub wait_count: usize,
    /// Points that are signalled once all targets are filled. A call that fails signals none.
    pub signals: *const SemaphorePoint,
    /// How many.
    pub signal_count: usize,
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

/// # Safety
/// The descriptor's pointers are what the header asks for.
unsafe fn request_of(given: &FrameDescriptor, view: crate::scene::CameraView) -> Result<FrameRequest, Fault> {
    zero(given.reserved, FrameDescriptor::NAME)?;
    let all = 2 * IRRADIA_SLOT_DISPLAY - 1;
    let stays = boolean(given.stay_on_device, "stay_on_device")?;
    let slots = if given.slots == 0 && !stays { IRRADIA_SLOT_IMAGE } else { given.slots };
    if stays && slots & IRRADIA_SLOT_DISPLAY != 0 {
        return Err(Fault::argument("display values are made for the host's memory; they cannot stay on the device"));
    }
    if !(given.patience.is_finite() && given.patience >= 0.0) {
        return Err(Fault::argument("the patience is negative or not finite"));
    }
    let patience = if given.patience > 0.0 { f64::from(given.patience) } else { 10.0 };
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
    // SAFETY: the caller's.
    let handed = unsafe {
        Handed {
            targets: targets(given.targets, given.target_count, given.width)?,
            waits: points(slice(given.waits, given.wait_count, "points to wait for")?)?,
            patience,
            signals: points(slice(given.signals, given.signal_count, "points to signal")?)?,
        }
    };
    let progress = given.progress.map(|function| Progress { function, user: given.progress_user });
    Ok(FrameRequest::new([given.width, given.height], view).with(|request| {
        request.slots = (0..5).filter_map(|bit| slot_of(slots & 1 << bit)).collect();
        request.image = slots & IRRADIA_SLOT_IMAGE != 0;
        request.tonemap = (slots & IRRADIA_SLOT_DISPLAY != 0).then_some(tone_map);
        (request.index, request.time_step, request.timing) = (given.index, given.time_step, timing);
        (request.read_back, request.handed) = (!stays, handed);
        request.progress = progress.map(|progress| crate::renderer::Progress::new(move |done| progress.goes_on(done)));
    }))
}

/// Makes a frame of a scene as it is now, and waits until it is done.
///
/// What the scene, its lights and the camera leave unchanged since the renderer's last frame is not made again. The scene may belong to another context.
/// `frame`: receives the frame, which irradia_frame_destroy() ends.
///
/// Errors: IRRADIA_ERROR_ARGUMENT; IRRADIA_ERROR_SCENE for a camera that the scene has not; IRRADIA_ERROR_SETTINGS for methods that do not go together; IRRADIA_ERROR_DEVICE
/// for what the device cannot do, a target that cannot be filled and a point that is not reached; IRRADIA_ERROR_MEMORY; IRRADIA_ERROR_DEVICE_LOST; IRRADIA_ERROR_CANCELLED;
/// IRRADIA_ERROR_INTERNAL if a pixel were not a finite number of at least 0, which is a fault of the library's: its sentence names the pass.
/// The renderer can go on after each but a lost device and a failure of the library. A frame that failed on its way may have moved on what is kept over frames;
/// one that was refused, for an argument, a target or a point that is not reached, has not.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_render(
    renderer: *mut RendererHandle,
    scene: *const SceneHandle,
    descriptor: *const FrameDescriptor,
    frame: *mut *mut FrameHandle,
) -> Status {
    let make = |border: &mut Border<'_>| {
        // SAFETY: the host's pointers are what the header asks for.
        let (state, scene, given) = unsafe { (border.enter(renderer)?, border.enter(scene)?, read(descriptor)?) };
        let RendererState { renderer, shared, shown, .. } = state;
        let size = [given.width, given.height];
        let scene = &scene.scene;
        // SAFETY: as above.
        let own = unsafe { camera::given(given.camera, size) }?;
        // SAFETY: as above.
        let name = unsafe { optional_text(given.camera_name, "the camera's name") }?;
        let view = match (own, name) {
            (Some(_), Some(_)) => return Err(Fault::argument("the frame has both a camera and the name of one")),
            (Some(view), None) => view,
            (None, name) if scene.nodes().iter().any(|node| node.camera.is_some()) => {
                shared.workers.listen(|| scene.camera_view(name))?
            }
            // To find a view of a scene that has none is work for all threads.
            (None, name) => shared.run(|| scene.camera_view(name))?,
        };
        // SAFETY: as above.
        let request = unsafe { request_of(&given, view) }?;
        let points = given.wait_count > 0 || given.signal_count > 0;
        let _held = match shared.context.shared_device().timelines_of_host() {
            None if points => {
                return Err(Fault::argument(
                    "semaphores are of a host's device, and this context is on one of its own",
                ));
            }
            None => shared_targets(shared, &request.handed, size)?,
            Some(false) if points => {
                return Err(Fault::argument("the host's device was created without the feature timelineSemaphore"));
            }
            Some(_) => Vec::new(),
        };
        let asked = [given.slots, request.handed.targets.iter().fold(0, |asked, &(slot, _)| asked | bit_of(slot))];
        let now = Shown { scene: scene.identity(), revisions: scene.revisions(), asked };
        let again = shown.take().is_some_and(|before| before == now);
        let make = || renderer.render(scene, &request);
        let frame = if again { shared.workers.listen(make) } else { shared.run(make) }?;
        *shown = Some(now);
        let texts = FrameTexts::of(&frame);
        Ok(FrameHandle { guarded: Guarded::new(FrameState { frame, texts }) })
    };
    // SAFETY: as above.
    unsafe { create(frame, make) }
}

/// Ends a frame. Null is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_frame_destroy(frame: *mut FrameHandle) {
    // SAFETY: the host gives back what it was given.
    unsafe { take(frame) };
}
