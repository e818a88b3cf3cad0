//! The light that a method of the slot `diffuse` keeps on all surfaces, for whoever takes it off the device.

use std::sync::Arc;

use super::rays::Lightmap;
use crate::graph::bindings::BufferRef;

/// What texels of light maps receive when nothing changes any more, W/m², by its way: each is four floats a texel.
pub(crate) struct StoredLight {
    pub(crate) map: Arc<Lightmap>,
    /// Texels along the side of one that light was found at: those asked for, or fewer where there are many.
    pub(crate) detail: u32,
    /// Of each texel: 0 if it lies within geometry.
    pub(crate) valid: BufferRef<u32>,
    /// Of the lights themselves.
    pub(crate) direct: BufferRef<[f32; 4]>,
    /// Of punctual lights by way of mirrors and glass; none where there is no such light.
    pub(crate) caustics: Option<BufferRef<[f32; 4]>>,
    /// Of lamps, and of a sky of radiance one, likewise: found by a few rays a texel, and noisy.
    pub(crate) arrivals: Option<[BufferRef<[f32; 4]>; 2]>,
    /// Of diffuse surfaces.
    pub(crate) diffuse: BufferRef<[f32; 4]>,
}
