//! Points of surfaces that mirrors and glass show, and the diffuse light at them: what the methods of the slots `specular` and `diffuse` tell each other.
//!
//! The method that follows reflections lists the points before any method declares its passes ([`MirroredPoints`]); a method of the slot `diffuse` then says
//! what diffuse light comes to them ([`MirroredLight`]), and may do so by the same passes that make its own picture. Neither knows the other.

use ash::vk;

use crate::graph::bindings::BufferRef;
use crate::shaders::{groups, types};

const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// Points as lists, of some rows of pixels each.
#[derive(Clone, Debug)]
pub(crate) struct MirroredPoints {
    pub(crate) lists: Vec<MirroredList>,
}

/// One list (glsl/lib/mirrored.glsl). Its order differs from frame to frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MirroredList {
    pub(crate) points: BufferRef<types::MirroredPoint>,
    /// Groups of 64 that take one point each, in three words, and how many points there are.
    pub(crate) arguments: BufferRef<u32>,
}

impl MirroredList {
    /// As kernels read it.
    pub(crate) fn group(&self) -> groups::Mirrored {
        groups::Mirrored {
            mirrored_points: self.points.texels(WORDS),
            mirrored_count: self.arguments.texels(vk::Format::R32_UINT),
        }
    }
}

/// The irradiance of diffuse light at the points of each list, W/m².
#[derive(Clone, Debug)]
pub(crate) struct MirroredLight {
    pub(crate) irradiance: Vec<BufferRef<[f32; 4]>>,
}
