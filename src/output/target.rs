//! Where what the program writes goes: every file of every command, through here.
//!
//! A file appears whole or not at all: its bytes are written beside it and renamed onto it. A reader never sees half a
//! file, and a failed run leaves the old one untouched. The data is not forced to the disk: this guards against failures
//! of the program, not of the power supply. What cannot be replaced, such as `/dev/stdout` or a named pipe, is a stream:
//! opened once, and written to in place.

use std::ffi::OsStr;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tempfile::NamedTempFile;

use super::OutputError;

/// More links than this after each other are a circle.
const MOST_LINKS: usize = 40;

/// A place for a file. Made from a path it is looked at when it is written to; [`open`](Target::open) looks before.
#[derive(Clone, Debug)]
pub struct Target {
    path: PathBuf,
    stream: Option<Arc<File>>,
}

/// A file that is whole but not yet in its place; it goes when it is dropped.
#[derive(Debug)]
#[must_use]
pub struct Staged {
    path: PathBuf,
    /// With the name that it gets; `None`: a stream has it.
    file: Option<(NamedTempFile, PathBuf)>,
}

/// What a path leads to.
enum Place {
    /// A regular file, by the name that is no link, and what is there of it already.
    File(PathBuf, Option<Metadata>),
    Stream(Stream),
}

enum Stream {
    StandardOutput,
    StandardError,
    Named,
}

impl Target {
    /// Finds out whether `path` can be written, before the work whose result goes there. A stream is opened, and stays
    /// open: the reader of a pipe would take a second opening for another writer.
    ///
    /// # Errors
    /// The folder does not exist or cannot be written, or `path` is a folder or write-protected.
    pub fn open(path: &Path) -> Result<Target, OutputError> {
        let stream = match place(path)? {
            Place::Stream(stream) => Some(Arc::new(stream.open(path)?)),
            Place::File(name, existing) => {
                temporary(path, &name, existing.as_ref())?;
                None
            }
        };
        Ok(Target { path: path.to_owned(), stream })
    }

    /// The path as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the target is a stream: all that is written to it stays there, and nothing can be read back.
    pub fn is_stream(&self) -> bool {
        self.stream.is_some() || matches!(place(&self.path), Ok(Place::Stream(_)))
    }

    /// Writes the bytes: all that the file then holds, or the next ones of a stream. A symbolic link stays one: the file
    /// that it points to is replaced. A file that is there keeps its permissions.
    ///
    /// # Errors
    /// Those of [`open`](Target::open), and whatever the file system says; then nothing is left of the file.
    pub fn write(&self, bytes: &[u8]) -> Result<(), OutputError> {
        self.stage(bytes)?.finish()
    }

    /// Writes the bytes beside the file, which stays as it is until [`Staged::finish`]: whatever can fail has been done then. A stream has them at once.
    ///
    /// # Errors
    /// Those of [`write`](Target::write).
    pub fn stage(&self, bytes: &[u8]) -> Result<Staged, OutputError> {
        let failed = |error: &dyn std::fmt::Display| OutputError::write(&self.path, error);
        let staged = |file| Staged { path: self.path.clone(), file };
        if let Some(stream) = &self.stream {
            stream.as_ref().write_all(bytes).map_err(|error| failed(&error))?;
            return Ok(staged(None));
        }
        match place(&self.path)? {
            Place::Stream(stream) => {
                stream.open(&self.path)?.write_all(bytes).map_err(|error| failed(&error))?;
                Ok(staged(None))
            }
            Place::File(name, existing) => {
                let mut file = temporary(&self.path, &name, existing.as_ref())?;
                file.write_all(bytes).map_err(|error| failed(&error))?;
                Ok(staged(Some((file, name))))
            }
        }
    }
}

impl Staged {
    /// Puts the file in its place.
    ///
    /// # Errors
    /// Whatever the file system says; then the file is as it was.
    pub fn finish(self) -> Result<(), OutputError> {
        let Some((file, name)) = self.file else { return Ok(()) };
        file.persist(&name).map(drop).map_err(|error| OutputError::write(&self.path, error.error))
    }
}

impl From<&Path> for Target {
    fn from(path: &Path) -> Target {
        Target { path: path.to_owned(), stream: None }
    }
}

impl From<&PathBuf> for Target {
    fn from(path: &PathBuf) -> Target {
        Target::from(path.as_path())
    }
}

impl From<&Target> for Target {
    fn from(target: &Target) -> Target {
        target.clone()
    }
}

impl Stream {
    /// The standard streams are shared with what was and will be printed there: opened anew, a file that they are
    /// redirected to would be written over from its start.
    fn open(&self, path: &Path) -> Result<File, OutputError> {
        let file = match self {
            Stream::StandardOutput => io::stdout().flush().and_then(|()| duplicate(&io::stdout())),
            Stream::StandardError => duplicate(&io::stderr()),
            Stream::Named => OpenOptions::new().append(true).open(path),
        };
        file.map_err(|error| OutputError::write(path, error))
    }
}

#[cfg(unix)]
fn duplicate(stream: &impl std::os::fd::AsFd) -> io::Result<File> {
    stream.as_fd().try_clone_to_owned().map(File::from)
}

#[cfg(not(unix))]
fn duplicate<T>(_: &T) -> io::Result<File> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Follows links to what they lead to, which need not be there.
fn place(path: &Path) -> Result<Place, OutputError> {
    let failed = |reason: &dyn std::fmt::Display| OutputError::write(path, reason);
    let mut name = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Some(stream) = descriptor(&name) {
            return Ok(Place::Stream(stream));
        }
        let metadata = match fs::symlink_metadata(&name) {
            Ok(metadata) => metadata,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Place::File(name, None)),
            Err(error) => return Err(failed(&error)),
        };
        if metadata.is_symlink() {
            let next = fs::read_link(&name).map_err(|error| failed(&error))?;
            name = folder_of(&name).join(next);
        } else if metadata.is_dir() {
            return Err(failed(&"it is a folder"));
        } else if !metadata.is_file() {
            return Ok(Place::Stream(Stream::Named));
        } else if metadata.permissions().readonly() {
            return Err(failed(&"it is write-protected"));
        } else {
            return Ok(Place::File(name, Some(metadata)));
        }
    }
    Err(failed(&"it is a symbolic link that leads nowhere"))
}

/// The stream that a name like `/dev/fd/1` or `/proc/self/fd/1` stands for, whatever kind of file is behind it.
fn descriptor(name: &Path) -> Option<Stream> {
    let folder = fs::canonicalize(folder_of(name)).ok()?;
    if !folder.starts_with("/proc") || folder.file_name() != Some(OsStr::new("fd")) {
        return None;
    }
    let ours = fs::canonicalize("/proc/self/fd").is_ok_and(|descriptors| descriptors == folder);
    match name.file_name()?.to_str()? {
        "1" if ours => Some(Stream::StandardOutput),
        "2" if ours => Some(Stream::StandardError),
        _ => Some(Stream::Named),
    }
}

fn folder_of(name: &Path) -> &Path {
    name.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A new file beside `name`, under a short name that nobody else has: neither the length of `name` nor what a killed
/// process left matters. It goes when it is dropped.
fn temporary(path: &Path, name: &Path, existing: Option<&Metadata>) -> Result<NamedTempFile, OutputError> {
    let failed = |reason: &dyn std::fmt::Display| OutputError::write(path, reason);
    let folder = folder_of(name);
    if !folder.is_dir() {
        return Err(failed(&format!("there is no folder {}", folder.display())));
    }
    if name.file_name().is_none() {
        return Err(failed(&"it names no file"));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".irradia-").suffix(".part");
    #[cfg(unix)]
    let everybody = <fs::Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666);
    // As any new file: less what the user's mask takes away.
    #[cfg(unix)]
    builder.permissions(everybody);
    let file = builder.tempfile_in(folder).map_err(|error| failed(&reason(&error)))?;
    if let Some(existing) = existing {
        file.as_file().set_permissions(existing.permissions()).map_err(|error| failed(&error))?;
    }
    Ok(file)
}

/// What the system says, without the name of the temporary file, which says nothing to anybody.
fn reason(error: &io::Error) -> String {
    let inner = error.get_ref().and_then(std::error::Error::source);
    inner.map_or_else(|| error.to_string(), ToString::to_string)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// An empty folder for one test, removed with all that is in it.
    pub(crate) struct TestFolder(
        pub(crate) PathBuf,
        #[expect(dead_code, reason = "it is removed when dropped")] tempfile::TempDir,
    );

    impl TestFolder {
        pub(crate) fn new(name: &str) -> TestFolder {
            let folder = tempfile::Builder::new().prefix(name).tempdir().expect("the temporary folder is writable");
            TestFolder(folder.path().to_owned(), folder)
        }

        pub(crate) fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).expect("the test's own folder");
            let mut names: Vec<String> =
                entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
            names.sort();
            names
        }
    }

    #[test]
    fn a_file_appears_with_all_its_bytes() {
        let folder = TestFolder::new("target-success");
        let path = folder.0.join("a.txt");
        fs::write(&path, "old").expect("writable");
        let target = Target::open(&path).expect("writable");
        assert_eq!(fs::read(&path).expect("there"), b"old", "the old file stands until the new one is whole");
        assert_eq!(folder.names(), ["a.txt"], "a run that is killed while it works leaves nothing");
        target.write(b"new").expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"new");
        assert_eq!(folder.names(), ["a.txt"]);
    }

    #[test]
    fn what_is_staged_waits_or_goes() {
        let folder = TestFolder::new("target-staged");
        let path = folder.0.join("a.txt");
        fs::write(&path, "old").expect("writable");
        let target = Target::open(&path).expect("writable");
        drop(target.stage(b"dropped").expect("written"));
        assert_eq!((fs::read(&path).expect("there"), folder.names()), (b"old".to_vec(), vec!["a.txt".to_owned()]));
        let staged = target.stage(b"new").expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"old");
        staged.finish().expect("renamed");
        assert_eq!((fs::read(&path).expect("there"), folder.names()), (b"new".to_vec(), vec!["a.txt".to_owned()]));
    }

    #[test]
    fn targets_that_cannot_be_written_say_why() {
        let folder = TestFolder::new("target-faults");
        let fault = |path: &Path| Target::open(path).expect_err("it cannot be written").to_string();
        let missing = fault(&folder.0.join("no-such-folder/a.txt"));
        assert!(missing.contains("there is no folder"), "{missing}");
        assert!(fault(&folder.0).contains("it is a folder"));
        let long = fault(&folder.0.join("n".repeat(256)));
        assert!(long.contains("File name too long"), "{long}");
        let protected = folder.0.join("protected");
        fs::write(&protected, "old").expect("writable");
        let mut permissions = fs::metadata(&protected).expect("there").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&protected, permissions).expect("ours");
        assert!(fault(&protected).contains("write-protected"));
        Target::open(&folder.0.join("a.txt")).expect("writable");
        assert_eq!(folder.names(), ["protected"], "looking leaves nothing");
    }

    #[test]
    fn a_name_may_be_as_long_as_names_may_be() {
        let folder = TestFolder::new("target-long");
        let name = "n".repeat(255);
        Target::from(&folder.0.join(&name)).write(b"new").expect("written");
        assert_eq!(folder.names(), [name]);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_stay_and_are_the_users_where_there_are_none() {
        use std::os::unix::fs::PermissionsExt;
        let folder = TestFolder::new("target-permissions");
        let (kept, new, plain) = (folder.0.join("kept"), folder.0.join("new"), folder.0.join("plain"));
        let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o7777;
        fs::write(&kept, "old").expect("writable");
        fs::set_permissions(&kept, fs::Permissions::from_mode(0o624)).expect("ours");
        fs::write(&plain, "").expect("writable");
        for path in [&kept, &new] {
            Target::from(path).write(b"new").expect("written");
        }
        assert_eq!((mode(&kept), mode(&new)), (0o624, mode(&plain)));
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = TestFolder::new("target-link");
        let (file, link) = (folder.0.join("file"), folder.0.join("link"));
        std::os::unix::fs::symlink("file", &link).expect("links can be made");
        for content in [&b"new"[..], b"newer"] {
            // The first time the link leads to a file that is not there.
            Target::from(&link).write(content).expect("written");
            assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
            assert_eq!(fs::read(&file).expect("there"), content);
        }
        std::os::unix::fs::symlink("circle", folder.0.join("circle")).expect("links can be made");
        assert!(Target::open(&folder.0.join("circle")).is_err());
        Target::from(Path::new("/dev/null")).write(b"new").expect("written");
        assert!(!fs::metadata("/dev/null").expect("there").is_file());
        assert!(Target::from(Path::new("/dev/stdout")).is_stream());
    }

    #[test]
    #[cfg_attr(not(target_os = "linux"), ignore = "a device that is always full")]
    fn a_device_without_room_is_a_failure() {
        let message = Target::from(Path::new("/dev/full")).write(b"new").expect_err("it is full").to_string();
        assert!(message.contains("/dev/full"), "{message}");
    }
}
