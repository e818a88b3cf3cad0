//! Samples of the surfaces on the device.

use ash::vk;

use crate::graph::bindings::BufferRef;
use crate::shaders::groups::SceneRays;

pub(super) const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
pub(super) const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Samples in a row of work groups.
const ROW: u32 = 32_768;

/// Samples, and what they are made of.
pub(super) struct Space {
    pub(super) rays: SceneRays,
    pub(super) samples: BufferRef<[u32; 4]>,
    pub(super) matter: BufferRef<[f32; 4]>,
    pub(super) slot_count: u32,
    pub(super) cluster: u32,
}

impl Space {
    pub(super) fn groups(&self) -> [u32; 3] {
        [self.slot_count.min(ROW), self.slot_count.div_ceil(ROW), 1]
    }

    /// Words of the bits of what a sample sees.
    pub(super) fn words(&self) -> u32 {
        (self.slot_count / self.cluster).div_ceil(32)
    }
}

/// Irradiance at samples, W/m².
pub(super) type Light = BufferRef<[f32; 4]>;
