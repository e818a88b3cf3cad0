//! Files that could not be written or read.

use std::path::{Path, PathBuf};

/// The extensions that name a format.
pub(super) const EXTENSIONS: [&str; 2] = [".exr", ".png"];

/// A file that could not be written or read. One sentence: which file, why.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The extension names no format that we write.
    #[error("{path} is no image that irradia writes; the extensions are {known}", path = .0.display(), known = EXTENSIONS.join(", "))]
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
    pub(super) fn write(path: &Path, reason: impl std::fmt::Display) -> OutputError {
        OutputError::Write { path: path.to_owned(), reason: reason.to_string() }
    }

    pub(super) fn read(path: &Path, reason: impl std::fmt::Display) -> OutputError {
        OutputError::Read { path: path.to_owned(), reason: reason.to_string() }
    }
}
