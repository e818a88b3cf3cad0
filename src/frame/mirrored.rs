//! Points of surfaces that mirrors and glass show, and the light at them: what the method of the slot `specular` and those of `diffuse` and `caustics` tell each other.
//!
//! The method that follows reflections lists the points before any method declares its passes ([`MirroredPoints`]); a method of the slot `diffuse` then says
//! what diffuse light comes to them ([`MirroredLight`]), one of `caustics` what light of caustics does ([`MirroredCaustics`]), and either may do so by the same passes
//! that make its own picture. None knows another.

use ash::vk;
use glam::Vec3;

use crate::graph::bindings::BufferRef;
use crate::shaders::{groups, types};

const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// Points as lists, of some rows of pixels each.
#[derive(Clone, Debug)]
pub(crate) struct MirroredPoints {
    pub(crate) lists: Vec<MirroredList>,
    pub(crate) seen: Seen,
}

/// From where points are seen, and how far apart they lie.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// In the rays' space.
    pub(crate) eye: [f32; 3],
    /// Metres across a pixel at a distance of one.
    pub(crate) angle: f32,
    /// Metres across a pixel at any distance.
    pub(crate) extent: f32,
}

impl Seen {
    /// By the pixels of a camera. `shift`: from render space to that of rays.
    pub(crate) fn by_pixels(camera: &types::Camera, size: [u32; 2], shift: Vec3) -> Seen {
        let across = |axis: [f32; 3], pixels: u32| 2.0 * Vec3::from(axis).length() / pixels as f32;
        let pixel = across(camera.right_scaled, size[0]).max(across(camera.down_scaled, size[1]));
        let eye = (Vec3::from(camera.position_rs) + shift).to_array();
        if camera.depth_range > 0.0 {
            Seen { eye, angle: 0.0, extent: pixel }
        } else {
            Seen { eye, angle: pixel, extent: 0.0 }
        }
    }
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

/// Likewise of caustics.
#[derive(Clone, Debug)]
pub(crate) struct MirroredCaustics {
    pub(crate) irradiance: Vec<BufferRef<[f32; 4]>>,
}
