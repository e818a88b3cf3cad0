//! The files that a glTF file names: found in its folder, and read as far as the limits go.

use crate::scene::LoadOptions;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Reads a file by the URI that names it, percent-encoding undone; says what is wrong otherwise. Several threads may call it at once.
pub type ReadFile<'a> = dyn Fn(&str) -> Result<Vec<u8>, String> + Sync + 'a;

/// Where the files are that a glTF file names.
pub(super) enum Source<'a> {
    /// Beside it in this folder; without one, nowhere.
    Folder(Option<&'a Path>),
    /// In a file system of the caller's.
    Caller(&'a ReadFile<'a>),
}

/// Where files are, and how much may still be read.
pub(super) struct Files<'a> {
    source: Source<'a>,
    options: &'a LoadOptions,
    read: AtomicU64,
}

impl<'a> Files<'a> {
    /// Files that a glTF file of `file_bytes` bytes names.
    pub(super) fn new(source: Source<'a>, options: &'a LoadOptions, file_bytes: u64) -> Files<'a> {
        Files { source, options, read: AtomicU64::new(file_bytes) }
    }

    /// The bytes of the file that a URI names.
    pub(super) fn read(&self, uri: &str) -> Result<Vec<u8>, String> {
        match self.source {
            Source::Folder(folder) => self.read_in(folder, uri),
            Source::Caller(read) => {
                let bytes = read(&decoded(uri)?)?;
                self.count(bytes.len() as u64, Path::new(uri))?;
                Ok(bytes)
            }
        }
    }

    /// Adds to what was read, as far as the limit.
    fn count(&self, bytes: u64, path: &Path) -> Result<(), String> {
        let before = self.read.fetch_add(bytes, Ordering::Relaxed);
        let fits = before.saturating_add(bytes) <= self.options.file_bytes;
        if fits { Ok(()) } else { Err(too_large(path, self.options)) }
    }

    fn read_in(&self, folder: Option<&Path>, uri: &str) -> Result<Vec<u8>, String> {
        let path = self.find(folder, uri)?;
        let failed = |error: std::io::Error| format!("cannot read {}: {error}", path.display());
        // A pipe or a device could block for ever or never end.
        let metadata = std::fs::metadata(&path).map_err(failed)?;
        if !metadata.is_file() {
            return Err(format!("cannot read {}: it is not a file", path.display()));
        }
        self.count(metadata.len(), &path)?;
        std::fs::read(&path).map_err(failed)
    }

    fn find(&self, folder: Option<&Path>, uri: &str) -> Result<PathBuf, String> {
        let shown = shown(uri);
        let local = uri.strip_prefix("file://").map(|path| path.strip_prefix("localhost").unwrap_or(path));
        if local.is_none() && has_scheme(uri) {
            return Err(format!(
                "the uri {shown:?} is not a relative path; download the file and put it beside the glTF file"
            ));
        }
        let decoded = decoded(local.unwrap_or(uri))?;
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

fn shown(uri: &str) -> String {
    uri.chars().take(80).collect()
}

/// The path that a URI stands for.
fn decoded(uri: &str) -> Result<String, String> {
    percent_decode(uri).ok_or_else(|| format!("the uri {:?} is not valid percent-encoded UTF-8", shown(uri)))
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
