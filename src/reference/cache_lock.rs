//! One process, and one thread of it, changes a cache at a time.

use std::fs::{File, OpenOptions};
use std::path::Path;

use fs4::FileExt;

/// The file that is locked. It stays: removed, it could be locked by one process while another makes it anew.
const NAME: &str = ".lock";

/// The right to change a folder, until it is dropped or the process ends, however it does.
pub(super) struct CacheLock {
    /// Closing it unlocks it; `None` on a file system without locks.
    _file: Option<File>,
}

impl CacheLock {
    /// Waits until nobody else holds it. Who holds it writes one file at the most.
    pub(super) fn take(folder: &Path) -> CacheLock {
        let path = folder.join(NAME);
        let opened = OpenOptions::new().write(true).create(true).truncate(false).open(&path);
        let locked = opened.and_then(|file| FileExt::lock(&file).map(|()| file));
        if let Err(error) = &locked {
            tracing::warn!("{} cannot be locked ({error}): no other process should write there now", path.display());
        }
        CacheLock { _file: locked.ok() }
    }
}
