//! A finished frame: the images of its slots, and what each pass cost.

use std::collections::BTreeMap;

use serde::Serialize;

use super::slots::Slot;
use crate::reference::Noise;
use crate::scene::CameraView;

/// How the frame is timed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Timing {
    /// One pair of timestamps around the frame; passes overlap as the driver likes.
    #[default]
    Frame,
    /// Every pass alone, between full barriers, each with its own pair; and the frame as a whole.
    Passes,
}

/// How linear radiance becomes display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ToneMap {
    /// Drago et al. 2003, adaptive logarithmic mapping.
    Drago,
    /// The ACES filmic fit of Narkowicz 2015, after exposure to the log-average luminance.
    #[default]
    Aces,
    /// Radiance 1 is white; values are clamped. No exposure.
    Linear,
}

/// What is asked of one frame.
#[derive(Clone, Debug)]
pub struct FrameRequest {
    /// Width and height in pixels, each 1 to the device's limit.
    pub size: [u32; 2],
    /// Where the picture is taken from.
    pub camera: CameraView,
    /// The slots wanted as images of their own.
    pub slots: Vec<Slot>,
    /// Whether the image, the sum of all slots, is wanted.
    pub image: bool,
    /// Whether 8-bit display values are wanted, and how they are made.
    pub tonemap: Option<ToneMap>,
    /// How the frame is timed.
    pub timing: Timing,
    /// Whether the images are copied to the host; without it the frame is made and timed, and its images stay
    /// on the device.
    pub read_back: bool,
}

impl FrameRequest {
    /// The image, read back, timed as a frame.
    pub fn new(size: [u32; 2], camera: CameraView) -> FrameRequest {
        FrameRequest {
            size,
            camera,
            slots: Vec::new(),
            image: true,
            tonemap: None,
            timing: Timing::Frame,
            read_back: true,
        }
    }

    /// Whether the frame needs the slot, by itself or as a part of the image.
    pub(crate) fn wants(&self, slot: Slot) -> bool {
        self.image || self.tonemap.is_some() || self.slots.contains(&slot)
    }
}

/// An RGB image in row-major order from the top left, linear Rec.709 radiance, W/(m² sr).
#[derive(Clone, Debug, PartialEq)]
pub struct ColorImage {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// `size[0] * size[1]` pixels.
    pub pixels: Vec<[f32; 3]>,
}

/// One pass of the frame: its cost, or why it did not run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassTiming {
    /// The piece that the pass belongs to, such as `light-views`.
    pub piece: String,
    /// The pass within its piece.
    pub pass: String,
    /// GPU time in milliseconds; `None` if it was skipped or passes were not timed.
    pub ms: Option<f64>,
    /// Why the pass did not run; `None` if it did.
    pub skipped: Option<String>,
    /// What the pass did: invocations, triangles, VPLs …
    pub work: BTreeMap<String, u64>,
}

/// What the frame cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameTimings {
    /// How the frame was timed.
    pub timing: Timing,
    /// GPU time from the start to the end of the frame, milliseconds, by its own pair of timestamps.
    pub gpu_ms: f64,
    /// Host time from the call to the finished frame, milliseconds, read-back included.
    pub host_ms: f64,
    /// Of the host time: bringing what changed of the scene onto the device, milliseconds.
    pub upload_ms: f64,
    /// Time spent creating pipelines in this frame, milliseconds; zero once they exist.
    pub pipeline_ms: f64,
    /// All passes in the order of their declaration, the skipped ones included.
    pub passes: Vec<PassTiming>,
    /// Bytes of device memory that each piece's images and buffers hold, by piece; `scene` is the scene itself.
    pub memory_bytes: BTreeMap<String, u64>,
}

/// A finished frame.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The sum of all slots, if it was asked for and read back.
    pub image: Option<ColorImage>,
    /// The slots asked for, if they were read back. A slot that no method fills, or that the scene cannot have, is black.
    pub slots: BTreeMap<Slot, ColorImage>,
    /// sRGB-encoded display values, 8 bits, if a tone map was asked for: `size[0] * size[1]` pixels.
    pub display: Option<Vec<[u8; 3]>>,
    /// How sure the frame is, if it was estimated by random samples.
    pub estimate: Option<Estimate>,
    /// What the frame cost.
    pub timings: FrameTimings,
}

/// How a frame was sampled and how noisy that left it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Estimate {
    /// Samples of every pixel.
    pub spp: u32,
    /// Rays cast.
    pub rays: u64,
    /// Time that the samples took, seconds on the device.
    pub seconds: f64,
    /// The noise of each traced slot by its name, and of their sum as `image`, by the two halves of the samples; empty for a single
    /// sample.
    pub noise: BTreeMap<String, Noise>,
}
