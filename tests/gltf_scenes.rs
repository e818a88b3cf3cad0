//! What the glTF reader promises, feature by feature, on files made here.

mod gltf_file;

use glam::{DAffine3, DQuat, DVec3};
use gltf_file::File;
use irradia::scene::{Alpha, LightKind, NodeId, Primitive, Projection, Scene, SceneError, Wrap};
use serde_json::{Value, json};

/// The first primitive of a file whose mesh has one.
fn only_primitive(file: &File) -> Primitive {
    let scene = file.load().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.instances().len(), 1, "{:?}", scene.warnings);
    scene.meshes()[0].primitives[0].clone()
}

fn fault(file: &File) -> String {
    file.load().expect_err("the file is at fault").to_string()
}

#[test]
fn all_index_types_are_read() {
    for (component, bytes) in [(5121, 1), (5123, 2), (5125, 4)] {
        let mut file = File::triangle();
        let data: Vec<u8> = [2u32, 0, 1]
            .iter()
            .flat_map(|index| index.to_le_bytes()[..bytes].to_vec())
            .collect();
        let indices = file.accessor(&data, component, "SCALAR", 3);
        file.primitive()["indices"] = json!(indices);
        assert_eq!(
            only_primitive(&file).indices,
            [2, 0, 1],
            "component type {component}"
        );
    }
}

#[test]
fn without_indices_the_vertices_are_used_in_order() {
    assert_eq!(only_primitive(&File::triangle()).indices, [0, 1, 2]);
}

#[test]
fn strips_and_fans_become_lists_of_the_same_orientation() {
    // A strip zigzags up, a fan turns counter-clockwise; all their triangles face +Z.
    let strip = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 2.0, 0.0],
    ];
    let fan = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
    ];
    for (mode, positions) in [(5, strip), (6, fan)] {
        let mut file = File::with_positions(&positions);
        file.primitive()["mode"] = json!(mode);
        let primitive = only_primitive(&file);
        assert_eq!(primitive.triangle_count(), 3, "mode {mode}");
        for [a, b, c] in primitive.triangles() {
            let signed_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
            assert!(signed_area > 0.0, "mode {mode}: {a:?} {b:?} {c:?}");
        }
    }
}

#[test]
fn points_and_lines_are_left_out_with_one_warning() {
    for mode in 0..4 {
        let mut file = File::triangle();
        file.primitive()["mode"] = json!(mode);
        let scene = file.load().expect("the rest is sound");
        assert!(scene.instances().is_empty());
        assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    }
}

#[test]
fn normalised_integers_become_floats() {
    let mut file = File::triangle();
    let texcoords = file.normalized(&[0, 0, 255, 0, 0, 51], 5121, "VEC2", 3);
    let colors: Vec<u8> = [65535u16, 0, 0, 0, 65535, 0, 0, 0, 13107]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let colors = file.normalized(&colors, 5123, "VEC3", 3);
    file.attribute("TEXCOORD_0", texcoords);
    file.attribute("COLOR_0", colors);
    let primitive = only_primitive(&file);
    assert_eq!(
        primitive.texcoords[0].as_deref(),
        Some(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.2]][..])
    );
    assert_eq!(
        primitive.colors.as_deref(),
        Some(
            &[
                [1.0, 0.0, 0.0, 1.0],
                [0.0, 1.0, 0.0, 1.0],
                [0.0, 0.0, 0.2, 1.0]
            ][..]
        )
    );
}

#[test]
fn quantized_positions_and_normals_are_read() {
    let mut file = File::triangle();
    file.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let positions: Vec<u8> = [0i16, 0, 0, 300, 0, 0, 0, -300, 0]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let positions = file.accessor(&positions, 5122, "VEC3", 3);
    let normals = file.normalized(&[0, 0, 127, 0, 0, 127, 0, 0, 128], 5120, "VEC3", 3);
    file.attribute("POSITION", positions);
    file.attribute("NORMAL", normals);
    let primitive = only_primitive(&file);
    assert_eq!(
        primitive.positions,
        [[0.0, 0.0, 0.0], [300.0, 0.0, 0.0], [0.0, -300.0, 0.0]]
    );
    assert_eq!(
        primitive.normals.as_deref(),
        Some(&[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]][..])
    );
}

#[test]
fn sparse_accessors_replace_elements_of_a_base_or_of_zeros() {
    for with_base in [true, false] {
        let mut file = File::triangle();
        let indices = file.view(&[1, 2]);
        let values = file.view(&gltf_file::float_bytes(&[5.0, 0.0, 0.0, 0.0, 6.0, 0.0]));
        let mut accessor = json!({
            "componentType": 5126, "type": "VEC3", "count": 3,
            "sparse": {"count": 2, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}},
        });
        let mut first = [0.0; 3];
        if with_base {
            first = [9.0, 9.0, 9.0];
            accessor["bufferView"] = json!(file.view(&gltf_file::float_bytes(&[9.0; 9])));
        }
        let accessor = file.push("accessors", accessor);
        file.attribute("POSITION", accessor);
        assert_eq!(
            only_primitive(&file).positions,
            [first, [5.0, 0.0, 0.0], [0.0, 6.0, 0.0]],
            "with base: {with_base}"
        );
    }
}

#[test]
fn what_an_accessor_claims_is_checked_before_it_is_allocated() {
    let huge = 1u64 << 40;
    let cases = [
        json!({"count": huge}),
        json!({"count": u64::MAX}),
        json!({"byteOffset": u64::MAX}),
        json!({"bufferView": 99}),
        json!({"bufferView": null, "count": huge}),
        json!({"bufferView": null, "count": 100_000_000}),
        json!({"componentType": 7}),
        json!({"type": "VEC2"}),
    ];
    for case in cases {
        let mut file = File::triangle();
        let accessor = &mut file.json["accessors"][0];
        case.as_object()
            .expect("an object")
            .iter()
            .for_each(|(key, value)| accessor[key] = value.clone());
        let fault = fault(&file);
        assert!(
            fault.contains("mesh 0") && fault.contains("accessor 0")
                || fault.contains("buffer view 99"),
            "{case}: {fault}"
        );
    }
    for (key, value) in [
        ("byteLength", json!(37)),
        ("byteOffset", json!(u64::MAX)),
        ("byteStride", json!(8)),
        ("byteStride", json!(u64::MAX)),
    ] {
        let mut file = File::triangle();
        file.json["bufferViews"][0][key] = value;
        assert!(
            fault(&file).contains("buffer view 0"),
            "{key}: {}",
            fault(&file)
        );
    }
}

#[test]
fn many_primitives_may_share_vertices_of_which_each_keeps_few() {
    // Kept whole by each of 200 primitives, 100 kB of vertices would be more than the file justifies.
    let positions: Vec<[f32; 3]> = (0..9000)
        .map(|vertex| [vertex as f32, (vertex % 2) as f32, 0.0])
        .collect();
    for indexed in [true, false] {
        let mut file = File::with_positions(&positions);
        if indexed {
            let indices = file.accessor(&[0, 2, 1], 5121, "SCALAR", 3);
            file.primitive()["indices"] = json!(indices);
        }
        let primitive = file.primitive().clone();
        file.json["meshes"][0]["primitives"] = json!(vec![primitive; 200]);
        match file.load() {
            Ok(scene) => assert!(indexed && scene.meshes()[0].primitives[199].positions.len() == 3),
            Err(error) => assert!(
                !indexed && error.to_string().contains("16 times"),
                "{error}"
            ),
        }
    }
}

#[test]
fn skins_and_morph_targets_are_warned_of_once() {
    let mut file = File::triangle();
    let targets = json!([{"POSITION": 0}]);
    file.primitive()["targets"] = targets;
    file.json["skins"] = json!([{"joints": [0]}]);
    file.json["nodes"] = json!([{"mesh": 0, "skin": 0, "children": [1]}, {"mesh": 0, "skin": 0}]);
    let scene = file.load().expect("the static mesh is shown");
    assert_eq!(scene.instances().len(), 2);
    let [morphs, skins] = &scene.warnings[..] else {
        panic!("{:?}", scene.warnings)
    };
    assert!(morphs.contains("morph") && skins.contains("skins"));
}

#[test]
fn indices_out_of_range_name_mesh_and_primitive() {
    let mut file = File::triangle();
    let indices = file.accessor(&[0, 1, 3], 5121, "SCALAR", 3);
    file.primitive()["indices"] = json!(indices);
    file.json["meshes"][0]["name"] = json!("wall");
    let fault = fault(&file);
    assert!(
        fault.contains("\"wall\", primitive 0") && fault.contains("index is 3"),
        "{fault}"
    );
}

#[test]
fn positions_that_are_not_finite_drop_their_primitive() {
    let file = File::with_positions(&[[0.0, 0.0, 0.0], [f32::NAN, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let scene = file.load().expect("the rest is sound");
    assert!(scene.instances().is_empty());
    assert!(
        scene.warnings[0].contains("not finite"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn vertices_that_no_triangle_uses_are_dropped() {
    let mut file = File::with_positions(&[
        [0.0, 0.0, 0.0],
        [7.0, 7.0, 7.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
    ]);
    let indices = file.accessor(&[0, 2, 3], 5121, "SCALAR", 3);
    file.primitive()["indices"] = json!(indices);
    let primitive = only_primitive(&file);
    assert_eq!(
        primitive.positions,
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    );
    assert_eq!(primitive.indices, [0, 1, 2]);
    assert_eq!(primitive.source_bytes, 4 * 12 + 3);
}

#[test]
fn bad_normals_become_face_normals_and_missing_ones_stay_missing() {
    assert!(only_primitive(&File::triangle()).normals.is_none());
    let mut file = File::triangle();
    let normals = file.floats(
        &[0.0, 0.0, 0.0, 0.0, 2.0, 0.0, f32::NAN, 0.0, 0.0],
        "VEC3",
        3,
    );
    file.attribute("NORMAL", normals);
    assert_eq!(
        only_primitive(&file).normals.as_deref(),
        Some(&[[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]][..])
    );
}

#[test]
fn tangents_are_made_for_normal_maps_alone() {
    // v grows downwards, so this quad shows its texture upright: the tangent is +X, the bitangent +Y.
    let mut file = File::with_positions(&[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ]);
    let indices = file.accessor(&[0, 1, 2, 0, 2, 3], 5121, "SCALAR", 6);
    file.primitive()["indices"] = json!(indices);
    let texcoords = file.floats(&[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0], "VEC2", 4);
    file.attribute("TEXCOORD_0", texcoords);
    let texture = file.texture(&gltf_file::png(1, 1, &[128, 128, 255, 255]), json!({}));
    file.material(json!({}));
    assert!(only_primitive(&file).tangents.is_none());
    file.json["materials"][0]["normalTexture"] = json!({"index": texture});
    let primitive = only_primitive(&file);
    assert_eq!(
        primitive.positions.len(),
        6,
        "flat normals need vertices of their own"
    );
    assert!(
        primitive
            .normals
            .as_ref()
            .expect("made")
            .iter()
            .all(|normal| *normal == [0.0, 0.0, 1.0])
    );
    for tangent in primitive.tangents.as_ref().expect("made") {
        let error = tangent
            .iter()
            .zip([1.0, 0.0, 0.0, 1.0])
            .map(|(is, should): (&f32, f32)| (is - should).abs())
            .fold(0.0, f32::max);
        assert!(error < 1e-6, "{tangent:?}");
    }
    // With smooth normals the corners are welded again.
    let normals = file.floats(&[0.0, 0.0, 1.0].repeat(4), "VEC3", 4);
    file.attribute("NORMAL", normals);
    assert_eq!(only_primitive(&file).positions.len(), 4);
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
    assert!(
        (origin - DVec3::new(1e6, 0.252, 0.0)).length() < 1e-9,
        "{origin}"
    );
    let bounds = scene.bounds().expect("it has a triangle");
    assert!(
        (bounds.size() - DVec3::new(2.0, 2.0, 0.0)).length() < 1e-9,
        "{bounds:?}"
    );
}

#[test]
fn negative_scales_flip_the_winding() {
    for (scale, flips) in [
        ([1.0, 1.0, 1.0], false),
        ([-1.0, 1.0, 1.0], true),
        ([-1.0, -1.0, 1.0], false),
        ([-1.0, -1.0, -1.0], true),
    ] {
        let mut file = File::triangle();
        file.json["nodes"][0]["scale"] = json!(scale);
        assert_eq!(
            file.load().expect("it is sound").instances()[0].flips_winding,
            flips,
            "{scale:?}"
        );
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
    let chain =
        (0..100_000).map(|index| json!({"children": [index + 1], "translation": [0, 0, 1]}));
    deep.json["nodes"] = chain.chain([json!({"mesh": 0})]).collect();
    let mut scene = deep.load().expect("depth is no fault");
    assert_eq!(scene.instances()[0].world.translation.z, 1e5);
    scene
        .set_local_transform(NodeId(0), DAffine3::IDENTITY)
        .expect("it can be moved");
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
    assert_eq!(
        first.projection,
        Projection::Perspective {
            vertical_fov: 1.0,
            aspect: Some(1.5),
            near: 0.1
        }
    );
    assert_eq!(
        first.world,
        DAffine3::from_translation(DVec3::new(0.0, 0.0, 5.0)),
        "scale is removed"
    );
    let flat = scene.camera_view(Some("flat")).expect("by the node's name");
    assert_eq!(
        flat.projection,
        Projection::Orthographic {
            half_width: 2.0,
            half_height: 1.0,
            near: 0.0,
            far: 10.0
        }
    );
    assert_eq!(flat, scene.camera_view(Some("1")).expect("by index"));
    let error = scene
        .camera_view(Some("third"))
        .expect_err("there is none")
        .to_string();
    assert!(
        error.contains("third") && error.contains("first") && error.contains("flat"),
        "{error}"
    );
}

#[test]
fn without_cameras_a_view_shows_the_scene() {
    let scene = File::triangle().load().expect("it is sound");
    let view = scene.camera_view(None).expect("a view is always found");
    let forward = -view.world.matrix3.z_axis;
    assert!(
        view.automatic && forward.z < 0.0,
        "the triangle faces +Z: {forward}"
    );
    let bounds = scene.bounds().expect("it has a triangle");
    let to_center = (bounds.center() - view.world.translation).normalize();
    assert!(to_center.dot(forward) > 0.999);
    assert!(matches!(
        scene.camera_view(Some("any")),
        Err(SceneError::UnknownCamera { .. })
    ));
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
    assert_eq!(
        lights.len(),
        2,
        "the third is of no known kind: {:?}",
        scene.warnings
    );
    assert_eq!(scene.warnings.len(), 1);
    assert_eq!(
        lights[0].kind,
        LightKind::Spot {
            inner_angle: 0.2,
            outer_angle: 0.4
        }
    );
    assert_eq!(lights[0].intensity, [10.0, 5.0, 0.0]);
    assert_eq!(lights[0].position, DVec3::new(1.0, 2.0, 3.0));
    assert!(
        (lights[0].direction - DVec3::NEG_Y).length() < 1e-9,
        "{}",
        lights[0].direction
    );
    assert_eq!(lights[1].direction, DVec3::NEG_Z);
}

fn animated(interpolation: &str, path: &str, times: &[f32], values: &[f32]) -> Scene {
    let mut file = File::triangle();
    let shape = if path == "rotation" { "VEC4" } else { "VEC3" };
    let input = file.floats(times, "SCALAR", times.len());
    let output = file.floats(
        values,
        shape,
        values.len() / if path == "rotation" { 4 } else { 3 },
    );
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
    assert!(
        (local.matrix3.x_axis - DVec3::X * 2.0).length() < 1e-12,
        "what is not animated stays: {local:?}"
    );
    local.translation
}

#[test]
fn linear_and_step_animations_interpolate_and_stop_at_their_ends() {
    let values = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 4.0, 8.0, 0.0];
    let mut linear = animated("LINEAR", "translation", &[1.0, 2.0, 4.0], &values);
    for (seconds, x, y) in [
        (0.0, 0.0, 0.0),
        (1.25, 1.0, 0.0),
        (2.0, 4.0, 0.0),
        (3.0, 4.0, 4.0),
        (9.0, 4.0, 8.0),
    ] {
        assert_eq!(
            translation_at(&mut linear, seconds),
            DVec3::new(x, y, 0.0),
            "at {seconds} s"
        );
    }
    let mut step = animated("STEP", "translation", &[1.0, 2.0, 4.0], &values);
    for (seconds, x, y) in [
        (0.0, 0.0, 0.0),
        (1.99, 0.0, 0.0),
        (2.0, 4.0, 0.0),
        (3.99, 4.0, 0.0),
        (9.0, 4.0, 8.0),
    ] {
        assert_eq!(
            translation_at(&mut step, seconds),
            DVec3::new(x, y, 0.0),
            "at {seconds} s"
        );
    }
    linear.set_frame(45); // frame 45 is at 1.5 s
    assert_eq!(
        linear.nodes()[0].local.translation,
        DVec3::new(2.0, 0.0, 0.0)
    );
}

#[test]
fn cubic_splines_follow_their_tangents() {
    // x(t) = t³ − t over [0, 2]: its tangents are −1 and 11.
    let values = [
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 11.0, 0.0, 0.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    ];
    let mut scene = animated("CUBICSPLINE", "translation", &[0.0, 2.0], &values);
    for seconds in [0.0, 0.3, 1.0, 1.7, 2.0] {
        let x = translation_at(&mut scene, seconds).x;
        let expected = seconds * seconds * seconds - seconds;
        assert!(
            (x - expected).abs() < 1e-12,
            "at {seconds} s: {x}, not {expected}"
        );
    }
}

#[test]
fn rotations_take_the_shortest_arc() {
    // The second quaternion is a quarter turn about Z with its sign reversed.
    let half = 0.5f32.sqrt();
    let mut scene = animated(
        "LINEAR",
        "rotation",
        &[0.0, 1.0],
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -half, -half],
    );
    scene.set_time(0.5);
    let axis = scene.nodes()[0].local.matrix3.x_axis.normalize();
    let expected = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_4) * DVec3::X;
    assert!((axis - expected).length() < 1e-6, "{axis}");
}

#[test]
fn materials_take_their_extensions() {
    let mut file = File::triangle();
    file.material(json!({
        "name": "all",
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 7.0},
        "emissiveFactor": [1.0, 0.5, 0.0], "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 20.0}, "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_specular": {"specularFactor": 0.0, "specularColorFactor": [2.0, 1.0, 0.5]},
            "KHR_materials_transmission": {"transmissionFactor": 0.75},
            "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": 3.0, "attenuationColor": [0.5, 0.6, 0.7]},
        },
    }));
    let scene = file.load().expect("it is sound");
    let material = &scene.materials()[0];
    assert_eq!(
        (material.base_color, material.metallic, material.roughness),
        ([0.1, 0.2, 0.3, 0.4], 0.5, 1.0)
    );
    assert_eq!(material.emissive, [20.0, 10.0, 0.0]);
    assert_eq!(
        (material.alpha, material.double_sided, material.unlit),
        (Alpha::Mask { cutoff: 0.25 }, true, false)
    );
    assert_eq!(
        (material.ior, material.specular, material.specular_color),
        (1.33, 0.0, [2.0, 1.0, 0.5])
    );
    assert_eq!((material.transmission, material.thickness), (0.75, 1.0));
    assert_eq!(
        (material.attenuation_distance, material.attenuation_color),
        (3.0, [0.5, 0.6, 0.7])
    );
    let facts = scene.facts();
    assert!(
        facts.emissive
            && facts.transmissive
            && facts.alpha_masked
            && facts.specular
            && facts.diffuse
            && facts.lit()
    );
}

#[test]
fn a_matt_material_has_no_specular_lobe_and_metal_no_diffuse_one() {
    let facts = |material: Value| {
        let mut file = File::triangle();
        file.material(material);
        file.load().expect("it is sound").facts()
    };
    let matt = facts(
        json!({"pbrMetallicRoughness": {"metallicFactor": 0.0}, "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}}}),
    );
    assert!(matt.diffuse && !matt.specular && !matt.glossy && !matt.lit());
    let metal = facts(json!({"pbrMetallicRoughness": {"roughnessFactor": 0.1}}));
    assert!(!metal.diffuse && metal.specular && metal.glossy);
    let plastic = facts(json!({"pbrMetallicRoughness": {"metallicFactor": 0.0}}));
    assert!(plastic.diffuse && plastic.specular && !plastic.glossy);
}

#[test]
fn blending_becomes_a_cutout_with_a_warning() {
    let mut file = File::triangle();
    file.material(json!({"name": "veil", "alphaMode": "BLEND"}));
    let scene = file.load().expect("it is sound");
    assert_eq!(scene.materials()[0].alpha, Alpha::Mask { cutoff: 0.5 });
    assert!(
        scene.warnings.len() == 1 && scene.warnings[0].contains("veil"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn textures_are_shared_split_by_use_and_decoded_only_if_used() {
    let mut file = File::triangle();
    let image = gltf_file::png(2, 1, &[255, 0, 0, 255, 0, 255, 0, 128]);
    let texture = file.texture(
        &image,
        json!({"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}),
    );
    file.texture(b"this is no image, and nothing uses it", json!({}));
    file.material(json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": texture}, "metallicRoughnessTexture": {"index": texture, "texCoord": 1}},
        "emissiveTexture": {"index": texture},
    }));
    let scene = file.load().expect("it is sound");
    let material = &scene.materials()[0];
    let [base, data, emissive] = [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.emissive_texture,
    ]
    .map(|reference| reference.expect("it is used"));
    assert_eq!(base.texture, emissive.texture);
    assert_ne!(base.texture, data.texture);
    assert_eq!((base.texcoord, data.texcoord), (0, 1));
    assert_eq!(scene.textures().len(), 2);
    let [colors, numbers] = [base, data].map(|reference| &scene.textures()[reference.texture.0]);
    assert!(colors.srgb && !numbers.srgb && colors.nearest);
    assert_eq!(colors.wrap, [Wrap::Clamp, Wrap::Mirror]);
    assert_eq!((colors.width, colors.height), (2, 1));
    assert_eq!(colors.rgba8, [255, 0, 0, 255, 0, 255, 0, 128]);
}

#[test]
fn grey_and_16_bit_images_are_converted() {
    for (bytes, expected) in [
        (gltf_file::grey_png(&[77]), [77, 77, 77, 255]),
        (
            gltf_file::png_16(&[0xFFFF, 0x8080, 0, 0xFFFF]),
            [255, 128, 0, 255],
        ),
    ] {
        let mut file = File::triangle();
        let texture = file.texture(&bytes, json!({}));
        file.material(json!({"emissiveTexture": {"index": texture}}));
        assert_eq!(
            file.load().expect("it is sound").textures()[0].rgba8,
            expected
        );
    }
}

#[test]
fn images_that_claim_more_than_they_hold_are_refused() {
    let mut image = gltf_file::png(1, 1, &[0; 4]);
    image[16..24].copy_from_slice(&[0, 0, 0x3F, 0xFF, 0, 0, 0x3F, 0xFF]); // 16383 × 16383
    let header_crc = gltf_file::crc32(&image[12..29]);
    image[29..33].copy_from_slice(&header_crc.to_be_bytes());
    let mut file = File::triangle();
    let texture = file.texture(&image, json!({}));
    file.material(json!({"emissiveTexture": {"index": texture}}));
    assert!(fault(&file).contains("16383×16383"), "{}", fault(&file));
}

#[test]
fn texture_transforms_scale_then_turn_then_move() {
    let mut file = File::triangle();
    let texture = file.texture(&gltf_file::png(1, 1, &[0; 4]), json!({}));
    let transform = json!({"offset": [0.5, 0.25], "rotation": std::f64::consts::FRAC_PI_2, "scale": [2.0, 3.0], "texCoord": 1});
    file.material(json!({"emissiveTexture": {"index": texture, "extensions": {"KHR_texture_transform": transform}}}));
    let scene = file.load().expect("it is sound");
    let reference = scene.materials()[0].emissive_texture.expect("it is used");
    assert_eq!(reference.texcoord, 1);
    // Scaled to (2, 3), turned to (3, -2), moved.
    let [u, v] = reference.apply([1.0, 1.0]);
    assert!((u - 3.5).abs() < 1e-5 && (v + 1.75).abs() < 1e-5, "{u} {v}");
}

#[test]
fn extensions_are_refused_if_required_and_named_once_if_not() {
    let mut file = File::triangle();
    file.json["extensionsUsed"] = json!(["EXT_b", "EXT_a", "KHR_materials_ior"]);
    let scene = file.load().expect("they are optional");
    assert_eq!(
        scene.warnings,
        ["extensions that are not supported are ignored: EXT_a, EXT_b"]
    );
    file.json["extensionsRequired"] = json!(["EXT_b", "KHR_materials_ior"]);
    let error = file.load().expect_err("it is required");
    assert!(
        matches!(&error, SceneError::RequiredExtensions { extensions, .. } if extensions == "EXT_b"),
        "{error}"
    );
}

#[test]
fn all_containers_give_the_same_scene() {
    let folder = std::env::temp_dir().join(format!("irradia-containers-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("sub folder")).expect("a temporary folder");
    let file = File::triangle();
    std::fs::write(folder.join("sub folder/data.bin"), &file.bin).expect("it can be written");
    std::fs::write(
        folder.join("external.gltf"),
        file.gltf("sub%20folder/data.bin"),
    )
    .expect("it can be written");
    std::fs::write(folder.join("binary.glb"), file.glb()).expect("it can be written");
    let external = Scene::load(&folder.join("external.gltf")).expect("the buffer lies beside it");
    let binary = Scene::open(&folder.join("binary.glb").display().to_string())
        .expect("the buffer is a chunk");
    let embedded = Scene::from_bytes("embedded", file.gltf(&file.data_uri()).as_bytes(), None)
        .expect("the buffer is a data URI");
    std::fs::remove_dir_all(&folder).expect("it can be removed");
    assert_eq!(
        (external.name.as_str(), binary.name.as_str()),
        ("external", "binary")
    );
    for scene in [&external, &binary, &embedded] {
        assert_eq!(
            scene.bounds(),
            File::triangle().load().expect("it is sound").bounds()
        );
    }
}

#[test]
fn uris_that_lead_elsewhere_are_refused() {
    let file = File::triangle();
    for (uri, expected) in [
        ("http://example.org/a.bin", "relative path"),
        ("file:///etc/passwd", "relative path"),
        ("/etc/passwd", "absolute"),
        ("%2Fetc/passwd", "absolute"),
        ("a%zz.bin", "percent"),
        ("missing.bin", "missing.bin"),
        ("data:application/octet-stream;base64,@@@@", "base64"),
        ("data:application/octet-stream,plain", "base64"),
    ] {
        let result = Scene::from_bytes(
            "test",
            file.gltf(uri).as_bytes(),
            Some(std::path::Path::new("/tmp")),
        );
        let error = result.expect_err(uri).to_string();
        assert!(error.contains(expected), "{uri}: {error}");
    }
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
    assert_eq!(
        scene.warnings.len(),
        1,
        "the animation: {:?}",
        scene.warnings
    );
}

#[test]
fn the_description_is_read() {
    let mut file = File::triangle();
    file.json["asset"]["extras"] = json!({"description": "one triangle"});
    assert_eq!(
        file.load().expect("it is sound").description.as_deref(),
        Some("one triangle")
    );
}

#[test]
fn builtin_scenes_load_and_describe_themselves() {
    for name in irradia::scene::builtin_names() {
        let scene = Scene::open(name).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(scene.warnings, Vec::<String>::new(), "{name}");
        assert!(
            scene.description.is_some_and(|line| !line.is_empty()),
            "{name} has no description"
        );
    }
    let error = Scene::open("no such scene")
        .expect_err("there is none")
        .to_string();
    assert!(
        error.contains("no such scene")
            && irradia::scene::builtin_names()
                .iter()
                .all(|name| error.contains(name)),
        "{error}"
    );
}
