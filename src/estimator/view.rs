//! The picture that paths are traced for.

use glam::DVec3;

use crate::frame::camera::camera;
use crate::scene::CameraView;
use crate::shaders::types;
use crate::slot::{CausticPaths, PixelFilter};

/// What is asked of an estimator; the samples to come do not change it, they only lessen its noise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EstimateRequest {
    /// Width and height in pixels.
    pub(crate) size: [u32; 2],
    pub(crate) camera: CameraView,
    /// Scatterings between the light and the first visible surface at most; `None`: no limit.
    pub(crate) bounces: Option<u32>,
    pub(crate) caustics: CausticPaths,
    pub(crate) filter: PixelFilter,
    pub(crate) seed: u32,
}

/// The same with the camera in render space.
#[derive(Clone, Debug)]
pub(crate) struct View {
    pub(crate) size: [u32; 2],
    pub(crate) camera: types::Camera,
    pub(crate) bounces: Option<u32>,
    pub(crate) caustics: CausticPaths,
    pub(crate) filter: PixelFilter,
    pub(crate) seed: u32,
}

impl View {
    /// The picture that a request asks for of a scene with this origin of render space.
    pub(super) fn new(request: &EstimateRequest, origin: DVec3) -> View {
        View {
            size: request.size,
            camera: camera(&request.camera, request.size, origin),
            bounces: request.bounces,
            caustics: request.caustics,
            filter: request.filter,
            seed: request.seed,
        }
    }

    /// Pixels, and light paths a sample.
    pub(super) fn pixel_count(&self) -> f32 {
        self.size[0] as f32 * self.size[1] as f32
    }
}
