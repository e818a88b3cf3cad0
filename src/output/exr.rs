//! OpenEXR: linear radiance, float32, losslessly compressed; the image as `R G B`, each slot as a layer of channels
//! (`diffuse.R`, `diffuse.G`, `diffuse.B`), all in one part so that any viewer opens it.

use std::collections::BTreeMap;
use std::path::Path;

use super::layers::{Layers, read_layers, write_layers};
use super::{Attributes, OutputError, Target};
use crate::image::ColorImage;
use crate::slot::Slot;

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
    target: impl Into<Target>,
    image: &ColorImage,
    slots: &BTreeMap<Slot, ColorImage>,
    attributes: &Attributes,
) -> Result<(), OutputError> {
    let (target, [width, height]) = (target.into(), image.size);
    if let Some((slot, layer)) = slots.iter().find(|(_, layer)| layer.size != image.size) {
        let reason = format!("layer {slot} has {} pixels, the image {width}x{height}", layer.pixels.len());
        return Err(OutputError::write(target.path(), reason));
    }
    let layers = slots.iter().map(|(slot, layer)| (slot.name().to_owned(), &layer.pixels[..]));
    let layers: Vec<_> = [(String::new(), &image.pixels[..])].into_iter().chain(layers).collect();
    write_layers(&target, image.size, &layers, attributes)
}

/// Reads an image and the layers that are named like slots; other channels are left out.
///
/// # Errors
/// The file cannot be read or has no channels `R G B`.
pub fn read_exr(path: &Path) -> Result<ExrImage, OutputError> {
    let Layers { size, mut layers, channels, attributes } = read_layers(path)?;
    let mut take = |name: &str| Some(ColorImage { size, pixels: layers.remove(name)? });
    let image = take("").ok_or_else(|| {
        OutputError::read(path, format!("it has no channels R, G and B, but {}", channels.join(", ")))
    })?;
    let slots = Slot::ALL.into_iter().filter_map(|slot| Some((slot, take(slot.name())?))).collect();
    Ok(ExrImage { image, slots, attributes })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use ::exr::prelude::{Compression, LineOrder};

    use super::*;
    use crate::output::layers::REC_709;
    use crate::output::target::tests::TestFolder;

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
            fs::read(path).expect("just written")
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
        let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
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

    #[test]
    fn a_file_too_small_for_what_it_claims_is_refused_before_anything_is_allocated() {
        let folder = TestFolder::new("exr-claim");
        let path = folder.0.join("a.exr");
        write_exr(&path, &gradient([2, 2], 0.0), &BTreeMap::new(), &Attributes::new()).expect("written");
        let mut bytes = fs::read(&path).expect("written");
        let window = b"dataWindow\0box2i\0";
        let at = bytes.windows(window.len()).position(|part| part == window).expect("every file has one");
        let values = at + window.len() + 4;
        // 1024×1024 pixels of three floats, 12 MiB, in less than a thousandth of it.
        bytes[values + 8..values + 16].copy_from_slice(&[1023_u32.to_le_bytes(); 2].concat());
        bytes.resize(8 << 10, 0);
        fs::write(&path, bytes).expect("writable");
        let message = read_exr(&path).expect_err("it claims too much").to_string();
        assert!(message.contains("too small"), "{message}");
    }
}
