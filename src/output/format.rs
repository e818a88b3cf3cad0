//! The formats of images, and the extensions that name them.

use std::path::Path;

use super::error::{EXTENSIONS, OutputError};

/// The image formats that irradia writes, chosen by a file's extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImageFormat {
    /// OpenEXR: linear radiance, float32, the image and its slots.
    Exr,
    /// PNG: the tone-mapped image, 8 bits, sRGB.
    Png,
}

impl ImageFormat {
    /// The extensions that name a format.
    pub const EXTENSIONS: [&str; 2] = EXTENSIONS;

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
