//! C strings in and out.

use std::ffi::{CStr, CString, c_char};

use super::status::Fault;

/// A text of the host's.
///
/// # Safety
/// `text` is null or ends in a zero.
pub(super) unsafe fn text<'a>(text: *const c_char, what: &str) -> Result<&'a str, Fault> {
    // SAFETY: the caller's.
    let found = unsafe { optional_text(text, what) }?;
    found.ok_or_else(|| Fault::argument(format!("{what} is a null pointer")))
}

/// The same, or nothing where the pointer is null.
///
/// # Safety
/// As [`text`].
pub(super) unsafe fn optional_text<'a>(text: *const c_char, what: &str) -> Result<Option<&'a str>, Fault> {
    if text.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's.
    let bytes = unsafe { CStr::from_ptr(text) };
    bytes.to_str().map(Some).map_err(|_| Fault::argument(format!("{what} is not UTF-8")))
}

/// A text for the host.
pub(super) fn owned(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// Copies a text, its zero included, into the host's buffer if it fits, and says how many bytes it takes in any case.
///
/// # Safety
/// `buffer` is null or has `capacity` bytes; `needed` is null or may be written to.
pub(super) unsafe fn copy(text: &str, buffer: *mut c_char, capacity: usize, needed: *mut usize) -> Result<(), Fault> {
    let text = owned(text);
    let bytes = text.as_bytes_with_nul();
    if buffer.is_null() && needed.is_null() {
        return Err(Fault::argument("there is neither a buffer for the text nor a place for its length"));
    }
    if !needed.is_null() {
        // SAFETY: the caller's.
        unsafe { needed.write(bytes.len()) };
    }
    if buffer.is_null() {
        return Ok(());
    }
    if capacity < bytes.len() {
        let (has, takes) = (capacity, bytes.len());
        return Err(Fault::argument(format!("the text takes {takes} bytes and its buffer has {has}")));
    }
    // SAFETY: the caller's.
    unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), buffer.cast::<u8>(), bytes.len()) };
    Ok(())
}
