//! OpenEXR: linear radiance, float32, losslessly compressed; the image as `R G B`, each slot as a layer of channels
//! (`diffuse.R`, `diffuse.G`, `diffuse.B`), all in one part so that any viewer opens it.

use std::collections::BTreeMap;
use std::io::{Cursor, Write as _};
use std::path::Path;

use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, ReadChannels, ReadLayers, SmallVec, Text, Vec2, WritableImage,
};

use super::{AtomicFile, Attributes, OutputError};
use crate::renderer::{ColorImage, Slot};

/// Rec.709 primaries and D65, so that a colour-managed viewer need not guess.
const REC_709: ::exr::meta::attribute::Chromaticities = ::exr::meta::attribute::Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// What an EXR file of ours holds.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrImage {
    /// The image, the channels `R G B`.
    pub image: ColorImage,
    /// The slots that the file has layers for.
    pub slots: BTreeMap<Slot, ColorImage>,
    /// The attributes that are text.
    pub attributes: Attributes,
}

/// Writes an image and its slots. Attributes become text attributes of their names, in UTF-8.
///
/// # Errors
/// The file cannot be written, or the slots are not of the image's size.
pub fn write_exr(
    path: &Path,
    image: &ColorImage,
    slots: &BTreeMap<Slot, ColorImage>,
    attributes: &Attributes,
) -> Result<(), OutputError> {
    let pixel_count = image.size[0] as usize * image.size[1] as usize;
    let layers = slots.iter().map(|(slot, layer)| (format!("{slot}."), layer));
    let layers: Vec<_> = [(String::new(), image)].into_iter().chain(layers).collect();
    if let Some((name, layer)) =
        layers.iter().find(|(_, layer)| layer.size != image.size || layer.pixels.len() != pixel_count)
    {
        let [width, height] = image.size;
        let reason = format!("layer {name:?} has {} pixels, the image {width}x{height}", layer.pixels.len());
        return Err(OutputError::write(path, reason));
    }
    let channels = layers.iter().flat_map(|(prefix, layer)| {
        ["R", "G", "B"].into_iter().enumerate().map(move |(index, channel)| {
            let samples = layer.pixels.iter().map(|pixel| pixel[index]).collect();
            let name = text(&format!("{prefix}{channel}"));
            AnyChannel { name, sample_data: FlatSamples::F32(samples), quantize_linearly: false, sampling: Vec2(1, 1) }
        })
    });
    let size = Vec2(image.size[0] as usize, image.size[1] as usize);
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
    AtomicFile::write_whole(path, |file| file.write_all(&bytes))
}

/// Puts the attributes of a single-part file's header in the order of their names. The crate keeps them in a hash map and
/// writes them in another order every time; the same frame shall make the same file. An attribute is its name, its type's
/// name, both ended by a zero, the size of its value, and the value; a zero ends the list. Nothing else moves.
fn sort_attributes(bytes: &mut [u8]) {
    const START: usize = 8;
    let mut attributes: Vec<&[u8]> = Vec::new();
    let mut at = START;
    while bytes.get(at).is_some_and(|&first| first != 0) {
        let zero = |from: usize| bytes[from..].iter().position(|&byte| byte == 0).map(|length| from + length);
        let end = zero(at).and_then(|name| zero(name + 1)).and_then(|kind| {
            let size = bytes.get(kind + 1..kind + 5)?;
            Some(kind + 5 + u32::from_le_bytes([size[0], size[1], size[2], size[3]]) as usize)
        });
        let Some(attribute) = end.and_then(|end| bytes.get(at..end)) else { return };
        attributes.push(attribute);
        at += attribute.len();
    }
    attributes.sort_unstable();
    let sorted = attributes.concat();
    bytes[START..at].copy_from_slice(&sorted);
}

/// Reads an image and the layers that are named like slots; other channels are left out.
///
/// # Errors
/// The file cannot be read or has no channels `R G B`.
pub fn read_exr(path: &Path) -> Result<ExrImage, OutputError> {
    let document = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(|error| OutputError::read(path, error))?;
    let layer = document.layer_data;
    let size = [layer.size.x() as u32, layer.size.y() as u32];
    let channels = &layer.channel_data.list;
    let color_image = |prefix: &str| {
        let mut pixels = vec![[0.0; 3]; layer.size.area()];
        for (index, name) in ["R", "G", "B"].into_iter().enumerate() {
            let name = format!("{prefix}{name}");
            let channel = channels.iter().find(|channel| string(&channel.name) == name)?;
            for (pixel, value) in pixels.iter_mut().zip(channel.sample_data.values_as_f32()) {
                pixel[index] = value;
            }
        }
        Some(ColorImage { size, pixels })
    };
    let image = color_image("").ok_or_else(|| {
        let names: Vec<String> = channels.iter().map(|channel| string(&channel.name)).collect();
        OutputError::read(path, format!("it has no channels R, G and B, but {}", names.join(", ")))
    })?;
    let slots = Slot::ALL.into_iter().filter_map(|slot| Some((slot, color_image(&format!("{slot}."))?))).collect();
    let texts = document.attributes.other.iter().chain(&layer.attributes.other);
    let attributes = texts.filter_map(|(name, value)| match value {
        AttributeValue::Text(value) => Some((string(name), string(value))),
        _ => None,
    });
    Ok(ExrImage { image, slots, attributes: attributes.collect() })
}

/// EXR text is bytes; we write UTF-8, as current OpenEXR does.
fn text(string: &str) -> Text {
    Text::from_slice_unchecked(string.as_bytes())
}

fn string(text: &Text) -> String {
    String::from_utf8_lossy(text.bytes()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::atomic_file::tests::TestFolder;

    fn gradient(size: [u32; 2], offset: f32) -> ColorImage {
        let pixels = (0..size[0] * size[1]).map(|index| [offset + index as f32, -1e-30 * index as f32, 1e30]).collect();
        ColorImage { size, pixels }
    }

    #[test]
    fn image_slots_and_attributes_come_back_to_the_bit() {
        let folder = TestFolder::new("exr");
        let path = folder.0.join("a.exr");
        let size = [37, 19];
        let written = ExrImage {
            image: gradient(size, 0.1),
            slots: Slot::ALL.into_iter().zip(1..).map(|(slot, offset)| (slot, gradient(size, offset as f32))).collect(),
            attributes: Attributes::from([
                ("scene".to_owned(), "Кухня 台所".to_owned()),
                ("settings".to_owned(), format!("{{\"long\":\"{}\"}}", "x".repeat(5000))),
                ("camera".to_owned(), String::new()),
            ]),
        };
        write_exr(&path, &written.image, &written.slots, &written.attributes).expect("written");
        assert_eq!(folder.names(), ["a.exr"]);
        assert_eq!(read_exr(&path).expect("read"), written);
    }

    #[test]
    fn the_same_frame_makes_the_same_file() {
        let folder = TestFolder::new("exr-same");
        let image = gradient([5, 3], 0.25);
        let attributes: Attributes = (0..12).map(|index| (format!("attribute{index}"), format!("{index}"))).collect();
        let write = |name: &str| {
            let path = folder.0.join(name);
            write_exr(&path, &image, &BTreeMap::new(), &attributes).expect("a sound image");
            std::fs::read(path).expect("just written")
        };
        assert!(write("a.exr") == write("b.exr"));
    }

    #[test]
    fn channels_have_the_names_that_viewers_expect() {
        let folder = TestFolder::new("exr-names");
        let path = folder.0.join("a.exr");
        let image = gradient([2, 2], 0.0);
        let slots = BTreeMap::from([(Slot::Diffuse, image.clone()), (Slot::Direct, image.clone())]);
        write_exr(&path, &image, &slots, &Attributes::new()).expect("written");
        let meta = ::exr::meta::MetaData::read_from_file(&path, true).expect("valid by the strict rules");
        assert_eq!(meta.headers.len(), 1, "one part");
        let header = &meta.headers[0];
        let names: Vec<String> = header.channels.list.iter().map(|channel| string(&channel.name)).collect();
        let expected = ["B", "G", "R", "diffuse.B", "diffuse.G", "diffuse.R", "direct.B", "direct.G", "direct.R"];
        assert_eq!(names, expected);
        assert!(header.channels.list.iter().all(|channel| channel.sample_type == ::exr::prelude::SampleType::F32));
        assert_eq!(header.compression, Compression::ZIP16);
        assert_eq!(
            (header.blocks, header.line_order),
            (::exr::meta::BlockDescription::ScanLines, LineOrder::Increasing)
        );
        assert_eq!(header.shared_attributes.chromaticities, Some(REC_709));
    }

    #[test]
    fn mismatched_slots_and_missing_files_are_errors() {
        let folder = TestFolder::new("exr-errors");
        let path = folder.0.join("a.exr");
        let slots = BTreeMap::from([(Slot::Direct, gradient([3, 2], 0.0))]);
        let message =
            write_exr(&path, &gradient([2, 2], 0.0), &slots, &Attributes::new()).expect_err("sizes differ").to_string();
        assert!(message.contains("direct"), "{message}");
        assert!(folder.names().is_empty());
        let message = read_exr(&path).expect_err("there is none").to_string();
        assert!(message.contains("a.exr"), "{message}");
    }
}
