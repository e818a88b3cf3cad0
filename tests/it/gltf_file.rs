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

/// A JPEG of 8×8 equal texels: grey if there is one value, else Y, Cb and Cr. Its blocks hold a mean and no more.
pub(crate) fn jpeg(values: &[u8]) -> Vec<u8> {
    let count = values.len() as u8;
    let segment =
        |marker: u8, content: &[u8]| [&[0xFF, marker], &(content.len() as u16 + 2).to_be_bytes()[..], content].concat();
    let quantisation = [&[0], &[1; 64][..]].concat();
    let frame: Vec<u8> = (1..=count).flat_map(|component| [component, 0x11, 0]).collect();
    let means = [&[0x00, 0, 0, 0, 12], &[0; 12][..], &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]].concat(); // four bits each
    let waves = [&[0x10, 1], &[0; 15][..], &[0]].concat(); // the end of a block, in one bit
    let scan: Vec<u8> = (1..=count).flat_map(|component| [component, 0]).collect();
    let mut bits = String::new();
    for &value in values {
        let mean = 8 * (i32::from(value) - 128);
        let width = (i32::BITS - mean.abs().leading_zeros()) as usize;
        let code = if mean < 0 { mean + (1 << width) - 1 } else { mean };
        bits += &format!("{width:04b}");
        if width > 0 {
            bits += &format!("{code:0width$b}");
        }
        bits.push('0');
    }
    bits += &"1".repeat(bits.len().next_multiple_of(8) - bits.len());
    let bytes = bits.as_bytes().chunks(8).map(|bits| bits.iter().fold(0, |byte, bit| byte << 1 | (bit - b'0')));
    let data: Vec<u8> = bytes.flat_map(|byte| if byte == 0xFF { vec![byte, 0] } else { vec![byte] }).collect();
    [
        vec![0xFF, 0xD8],
        segment(0xDB, &quantisation),
        segment(0xC0, &[&[8, 0, 8, 0, 8, count], &frame[..]].concat()),
        segment(0xC4, &means),
        segment(0xC4, &waves),
        segment(0xDA, &[&[count], &scan[..], &[0, 63, 0]].concat()),
        data,
        vec![0xFF, 0xD9],
    ]
    .concat()
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
