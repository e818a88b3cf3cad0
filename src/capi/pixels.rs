//! Pixels of a frame, copied into the host's memory.

use std::ffi::c_void;

use half::f16;

use super::border::call;
use super::descriptor::{descriptors, read};
use super::frame::FrameHandle;
use super::slots::{IRRADIA_SLOT_DISPLAY, IRRADIA_SLOT_IMAGE, slot_of};
use super::status::{Fault, Status};
use crate::image::ColorImage;
use crate::renderer::Frame;

/// Red, green, blue, each a 32-bit float.
pub const IRRADIA_PIXELS_RGB32F: u32 = 0;
/// The same and an alpha of 1.
pub const IRRADIA_PIXELS_RGBA32F: u32 = 1;
/// Red, green, blue, each a 16-bit float; beyond 65504 infinite.
pub const IRRADIA_PIXELS_RGB16F: u32 = 2;
/// The same and an alpha of 1.
pub const IRRADIA_PIXELS_RGBA16F: u32 = 3;
/// Red, green, blue, each a byte; of IRRADIA_SLOT_DISPLAY alone.
pub const IRRADIA_PIXELS_RGB8: u32 = 4;
/// The same and an alpha of 255.
pub const IRRADIA_PIXELS_RGBA8: u32 = 5;

/// Where pixels go.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct PixelsDescriptor {
    /// sizeof(irradia_pixels_descriptor).
    pub size: usize,
    /// One of IRRADIA_SLOT_…, which the frame was asked for. Radiance in W/(m² sr), linear Rec. 709.
    pub slot: u32,
    /// One of IRRADIA_PIXELS_….
    pub format: u32,
    /// Receives the rows, the top one first.
    pub pixels: *mut c_void,
    /// Bytes that may be written there.
    pub byte_count: usize,
    /// Bytes from one row to the next; 0: rows lie one behind the other. Between rows nothing is written.
    pub row_stride: usize,
}

descriptors! {
    PixelsDescriptor = "pixels descriptor", size_of::<PixelsDescriptor>();
}

/// Copies the pixels of a slot. A slot that no method fills is black.
///
/// Errors: IRRADIA_ERROR_ARGUMENT if the frame was not asked for the slot, or the rows do not fit; nothing is written then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_frame_copy(frame: *const FrameHandle, descriptor: *const PixelsDescriptor) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let (state, given) = unsafe { (border.enter(frame)?, read(descriptor)?) };
        let frame = &state.frame;
        let width = match given.format {
            IRRADIA_PIXELS_RGB32F => 12,
            IRRADIA_PIXELS_RGBA32F => 16,
            IRRADIA_PIXELS_RGB16F => 6,
            IRRADIA_PIXELS_RGBA16F => 8,
            IRRADIA_PIXELS_RGB8 => 3,
            IRRADIA_PIXELS_RGBA8 => 4,
            other => return Err(Fault::argument(format!("the format is {other}; write one of IRRADIA_PIXELS_…"))),
        };
        let source = Source::of(frame, given.slot, given.format)?;
        let [columns, rows] = frame.size.map(|side| side as usize);
        let row = width * columns;
        let stride = if given.row_stride == 0 { row } else { given.row_stride };
        if given.pixels.is_null() || stride < row {
            return Err(Fault::argument(format!(
                "rows of {row} bytes cannot be {stride} bytes apart, or have no place"
            )));
        }
        let bytes = stride.checked_mul(rows - 1).and_then(|bytes| bytes.checked_add(row));
        let bytes = bytes.filter(|&bytes| bytes <= given.byte_count && bytes <= isize::MAX as usize);
        let bytes = bytes.ok_or_else(|| {
            let sentence =
                format!("{rows} rows of {row} bytes, {stride} apart, do not fit into {} bytes", given.byte_count);
            Fault::argument(sentence)
        })?;
        // SAFETY: the host has as many bytes there, which nothing else uses during the call.
        let target = unsafe { std::slice::from_raw_parts_mut(given.pixels.cast::<u8>(), bytes) };
        for (number, target) in target.chunks_mut(stride).enumerate() {
            source.row(number * columns..(number + 1) * columns, given.format, &mut target[..row]);
        }
        Ok(())
    })
}

/// What is copied.
enum Source<'a> {
    Radiance(&'a ColorImage),
    Display(&'a [[u8; 3]]),
}

impl<'a> Source<'a> {
    fn of(frame: &'a Frame, slot: u32, format: u32) -> Result<Source<'a>, Fault> {
        let found = match slot {
            IRRADIA_SLOT_DISPLAY => frame.display.as_deref().map(Source::Display),
            IRRADIA_SLOT_IMAGE => frame.image.as_ref().map(Source::Radiance),
            bit => slot_of(bit).and_then(|slot| frame.slots.get(&slot)).map(Source::Radiance),
        };
        let found = found.ok_or_else(|| {
            Fault::argument(format!("the frame was not asked for slot {slot}; name it in its descriptor's slots"))
        })?;
        let bytes = format >= IRRADIA_PIXELS_RGB8;
        if bytes != matches!(found, Source::Display(_)) {
            return Err(Fault::argument("bytes are for IRRADIA_SLOT_DISPLAY, floats for all other slots"));
        }
        Ok(found)
    }

    fn row(&self, pixels: std::ops::Range<usize>, format: u32, row: &mut [u8]) {
        match self {
            Source::Radiance(image) => {
                let pixels = &image.pixels[pixels];
                match format {
                    IRRADIA_PIXELS_RGB32F => row.copy_from_slice(bytemuck::cast_slice(pixels)),
                    IRRADIA_PIXELS_RGBA32F => spread(pixels, row, |&[r, g, b]| [r, g, b, 1.0]),
                    IRRADIA_PIXELS_RGB16F => spread(pixels, row, |pixel| pixel.map(f16::from_f32)),
                    _ => spread(pixels, row, |&[r, g, b]| [r, g, b, 1.0].map(f16::from_f32)),
                }
            }
            Source::Display(levels) => {
                let levels = &levels[pixels];
                match format {
                    IRRADIA_PIXELS_RGB8 => row.copy_from_slice(levels.as_flattened()),
                    _ => spread(levels, row, |&[r, g, b]| [r, g, b, u8::MAX]),
                }
            }
        }
    }
}

/// Fills a row with what each pixel becomes. The host's rows may lie anywhere, so that they are written byte by byte.
fn spread<T, P: bytemuck::Pod>(pixels: &[T], row: &mut [u8], become_what: impl Fn(&T) -> P) {
    for (pixel, target) in pixels.iter().zip(row.chunks_exact_mut(size_of::<P>())) {
        target.copy_from_slice(bytemuck::bytes_of(&become_what(pixel)));
    }
}
