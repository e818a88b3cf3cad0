//! What is played: how fast, seen from where, compared with what.

use crate::reference::Cache;
use crate::scene::{CameraView, Flight, Scene, SceneError};

/// How a scene is played.
#[derive(Clone, Copy, Debug)]
pub struct Sequence<'a> {
    /// Frames a second of the scene's own time, above 0.
    pub fps: f64,
    /// The way that the eye takes; `None`: that of a camera of the scene.
    pub flight: Option<&'a Flight>,
    /// That camera, see [`Scene::camera_view`].
    pub camera: Option<&'a str>,
    /// Whether it is measured how late pictures are: frames that are kept over frames are made a second time without a past.
    pub lag: bool,
    /// What the frames are compared with, if they are.
    pub compare: Option<Comparing<'a>>,
}

/// The references of the frames.
#[derive(Clone, Copy, Debug)]
pub struct Comparing<'a> {
    /// Samples per pixel.
    pub spp: u32,
    /// Where they are kept.
    pub cache: Option<&'a Cache>,
}

impl Sequence<'_> {
    /// The time of a frame.
    pub fn seconds(&self, frame: u32) -> f64 {
        f64::from(frame) / self.fps
    }

    /// What a frame is seen from; the scene stands where the frame has it.
    ///
    /// # Errors
    /// The scene has no such camera.
    pub fn view(&self, scene: &Scene, frame: u32) -> Result<CameraView, SceneError> {
        match self.flight {
            Some(flight) => Ok(flight.view(self.seconds(frame))),
            None => scene.camera_view(self.camera),
        }
    }
}
