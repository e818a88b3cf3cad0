//! A scene takes little more memory on the device than its vertices, indices and textures have bytes.

use std::path::PathBuf;

use super::scenes::{builtin, request, settings};
use super::session::Session;
use crate::scene::Scene;

/// Device memory of a scene over the bytes of its vertices and indices as its file stores them, and of its decoded texels.
fn ratio(session: &Session, scene: &Scene) -> f64 {
    let primitives = scene.meshes().iter().flat_map(|mesh| &mesh.primitives);
    let texels = scene.textures().iter().map(|texture| texture.rgba8.len() as u64);
    let stored = primitives.map(|primitive| primitive.source_bytes).sum::<u64>() + texels.sum::<u64>();
    let view = scene.camera_view(None).expect("a view");
    let frame = session.render(scene, &settings(&[]), &request([16, 16], view, &[]));
    frame.timings.memory_bytes["scene"] as f64 / stored as f64
}

#[test]
fn a_textured_scene_takes_little_more_than_its_bytes() {
    let found = ratio(&Session::open(), &builtin("textured"));
    println!("textured: {found:.2}");
    // Half of its triangles' first vertices are copies (src/frame/drawn_triangles.rs).
    assert!(found <= 1.55, "{found:.2}");
}

#[test]
fn large_scenes_take_little_more_than_their_bytes() {
    let folder =
        std::env::var_os("IRRADIA_SHARED_SCENES").map_or_else(|| PathBuf::from("../shared/scenes"), PathBuf::from);
    let session = Session::open();
    for name in ["crytek-sponza-geometry", "white-room", "sponza"] {
        let path = folder.join(name).join(format!("{name}.glb"));
        if !path.is_file() {
            println!("skipped: {} is absent", path.display());
            continue;
        }
        let mut scene = Scene::load(&path).expect("a sound file");
        scene.set_sky([0.0; 3]);
        let found = ratio(&session, &scene);
        println!("{name}: {found:.2}");
        assert!(found <= 1.5, "{name}: {found:.2}");
    }
}
