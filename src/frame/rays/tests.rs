//! What stands of a traced scene when something changes.

use std::sync::Arc;

use glam::DVec3;

use super::TracedScene;
use crate::gpu_tests::scenes::{add_light, builtin};
use crate::gpu_tests::session::Session;
use crate::scene::{Alpha, LightId, LightKind, MaterialId, Node};

#[test]
fn a_moved_light_makes_no_hierarchy_and_a_moved_thing_no_textures() {
    let session = Session::open();
    let device = session.context.shared_device();
    let mut scene = builtin("textured");
    let first = TracedScene::new(device, &scene).expect("it fits the device");
    let mut light = scene.lights()[0].clone();
    light.intensity = light.intensity.map(|channel| 2.0 * channel);
    scene.set_light(LightId(0), light).expect("a sound light");
    let relit = TracedScene::update(device, &scene, Some(&first)).expect("it fits the device");
    assert_ne!(first.key, relit.key);
    assert!(Arc::ptr_eq(&first.surfaces, &relit.surfaces) && Arc::ptr_eq(&first.looks, &relit.looks));
    assert_eq!(first.triangles.key, relit.triangles.key, "no surface shines");
    assert_ne!(first.lights.key, relit.lights.key);

    let id = scene.instances().iter().last().expect("it has some").node;
    let Node { mut local, .. } = scene.nodes()[id.0];
    local.translation += DVec3::new(0.0, 0.1, 0.0);
    scene.set_local_transform(id, local).expect("a sound transform");
    let moved = TracedScene::update(device, &scene, Some(&relit)).expect("it fits the device");
    assert!(!Arc::ptr_eq(&relit.surfaces, &moved.surfaces) && Arc::ptr_eq(&relit.looks, &moved.looks));
    assert_eq!(moved.surfaces_key(), TracedScene::new(device, &scene).expect("it fits the device").surfaces_key());
}

#[test]
fn a_changed_material_makes_no_hierarchy_and_no_textures() {
    let session = Session::open();
    let device = session.context.shared_device();
    let mut scene = builtin("textured");
    let first = TracedScene::new(device, &scene).expect("it fits the device");
    let mut material = scene.materials()[0].clone();
    material.base_color[0] *= 0.5;
    scene.set_material(MaterialId(0), material).expect("it is sound");
    let painted = TracedScene::update(device, &scene, Some(&first)).expect("it fits the device");
    assert_ne!(first.looks.materials.key, painted.looks.materials.key);
    assert_eq!(first.looks.texels.key, painted.looks.texels.key);
    let keys = |scene: &TracedScene| scene.surfaces.hierarchy().map(|list| list.key);
    assert_eq!(keys(&first), keys(&painted));
    // Alpha cuts: other triangles can be hit.
    let mut material = scene.materials()[0].clone();
    (material.alpha, material.base_color[3]) = (Alpha::Mask { cutoff: 0.5 }, 0.0);
    scene.set_material(MaterialId(0), material).expect("it is sound");
    let cut = TracedScene::update(device, &scene, Some(&painted)).expect("it fits the device");
    assert_ne!(keys(&painted), keys(&cut));
}

#[test]
fn emissive_surfaces_stand_while_another_light_moves() {
    let session = Session::open();
    let device = session.context.shared_device();
    let mut scene = builtin("cornell-panel");
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 1.0, 0.0), DVec3::NEG_Y, [1.0; 3]);
    let light = scene.placed_lights()[0].node;
    let first = TracedScene::new(device, &scene).expect("it fits the device");
    let Node { mut local, .. } = scene.nodes()[light.0];
    local.translation.y += 0.25;
    scene.set_local_transform(light, local).expect("a sound transform");
    let relit = TracedScene::update(device, &scene, Some(&first)).expect("it fits the device");
    assert_ne!(first.lights.key, relit.lights.key);
    assert_eq!((first.emissive.key, first.triangles.key), (relit.emissive.key, relit.triangles.key));
}
