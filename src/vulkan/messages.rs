//! What the validation layer says, and what of it is a finding.
//!
//! Messages are told apart by their identifiers where they have one of their own: texts change from version to version.

#![allow(unsafe_code, reason = "a callback of the validation layer")]

use std::ffi::{CStr, c_char, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

/// Messages of the validation layer, warnings and worse.
pub(super) type Messages = Arc<Mutex<Vec<String>>>;

/// What is no finding: the beginning of a message's identifier, and a part of its text where the identifier also stands for
/// findings.
const NO_FINDINGS: [(&str, &str); 12] = [
    // An output without an attachment is discarded (KhronosGroup/Vulkan-Docs#2125), and its write mask is 0 here besides.
    // Newer layers say that it is not consumed, older ones compare its type with that of the absent attachment.
    ("Undefined-Value-ShaderOutputNotConsumed", ""),
    ("UNASSIGNED-CoreValidation-Shader-InterfaceTypeMismatch", "VK_FORMAT_UNDEFINED"),
    // A stream without a stride holds one vertex for all indices. GPU-assisted validation takes its bytes for its vertices.
    ("VUID-vkCmdDraw", "Binding stride: 0 bytes"),
    // GPU-assisted validation announces what it reserves, which features and limits it changes, and that it is slow.
    ("WARNING-Setting", ""),
    ("WARNING-GPU-Assisted-Validation", "Internal Warning: Forcing"),
    ("WARNING-GPU-Assisted-Validation", "Internal Warning: Setting"),
    // No shader here has ray queries.
    ("WARNING-GPU-Assisted-Validation", "Disabling gpuav_validate_ray_query"),
    ("VALIDATION-SETTINGS", "Both GPU Assisted Validation and Normal Core Check Validation are enabled"),
    ("UNASSIGNED-", "reserved a descriptor"),
    ("UNASSIGNED-", "Forcing vertexPipelineStoresAndAtomics"),
    ("UNASSIGNED-", "Forcing fragmentStoresAndAtomics"),
    ("UNASSIGNED-", "Forcing shaderInt64"),
];

fn is_finding(identifier: &str, text: &str) -> bool {
    !NO_FINDINGS.iter().any(|(begin, part)| identifier.starts_with(begin) && text.contains(part))
}

/// What the messenger is made of. Given with an instance too it hears what is said while that is made.
pub(super) fn messenger(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'_> {
    use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
    use vk::DebugUtilsMessageTypeFlagsEXT as Kind;
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Kind::GENERAL | Kind::VALIDATION | Kind::PERFORMANCE)
        .pfn_user_callback(Some(on_message))
        .user_data(Arc::as_ptr(messages).cast_mut().cast())
}

/// SAFETY: called by the validation layer with valid data, and with a pointer to the mutex inside `Messages`, which lives
/// as long as the messenger.
unsafe extern "system" fn on_message(
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
        let vertices = "Vertex index 10 is not within the smallest bound vertex buffer.\n- Binding stride: ";
        for (identifier, text) in [
            (
                "WARNING-GPU-Assisted-Validation",
                "vkCreateDevice(): Internal Warning: Forcing timelineSemaphore to VK_TRUE",
            ),
            ("VUID-vkCmdDrawIndexed-None-02721", &format!("{vertices}0 bytes")),
        ] {
            assert!(!is_finding(identifier, text), "{identifier}");
        }
        assert!(is_finding("VUID-vkCmdDrawIndexed-None-02721", &format!("{vertices}8 bytes")));
        assert!(is_finding("WARNING-GPU-Assisted-Validation", "Internal Warning: nothing will be checked"));
        let present = old.replace("VK_FORMAT_UNDEFINED", "VK_FORMAT_R8G8B8A8_UINT");
        assert!(is_finding("UNASSIGNED-CoreValidation-Shader-InterfaceTypeMismatch", &present));
        assert!(is_finding("Undefined-Value-ShaderInputNotProduced", "input Location 1 is not written."));
        assert!(is_finding("VUID-vkCmdDraw-None-02699", "a descriptor was never updated."));
    }
}
