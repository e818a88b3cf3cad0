//! What stands in the file.

use std::collections::BTreeSet;

use irradia::glam::{DAffine3, DVec3};
use irradia::scene::{NodeId, Scene};
use serde_json::Value;

use super::{baked, context, options};

/// The JSON of a binary glTF file, and its buffer.
pub(super) fn parts(glb: &[u8]) -> (Value, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().expect("four bytes")) as usize;
    assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
    let json = 20..20 + word(12);
    let binary = json.end + 8;
    assert_eq!((&glb[16..20], &glb[binary - 4..binary]), (&b"JSON"[..], &b"BIN\0"[..]));
    assert_eq!((json.len() % 4, binary + word(json.end)), (0, glb.len()));
    (serde_json::from_slice(&glb[json]).expect("JSON"), &glb[binary..])
}

pub(super) fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

pub(super) fn number(value: &Value) -> usize {
    value.as_u64().expect("a number") as usize
}

/// The floats of an accessor.
fn floats(document: &Value, binary: &[u8], accessor: &Value) -> Vec<f32> {
    let accessor = &document["accessors"][number(accessor)];
    let view = &document["bufferViews"][number(&accessor["bufferView"])];
    let start = number(&view["byteOffset"]);
    assert_eq!((start % 4, &accessor["componentType"]), (0, &Value::from(5126)));
    let bytes = &binary[start..start + number(&view["byteLength"])];
    bytes.chunks_exact(4).map(|float| f32::from_le_bytes(float.try_into().expect("four bytes"))).collect()
}

/// Black surfaces that emit what an image says by the second coordinates, times a strength, and reflect nothing.
#[test]
fn materials_emit_the_light_and_reflect_nothing() {
    let context = context();
    let scene = Scene::open("cornell-point").expect("a built-in scene");
    let (baked, _) = baked(&context, &scene, &options(1000));
    let (document, binary) = parts(&baked.glb);
    for material in list(&document["materials"]) {
        let base = &material["pbrMetallicRoughness"];
        assert_eq!(base["baseColorFactor"], serde_json::json!([0.0, 0.0, 0.0, 1.0]));
        assert_eq!((&base["metallicFactor"], &material["emissiveTexture"]["texCoord"]), (&0.0.into(), &1.into()));
        assert_eq!(material["extensions"]["KHR_materials_specular"]["specularFactor"], 0.0);
        let strength = &material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"];
        assert_eq!(strength.as_f64().expect("a strength").log2().fract(), 0.0);
    }
    let used: BTreeSet<&str> = list(&document["extensionsUsed"]).iter().filter_map(Value::as_str).collect();
    assert_eq!(used, BTreeSet::from(["KHR_materials_emissive_strength", "KHR_materials_specular"]));
    let primitives = list(&document["meshes"]).iter().flat_map(|mesh| list(&mesh["primitives"]));
    let (mut triangles, mut places) = (0, BTreeSet::new());
    for primitive in primitives {
        let attributes = &primitive["attributes"];
        assert!(attributes["TEXCOORD_0"].is_u64() && attributes["NORMAL"].is_null());
        let coordinates = floats(&document, binary, &attributes["TEXCOORD_1"]);
        assert!(coordinates.iter().all(|place| (0.0..=1.0).contains(place)));
        places.extend(coordinates.chunks_exact(2).map(|place| [place[0].to_bits(), place[1].to_bits()]));
        triangles += number(&document["accessors"][number(&primitive["indices"])]["count"]) / 3;
        let positions = floats(&document, binary, &attributes["POSITION"]);
        let accessor = &document["accessors"][number(&attributes["POSITION"])];
        for axis in 0..3 {
            let along = || positions.iter().skip(axis).step_by(3).copied();
            let [least, most] = ["min", "max"].map(|end| accessor[end][axis].as_f64().expect("a number") as f32);
            assert_eq!(
                (least, most),
                (along().fold(f32::INFINITY, f32::min), along().fold(f32::NEG_INFINITY, f32::max))
            );
        }
    }
    assert_eq!(triangles as u64, scene.facts().triangles);
    assert!(places.len() >= 4 * baked.surfaces, "no two surfaces share a place");
}

/// A scene far from the world's origin is where it was, to the last millimetre, and so is its camera.
#[test]
fn what_is_far_away_stays_there() {
    let context = context();
    let mut scene = Scene::open("cornell-point").expect("a built-in scene");
    let far = DVec3::new(3e6, -2e6, 1e6);
    for node in 0..scene.nodes().len() {
        if scene.nodes()[node].parent.is_none() {
            let local = scene.nodes()[node].local;
            scene.set_local_transform(NodeId(node), DAffine3::from_translation(far) * local).expect("sound");
        }
    }
    let (_, loaded) = baked(&context, &scene, &options(300));
    let [found, expected] = [&loaded, &scene].map(|scene| scene.bounds().expect("triangles"));
    assert!((found.min - expected.min).length() < 1e-3 && (found.max - expected.max).length() < 1e-3, "{found:?}");
    let [found, expected] = [&loaded, &scene].map(|scene| scene.camera_view(None).expect("a camera").world.translation);
    assert!((found - expected).length() < 1e-6, "{found} {expected}");
}
