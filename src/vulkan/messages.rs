//! What the validation layer says, and what of it is a finding.
//!
//! Messages are told apart by their identifiers where they have one of their own: texts change from version to version.

#![allow(unsafe_code, reason = "a callback of the validation layer")]

use std::ffi::{CStr, c_char, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

/// Messages of the validation layer, warnings and worse.
pub(super) type Messages = Arc<Mutex<Vec<String>>>;

/// Identifiers, or the beginnings of identifiers, of messages that are no findings.
const NO_FINDINGS: [&str; 2] = [
    // An output without an attachment is discarded (KhronosGroup/Vulkan-Docs#2125), and its write mask is 0 here besides;
    // layers since 1.3.290 say that it is not consumed.
    "Undefined-Value-ShaderOutputNotConsumed",
    // GPU-assisted validation announces which features and limits it changes, since 1.3.280.
    "WARNING-Setting",
];

/// Parts of announcements of older layers, whose identifiers also stand for findings.
const ANNOUNCEMENTS: [&str; 4] = [
    "reserved a descriptor",
    "Forcing vertexPipelineStoresAndAtomics",
    "Forcing fragmentStoresAndAtomics",
    "Forcing shaderInt64",
];

fn is_finding(identifier: &str, text: &str) -> bool {
    let named = NO_FINDINGS.iter().any(|begin| identifier.starts_with(begin));
    let announced = ANNOUNCEMENTS.iter().any(|part| text.contains(part));
    // What layers before 1.3.290 say of an output without an attachment: they compare its type with that of the absent
    // attachment. Of an attachment that is there it is a finding.
    let absent_attachment =
        identifier.ends_with("Shader-InterfaceTypeMismatch") && text.contains("VK_FORMAT_UNDEFINED");
    !(named || announced || absent_attachment)
}

/// SAFETY: called by the validation layer with valid data, and with a pointer to the mutex inside `Messages`, which lives
/// as long as the messenger.
pub(super) unsafe extern "system" fn on_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the caller's.
    let messages = unsafe { &*user.cast::<Mutex<Vec<String>>>() };
    // SAFETY: the layer passes valid data or null.
    let Some(data) = (unsafe { data.as_ref() }) else { return vk::FALSE };
    // SAFETY: both are strings that end in zero, or null.
    let (identifier, text) = unsafe { (string(data.p_message_id_name), string(data.p_message)) };
    if is_finding(&identifier, &text) {
        // Older layers repeat the identifier in the text.
        let message = if text.contains(&identifier) { text } else { format!("{identifier}: {text}") };
        tracing::warn!("validation: {message}");
        messages.lock().unwrap_or_else(PoisonError::into_inner).push(message);
    }
    vk::FALSE
}

/// SAFETY: a string that ends in zero, or null.
unsafe fn string(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: the caller's.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_are_told_from_announcements_by_every_version_of_the_layer() {
        let old = "Validation Warning: [ UNASSIGNED-CoreValidation-Shader-InterfaceTypeMismatch ] Attachment 1 of type \
                   `VK_FORMAT_UNDEFINED` does not match fragment shader output type of `float4`.";
        let absent = [
            ("UNASSIGNED-CoreValidation-Shader-InterfaceTypeMismatch", old),
            (
                "Undefined-Value-ShaderOutputNotConsumed-DynamicRendering",
                "vkCmdDraw(): it writes to output Location 1.",
            ),
            ("Undefined-Value-ShaderOutputNotConsumed", "it writes to output Location 1."),
        ];
        for (identifier, text) in absent {
            assert!(!is_finding(identifier, text), "{identifier}");
        }
        let present = old.replace("VK_FORMAT_UNDEFINED", "VK_FORMAT_R8G8B8A8_UINT");
        assert!(is_finding("UNASSIGNED-CoreValidation-Shader-InterfaceTypeMismatch", &present));
        assert!(is_finding("Undefined-Value-ShaderInputNotProduced", "input Location 1 is not written."));
        assert!(is_finding("VUID-vkCmdDraw-None-02699", "a descriptor was never updated."));
    }
}
