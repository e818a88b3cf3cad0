//! Third-party scenes: everything sound loads, nothing malformed panics, hangs or takes the machine's memory.
//!
//! The scenes are no part of the repository. They are looked for in `IRRADIA_SHARED_SCENES`, else in `shared/scenes` beside the
//! repository; without them these tests say so and pass.

use irradia::scene::{Scene, SceneError};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Far above what any file takes on the busiest machine, far below a hang.
const LONGEST_LOAD: Duration = Duration::from_secs(120);

/// Files that say that they cannot be shown without an extension that irradia lacks.
const REQUIRING: [(&str, &str); 2] = [
    ("BoxMeshopt.glb", "EXT_meshopt_compression"),
    ("04_sphere_specular_glossiness.gltf", "KHR_materials_pbrSpecularGlossiness"),
];

fn shared_scenes() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes");
    let folder = std::env::var_os("IRRADIA_SHARED_SCENES").map_or_else(beside, PathBuf::from);
    if !folder.is_dir() {
        println!("skipped: there is no {}; set IRRADIA_SHARED_SCENES", folder.display());
        return None;
    }
    Some(folder)
}

/// All glTF files below a folder, in order.
fn gltf_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("the folder can be listed") {
            let path = entry.expect("the entry can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "gltf" || extension == "glb") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn load_timed(path: &Path) -> (Result<Scene, SceneError>, Duration) {
    let start = Instant::now();
    let result = Scene::load(path);
    let took = start.elapsed();
    assert!(took < LONGEST_LOAD, "{} took {took:?}", path.display());
    (result, took)
}

#[test]
fn sound_scenes_load() {
    let Some(folder) = shared_scenes() else {
        return;
    };
    let mut count = 0;
    for path in gltf_files(&folder).into_iter().filter(|path| !path.starts_with(folder.join("malformed"))) {
        let shown = path.strip_prefix(&folder).unwrap_or(&path).display().to_string();
        let (result, took) = load_timed(&path);
        count += 1;
        let refusal = REQUIRING.iter().find(|(file, _)| shown.ends_with(file));
        if let Some((_, extension)) = refusal {
            let error = result.expect_err("what it requires is not supported").to_string();
            assert!(error.contains(extension), "{error}");
            continue;
        }
        let scene = result.unwrap_or_else(|error| panic!("{shown}: {error}"));
        let view_start = Instant::now();
        let view = scene.camera_view(None).unwrap_or_else(|error| panic!("{shown}: {error}"));
        let view_time = view_start.elapsed();
        assert!(view.world.is_finite(), "{shown}: {view:?}");
        let triangles = scene.facts().triangles;
        println!(
            "{shown}: {triangles} triangles in {took:?}, view {} along {} in {view_time:?} {:?}",
            view.name, -view.world.matrix3.z_axis, scene.warnings
        );
        if let Some(bounds) = scene.bounds() {
            assert!(
                bounds.min.is_finite() && bounds.max.is_finite() && bounds.min.cmple(bounds.max).all(),
                "{shown}: {bounds:?}"
            );
        }
    }
    assert!(count > 80, "only {count} scenes were found");
}

#[test]
fn triangle_counts_agree_with_the_catalogue() {
    let Some(folder) = shared_scenes() else {
        return;
    };
    // As the catalogue beside the scenes counts them.
    let expected = [
        ("bevy-cornell-box/bevy-cornell-box.glb", 36),
        ("breakfast-room/breakfast-room.glb", 269_538),
        ("cornell-original/cornell-original.glb", 36),
        ("sauerbraten-zdm2/sauerbraten-zdm2.glb", 58_772),
        ("sponza/sponza.glb", 70_413),
        ("two-cylinder-engine/two-cylinder-engine.glb", 121_496),
        ("white-room/white-room.glb", 385_833),
    ];
    for (path, triangles) in expected {
        let scene = Scene::load(&folder.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert_eq!(scene.facts().triangles, triangles, "{path}");
    }
}

#[test]
fn a_box_without_a_camera_is_seen_through_its_open_side() {
    let Some(folder) = shared_scenes() else {
        return;
    };
    let scene = Scene::load(&folder.join("bevy-cornell-box/bevy-cornell-box.glb")).expect("it is sound");
    let view = scene.camera_view(None).expect("a view is always found");
    let bounds = scene.bounds().expect("it has triangles");
    let forward = -view.world.matrix3.z_axis;
    println!("{view:?} {bounds:?}");
    assert!(view.automatic);
    // From outside, along the axis of the one wall that is missing.
    assert!(forward.z.abs() > 0.99, "{forward}");
    assert!(view.world.translation.z < bounds.min.z || view.world.translation.z > bounds.max.z);
}

#[test]
fn malformed_files_give_errors_or_their_sound_part() {
    let Some(folder) = shared_scenes() else {
        return;
    };
    let files = gltf_files(&folder.join("malformed"));
    let (mut loaded, mut refused) = (0, 0);
    for path in &files {
        let shown = path.strip_prefix(&folder).unwrap_or(path).display().to_string();
        match load_timed(path).0 {
            Ok(scene) => {
                loaded += 1;
                // What was loaded can be used.
                let view = scene.camera_view(None).expect("a view is always found");
                assert!(view.world.is_finite(), "{shown}: {view:?}");
                scene.emitter_samples(16);
                println!("{shown}: loads {:?}", scene.warnings);
            }
            Err(error) => {
                refused += 1;
                println!("{shown}: {error}");
            }
        }
    }
    println!("{loaded} load, {refused} are refused");
    assert!(files.len() > 100, "only {} files were found", files.len());
    assert!(refused > 20, "only {refused} of {} malformed files were refused", files.len());
}
