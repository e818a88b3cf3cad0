//! Which camera a scene is seen from.

use super::auto_view;
use super::camera::{CameraView, rigid};
use super::error::SceneError;
use super::ids::{CameraId, NodeId};
use super::world::Scene;

impl Scene {
    /// Every placed camera: name, node, camera; in the order that indices of [`Scene::camera_view`] count.
    pub fn placed_cameras(&self) -> Vec<(String, NodeId, CameraId)> {
        let placed = self.nodes().iter().enumerate().filter_map(|(index, node)| Some((index, node, node.camera?)));
        placed
            .map(|(index, node, camera)| {
                let own = &self.cameras()[camera.0].name;
                (if own.is_empty() { node.name.clone() } else { own.clone() }, NodeId(index), camera)
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
                let by_node = || placed.iter().find(|(_, node, _)| self.nodes()[node.0].name == name);
                let by_index = || placed.get(name.parse::<usize>().ok()?);
                Some(by_name.or_else(by_node).or_else(by_index).ok_or_else(|| self.unknown_camera(name, &placed))?)
            }
        };
        Ok(chosen.map_or_else(|| auto_view::find(self), |placed| self.view_of(placed)))
    }

    /// The views of all placed cameras, in the same order.
    pub fn camera_views(&self) -> Vec<CameraView> {
        self.placed_cameras().iter().map(|placed| self.view_of(placed)).collect()
    }

    fn view_of(&self, (name, node, camera): &(String, NodeId, CameraId)) -> CameraView {
        let world = self.world_transform(*node);
        CameraView {
            world: rigid(world.matrix3, world.translation),
            projection: self.cameras()[camera.0].projection,
            name: name.clone(),
            automatic: false,
        }
    }

    fn unknown_camera(&self, name: &str, placed: &[(String, NodeId, CameraId)]) -> SceneError {
        let names: Vec<String> =
            placed.iter().enumerate().map(|(index, (name, ..))| format!("{index} {name:?}")).collect();
        let known = match names.len() {
            0 => "it has none: leave the camera out for an automatic view".to_owned(),
            _ => format!("it has {}", names.join(", ")),
        };
        SceneError::UnknownCamera { scene: self.name.clone(), camera: name.to_owned(), known }
    }
}
