//! A binary glTF file: JSON, and one buffer that vertex data and images are appended to.

use serde_json::{Map, Value, json};

use super::BakeError;

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// What is written so far.
#[derive(Default)]
pub(super) struct Glb {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Glb {
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.binary.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    /// A file within the file; returns the number of its buffer view.
    pub(super) fn file(&mut self, bytes: &[u8]) -> usize {
        self.view(bytes, None)
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// A vertex attribute; returns the number of its accessor.
    pub(super) fn vectors<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let view = self.view(bytemuck::cast_slice(values.as_flattened()), Some(ARRAY_BUFFER));
        self.accessor(
            json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": format!("VEC{N}") }),
        )
    }

    /// The same of positions, which say how far they reach.
    pub(super) fn positions(&mut self, values: &[[f32; 3]]) -> usize {
        let number = self.vectors(values);
        let reach = |pick: fn(f32, f32) -> f32, start: f32| {
            [0, 1, 2].map(|axis| values.iter().map(|value| value[axis]).fold(start, pick))
        };
        self.accessors[number]["min"] = json!(reach(f32::min, f32::INFINITY));
        self.accessors[number]["max"] = json!(reach(f32::max, f32::NEG_INFINITY));
        number
    }

    pub(super) fn indices(&mut self, values: &[u32]) -> usize {
        let view = self.view(bytemuck::cast_slice(values), Some(ELEMENT_ARRAY_BUFFER));
        self.accessor(
            json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": values.len(), "type": "SCALAR" }),
        )
    }

    /// The file, of this and the rest of the document; lists without elements are left out, as the format asks.
    ///
    /// # Errors
    /// It is longer than its header can say.
    pub(super) fn finish(mut self, mut document: Map<String, Value>) -> Result<Vec<u8>, BakeError> {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        if !self.binary.is_empty() {
            document.insert("buffers".to_owned(), json!([{ "byteLength": self.binary.len() }]));
        }
        document.insert("bufferViews".to_owned(), self.views.into());
        document.insert("accessors".to_owned(), self.accessors.into());
        document.retain(|_, value| value.as_array().is_none_or(|list| !list.is_empty()));
        let mut text = Value::Object(document).to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let chunks: [(&[u8; 4], Vec<u8>); 2] = [(b"JSON", text), (b"BIN\0", self.binary)];
        let length = 12 + chunks.iter().map(|(_, chunk)| 8 + chunk.len() as u64).sum::<u64>();
        let word = |length: u64| u32::try_from(length).map_err(|_| BakeError::TooLong(length));
        let mut file = [&b"glTF"[..], &2_u32.to_le_bytes(), &word(length)?.to_le_bytes()].concat();
        for (kind, chunk) in chunks {
            file.extend_from_slice(&word(chunk.len() as u64)?.to_le_bytes());
            file.extend_from_slice(kind);
            file.extend_from_slice(&chunk);
        }
        Ok(file)
    }
}
