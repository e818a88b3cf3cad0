//! Cameras, and how one of them is chosen.

use super::world::Scene;
use super::{CameraId, NodeId, SceneError, auto_view};
use glam::{DAffine3, DMat3, DVec3};

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
fn rigid(frame: DMat3, position: DVec3) -> DAffine3 {
    let back = frame.z_axis.try_normalize().unwrap_or(DVec3::Z);
    let right = frame
        .y_axis
        .cross(back)
        .try_normalize()
        .unwrap_or_else(|| back.any_orthonormal_vector());
    DAffine3 {
        matrix3: DMat3::from_cols(right, back.cross(right), back),
        translation: position,
    }
}

impl Scene {
    /// Every placed camera: name, node, camera; in the order that indices of [`Scene::camera_view`] count.
    pub fn placed_cameras(&self) -> Vec<(String, NodeId, CameraId)> {
        let placed = self
            .nodes()
            .iter()
            .enumerate()
            .filter_map(|(index, node)| Some((index, node, node.camera?)));
        placed
            .map(|(index, node, camera)| {
                let own = &self.cameras()[camera.0].name;
                (
                    if own.is_empty() {
                        node.name.clone()
                    } else {
                        own.clone()
                    },
                    NodeId(index),
                    camera,
                )
            })
            .collect()
    }

    /// The view of a camera chosen by its name, its node's name, or its index as a decimal number. `None` chooses the first
    /// camera, or finds a view that shows the scene if it has no camera.
    ///
    /// # Errors
    /// [`SceneError::UnknownCamera`], which lists the cameras there are.
    pub fn camera_view(&self, select: Option<&str>) -> Result<CameraView, SceneError> {
        let placed = self.placed_cameras();
        let chosen = match select {
            None => placed.first(),
            Some(name) => {
                let by_name = placed.iter().find(|(own, ..)| own == name);
                let by_node = || {
                    placed
                        .iter()
                        .find(|(_, node, _)| self.nodes()[node.0].name == name)
                };
                let by_index = || placed.get(name.parse::<usize>().ok()?);
                Some(
                    by_name
                        .or_else(by_node)
                        .or_else(by_index)
                        .ok_or_else(|| self.unknown_camera(name, &placed))?,
                )
            }
        };
        let Some((name, node, camera)) = chosen else {
            return Ok(auto_view::find(self));
        };
        let world = self.world_transform(*node);
        Ok(CameraView {
            world: rigid(world.matrix3, world.translation),
            projection: self.cameras()[camera.0].projection,
            name: name.clone(),
            automatic: false,
        })
    }

    fn unknown_camera(&self, name: &str, placed: &[(String, NodeId, CameraId)]) -> SceneError {
        let names: Vec<String> = placed
            .iter()
            .enumerate()
            .map(|(index, (name, ..))| format!("{index} {name:?}"))
            .collect();
        let known = match names.len() {
            0 => "it has none: leave the camera out for an automatic view".to_owned(),
            _ => format!("it has {}", names.join(", ")),
        };
        SceneError::UnknownCamera {
            scene: self.name.clone(),
            camera: name.to_owned(),
            known,
        }
    }
}
