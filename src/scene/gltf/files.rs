//! The files that a glTF file names: found in its folder, and read as far as the limits go.

use crate::scene::LoadOptions;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// The scene's folder, and how much may still be read.
pub(super) struct Files<'a> {
    folder: Option<PathBuf>,
    options: &'a LoadOptions,
    read: AtomicU64,
}

impl<'a> Files<'a> {
    /// Files beside a glTF file of `file_bytes` bytes; none without a folder.
    pub(super) fn new(folder: Option<&Path>, options: &'a LoadOptions, file_bytes: u64) -> Files<'a> {
        Files { folder: folder.map(Path::to_owned), options, read: AtomicU64::new(file_bytes) }
    }

    /// The bytes of the file that a URI names, relative to the scene's folder.
    pub(super) fn read(&self, uri: &str) -> Result<Vec<u8>, String> {
        let path = self.find(uri)?;
        let failed = |error: std::io::Error| format!("cannot read {}: {error}", path.display());
        // A pipe or a device could block for ever or never end.
        let metadata = std::fs::metadata(&path).map_err(failed)?;
        if !metadata.is_file() {
            return Err(format!("cannot read {}: it is not a file", path.display()));
        }
        let before = self.read.fetch_add(metadata.len(), Ordering::Relaxed);
        if before.saturating_add(metadata.len()) > self.options.file_bytes {
            return Err(too_large(&path, self.options));
        }
        std::fs::read(&path).map_err(failed)
    }

    fn find(&self, uri: &str) -> Result<PathBuf, String> {
        let shown: String = uri.chars().take(80).collect();
        let local = uri.strip_prefix("file://").map(|path| path.strip_prefix("localhost").unwrap_or(path));
        if local.is_none() && has_scheme(uri) {
            return Err(format!(
                "the uri {shown:?} is not a relative path; download the file and put it beside the glTF file"
            ));
        }
        let decoded = percent_decode(local.unwrap_or(uri))
            .ok_or_else(|| format!("the uri {shown:?} is not valid percent-encoded UTF-8"))?;
        let outside = |how: &str| {
            Err(format!(
                "the uri {shown:?} {how}; put the file beside the glTF file, or if you trust the scene allow it by \
                 --allow-outside-files (LoadOptions::allow_outside_files)"
            ))
        };
        let relative = Path::new(&decoded);
        let absolute = relative.has_root() || relative.is_absolute() || decoded.starts_with('\\');
        if !self.options.allow_outside_files && (absolute || local.is_some()) {
            return outside("is an absolute path");
        }
        let folder = self.folder.as_ref();
        let folder = folder
            .ok_or_else(|| format!("the uri {shown:?} names a file, but no directory to find it in was given"))?;
        let path = folder.join(relative);
        if self.options.allow_outside_files {
            return Ok(path);
        }
        // Where the path ends up counts, with all its links followed, not how it is spelled.
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let resolved = std::fs::canonicalize(&path);
        let resolved = resolved.map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        let home = std::fs::canonicalize(folder);
        let home = home.map_err(|error| format!("cannot read {}: {error}", folder.display()))?;
        if resolved.starts_with(home) { Ok(resolved) } else { outside("leads out of the scene's folder") }
    }
}

/// The bytes of the glTF file itself, which may also be a pipe.
pub(super) fn read_main(path: &Path, options: &LoadOptions) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(options.file_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > options.file_bytes {
        return Err(std::io::Error::other(too_large(path, options)));
    }
    Ok(bytes)
}

fn too_large(path: &Path, options: &LoadOptions) -> String {
    format!(
        "with {} the scene's files have more than the {} MiB that may be read (LoadOptions::file_bytes)",
        path.display(),
        options.file_bytes >> 20
    )
}

/// Whether a uri begins with `scheme:`; "C:" counts as one too.
fn has_scheme(uri: &str) -> bool {
    let Some((scheme, _)) = uri.split_once(':') else {
        return false;
    };
    let mut letters = scheme.chars();
    letters.next().is_some_and(|first| first.is_ascii_alphabetic())
        && letters.all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
}

fn percent_decode(uri: &str) -> Option<String> {
    let mut decoded = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(byte) = bytes.next() {
        let digit = |byte: Option<u8>| char::from(byte?).to_digit(16).map(|digit| digit as u8);
        decoded.push(if byte == b'%' { digit(bytes.next())? * 16 + digit(bytes.next())? } else { byte });
    }
    String::from_utf8(decoded).ok().filter(|path| !path.contains('\0'))
}
