//! The picture that paths are traced for.

use glam::DVec3;

use crate::frame::camera::camera;
use crate::frame::rays::TracedScene;
use crate::scene::CameraView;
use crate::shaders::types;
use crate::slot::{CausticPaths, PixelFilter};

/// Light paths for each camera path. They are short, and the caustics that they alone find are the noisiest light there is.
pub(super) const LIGHT_PATHS_PER_PIXEL: u32 = 4;

/// What is asked of an estimator; the samples to come do not change it, they only lessen its noise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EstimateRequest {
    /// Width and height in pixels.
    pub(crate) size: [u32; 2],
    pub(crate) camera: CameraView,
    /// Scatterings between the light and the first visible surface at most; `None`: no limit.
    pub(crate) bounces: Option<u32>,
    pub(crate) caustics: CausticPaths,
    /// As in [`crate::slot::LightPaths`].
    pub(crate) mirrors: Option<u32>,
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
    pub(crate) mirrors: Option<u32>,
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
            mirrors: request.mirrors,
            filter: request.filter,
            seed: request.seed,
        }
    }

    /// Pixels, and photon paths a pass.
    pub(super) fn pixel_count(&self) -> f32 {
        self.size[0] as f32 * self.size[1] as f32
    }

    /// Scatterings of the camera's paths beyond the first visible surface at most.
    pub(super) fn camera_bounces(&self) -> Option<u32> {
        self.bounces.map(|bounces| bounces.saturating_add(self.mirrors.unwrap_or(0)))
    }

    /// Whether lights send out paths: they find what specular surfaces light.
    pub(super) fn needs_light_paths(&self, scene: &TracedScene) -> bool {
        self.caustics != CausticPaths::None && scene.needs_light_paths(self.bounces)
    }

    /// Light paths of the path tracer a sample.
    pub(super) fn light_path_count(&self) -> u64 {
        u64::from(LIGHT_PATHS_PER_PIXEL) * u64::from(self.size[0]) * u64::from(self.size[1])
    }
}
