//! A finished frame: the images of its slots, and what each pass cost.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::estimator::Noise;
use crate::graph::{FrameTimings, Progress, Timing};
use crate::image::{ColorImage, ToneMap};
use crate::scene::CameraView;
use crate::slot::Slot;

/// What is asked of one frame.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FrameRequest {
    /// Width and height in pixels, each 1 to the device's limit.
    pub size: [u32; 2],
    /// Where the picture is taken from.
    pub camera: CameraView,
    /// The frame's number in its sequence: what varies from frame to frame, such as the directions of samples, varies by it.
    pub index: u32,
    /// Time since the frame before, seconds; zero if time stands still. What adapts at a rate adapts by it.
    pub time_step: f32,
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
    /// Hears how far the frame is, and may stop it.
    pub progress: Option<Progress>,
    /// Whether the light that methods keep on surfaces is taken off the device, and on how many texels along a side of theirs.
    pub(crate) stored_light: Option<u32>,
    /// What is left in a host's images and buffers.
    #[cfg(feature = "capi")]
    pub(crate) handed: super::handed::Handed,
}

impl FrameRequest {
    /// The image, read back, timed as a frame.
    pub fn new(size: [u32; 2], camera: CameraView) -> FrameRequest {
        FrameRequest {
            size,
            camera,
            index: 0,
            time_step: 0.0,
            slots: Vec::new(),
            image: true,
            tonemap: None,
            timing: Timing::Frame,
            read_back: true,
            progress: None,
            stored_light: None,
            #[cfg(feature = "capi")]
            handed: super::handed::Handed::default(),
        }
    }

    /// The same request but for what `change` does to it.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut FrameRequest)) -> FrameRequest {
        change(&mut self);
        self
    }

    /// Whether the frame needs the sum of all slots.
    pub(crate) fn wants_image(&self) -> bool {
        #[cfg(feature = "capi")]
        let handed = self.handed.wants_image();
        #[cfg(not(feature = "capi"))]
        let handed = false;
        handed || self.image || self.tonemap.is_some()
    }

    /// Whether somebody outside gets to see the sum of all slots.
    pub(super) fn shows_image(&self) -> bool {
        #[cfg(feature = "capi")]
        let handed = self.handed.wants_image();
        #[cfg(not(feature = "capi"))]
        let handed = false;
        handed || self.read_back && self.image
    }

    /// Whether somebody outside gets to see the slot.
    pub(super) fn shows(&self, slot: Slot) -> bool {
        #[cfg(feature = "capi")]
        let handed = self.handed.shows(slot);
        #[cfg(not(feature = "capi"))]
        let handed = false;
        handed || self.read_back && self.slots.contains(&slot)
    }

    /// Whether the frame needs the slot, by itself or as a part of the image.
    pub(crate) fn wants(&self, slot: Slot) -> bool {
        #[cfg(feature = "capi")]
        let handed = self.handed.wants(slot);
        #[cfg(not(feature = "capi"))]
        let handed = false;
        handed || self.image || self.tonemap.is_some() || self.slots.contains(&slot)
    }
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
