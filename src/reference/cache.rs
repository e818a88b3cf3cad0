//! The folder in which references are kept from one run to the next, one file each.

use std::fs;
use std::path::{Path, PathBuf};

use super::about::About;
use super::cache_lock::CacheLock;
use super::{ReferenceError, ReferenceFile, ReferenceKey};
use crate::output::{OutputError, read_attributes};

/// Names the folder of the cache.
const FOLDER_VARIABLE: &str = "IRRADIA_CACHE_DIR";

const EXTENSION: &str = ".exr";

/// A folder of references. Several processes may use it at a time: files appear whole, they are changed under a lock, and of
/// one reference the file with the most samples stays.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
}

/// What the cache holds of one reference, or a file in its folder that cannot be used.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The file.
    pub path: PathBuf,
    /// Its size.
    pub bytes: u64,
    /// What it is of; or why it cannot be used.
    pub content: Result<EntryContent, String>,
}

/// What a cached reference is of, by its file's header.
#[derive(Clone, Debug)]
pub struct EntryContent {
    /// What tells it from other references.
    pub key: ReferenceKey,
    /// The scene's name.
    pub scene: String,
    /// The camera's name.
    pub camera: String,
    /// `WxH`.
    pub size: String,
    /// `path` or `sppm`.
    pub estimator: String,
    /// A number or `unlimited`.
    pub bounces: String,
    /// Samples per pixel.
    pub spp: u32,
    /// Relative noise of the image.
    pub noise: f64,
}

impl Cache {
    /// The cache in `$IRRADIA_CACHE_DIR`, else `$XDG_CACHE_HOME/irradia/references`, else `~/.cache/irradia/references`;
    /// `None` if none of these is known. The folder is made when something is written.
    pub fn open() -> Option<Cache> {
        let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let of_user = |caches: PathBuf| caches.join("irradia").join("references");
        let folder = variable(FOLDER_VARIABLE)
            .or_else(|| variable("XDG_CACHE_HOME").filter(|path| path.is_absolute()).map(of_user))
            .or_else(|| Some(of_user(variable("HOME")?.join(".cache"))))?;
        Some(Cache::at(folder))
    }

    /// The cache in a folder.
    pub fn at(folder: impl Into<PathBuf>) -> Cache {
        Cache { folder: folder.into() }
    }

    /// Where the files lie.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The file of a key, if there is one, whatever its scene was called then.
    pub fn find(&self, key: &ReferenceKey) -> Option<PathBuf> {
        let end = format!("-{}{EXTENSION}", key.prefix());
        self.files().into_iter().find(|path| name(path).ends_with(&end))
    }

    /// The cached reference of a key. A file that cannot be used counts as none, with a warning.
    pub(crate) fn read(&self, key: &ReferenceKey) -> Option<ReferenceFile> {
        let path = self.find(key)?;
        match ReferenceFile::read(&path) {
            Ok(file) if file.key() == key && file.shard.is_none() => Some(file),
            Ok(_) => {
                tracing::warn!("{} holds another reference than its name says; it is made anew", path.display());
                None
            }
            Err(error) => {
                tracing::warn!("{error}; it is made anew");
                None
            }
        }
    }

    /// Puts a reference into the cache unless it holds one of the same key with as many samples. Gives the file that holds
    /// it now.
    ///
    /// # Errors
    /// The folder cannot be made or the file cannot be written.
    pub fn keep(&self, file: &ReferenceFile) -> Result<PathBuf, OutputError> {
        fs::create_dir_all(&self.folder)
            .map_err(|error| OutputError::Write { path: self.folder.clone(), reason: error.to_string() })?;
        let _lock = CacheLock::take(&self.folder);
        match self.find(file.key()) {
            // All of the file is read only if by its header it would stay.
            Some(path) if spp_of(&path) >= file.spp() && self.read(file.key()).is_some() => Ok(path),
            present => {
                let path = present.unwrap_or_else(|| self.folder.join(file_name(&file.about)));
                file.write(&path)?;
                Ok(path)
            }
        }
    }

    /// Everything in the cache, by name.
    pub fn list(&self) -> Vec<Entry> {
        self.files().into_iter().map(entry).collect()
    }

    /// Removes the references whose keys begin with `prefix`, or all, and files that cannot be used if all is asked for.
    /// Gives what was removed.
    ///
    /// # Errors
    /// [`ReferenceError::NotCached`] if no key begins so; a file that cannot be removed.
    pub fn clear(&self, prefix: Option<&str>) -> Result<Vec<Entry>, ReferenceError> {
        let _lock = self.folder.is_dir().then(|| CacheLock::take(&self.folder));
        let mut entries = self.list();
        if let Some(prefix) = prefix {
            let begins = |entry: &Entry| {
                key_in_name(&entry.path).is_some_and(|key| prefix.starts_with(key) || key.starts_with(prefix))
            };
            entries.retain(|entry| begins(entry) && !prefix.is_empty());
            if entries.is_empty() {
                return Err(ReferenceError::NotCached(prefix.to_owned()));
            }
        }
        for Entry { path, .. } in &entries {
            fs::remove_file(path)
                .map_err(|error| OutputError::Write { path: path.clone(), reason: error.to_string() })?;
        }
        Ok(entries)
    }

    /// The files whose names end in a key's prefix, sorted; nothing else in the folder is touched.
    fn files(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> =
            entries.map(|entry| entry.path()).filter(|path| key_in_name(path).is_some()).collect();
        files.sort();
        files
    }
}

fn name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).unwrap_or_default()
}

/// The digits of the key in a file's name; `None` if it is not one of the cache's.
fn key_in_name(path: &Path) -> Option<&str> {
    let stem = name(path).strip_suffix(EXTENSION).filter(|stem| !stem.starts_with('.'))?;
    let (_, digits) = stem.rsplit_once('-')?;
    let sound = digits.len() == ReferenceKey::PREFIX_DIGITS && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    sound.then_some(digits)
}

/// `SCENE-WxH-KEY.exr`; what is harmful in a scene's name becomes `_`.
fn file_name(about: &About) -> String {
    let [width, height] = about.size;
    let harmless =
        |character: char| if character.is_alphanumeric() || "-_".contains(character) { character } else { '_' };
    // Names of files are limited to 255 bytes.
    let scene: String = about.attribute("scene").chars().take(48).map(harmless).collect();
    format!("{scene}-{width}x{height}-{}{EXTENSION}", about.key.prefix())
}

/// Samples per pixel by the file's header; 0 if it cannot be read.
fn spp_of(path: &Path) -> u32 {
    read_attributes(path).ok().and_then(|attributes| attributes.get("spp")?.parse().ok()).unwrap_or_default()
}

fn entry(path: PathBuf) -> Entry {
    let bytes = fs::metadata(&path).map_or(0, |data| data.len());
    let content = read_attributes(&path).map_err(|error| error.to_string()).and_then(|attributes| {
        let about = About::read([0, 0], &attributes)?;
        let number = |name: &str| attributes.get(name).map_or("", String::as_str);
        Ok(EntryContent {
            key: about.key.clone(),
            scene: about.attribute("scene").to_owned(),
            camera: about.attribute("camera").to_owned(),
            size: about.attribute("size").to_owned(),
            estimator: about.attribute("estimator").to_owned(),
            bounces: about.attribute("bounces").to_owned(),
            spp: number("spp").parse().unwrap_or_default(),
            noise: number("noise.image.rrmse").parse().unwrap_or(f64::NAN),
        })
    });
    Entry { path, bytes, content }
}
