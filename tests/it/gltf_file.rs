//! Small glTF files made in memory.

use base64::Engine;
use irradia::scene::{Scene, SceneError};
use serde_json::{Value, json};

/// A glTF document with one buffer.
pub(crate) struct File {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl File {
    /// One triangle in the XY plane, facing +Z, on one node.
    pub(crate) fn triangle() -> File {
        File::with_positions(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    }

    /// One primitive with these vertices on one node.
    pub(crate) fn with_positions(positions: &[[f32; 3]]) -> File {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {}}]}],
        });
        let mut file = File { json, bin: Vec::new() };
        let accessor = file.floats(positions.as_flattened(), "VEC3", positions.len());
        file.attribute("POSITION", accessor);
        file
    }

    pub(crate) fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    pub(crate) fn attribute(&mut self, semantic: &str, accessor: usize) {
        self.primitive()["attributes"][semantic] = json!(accessor);
    }

    /// Appends to a section and returns the index.
    pub(crate) fn push(&mut self, section: &str, element: Value) -> usize {
        if self.json[section].is_null() {
            self.json[section] = json!([]);
        }
        let section = self.json[section].as_array_mut().expect("sections are arrays");
        section.push(element);
        section.len() - 1
    }

    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let offset = self.bin.len();
        self.bin.extend(bytes);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    pub(crate) fn accessor(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({"bufferView": view, "componentType": component, "type": shape, "count": count}))
    }

    pub(crate) fn normalized(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize) -> usize {
        let accessor = self.accessor(bytes, component, shape, count);
        self.json["accessors"][accessor]["normalized"] = json!(true);
        accessor
    }

    pub(crate) fn floats(&mut self, values: &[f32], shape: &str, count: usize) -> usize {
        self.accessor(&float_bytes(values), 5126, shape, count)
    }

    /// Adds a texture and returns its index.
    pub(crate) fn texture(&mut self, image: &[u8], sampler: Value) -> usize {
        let view = self.view(image);
        let source = self.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
        let sampler = self.push("samplers", sampler);
        self.push("textures", json!({"source": source, "sampler": sampler}))
    }

    /// Makes this the material of the one primitive.
    pub(crate) fn material(&mut self, material: Value) {
        let index = self.push("materials", material);
        self.primitive()["material"] = json!(index);
    }

    pub(crate) fn data_uri(&self) -> String {
        format!("data:application/octet-stream;base64,{}", base64::engine::general_purpose::STANDARD.encode(&self.bin))
    }

    /// The .gltf text with this uri for the buffer.
    pub(crate) fn gltf(&self, uri: &str) -> String {
        let mut json = self.json.clone();
        let buffer = json!({"byteLength": self.bin.len(), "uri": uri});
        match json["buffers"].as_array_mut() {
            Some(buffers) => buffers.insert(0, buffer),
            None => json["buffers"] = json!([buffer]),
        }
        json.to_string()
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bin.len()}]);
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bin.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let words = |words: [usize; 2]| words.map(|word| (word as u32).to_le_bytes()).concat();
        let length = 12 + 8 + text.len() + 8 + bin.len();
        [
            b"glTF".to_vec(),
            words([2, length]),
            (text.len() as u32).to_le_bytes().to_vec(),
            b"JSON".to_vec(),
            text,
            (bin.len() as u32).to_le_bytes().to_vec(),
            b"BIN\0".to_vec(),
            bin,
        ]
        .concat()
    }

    pub(crate) fn load(&self) -> Result<Scene, SceneError> {
        Scene::from_bytes("test", self.gltf(&self.data_uri()).as_bytes(), None)
    }
}

pub(crate) fn float_bytes(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn encode([width, height]: [u32; 2], color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().expect("it can be encoded");
    writer.write_image_data(data).expect("the texels fit");
    writer.finish().expect("it can be encoded");
    bytes
}

pub(crate) fn png(width: u32, height: u32, rgba: &[u8]) -> Vec<u8> {
    encode([width, height], png::ColorType::Rgba, png::BitDepth::Eight, rgba)
}

pub(crate) fn grey_png(grey: &[u8]) -> Vec<u8> {
    encode([grey.len() as u32, 1], png::ColorType::Grayscale, png::BitDepth::Eight, grey)
}

pub(crate) fn png_16(rgba: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = rgba.iter().flat_map(|value| value.to_be_bytes()).collect();
    encode([rgba.len() as u32 / 4, 1], png::ColorType::Rgba, png::BitDepth::Sixteen, &bytes)
}

/// The checksum of PNG chunks.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = !0u32;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 0 { crc >> 1 } else { crc >> 1 ^ 0xEDB8_8320 };
        }
    }
    !crc
}
