//! What the glTF reader promises of nodes, cameras, lights, animations and files as such, on files made here.

use crate::files::empty_folder;
use crate::gltf_file::File;
use glam::{DAffine3, DQuat, DVec3};
use irradia::scene::{LightKind, LoadOptions, NodeId, Projection, Scene, SceneError};
use serde_json::json;

fn fault(file: &File) -> String {
    file.load().expect_err("the file is at fault").to_string()
}

#[test]
fn hierarchies_compose_in_double_precision() {
    let mut file = File::triangle();
    file.json["nodes"] = json!([
        {"name": "far", "translation": [1e6, 0.25, 0.0], "children": [1]},
        {"name": "turned", "rotation": [0.0, 0.0, 0.5f64.sqrt(), 0.5f64.sqrt()], "scale": [2.0, 2.0, 2.0], "children": [2]},
        {"name": "leaf", "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.001, 0, 0, 1], "mesh": 0},
    ]);
    let scene = file.load().expect("it is sound");
    let origin = scene.instances()[0].world.transform_point3(DVec3::ZERO);
    assert!((origin - DVec3::new(1e6, 0.252, 0.0)).length() < 1e-9, "{origin}");
    let bounds = scene.bounds().expect("it has a triangle");
    assert!((bounds.size() - DVec3::new(2.0, 2.0, 0.0)).length() < 1e-9, "{bounds:?}");
}

#[test]
fn negative_scales_flip_the_winding() {
    for (scale, flips) in
        [([1.0, 1.0, 1.0], false), ([-1.0, 1.0, 1.0], true), ([-1.0, -1.0, 1.0], false), ([-1.0, -1.0, -1.0], true)]
    {
        let mut file = File::triangle();
        file.json["nodes"][0]["scale"] = json!(scale);
        assert_eq!(file.load().expect("it is sound").instances()[0].flips_winding, flips, "{scale:?}");
    }
}

#[test]
fn cycles_and_second_parents_are_errors_and_depth_is_none() {
    let mut cycle = File::triangle();
    cycle.json["nodes"] = json!([{"children": [1]}, {"children": [0]}]);
    assert!(fault(&cycle).contains("reached twice"), "{}", fault(&cycle));
    let mut diamond = File::triangle();
    diamond.json["nodes"] = json!([{"children": [1, 2]}, {"children": [2]}, {}]);
    assert!(fault(&diamond).contains("node 2"), "{}", fault(&diamond));
    let mut deep = File::triangle();
    let chain = (0..100_000).map(|index| json!({"children": [index + 1], "translation": [0, 0, 1]}));
    deep.json["nodes"] = chain.chain([json!({"mesh": 0})]).collect();
    let mut scene = deep.load().expect("depth is no fault");
    assert_eq!(scene.instances()[0].world.translation.z, 1e5);
    scene.set_local_transform(NodeId(0), DAffine3::IDENTITY).expect("it can be moved");
    assert_eq!(scene.instances()[0].world.translation.z, 1e5 - 1.0);
}

#[test]
fn cameras_are_found_by_name_node_or_index() {
    let mut file = File::triangle();
    file.json["cameras"] = json!([
        {"type": "perspective", "name": "first", "perspective": {"yfov": 1.0, "znear": 0.1, "aspectRatio": 1.5}},
        {"type": "orthographic", "orthographic": {"xmag": 2.0, "ymag": 1.0, "znear": 0.0, "zfar": 10.0}},
    ]);
    file.json["nodes"] = json!([
        {"mesh": 0},
        {"camera": 0, "translation": [0.0, 0.0, 5.0], "scale": [2.0, 3.0, 4.0]},
        {"camera": 1, "name": "flat"},
    ]);
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let scene = file.load().expect("it is sound");
    let first = scene.camera_view(None).expect("there is one");
    assert_eq!(first, scene.camera_view(Some("first")).expect("by name"));
    assert_eq!(first, scene.camera_view(Some("0")).expect("by index"));
    assert_eq!(first.projection, Projection::Perspective { vertical_fov: 1.0, aspect: Some(1.5), near: 0.1 });
    assert_eq!(first.world, DAffine3::from_translation(DVec3::new(0.0, 0.0, 5.0)), "scale is removed");
    let flat = scene.camera_view(Some("flat")).expect("by the node's name");
    assert_eq!(flat.projection, Projection::Orthographic { half_width: 2.0, half_height: 1.0, near: 0.0, far: 10.0 });
    assert_eq!(flat, scene.camera_view(Some("1")).expect("by index"));
    let error = scene.camera_view(Some("third")).expect_err("there is none").to_string();
    assert!(error.contains("third") && error.contains("first") && error.contains("flat"), "{error}");
}

#[test]
fn without_cameras_a_view_shows_the_scene() {
    let scene = File::triangle().load().expect("it is sound");
    let view = scene.camera_view(None).expect("a view is always found");
    let forward = -view.world.matrix3.z_axis;
    assert!(view.automatic && forward.z < 0.0, "the triangle faces +Z: {forward}");
    let bounds = scene.bounds().expect("it has a triangle");
    let to_center = (bounds.center() - view.world.translation).normalize();
    assert!(to_center.dot(forward) > 0.999);
    assert!(matches!(scene.camera_view(Some("any")), Err(SceneError::UnknownCamera { .. })));
}

#[test]
fn lights_are_placed_in_the_world() {
    let mut file = File::triangle();
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "spot", "intensity": 10.0, "color": [1.0, 0.5, 0.0], "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.4}},
        {"type": "directional"},
        {"type": "lamp"},
    ]}});
    file.json["nodes"] = json!([
        {"translation": [1, 2, 3], "scale": [2, 2, 2], "rotation": [-(0.5f64.sqrt()), 0, 0, 0.5f64.sqrt()], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}},
        {"extensions": {"KHR_lights_punctual": {"light": 2}}},
    ]);
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let scene = file.load().expect("it is sound");
    let lights = scene.placed_lights();
    assert_eq!(lights.len(), 2, "the third is of no known kind: {:?}", scene.warnings);
    assert_eq!(scene.warnings.len(), 1);
    assert_eq!(lights[0].kind, LightKind::Spot { inner_angle: 0.2, outer_angle: 0.4 });
    assert_eq!(lights[0].intensity, [10.0, 5.0, 0.0]);
    assert_eq!(lights[0].position, DVec3::new(1.0, 2.0, 3.0));
    assert!((lights[0].direction - DVec3::NEG_Y).length() < 1e-9, "{}", lights[0].direction);
    assert_eq!(lights[1].direction, DVec3::NEG_Z);
}

fn animated(interpolation: &str, path: &str, times: &[f32], values: &[f32]) -> Scene {
    let mut file = File::triangle();
    let shape = if path == "rotation" { "VEC4" } else { "VEC3" };
    let input = file.floats(times, "SCALAR", times.len());
    let output = file.floats(values, shape, values.len() / if path == "rotation" { 4 } else { 3 });
    file.json["nodes"][0]["scale"] = json!([2.0, 2.0, 2.0]);
    file.json["animations"] = json!([{
        "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}],
    }]);
    let scene = file.load().expect("it is sound");
    assert_eq!(scene.warnings, Vec::<String>::new());
    assert_eq!(scene.animations().len(), 1);
    scene
}

fn translation_at(scene: &mut Scene, seconds: f64) -> DVec3 {
    scene.set_time(seconds);
    let local = scene.nodes()[0].local;
    assert!((local.matrix3.x_axis - DVec3::X * 2.0).length() < 1e-12, "what is not animated stays: {local:?}");
    local.translation
}

#[test]
fn linear_and_step_animations_interpolate_and_stop_at_their_ends() {
    let values = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 4.0, 8.0, 0.0];
    let mut linear = animated("LINEAR", "translation", &[1.0, 2.0, 4.0], &values);
    for (seconds, x, y) in [(0.0, 0.0, 0.0), (1.25, 1.0, 0.0), (2.0, 4.0, 0.0), (3.0, 4.0, 4.0), (9.0, 4.0, 8.0)] {
        assert_eq!(translation_at(&mut linear, seconds), DVec3::new(x, y, 0.0), "at {seconds} s");
    }
    let mut step = animated("STEP", "translation", &[1.0, 2.0, 4.0], &values);
    for (seconds, x, y) in [(0.0, 0.0, 0.0), (1.99, 0.0, 0.0), (2.0, 4.0, 0.0), (3.99, 4.0, 0.0), (9.0, 4.0, 8.0)] {
        assert_eq!(translation_at(&mut step, seconds), DVec3::new(x, y, 0.0), "at {seconds} s");
    }
    linear.set_frame(45); // frame 45 is at 1.5 s
    assert_eq!(linear.nodes()[0].local.translation, DVec3::new(2.0, 0.0, 0.0));
}

#[test]
fn cubic_splines_follow_their_tangents() {
    // x(t) = t³ − t over [0, 2]: its tangents are −1 and 11.
    let values = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 11.0, 0.0, 0.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut scene = animated("CUBICSPLINE", "translation", &[0.0, 2.0], &values);
    for seconds in [0.0, 0.3, 1.0, 1.7, 2.0] {
        let x = translation_at(&mut scene, seconds).x;
        let expected = seconds * seconds * seconds - seconds;
        assert!((x - expected).abs() < 1e-12, "at {seconds} s: {x}, not {expected}");
    }
}

#[test]
fn rotations_take_the_shortest_arc() {
    // The second quaternion is a quarter turn about Z with its sign reversed.
    let half = 0.5f32.sqrt();
    let mut scene = animated("LINEAR", "rotation", &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -half, -half]);
    scene.set_time(0.5);
    let axis = scene.nodes()[0].local.matrix3.x_axis.normalize();
    let expected = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_4) * DVec3::X;
    assert!((axis - expected).length() < 1e-6, "{axis}");
}

/// A file whose light 1 has an animated intensity; light 0 is of no known kind, so that the scene's own light is its first.
fn with_switched_light(interpolation: &str, pointer: &str, values: &[f32]) -> File {
    let mut file = File::triangle();
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "lamp"},
        {"type": "point", "color": [1.0, 0.5, 0.0], "intensity": 7.0},
    ]}});
    file.json["nodes"] = json!([{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 1}}}]);
    file.json["scenes"][0]["nodes"] = json!([0, 1]);
    let input = file.floats(&[0.0, 0.5, 1.5], "SCALAR", 3);
    let output = file.floats(values, "SCALAR", values.len());
    file.json["extensionsUsed"] = json!(["KHR_animation_pointer", "KHR_lights_punctual"]);
    file.json["animations"] = json!([{
        "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
        "channels": [{"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}}],
    }]);
    file
}

#[test]
fn lights_are_switched_and_dimmed() {
    let pointer = "/extensions/KHR_lights_punctual/lights/1/intensity";
    let intensities = |interpolation: &str, values: &[f32], times: &[f64]| -> Vec<[f32; 3]> {
        let mut scene = with_switched_light(interpolation, pointer, values).load().expect("it is sound");
        assert_eq!((scene.warnings.len(), scene.animations()[0].duration()), (0, 1.5), "{:?}", scene.warnings);
        assert_eq!(scene.placed_lights()[0].intensity, [7.0, 3.5, 0.0], "before any time is set");
        let at = |seconds: &f64| {
            scene.set_time(*seconds);
            scene.placed_lights()[0].intensity
        };
        times.iter().map(at).collect()
    };
    let switched = intensities("STEP", &[4.0, 0.0, 2.0], &[0.0, 0.49, 0.5, 1.0, 1.5, 9.0]);
    assert_eq!(switched, [4.0, 4.0, 0.0, 0.0, 2.0, 2.0].map(|strength| [strength, 0.5 * strength, 0.0]));
    let dimmed = intensities("LINEAR", &[4.0, 0.0, 2.0], &[0.25, 1.0]);
    assert_eq!(dimmed, [2.0, 1.0].map(|strength| [strength, 0.5 * strength, 0.0]));
    // A spline that swings below zero is dark there.
    let spline = intensities("CUBICSPLINE", &[0.0, 1.0, -20.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0], &[0.25, 0.5]);
    assert_eq!(spline, [[0.0; 3], [1.0, 0.5, 0.0]]);

    let mut scene = with_switched_light("STEP", pointer, &[4.0, 0.0, 2.0]).load().expect("it is sound");
    scene.set_time(0.1);
    let before = scene.revisions();
    scene.set_time(0.4);
    assert_eq!(scene.revisions(), before, "nothing changed");
    scene.set_time(0.5);
    assert_eq!((scene.revisions().lights, scene.revisions().geometry), (before.lights + 1, before.geometry));
}

#[test]
fn what_else_a_pointer_animates_is_left_out_with_a_sentence() {
    for (pointer, values, words) in [
        ("/materials/0/emissiveFactor", &[1.0, 1.0, 1.0][..], "/materials/0/emissiveFactor"),
        ("/extensions/KHR_lights_punctual/lights/1/color", &[1.0, 1.0, 1.0], "only the intensity of lights"),
        ("/extensions/KHR_lights_punctual/lights/1/intensity", &[1.0, 1.0], "2 values for 3 times"),
        ("/extensions/KHR_lights_punctual/lights/1/intensity", &[1.0, f32::NAN, 1.0], "not finite"),
    ] {
        let scene = with_switched_light("STEP", pointer, values).load().expect("the rest is sound");
        assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
        assert!(scene.warnings[0].contains(words), "{:?}", scene.warnings);
        assert!(scene.animations().is_empty());
    }
}

#[test]
fn extensions_are_refused_if_required_and_named_once_if_not() {
    let mut file = File::triangle();
    file.json["extensionsUsed"] = json!(["EXT_b", "EXT_a", "KHR_materials_ior"]);
    let scene = file.load().expect("they are optional");
    assert_eq!(scene.warnings, ["extensions that are not supported are ignored: EXT_a, EXT_b"]);
    file.json["extensionsRequired"] = json!(["EXT_b", "KHR_materials_ior"]);
    let error = file.load().expect_err("it is required");
    assert!(matches!(&error, SceneError::RequiredExtensions { extensions, .. } if extensions == "EXT_b"), "{error}");
}

#[test]
fn all_containers_give_the_same_scene() {
    let folder = std::env::temp_dir().join(format!("irradia-containers-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("sub folder")).expect("a temporary folder");
    let file = File::triangle();
    std::fs::write(folder.join("sub folder/data.bin"), &file.bin).expect("it can be written");
    std::fs::write(folder.join("external.gltf"), file.gltf("sub%20folder/data.bin")).expect("it can be written");
    std::fs::write(folder.join("binary.glb"), file.glb()).expect("it can be written");
    let external = Scene::load(&folder.join("external.gltf")).expect("the buffer lies beside it");
    let binary = Scene::open(&folder.join("binary.glb").display().to_string()).expect("the buffer is a chunk");
    let embedded =
        Scene::from_bytes("embedded", file.gltf(&file.data_uri()).as_bytes(), None).expect("the buffer is a data URI");
    std::fs::remove_dir_all(&folder).expect("it can be removed");
    assert_eq!((external.name.as_str(), binary.name.as_str()), ("external", "binary"));
    for scene in [&external, &binary, &embedded] {
        assert_eq!(scene.bounds(), File::triangle().load().expect("it is sound").bounds());
    }
}

#[test]
fn uris_that_lead_elsewhere_are_refused() {
    let file = File::triangle();
    for (uri, expected) in [
        ("http://example.org/a.bin", "relative path"),
        ("file:///etc/passwd", "--allow-outside-files"),
        ("/etc/passwd", "--allow-outside-files"),
        ("%2Fetc/passwd", "--allow-outside-files"),
        ("a%zz.bin", "percent"),
        ("missing.bin", "missing.bin"),
        ("data:application/octet-stream;base64,@@@@", "base64"),
        ("data:application/octet-stream,plain", "base64"),
    ] {
        let result = Scene::from_bytes("test", file.gltf(uri).as_bytes(), Some(std::path::Path::new("/tmp")));
        let error = result.expect_err(uri).to_string();
        assert!(error.contains(expected), "{uri}: {error}");
    }
}

#[test]
fn files_outside_the_scenes_folder_are_read_only_if_allowed() {
    let root = empty_folder("gltf-scenes", "outside");
    let folder = root.join("scene");
    std::fs::create_dir_all(folder.join("sub")).expect("the test's own folder");
    let file = File::triangle();
    std::fs::write(root.join("data.bin"), &file.bin).expect("the test's own folder");
    std::fs::write(folder.join("near.bin"), &file.bin).expect("the test's own folder");
    let mut outside = vec!["../data.bin".to_owned(), "%2e%2e/data.bin".to_owned(), "sub/../../data.bin".to_owned()];
    let path = root.join("data.bin").display().to_string();
    outside.extend([format!("file://{path}"), format!("file://localhost{path}"), path]);
    #[cfg(unix)]
    for (name, to) in [("link.bin", "../data.bin"), ("far", "..")] {
        std::os::unix::fs::symlink(to, folder.join(name)).expect("links can be made");
        outside.push(if name == "far" { "far/data.bin".to_owned() } else { name.to_owned() });
    }
    let load = |uri: &str, options: &LoadOptions| {
        Scene::from_bytes_with("test", file.gltf(uri).as_bytes(), Some(&folder), options)
    };
    let allowed = LoadOptions::default().with(|options| options.allow_outside_files = true);
    for uri in &outside {
        let error = load(uri, &LoadOptions::default()).expect_err(uri).to_string();
        assert!(error.contains("--allow-outside-files"), "{uri}: {error}");
        assert_eq!(load(uri, &allowed).expect(uri).instances().len(), 1);
    }
    for uri in ["near.bin", "./near.bin", "sub/../near.bin", "../scene/near.bin"] {
        assert!(load(uri, &LoadOptions::default()).is_ok(), "{uri} is in the folder, however it is spelled");
    }
    let scene = folder.join("outside.gltf");
    std::fs::write(&scene, file.gltf("../data.bin")).expect("the test's own folder");
    let program = |more: &[&str]| {
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_irradia"));
        program.args(["graph", "--size", "16x16"]).arg(&scene).args(more).output().expect("the program starts")
    };
    let refused = program(&[]);
    let message = String::from_utf8_lossy(&refused.stderr);
    assert_eq!((refused.status.code(), message.lines().count()), (Some(1), 1), "{message}");
    assert!(message.contains("--allow-outside-files"), "{message}");
    assert!(program(&["--allow-outside-files"]).status.success());
}

#[test]
fn files_larger_than_the_limit_are_not_read() {
    let folder = empty_folder("gltf-scenes", "large");
    let file = File::triangle();
    let sparse = std::fs::File::create(folder.join("data.bin")).expect("the test's own folder");
    sparse.set_len(1 << 40).expect("files may have holes");
    std::fs::write(folder.join("scene.gltf"), file.gltf("data.bin")).expect("the test's own folder");
    let error = Scene::load(&folder.join("scene.gltf")).expect_err("a tebibyte").to_string();
    assert!(error.contains("LoadOptions::file_bytes"), "{error}");
    let few = LoadOptions::default().with(|options| options.file_bytes = 16);
    let error = Scene::load_with(&folder.join("scene.gltf"), &few).expect_err("it has more").to_string();
    assert!(error.contains("scene.gltf"), "{error}");
}

#[test]
fn faults_in_unused_parts_do_not_matter() {
    let mut file = File::triangle();
    for (section, element) in [
        ("meshes", json!({"primitives": "none"})),
        ("nodes", json!({"mesh": 77, "children": [0]})),
        ("materials", json!({"emissiveFactor": "bright"})),
        ("accessors", json!({})),
        ("buffers", json!({"uri": "missing.bin"})),
        ("images", json!(3)),
        ("animations", json!({"channels": 1})),
        ("cameras", json!([])),
    ] {
        file.push(section, element);
    }
    file.json["skins"] = json!("none");
    let scene = file.load().expect("the active scene is sound");
    assert_eq!(scene.instances().len(), 1);
    assert_eq!(scene.warnings.len(), 1, "the animation: {:?}", scene.warnings);
}

#[test]
fn the_description_is_read() {
    let mut file = File::triangle();
    file.json["asset"]["extras"] = json!({"description": "one triangle"});
    assert_eq!(file.load().expect("it is sound").description.as_deref(), Some("one triangle"));
}

#[test]
fn builtin_scenes_load_and_describe_themselves() {
    for name in irradia::scene::builtin_names() {
        let scene = Scene::open(name).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(scene.warnings, Vec::<String>::new(), "{name}");
        assert!(scene.description.is_some_and(|line| !line.is_empty()), "{name} has no description");
    }
    let error = Scene::open("no such scene").expect_err("there is none").to_string();
    assert!(
        error.contains("no such scene") && irradia::scene::builtin_names().iter().all(|name| error.contains(name)),
        "{error}"
    );
}
