//! Images to files: layered OpenEXR, PNG, and the tone maps that turn radiance into display values.
//!
//! Files appear whole or not at all ([`AtomicFile`]), and carry what they show as attributes, so that a picture found
//! a year later still says which scene, settings and device made it.

pub(crate) mod atomic_file;
mod exr;
mod header;
mod layers;
mod png;
mod seal;
mod supersample;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use self::atomic_file::{AtomicFile, check_target};
pub use self::exr::{ExrImage, read_exr, write_exr};
pub(crate) use self::layers::{SealedError, read_attributes, read_sealed_layers, write_sealed_layers};
pub use self::png::write_png;
pub use self::supersample::box_reduced;

/// What a picture is of, by name: scene, settings, device, version …
pub type Attributes = BTreeMap<String, String>;

/// A file that could not be written or read. One sentence: which file, why.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The extension names no format that we write.
    #[error("{path} is no image that irradia writes; the extensions are {known}", path = .0.display(), known = ImageFormat::EXTENSIONS.join(", "))]
    UnknownExtension(PathBuf),
    /// The file cannot be written.
    #[error("{path} cannot be written: {reason}", path = .path.display())]
    Write {
        /// The file asked for.
        path: PathBuf,
        /// What the operating system or the format says.
        reason: String,
    },
    /// The file cannot be read.
    #[error("{path} cannot be read: {reason}", path = .path.display())]
    Read {
        /// The file asked for.
        path: PathBuf,
        /// What the operating system or the format says.
        reason: String,
    },
}

impl OutputError {
    fn write(path: &Path, reason: impl std::fmt::Display) -> OutputError {
        OutputError::Write { path: path.to_owned(), reason: reason.to_string() }
    }

    fn read(path: &Path, reason: impl std::fmt::Display) -> OutputError {
        OutputError::Read { path: path.to_owned(), reason: reason.to_string() }
    }
}

/// The image formats that irradia writes, chosen by a file's extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// OpenEXR: linear radiance, float32, the image and its slots.
    Exr,
    /// PNG: the tone-mapped image, 8 bits, sRGB.
    Png,
}

impl ImageFormat {
    /// The extensions that name a format.
    pub const EXTENSIONS: [&str; 2] = [".exr", ".png"];

    /// The format that the extension of `path` names, in capitals or not.
    ///
    /// # Errors
    /// Another extension or none; the message lists those there are.
    pub fn from_path(path: &Path) -> Result<ImageFormat, OutputError> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "exr" => Ok(ImageFormat::Exr),
            "png" => Ok(ImageFormat::Png),
            _ => Err(OutputError::UnknownExtension(path.to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_names_the_format() {
        let format = |name: &str| ImageFormat::from_path(Path::new(name)).ok();
        assert_eq!(format("a.exr"), Some(ImageFormat::Exr));
        assert_eq!(format("dir.exr/b.PNG"), Some(ImageFormat::Png));
        assert_eq!(format("a.jpg"), None);
        assert_eq!(format("png"), None);
        let message = ImageFormat::from_path(Path::new("a.jpg")).expect_err("not written").to_string();
        assert!(message.contains("a.jpg") && message.contains(".exr, .png"), "{message}");
    }
}
