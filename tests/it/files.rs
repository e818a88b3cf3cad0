//! Folders that tests write to, and pictures that they find there.

use std::fs;
use std::path::{Path, PathBuf};

/// An empty folder for one test, made anew every time.
pub(crate) fn empty_folder(capability: &str, test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(capability).join(test);
    if path.exists() {
        fs::remove_dir_all(&path).expect("the test's own folder");
    }
    fs::create_dir_all(&path).expect("the target folder is writable");
    path
}

/// What a folder holds, in order.
pub(crate) fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the test's own folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Size and pixels of an RGB file with eight bits a channel.
pub(crate) fn read_png(path: &Path) -> ([u32; 2], Vec<[u8; 3]>) {
    let bytes = fs::read(path).expect("it was written");
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
    let frame = reader.next_frame(&mut pixels).expect("its pixels");
    assert_eq!((frame.color_type, frame.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    ([frame.width, frame.height], pixels.as_chunks().0.to_vec())
}
