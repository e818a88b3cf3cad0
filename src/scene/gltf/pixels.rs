//! Pixels of PNG and JPEG files, as RGBA with eight bits a channel.

use std::fmt::Display;
use std::io::Cursor;

use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

#[derive(Clone, Copy)]
enum Format {
    Png,
    Jpeg,
}

/// What deflate reaches at the most: a match of 258 bytes in two bits.
const DEFLATE_RATIO: u64 = 1032;

/// Texels that a bit of a JPEG can stand for: a block of 8×8 takes one at the least.
const JPEG_TEXELS_PER_BIT: u64 = 64;

/// What a file's header says, and how many bytes a file of its format has at the least that holds so much.
pub(super) struct Claim {
    pub(super) size: [u32; 2],
    pub(super) least_bytes: u64,
}

pub(super) fn claim(file: &[u8]) -> Result<Claim, String> {
    match format(file)? {
        Format::Png => {
            let mut decoder = png_decoder(file);
            let header = decoder.read_header_info().map_err(undecodable)?;
            let bits = header.bits_per_pixel() as u64;
            // Every row begins with a byte for its filter.
            let row_bytes = 1 + (u64::from(header.width) * bits).div_ceil(8);
            let least_bytes = row_bytes * u64::from(header.height) / DEFLATE_RATIO;
            Ok(Claim { size: [header.width, header.height], least_bytes })
        }
        Format::Jpeg => {
            let mut decoder = jpeg_decoder(file, ColorSpace::RGB);
            decoder.decode_headers().map_err(undecodable)?;
            let info = decoder.info().ok_or("it has no header")?;
            let size: [u32; 2] = [info.width.into(), info.height.into()];
            let least_bytes = u64::from(size[0]) * u64::from(size[1]) / (8 * JPEG_TEXELS_PER_BIT);
            Ok(Claim { size, least_bytes })
        }
    }
}

/// The pixels of a file whose claim is sound.
pub(super) fn decode(file: &[u8]) -> Result<Vec<u8>, String> {
    match format(file)? {
        Format::Png => decode_png(file),
        Format::Jpeg => decode_jpeg(file),
    }
}

fn format(file: &[u8]) -> Result<Format, String> {
    match file {
        [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n', ..] => Ok(Format::Png),
        [0xff, 0xd8, 0xff, ..] => Ok(Format::Jpeg),
        _ => Err("it is neither PNG nor JPEG".to_owned()),
    }
}

fn undecodable(error: impl Display) -> String {
    format!("it cannot be decoded ({error})")
}

fn png_decoder(file: &[u8]) -> png::Decoder<Cursor<&[u8]>> {
    // The limits of the decoder itself are for what comes beside the pixels, of which nothing is used.
    let mut decoder = png::Decoder::new(Cursor::new(file));
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    // Palettes and fewer than eight bits become eight; sixteen are rounded below, not cut.
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder
}

fn decode_png(file: &[u8]) -> Result<Vec<u8>, String> {
    let mut reader = png_decoder(file).read_info().map_err(undecodable)?;
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data).map_err(undecodable)?;
    data.truncate(frame.buffer_size());
    if frame.bit_depth == png::BitDepth::Sixteen {
        let (values, _) = data.as_chunks();
        data = values.iter().map(|&value| ((u32::from(u16::from_be_bytes(value)) + 128) / 257) as u8).collect();
    }
    Ok(rgba(data, frame.color_type.samples()))
}

fn jpeg_decoder(file: &[u8], space: ColorSpace) -> JpegDecoder<ZCursor<&[u8]>> {
    // Files that other readers forgive are forgiven; their size is checked before they are decoded.
    let options = DecoderOptions::default().set_strict_mode(false).set_max_width(usize::MAX).set_max_height(usize::MAX);
    JpegDecoder::new_with_options(ZCursor::new(file), options.jpeg_set_out_colorspace(space))
}

fn decode_jpeg(file: &[u8]) -> Result<Vec<u8>, String> {
    let mut header = jpeg_decoder(file, ColorSpace::RGB);
    header.decode_headers().map_err(undecodable)?;
    let space = match header.input_colorspace() {
        Some(grey @ (ColorSpace::Luma | ColorSpace::LumaA)) => grey,
        _ => ColorSpace::RGB,
    };
    let data = jpeg_decoder(file, space).decode().map_err(undecodable)?;
    Ok(rgba(data, space.num_components()))
}

/// RGBA of pixels with so many channels: grey, grey and alpha, RGB, or RGBA already.
fn rgba(data: Vec<u8>, channels: usize) -> Vec<u8> {
    match channels {
        1 => data.iter().flat_map(|&grey| [grey, grey, grey, 255]).collect(),
        2 => data.as_chunks().0.iter().flat_map(|&[grey, alpha]| [grey, grey, grey, alpha]).collect(),
        3 => data.as_chunks().0.iter().flat_map(|&[red, green, blue]| [red, green, blue, 255]).collect(),
        _ => data,
    }
}
