//! Cameras.

use glam::{DAffine3, DMat3, DVec3};
use std::f64::consts::PI;

/// A camera looks along the local -Z of the node that places it, +Y up.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// How it maps the world to the picture.
    pub projection: Projection,
}

/// How a camera maps the world to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Projection {
    /// Central projection, without a far plane.
    Perspective {
        /// Full angle in radians, above 0 and below π.
        vertical_fov: f64,
        /// Width over height that the camera was made for; pictures of other shapes keep the vertical angle.
        aspect: Option<f64>,
        /// Nearest distance seen, in metres, above 0.
        near: f64,
    },
    /// Parallel projection.
    Orthographic {
        /// Half the width of what is seen, in metres, not 0.
        half_width: f64,
        /// Half the height, in metres, not 0.
        half_height: f64,
        /// Nearest distance seen, in metres, at least 0.
        near: f64,
        /// Farthest distance seen, in metres, above `near`.
        far: f64,
    },
}

impl Camera {
    /// Says which number of the projection is out of range, if any is.
    pub(super) fn fault(&self) -> Option<String> {
        self.projection.fault()
    }
}

impl Projection {
    fn fault(&self) -> Option<String> {
        let fault = match *self {
            Projection::Perspective { vertical_fov, aspect, near } => {
                if !(vertical_fov > 0.0 && vertical_fov < PI) {
                    format!("its vertical angle of {vertical_fov} rad is not between 0 and π")
                } else if !(near > 0.0 && near.is_finite()) {
                    format!("its near distance of {near} is not above 0")
                } else if !aspect.is_none_or(|aspect| aspect > 0.0 && aspect.is_finite()) {
                    format!("its aspect ratio {aspect:?} is not above 0")
                } else {
                    return None;
                }
            }
            Projection::Orthographic { half_width, half_height, near, far } => {
                if ![half_width, half_height, near, far].iter().all(|length| length.is_finite()) {
                    "a length of its projection is not finite".to_owned()
                } else if half_width == 0.0 || half_height == 0.0 {
                    "it shows an area without width or height".to_owned()
                } else if !(near >= 0.0 && far > near) {
                    format!("its depth from {near} to {far} is empty or behind it")
                } else {
                    return None;
                }
            }
        };
        Some(fault)
    }
}

/// A camera in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraView {
    /// Camera space to world space, a rigid motion: the camera looks along -Z, +Y is up.
    pub world: DAffine3,
    /// How it maps the world to the picture. Lengths are in metres of the world.
    pub projection: Projection,
    /// The camera's or its node's name.
    pub name: String,
    /// Whether the scene has no camera and this view was found for it.
    pub automatic: bool,
}

impl CameraView {
    /// Says what keeps a picture from being taken through it, if anything does.
    pub(crate) fn fault(&self) -> Option<String> {
        if !self.world.is_finite() {
            return Some("its place has a number that is not finite".to_owned());
        }
        self.projection.fault()
    }

    /// A view from `eye` towards `target`.
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, projection: Projection) -> CameraView {
        let back = (eye - target).try_normalize().unwrap_or(DVec3::Z);
        CameraView {
            world: rigid(DMat3::from_cols(up.cross(back), up, back), eye),
            projection,
            name: String::new(),
            automatic: false,
        }
    }
}

/// The rigid motion nearest to a camera's frame: the viewing direction is kept, then the up direction as far as it can be.
pub(super) fn rigid(frame: DMat3, position: DVec3) -> DAffine3 {
    let back = frame.z_axis.try_normalize().unwrap_or(DVec3::Z);
    let right = frame.y_axis.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
    DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: position }
}
