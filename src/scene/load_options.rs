//! What reading a scene may do, and how much of the machine it may take.

/// For scenes of unknown origin the defaults are safe: nothing outside the scene's folder is read, and what a file only
/// claims to hold is not allocated.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LoadOptions {
    /// Whether a glTF file may name files outside the folder that it lies in: by `..`, by an absolute path, by a `file:`
    /// URI or through a symbolic link.
    pub allow_outside_files: bool,
    /// Longest side of an image, in texels.
    pub image_side: u32,
    /// Bytes of all textures of a scene, at four a texel.
    pub texture_bytes: u64,
    /// Bytes of a scene's files together.
    pub file_bytes: u64,
}

impl Default for LoadOptions {
    fn default() -> LoadOptions {
        LoadOptions { allow_outside_files: false, image_side: 16_384, texture_bytes: 4 << 30, file_bytes: 8 << 30 }
    }
}

impl LoadOptions {
    /// The options after a change.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut LoadOptions)) -> LoadOptions {
        change(&mut self);
        self
    }
}
