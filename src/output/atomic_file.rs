//! Files that appear whole or not at all: written beside their target under a unique name, then renamed onto it.
//!
//! A reader never sees half a file, and a failed run leaves the old one untouched. The data is not forced to the disk:
//! this guards against failures of the program, not of the power supply.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use super::OutputError;

/// A file being written. [`commit`](AtomicFile::commit) makes it appear; dropped before, it leaves nothing.
#[derive(Debug)]
pub struct AtomicFile {
    writer: BufWriter<File>,
    target: PathBuf,
    /// Where the bytes lie until they are complete; `None` once renamed, and for a target that is no regular file.
    temporary: Option<PathBuf>,
}

impl AtomicFile {
    /// Starts to write what will be `path`. A symbolic link stays one: the file that it points to is replaced. What
    /// cannot be replaced, such as `/dev/stdout` or a named pipe, is written in place.
    ///
    /// # Errors
    /// The folder does not exist or cannot be written, or `path` is a folder.
    pub fn create(path: &Path) -> Result<AtomicFile, OutputError> {
        let failed = |reason: &dyn std::fmt::Display| OutputError::write(path, reason);
        let mut target = path.to_owned();
        if let Ok(existing) = fs::metadata(path) {
            if existing.is_dir() {
                return Err(failed(&"it is a folder"));
            }
            if !existing.is_file() {
                let file = OpenOptions::new().write(true).open(path).map_err(|error| failed(&error))?;
                return Ok(AtomicFile { writer: BufWriter::new(file), target, temporary: None });
            }
            target = fs::canonicalize(path).map_err(|error| failed(&error))?;
        }
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            return Err(failed(&format!("there is no folder {}", folder.display())));
        }
        let name = target.file_name().ok_or_else(|| failed(&"it names no file"))?;
        let temporary = folder.join(unique_name(name));
        let file = OpenOptions::new().write(true).create_new(true).open(&temporary).map_err(|error| failed(&error))?;
        Ok(AtomicFile { writer: BufWriter::new(file), target, temporary: Some(temporary) })
    }

    /// Makes the file appear under its name.
    ///
    /// # Errors
    /// The last bytes cannot be written or the file cannot be renamed; then nothing is left of it.
    pub fn commit(mut self) -> Result<(), OutputError> {
        self.writer.flush().map_err(|error| OutputError::write(&self.target, error))?;
        if let Some(temporary) = &self.temporary {
            fs::rename(temporary, &self.target).map_err(|error| OutputError::write(&self.target, error))?;
            self.temporary = None;
        }
        Ok(())
    }

    /// Writes all of `path` with `write`: it appears if that succeeds.
    ///
    /// # Errors
    /// Those of [`create`](AtomicFile::create), of `write` and of [`commit`](AtomicFile::commit).
    pub fn write_whole<E: std::fmt::Display>(
        path: &Path,
        write: impl FnOnce(&mut AtomicFile) -> Result<(), E>,
    ) -> Result<(), OutputError> {
        let mut file = AtomicFile::create(path)?;
        write(&mut file).map_err(|error| OutputError::write(path, error))?;
        file.commit()
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            // Nobody is left to tell; the error that led here is the one that counts.
            let _ = fs::remove_file(temporary);
        }
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl Seek for AtomicFile {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.writer.seek(position)
    }
}

/// Whether `path` could be written, found out before the work whose result goes there.
///
/// # Errors
/// Those of [`AtomicFile::create`].
pub fn check_target(path: &Path) -> Result<(), OutputError> {
    AtomicFile::create(path).map(drop)
}

/// `.NAME.PROCESS-COUNT.part`: unique among the threads of this process and the processes of this machine.
fn unique_name(name: &std::ffi::OsStr) -> OsString {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let mut unique = OsString::from(".");
    unique.push(name);
    unique.push(format!(".{}-{}.part", process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    unique
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// An empty folder for one test, removed with all that is in it.
    pub(crate) struct TestFolder(pub(crate) PathBuf);

    impl TestFolder {
        pub(crate) fn new(name: &str) -> TestFolder {
            let path = std::env::temp_dir().join(unique_name(std::ffi::OsStr::new(name)));
            fs::create_dir(&path).expect("the temporary folder is writable");
            TestFolder(path)
        }

        pub(crate) fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).expect("the test's own folder");
            let mut names: Vec<String> =
                entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
            names.sort();
            names
        }
    }

    impl Drop for TestFolder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_file_appears_with_all_its_bytes() {
        let folder = TestFolder::new("atomic-success");
        let path = folder.0.join("a.txt");
        fs::write(&path, "old").expect("writable");
        let mut file = AtomicFile::create(&path).expect("writable");
        file.write_all(b"new").expect("writable");
        assert_eq!(fs::read(&path).expect("there"), b"old", "the old file stands until the new one is whole");
        file.commit().expect("renamed");
        assert_eq!(fs::read(&path).expect("there"), b"new");
        assert_eq!(folder.names(), ["a.txt"]);
    }

    #[test]
    fn a_failure_leaves_nothing() {
        let folder = TestFolder::new("atomic-failure");
        let path = folder.0.join("a.txt");
        let failed = AtomicFile::write_whole(&path, |file| {
            file.write_all(b"half").expect("writable");
            Err("no more")
        });
        let message = failed.expect_err("the closure failed").to_string();
        assert!(message.contains("a.txt") && message.ends_with("no more"), "{message}");
        assert!(folder.names().is_empty());
    }

    #[test]
    fn targets_that_cannot_be_written_say_why() {
        let folder = TestFolder::new("atomic-targets");
        let missing = check_target(&folder.0.join("no-such-folder/a.txt")).expect_err("no folder").to_string();
        assert!(missing.contains("there is no folder"), "{missing}");
        let directory = check_target(&folder.0).expect_err("a folder").to_string();
        assert!(directory.contains("it is a folder"), "{directory}");
        check_target(&folder.0.join("a.txt")).expect("writable");
        assert!(folder.names().is_empty(), "checking leaves nothing");
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = TestFolder::new("atomic-link");
        let (file, link) = (folder.0.join("file"), folder.0.join("link"));
        fs::write(&file, "old").expect("writable");
        std::os::unix::fs::symlink(&file, &link).expect("links can be made");
        AtomicFile::write_whole(&link, |out| out.write_all(b"new")).expect("written");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::read(&file).expect("there"), b"new");
        AtomicFile::write_whole(Path::new("/dev/null"), |out| out.write_all(b"new")).expect("written");
        assert!(!fs::metadata("/dev/null").expect("there").is_file());
    }
}
