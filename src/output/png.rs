//! PNG: the tone-mapped image, 8 bits a channel, sRGB, with its attributes as text chunks.

use super::{Attributes, OutputError, Target};

/// Writes sRGB-encoded pixels, in rows from the top left. Attributes become UTF-8 text chunks (`iTXt`) of their names.
///
/// # Errors
/// The file cannot be written, or there are not `size[0] * size[1]` pixels.
pub fn write_png(
    target: impl Into<Target>,
    size: [u32; 2],
    pixels: &[[u8; 3]],
    attributes: &Attributes,
) -> Result<(), OutputError> {
    let target = target.into();
    let bytes = encode(size, pixels, attributes).map_err(|error| OutputError::write(target.path(), error))?;
    target.write(&bytes)
}

fn encode(size: [u32; 2], pixels: &[[u8; 3]], attributes: &Attributes) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (name, value) in attributes {
        encoder.add_itxt_chunk(name.clone(), value.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.as_flattened())?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::target::tests::TestFolder;

    #[test]
    fn pixels_and_attributes_come_back() {
        let folder = TestFolder::new("png");
        let path = folder.0.join("a.png");
        let pixels = [[0, 0, 0], [255, 0, 0], [0, 128, 255], [1, 2, 3], [4, 5, 6], [255, 255, 255]];
        let attributes = Attributes::from([
            ("scene".to_owned(), "Кухня 台所".to_owned()),
            ("settings".to_owned(), "{\"rsm\":{\"vpls\":256}}".to_owned()),
        ]);
        write_png(&path, [3, 2], &pixels, &attributes).expect("written");

        let file = std::io::BufReader::new(std::fs::File::open(&path).expect("there"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
        let mut bytes = vec![0; reader.output_buffer_size().expect("small")];
        let frame = reader.next_frame(&mut bytes).expect("an image");
        assert_eq!((frame.width, frame.height, frame.color_type), (3, 2, png::ColorType::Rgb));
        assert_eq!(bytes, pixels.as_flattened());
        assert!(reader.info().srgb.is_some());
        let texts = &reader.info().utf8_text;
        let read: Attributes =
            texts.iter().map(|text| (text.keyword.clone(), text.get_text().expect("UTF-8"))).collect();
        assert_eq!(read, attributes);
    }

    #[test]
    fn too_few_pixels_leave_no_file() {
        let folder = TestFolder::new("png-short");
        assert!(write_png(&folder.0.join("a.png"), [3, 2], &[[0; 3]], &Attributes::new()).is_err());
        assert!(folder.names().is_empty());
    }
}
