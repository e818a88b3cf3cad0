//! Cameras of the baked file: the scene's, or the view that is found for it if it has none, so that the picture is taken from where the scene's is.

use glam::{DMat4, DVec3};
use serde_json::{Value, json};

use crate::scene::{Projection, Scene};

/// Cameras, and the nodes that place them relative to `origin`.
pub(super) fn cameras(scene: &Scene, origin: DVec3) -> (Vec<Value>, Vec<Value>) {
    let mut views = scene.camera_views();
    if views.is_empty() {
        views.extend(scene.camera_view(None));
    }
    let (mut cameras, mut nodes) = (Vec::new(), Vec::new());
    for view in views.into_iter().filter(|view| view.fault().is_none()) {
        let name = if view.name.is_empty() { "view".to_owned() } else { view.name };
        let mut camera = match view.projection {
            Projection::Perspective { vertical_fov, aspect, near } => {
                let mut perspective = json!({ "yfov": vertical_fov, "znear": near });
                if let Some(aspect) = aspect {
                    perspective["aspectRatio"] = aspect.into();
                }
                json!({ "type": "perspective", "perspective": perspective })
            }
            Projection::Orthographic { half_width, half_height, near, far } => {
                let sides = json!({ "xmag": half_width, "ymag": half_height, "znear": near, "zfar": far });
                json!({ "type": "orthographic", "orthographic": sides })
            }
        };
        camera["name"] = name.clone().into();
        let mut world = view.world;
        world.translation -= origin;
        let matrix = DMat4::from(world).to_cols_array();
        nodes.push(json!({ "name": name, "camera": cameras.len(), "matrix": matrix }));
        cameras.push(camera);
    }
    (cameras, nodes)
}
