//! What a call returns, and the sentence that goes with it.

use std::cell::RefCell;
use std::ffi::{CString, c_char};

use crate::method::Error;
use crate::renderer::SettingsError;
use crate::scene::SceneError;
use crate::vulkan::VulkanError;

/// What every call that can fail returns: IRRADIA_OK, or one of IRRADIA_ERROR_…; irradia_last_error() has the sentence.
pub type Status = u32;

/// Done.
pub const IRRADIA_OK: Status = 0;
/// An argument cannot be what it is: null, out of range, not finite, a descriptor without its size. Nothing changed.
pub const IRRADIA_ERROR_ARGUMENT: Status = 1;
/// A scene, its file or something in it is at fault. Nothing changed.
pub const IRRADIA_ERROR_SCENE: Status = 2;
/// There is no such setting, or it does not take this value. The old settings stand.
pub const IRRADIA_ERROR_SETTINGS: Status = 3;
/// No Vulkan loader, no device, or not one that can do what is asked.
pub const IRRADIA_ERROR_DEVICE: Status = 4;
/// The device has no memory left for this.
pub const IRRADIA_ERROR_MEMORY: Status = 5;
/// The device was lost. Destroy the renderers and the context; nothing else works on them any more.
pub const IRRADIA_ERROR_DEVICE_LOST: Status = 6;
/// The program was built for a newer library and asks for what this one does not know.
pub const IRRADIA_ERROR_VERSION: Status = 7;
/// Another thread uses this handle now.
pub const IRRADIA_ERROR_BUSY: Status = 8;
/// irradia_renderer_cancel() stopped it. The renderer can go on.
pub const IRRADIA_ERROR_CANCELLED: Status = 9;
/// A fault of the library's own. After one that the sentence calls a failure of the library the handles of the call refuse to be used; destroy them.
pub const IRRADIA_ERROR_INTERNAL: Status = 10;

/// Why a call could not do what it was asked to.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(super) status: Status,
    pub(super) sentence: String,
}

impl Fault {
    pub(super) fn argument(sentence: impl Into<String>) -> Fault {
        Fault { status: IRRADIA_ERROR_ARGUMENT, sentence: sentence.into() }
    }
}

impl From<SceneError> for Fault {
    fn from(error: SceneError) -> Fault {
        Fault { status: IRRADIA_ERROR_SCENE, sentence: error.to_string() }
    }
}

impl From<SettingsError> for Fault {
    fn from(error: SettingsError) -> Fault {
        Fault { status: IRRADIA_ERROR_SETTINGS, sentence: error.to_string() }
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Fault {
        let status = match &error {
            Error::Vulkan(VulkanError::OutOfMemory { .. }) => IRRADIA_ERROR_MEMORY,
            Error::Vulkan(VulkanError::DeviceLost { .. }) => IRRADIA_ERROR_DEVICE_LOST,
            Error::Vulkan(VulkanError::TooLarge { .. })
            | Error::EmptyFrame(..)
            | Error::TimeStep(_)
            | Error::Camera(_) => IRRADIA_ERROR_ARGUMENT,
            Error::Vulkan(VulkanError::Cancelled) => IRRADIA_ERROR_CANCELLED,
            Error::Vulkan(_) => IRRADIA_ERROR_DEVICE,
            Error::Settings(_) | Error::SppmCaustics => IRRADIA_ERROR_SETTINGS,
            Error::NotFinite { .. } => IRRADIA_ERROR_INTERNAL,
        };
        Fault { status, sentence: error.to_string() }
    }
}

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// What irradia_last_error() says in this thread from now on.
pub(super) fn remember(sentence: &str) {
    let text = CString::new(sentence.replace('\0', " ")).unwrap_or_default();
    // A thread that is ending remembers nothing.
    let _ = LAST.try_with(|last| *last.borrow_mut() = text);
}

/// One sentence on the last call of this thread that did not return IRRADIA_OK: what, where, what to do. Empty if there was none. UTF-8.
///
/// The text stands until the next call of this thread fails; copy what must last longer. From any thread, each has its own.
#[unsafe(no_mangle)]
pub extern "C" fn irradia_last_error() -> *const c_char {
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}
