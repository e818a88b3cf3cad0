//! Calls into the Vulkan loader that must not meet.
//!
//! The loader keeps one list of instances, drivers and devices for the process. Making and destroying them and
//! enumerating devices change it, under a lock of the loader's own; since 1.4.309 enumerating also unloads drivers that
//! have no device. But two of its functions walk that list without the lock, to find the driver of a device: the one that
//! names objects and the one that looks up a device's functions. A walk that meets a change reads freed memory, as one in
//! four runs of many threads does there. So whoever changes the list holds this lock alone, and whoever walks it shares it.

use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

static LISTS: RwLock<()> = RwLock::new(());

/// Held while instances and devices are made, enumerated or destroyed.
pub(super) fn changing() -> RwLockWriteGuard<'static, ()> {
    LISTS.write().unwrap_or_else(PoisonError::into_inner)
}

/// Held while the loader looks for the driver of a device.
pub(super) fn walking() -> RwLockReadGuard<'static, ()> {
    LISTS.read().unwrap_or_else(PoisonError::into_inner)
}
