//! From the bytes of a file to its JSON text and its buffers: GLB chunks, data URIs, other files.

use super::document::{Document, get};
use super::files::Files;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::collections::HashMap;
use std::sync::Arc;

/// JSON text and, in a GLB, the binary chunk.
pub(super) type Parts<'a> = (&'a [u8], Option<&'a [u8]>);

/// Splits a .glb into its chunks; a .gltf is all JSON. Every length is checked against the bytes there are.
pub(super) fn split(bytes: &[u8]) -> Result<Parts<'_>, String> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), None));
    }
    let word = |at: usize| {
        let word = bytes.get(at..at + 4).and_then(|word| word.try_into().ok()).map(u32::from_le_bytes);
        word.ok_or(format!("the GLB ends in the middle of a header, at byte {at}"))
    };
    let version = word(4)?;
    if version != 2 {
        return Err(format!("the GLB container has version {version}; only version 2 is supported"));
    }
    let end = word(8)? as usize;
    if end > bytes.len() {
        return Err(format!("the GLB says it has {end} bytes but has {}; it may be cut short", bytes.len()));
    }
    let (mut at, mut json, mut binary) = (12, None, None);
    while at < end {
        let (length, kind) = (word(at)? as usize, word(at + 4)?);
        at += 8;
        let chunk =
            at.checked_add(length).filter(|&chunk_end| chunk_end <= end).and_then(|chunk_end| bytes.get(at..chunk_end));
        let chunk =
            chunk.ok_or(format!("a GLB chunk of {length} bytes at byte {at} reaches past the end of the file"))?;
        at += length;
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if binary.is_none() => binary = Some(chunk),
            // The specification asks to ignore chunks of other kinds.
            _ => {}
        }
    }
    Ok((json.ok_or("the GLB has no JSON chunk")?, binary))
}

enum Bytes<'a> {
    Borrowed(&'a [u8]),
    Shared(Arc<[u8]>),
}

/// The bytes of the file's buffers and of images stored beside it. A buffer that cannot be had is a fault only of what uses it.
pub(super) struct Storage<'a> {
    files: Files<'a>,
    buffers: Vec<Result<Bytes<'a>, String>>,
    /// All bytes that were read, the glTF file's own included: what the file can justify allocating is measured by it.
    pub(super) total_bytes: u64,
}

impl<'a> Storage<'a> {
    pub(super) fn read(document: &Document, binary: Option<&'a [u8]>, files: Files<'a>, file_bytes: u64) -> Self {
        let mut storage = Storage { files, buffers: Vec::new(), total_bytes: file_bytes };
        // A file may name one external buffer a thousand times; it is read once.
        let mut known: HashMap<String, Result<Arc<[u8]>, String>> = HashMap::new();
        for index in 0..document.buffers.len() {
            let buffer = get(&document.buffers, index, "buffer").and_then(|buffer| match (&buffer.uri, binary) {
                (Some(uri), _) => {
                    let read = known.entry(uri.clone()).or_insert_with(|| {
                        let bytes = storage.resolve(uri)?;
                        storage.total_bytes += bytes.len() as u64;
                        Ok(bytes.into())
                    });
                    read.clone().map(Bytes::Shared).map_err(|fault| format!("buffer {index}: {fault}"))
                }
                (None, Some(binary)) if index == 0 => Ok(Bytes::Borrowed(binary)),
                _ => Err(format!("buffer {index} has neither a uri nor a binary chunk in the file")),
            });
            storage.buffers.push(buffer);
        }
        storage
    }

    pub(super) fn buffer(&self, index: usize) -> Result<&[u8], String> {
        match self.buffers.get(index) {
            Some(Ok(Bytes::Borrowed(bytes))) => Ok(bytes),
            Some(Ok(Bytes::Shared(bytes))) => Ok(bytes),
            Some(Err(fault)) => Err(fault.clone()),
            None => Err(format!("buffer {index} is referred to, but the file has {} buffers", self.buffers.len())),
        }
    }

    /// The bytes of a buffer view, as far as the buffer holds them.
    pub(super) fn view(&self, document: &Document, index: usize) -> Result<&[u8], String> {
        let view = get(&document.buffer_views, index, "buffer view")?;
        let buffer = self.buffer(view.buffer)?;
        let range = usize::try_from(view.byte_offset).ok().zip(usize::try_from(view.byte_length).ok());
        let bytes = range.and_then(|(start, length)| buffer.get(start..start.checked_add(length)?));
        bytes.ok_or_else(|| {
            let (offset, length) = (view.byte_offset, view.byte_length);
            format!(
                "buffer view {index} ({length} bytes at {offset}) reaches past the {} bytes of buffer {}",
                buffer.len(),
                view.buffer
            )
        })
    }

    /// What a uri stands for: a data URI's bytes, or a file relative to the glTF file.
    pub(super) fn resolve(&self, uri: &str) -> Result<Vec<u8>, String> {
        if let Some(data) = uri.strip_prefix("data:") {
            return decode_data_uri(data);
        }
        self.files.read(uri)
    }
}

fn decode_data_uri(data: &str) -> Result<Vec<u8>, String> {
    let (header, payload) = data.split_once(',').ok_or("a data URI has no comma before its data")?;
    if !header.ends_with(";base64") {
        return Err("a data URI is not base64; only base64 data URIs are supported".into());
    }
    // Some exporters leave the padding out.
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let decoded = GeneralPurpose::new(&STANDARD, config).decode(payload.trim_end());
    decoded.map_err(|error| format!("a data URI is not valid base64 ({error})"))
}
