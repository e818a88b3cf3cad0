//! Layers of an EXR file: named images of one size, float32, losslessly compressed, in one part so that any viewer opens it.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::Path;

use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, ReadChannels, ReadLayers, SmallVec, Text, Vec2, WritableImage,
};

use super::header::sort_attributes;
use super::{Attributes, OutputError, Target, seal};

/// The channels of a layer.
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// Rec.709 primaries and D65, so that a colour-managed viewer need not guess.
pub(super) const REC_709: ::exr::meta::attribute::Chromaticities = ::exr::meta::attribute::Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Writes layers, each a name and its pixels: the channels `NAME.R`, `NAME.G`, `NAME.B`, or `R`, `G`, `B` if the name is empty.
///
/// # Errors
/// The file cannot be written, or there are not `size[0] * size[1]` pixels in every layer.
pub(super) fn write_layers(
    target: &Target,
    size: [u32; 2],
    layers: &[(String, &[[f32; 3]])],
    attributes: &Attributes,
) -> Result<(), OutputError> {
    target.write(&encode(target.path(), size, layers, attributes)?)
}

/// As [`write_layers`], with a checksum over all of the file as one more attribute.
///
/// # Errors
/// Those of [`write_layers`].
pub(crate) fn write_sealed_layers(
    target: &Target,
    size: [u32; 2],
    layers: &[(String, &[[f32; 3]])],
    attributes: &Attributes,
) -> Result<(), OutputError> {
    let mut attributes = attributes.clone();
    attributes.insert(seal::ATTRIBUTE.to_owned(), seal::OPEN.to_owned());
    let mut bytes = encode(target.path(), size, layers, &attributes)?;
    seal::close(&mut bytes);
    target.write(&bytes)
}

/// The bytes of a file; `path` is for messages alone.
fn encode(
    path: &Path,
    size: [u32; 2],
    layers: &[(String, &[[f32; 3]])],
    attributes: &Attributes,
) -> Result<Vec<u8>, OutputError> {
    let pixel_count = size[0] as usize * size[1] as usize;
    if let Some((name, pixels)) = layers.iter().find(|(_, pixels)| pixels.len() != pixel_count) {
        let [width, height] = size;
        let reason = format!("layer {name:?} has {} pixels, the image {width}x{height}", pixels.len());
        return Err(OutputError::write(path, reason));
    }
    let channels = layers.iter().flat_map(|(layer, pixels)| {
        CHANNELS.into_iter().enumerate().map(move |(index, channel)| {
            let samples = pixels.iter().map(|pixel| pixel[index]).collect();
            let name = text(&channel_name(layer, channel));
            AnyChannel { name, sample_data: FlatSamples::F32(samples), quantize_linearly: false, sampling: Vec2(1, 1) }
        })
    });
    let size = Vec2(size[0] as usize, size[1] as usize);
    // Scan lines from the top, which every reader knows, tiles not being known to all.
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let layer =
        Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(channels.collect::<SmallVec<_>>()));
    let mut document = Image::from_layer(layer);
    document.attributes.chromaticities = Some(REC_709);
    document
        .attributes
        .other
        .extend(attributes.iter().map(|(name, value)| (text(name), AttributeValue::Text(text(value)))));
    let mut bytes = Vec::new();
    document.write().to_buffered(Cursor::new(&mut bytes)).map_err(|error| OutputError::write(path, error))?;
    sort_attributes(&mut bytes);
    Ok(bytes)
}

fn channel_name(layer: &str, channel: &str) -> String {
    if layer.is_empty() { channel.to_owned() } else { format!("{layer}.{channel}") }
}

/// What [`read_layers`] finds.
pub(crate) struct Layers {
    /// Width and height in pixels.
    pub(crate) size: [u32; 2],
    /// The pixels of every layer that has the channels R, G and B, by its name; empty for the image itself.
    pub(crate) layers: BTreeMap<String, Vec<[f32; 3]>>,
    /// The names of all channels.
    pub(crate) channels: Vec<String>,
    /// The attributes that are text.
    pub(crate) attributes: Attributes,
}

/// Reads all layers of a file of one part.
///
/// # Errors
/// The file cannot be read.
pub(super) fn read_layers(path: &Path) -> Result<Layers, OutputError> {
    decode(path, &read_bytes(path)?)
}

/// Reads what [`write_sealed_layers`] wrote. Nothing of a file is looked at before its checksum is found to be right.
///
/// # Errors
/// The file cannot be read, has no checksum, or has another one than its bytes.
pub(crate) fn read_sealed_layers(path: &Path) -> Result<Layers, SealedError> {
    let mut bytes = read_bytes(path)?;
    match seal::open(&mut bytes) {
        Some(true) => Ok(decode(path, &bytes)?),
        Some(false) => Err(SealedError::Broken),
        None => Err(SealedError::Unsealed),
    }
}

/// Why [`read_sealed_layers`] gives nothing.
#[derive(Debug)]
pub(crate) enum SealedError {
    /// The file cannot be read.
    Output(OutputError),
    /// The checksum is not that of the bytes.
    Broken,
    /// There is no checksum.
    Unsealed,
}

impl From<OutputError> for SealedError {
    fn from(error: OutputError) -> SealedError {
        SealedError::Output(error)
    }
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, OutputError> {
    fs::read(path).map_err(|error| OutputError::read(path, error))
}

/// The factor by which a compression makes images smaller at the most.
fn most_compression(compression: Compression) -> u64 {
    match compression {
        Compression::Uncompressed => 1,
        // A run of 128 bytes in two.
        Compression::RLE => 64,
        // A match of 258 bytes in two bits; PXR24 also drops a byte in four.
        Compression::ZIP1 | Compression::ZIP16 => 1032,
        Compression::PXR24 => 1376,
        // A block of 4×4 halves in three bytes.
        Compression::B44 | Compression::B44A => 11,
        _ => 4096,
    }
}

fn decode(path: &Path, bytes: &[u8]) -> Result<Layers, OutputError> {
    let failed = |error: ::exr::error::Error| OutputError::read(path, error);
    // The decoder believes the header; a damaged one can ask for more memory than there is.
    let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(failed)?;
    let least = meta.headers.iter().map(|header| {
        let pixels = u64::try_from(header.layer_size.area()).unwrap_or(u64::MAX);
        let stored = header.channels.list.iter().map(|channel| {
            let bytes = pixels.saturating_mul(channel.sample_type.bytes_per_sample() as u64);
            bytes / (channel.sampling.area() as u64).max(1)
        });
        stored.fold(0, u64::saturating_add) / most_compression(header.compression)
    });
    if least.fold(0, u64::saturating_add) > bytes.len() as u64 {
        return Err(OutputError::read(path, "it is damaged: it is too small for the images that it says it has"));
    }
    let document = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(failed)?;
    let layer = document.layer_data;
    let size = [layer.size.x() as u32, layer.size.y() as u32];
    let channels: BTreeMap<String, &FlatSamples> =
        layer.channel_data.list.iter().map(|channel| (string(&channel.name), &channel.sample_data)).collect();
    let mut layers = BTreeMap::new();
    for name in channels.keys().filter_map(|name| name.strip_suffix(CHANNELS[0])) {
        let name = if name.is_empty() { Some(name) } else { name.strip_suffix('.') };
        let samples = name.and_then(|name| Some((name, rgb_channels(&channels, name)?)));
        let Some((name, samples)) = samples else { continue };
        let mut pixels = vec![[0.0; 3]; layer.size.area()];
        for (index, samples) in samples.into_iter().enumerate() {
            for (pixel, value) in pixels.iter_mut().zip(samples.values_as_f32()) {
                pixel[index] = value;
            }
        }
        layers.insert(name.to_owned(), pixels);
    }
    let texts = document.attributes.other.iter().chain(&layer.attributes.other);
    let attributes = texts.filter_map(text_attribute).collect();
    Ok(Layers { size, layers, channels: channels.into_keys().collect(), attributes })
}

fn rgb_channels<'a>(channels: &BTreeMap<String, &'a FlatSamples>, layer: &str) -> Option<[&'a FlatSamples; 3]> {
    let [red, green, blue] = CHANNELS.map(|channel| channels.get(&channel_name(layer, channel)).copied());
    Some([red?, green?, blue?])
}

/// Reads the attributes that are text and nothing else of a file.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn read_attributes(path: &Path) -> Result<Attributes, OutputError> {
    let meta = ::exr::meta::MetaData::read_from_file(path, false).map_err(|error| OutputError::read(path, error))?;
    let header = meta.headers.first().ok_or_else(|| OutputError::read(path, "it has no part"))?;
    let texts = header.shared_attributes.other.iter().chain(&header.own_attributes.other);
    Ok(texts.filter_map(text_attribute).collect())
}

fn text_attribute((name, value): (&Text, &AttributeValue)) -> Option<(String, String)> {
    match value {
        AttributeValue::Text(value) => Some((string(name), string(value))),
        _ => None,
    }
}

/// EXR text is bytes; we write UTF-8, as current OpenEXR does.
fn text(string: &str) -> Text {
    Text::from_slice_unchecked(string.as_bytes())
}

fn string(text: &Text) -> String {
    String::from_utf8_lossy(text.bytes()).into_owned()
}
