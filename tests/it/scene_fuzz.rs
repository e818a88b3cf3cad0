//! Damaged files: whatever bytes change, the reader returns, and soon.

use crate::gltf_file::{self, File};
use irradia::scene::Scene;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use serde_json::json;
use std::time::{Duration, Instant};

const MUTANTS: usize = 4000;
/// Far above what a file of a few kilobytes takes, far below a hang.
const LONGEST_LOAD: Duration = Duration::from_secs(5);

/// A small file in which much can break: indices, a sparse accessor, a normal map, a hierarchy, lights, a camera, an animation.
fn rich_file() -> File {
    let mut file = File::with_positions(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]]);
    let indices = file.accessor(&[0, 1, 2, 0, 2, 3], 5121, "SCALAR", 6);
    file.primitive()["indices"] = json!(indices);
    let texcoords = file.normalized(&[0, 255, 255, 255, 255, 0, 0, 0], 5121, "VEC2", 4);
    file.attribute("TEXCOORD_0", texcoords);
    let normals = file.floats(&[0.0, 0.0, 1.0].repeat(4), "VEC3", 4);
    file.attribute("NORMAL", normals);
    let (at, values) = (file.view(&[1, 3]), file.view(&gltf_file::float_bytes(&[0.5; 8])));
    let colors = file.push("accessors", json!({
        "componentType": 5126, "type": "VEC4", "count": 4,
        "sparse": {"count": 2, "indices": {"bufferView": at, "componentType": 5121}, "values": {"bufferView": values}},
    }));
    file.attribute("COLOR_0", colors);
    let texture = file.texture(&gltf_file::png(2, 2, &[128; 16]), json!({"wrapS": 33071}));
    file.material(json!({
        "normalTexture": {"index": texture, "extensions": {"KHR_texture_transform": {"rotation": 0.5}}},
        "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": texture},
    }));
    let input = file.floats(&[0.0, 1.0], "SCALAR", 2);
    let output = file.floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0], "VEC4", 2);
    file.json["animations"] = json!([{
        "samplers": [{"input": input, "output": output}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
    }]);
    file.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}});
    file.json["nodes"] = json!([
        {"mesh": 0, "children": [1, 2], "scale": [1, -2, 1]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
        {"camera": 0, "translation": [0, 0, 9], "extensions": {"KHR_lights_punctual": {"light": 0}}},
    ]);
    file
}

/// Loads damaged bytes and uses what loads, as a program would.
fn survive(bytes: &[u8], mutant: usize) -> bool {
    let start = Instant::now();
    let loaded = Scene::from_bytes("mutant", bytes, None);
    if let Ok(mut scene) = loaded.as_ref().cloned() {
        scene.set_time(0.5);
        scene.facts();
        scene.emitter_samples(4);
        scene.placed_lights();
        let _ = scene.camera_view(None);
        let _ = scene.camera_view(Some("automatic"));
    }
    let took = start.elapsed();
    assert!(took < LONGEST_LOAD, "mutant {mutant} took {took:?}");
    loaded.is_ok()
}

fn fuzz(original: &[u8], seed: u64, mutate: impl Fn(&mut Vec<u8>, &mut Pcg32)) {
    assert!(survive(original, 0), "the original is sound");
    let mut random = Pcg32::new(seed, 1);
    let mut loaded = 0;
    for mutant in 1..=MUTANTS {
        let mut bytes = original.to_vec();
        mutate(&mut bytes, &mut random);
        loaded += usize::from(survive(&bytes, mutant));
    }
    // Damage that never, or always, stops a file from loading would test little.
    println!("{loaded} of {MUTANTS} damaged files load");
    assert!(loaded > MUTANTS / 100 && loaded < MUTANTS, "{loaded} of {MUTANTS} load");
}

fn pick(random: &mut Pcg32, count: usize) -> usize {
    random.next_u32() as usize % count
}

#[test]
fn changed_bytes_are_survived() {
    fuzz(&rich_file().glb(), 7, |bytes, random| {
        for _ in 0..=pick(random, 4) {
            let at = pick(random, bytes.len());
            bytes[at] = random.next_u32() as u8;
        }
    });
}

#[test]
fn changed_numbers_are_survived() {
    // Digits of the JSON text, so that it stays JSON and the damage gets past the parser.
    let file = rich_file();
    let text = file.gltf(&file.data_uri()).into_bytes();
    fuzz(&text, 11, |bytes, random| {
        let data = bytes.windows(5).position(|window| window == b"data:").unwrap_or(0);
        let digits: Vec<usize> = (0..bytes.len())
            .filter(|&at| bytes[at].is_ascii_digit() && !(data..data + file.bin.len() * 2).contains(&at))
            .collect();
        for _ in 0..=pick(random, 2) {
            let at = digits[pick(random, digits.len())];
            match pick(random, 4) {
                0 => bytes[at] = b'0' + pick(random, 10) as u8,
                1 => bytes[at] = b'9',
                2 => drop(bytes.splice(at..=at, *b"4294967295")),
                _ => drop(bytes.splice(at..=at, *b"18446744073709551615")),
            }
            if bytes.len() != text.len() {
                break; // the list of digits is out of date
            }
        }
    });
}

#[test]
fn cut_files_are_survived() {
    let glb = rich_file().glb();
    for length in 0..glb.len() {
        assert!(!survive(&glb[..length], length), "{length} of {} bytes load", glb.len());
    }
}
