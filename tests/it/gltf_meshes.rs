//! What the glTF reader promises of meshes, feature by feature, on files made here.

use crate::gltf_file::{self, File};
use irradia::scene::Primitive;
use serde_json::json;

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
        let data: Vec<u8> = [2u32, 0, 1].iter().flat_map(|index| index.to_le_bytes()[..bytes].to_vec()).collect();
        let indices = file.accessor(&data, component, "SCALAR", 3);
        file.primitive()["indices"] = json!(indices);
        assert_eq!(only_primitive(&file).indices, [2, 0, 1], "component type {component}");
    }
}

#[test]
fn without_indices_the_vertices_are_used_in_order() {
    assert_eq!(only_primitive(&File::triangle()).indices, [0, 1, 2]);
}

#[test]
fn strips_and_fans_become_lists_of_the_same_orientation() {
    // A strip zigzags up, a fan turns counter-clockwise; all their triangles face +Z.
    let strip = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
    let fan = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
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
    let colors: Vec<u8> =
        [65535u16, 0, 0, 0, 65535, 0, 0, 0, 13107].iter().flat_map(|value| value.to_le_bytes()).collect();
    let colors = file.normalized(&colors, 5123, "VEC3", 3);
    file.attribute("TEXCOORD_0", texcoords);
    file.attribute("COLOR_0", colors);
    let primitive = only_primitive(&file);
    assert_eq!(primitive.texcoords[0].as_deref(), Some(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.2]][..]));
    assert_eq!(
        primitive.colors.as_deref(),
        Some(&[[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 0.2, 1.0]][..])
    );
}

#[test]
fn quantized_positions_and_normals_are_read() {
    let mut file = File::triangle();
    file.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let positions: Vec<u8> = [0i16, 0, 0, 300, 0, 0, 0, -300, 0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let positions = file.accessor(&positions, 5122, "VEC3", 3);
    let normals = file.normalized(&[0, 0, 127, 0, 0, 127, 0, 0, 128], 5120, "VEC3", 3);
    file.attribute("POSITION", positions);
    file.attribute("NORMAL", normals);
    let primitive = only_primitive(&file);
    assert_eq!(primitive.positions, [[0.0, 0.0, 0.0], [300.0, 0.0, 0.0], [0.0, -300.0, 0.0]]);
    assert_eq!(primitive.normals.as_deref(), Some(&[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]][..]));
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
        case.as_object().expect("an object").iter().for_each(|(key, value)| accessor[key] = value.clone());
        let fault = fault(&file);
        assert!(
            fault.contains("mesh 0") && fault.contains("accessor 0") || fault.contains("buffer view 99"),
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
        assert!(fault(&file).contains("buffer view 0"), "{key}: {}", fault(&file));
    }
}

#[test]
fn many_primitives_may_share_vertices_of_which_each_keeps_few() {
    // Kept whole by each of 200 primitives, 100 kB of vertices would be more than the file justifies.
    let positions: Vec<[f32; 3]> = (0..9000).map(|vertex| [vertex as f32, (vertex % 2) as f32, 0.0]).collect();
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
            Err(error) => assert!(!indexed && error.to_string().contains("16 times"), "{error}"),
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
    let [morphs, skins] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
    assert!(morphs.contains("morph") && skins.contains("skins"));
}

#[test]
fn indices_out_of_range_name_mesh_and_primitive() {
    let mut file = File::triangle();
    let indices = file.accessor(&[0, 1, 3], 5121, "SCALAR", 3);
    file.primitive()["indices"] = json!(indices);
    file.json["meshes"][0]["name"] = json!("wall");
    let fault = fault(&file);
    assert!(fault.contains("\"wall\", primitive 0") && fault.contains("index is 3"), "{fault}");
}

#[test]
fn positions_that_are_not_finite_drop_their_primitive() {
    let file = File::with_positions(&[[0.0, 0.0, 0.0], [f32::NAN, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let scene = file.load().expect("the rest is sound");
    assert!(scene.instances().is_empty());
    assert!(scene.warnings[0].contains("not finite"), "{:?}", scene.warnings);
}

#[test]
fn vertices_that_no_triangle_uses_are_dropped() {
    let mut file = File::with_positions(&[[0.0, 0.0, 0.0], [7.0, 7.0, 7.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let indices = file.accessor(&[0, 2, 3], 5121, "SCALAR", 3);
    file.primitive()["indices"] = json!(indices);
    let primitive = only_primitive(&file);
    assert_eq!(primitive.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(primitive.indices, [0, 1, 2]);
    assert_eq!(primitive.source_bytes, 4 * 12 + 3);
}

#[test]
fn bad_normals_become_face_normals_and_missing_ones_stay_missing() {
    assert!(only_primitive(&File::triangle()).normals.is_none());
    let mut file = File::triangle();
    let normals = file.floats(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0, f32::NAN, 0.0, 0.0], "VEC3", 3);
    file.attribute("NORMAL", normals);
    assert_eq!(
        only_primitive(&file).normals.as_deref(),
        Some(&[[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]][..])
    );
}

#[test]
fn tangents_are_made_for_normal_maps_alone() {
    // v grows downwards, so this quad shows its texture upright: the tangent is +X, the bitangent +Y.
    let mut file = File::with_positions(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    let indices = file.accessor(&[0, 1, 2, 0, 2, 3], 5121, "SCALAR", 6);
    file.primitive()["indices"] = json!(indices);
    let texcoords = file.floats(&[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0], "VEC2", 4);
    file.attribute("TEXCOORD_0", texcoords);
    let texture = file.texture(&gltf_file::png(1, 1, &[128, 128, 255, 255]), json!({}));
    file.material(json!({}));
    assert!(only_primitive(&file).tangents.is_none());
    file.json["materials"][0]["normalTexture"] = json!({"index": texture});
    let primitive = only_primitive(&file);
    assert_eq!(primitive.positions.len(), 6, "flat normals need vertices of their own");
    assert!(primitive.normals.as_ref().expect("made").iter().all(|normal| *normal == [0.0, 0.0, 1.0]));
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
