//! A scene takes little more memory on the device than its vertices, indices and textures have bytes.

use std::path::PathBuf;

use super::scenes::{builtin, request, settings};
use super::session::Session;
use crate::renderer::{Preset, Settings, Technique};
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

/// Four bytes a link; links are in several buffers, which count as one. Pieces are the sums of their parts.
#[test]
fn memory_is_told_by_what_it_holds() {
    let scene = builtin("cornell-point");
    let mut settings = Settings::new(Technique::Particles, Preset::Draft);
    for (key, value) in [("particles.count", "40000"), ("particles.gather", "8")] {
        settings.set(key, value).expect("a setting and its value");
    }
    let view = scene.camera_view(None).expect("a view");
    let frame = Session::open().render(&scene, &settings, &request([64, 64], view, &[]));
    let (pieces, parts) = (&frame.timings.memory_bytes, &frame.timings.memory_parts);
    for (piece, parts) in parts {
        assert_eq!(parts.values().sum::<u64>(), pieces[piece], "{piece}");
    }
    let particles = &parts["diffuse/particles"];
    assert_eq!(
        (particles["particles.links"], particles["particles.scatter_links"]),
        (4 * 8 * 8 * 40_000, 4 * 4 * 4 * 40_000)
    );
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
