//! What can go wrong with Vulkan, each as one sentence that says what to do.

use ash::vk;

/// A failure of the Vulkan loader, driver or device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VulkanError {
    /// The loader library is absent.
    #[error(
        "no Vulkan loader was found ({0}); install it (Debian, Ubuntu: apt install libvulkan1 mesa-vulkan-drivers)"
    )]
    NoLoader(String),
    /// The loader is older than Vulkan 1.3.
    #[error("the Vulkan loader offers version {0}; irradia needs 1.3: install a newer libvulkan1")]
    OldLoader(String),
    /// The loader found no device at all.
    #[error(
        "no Vulkan device was found; install a driver (Debian, Ubuntu: apt install mesa-vulkan-drivers, which also renders without a GPU)"
    )]
    NoDevice,
    /// No device matches `--device`.
    #[error("no Vulkan device matches {asked:?}; devices: {known}")]
    NoSuchDevice {
        /// What was asked for.
        asked: String,
        /// The devices there are.
        known: String,
    },
    /// The chosen device, or every device, lacks something.
    #[error("{device} cannot be used: {reason}; choose another with --device (irradia devices lists them)")]
    Unfit {
        /// The device's name.
        device: String,
        /// What it lacks, and what needs it.
        reason: String,
    },
    /// The device lacks what a method needs.
    #[error(
        "{piece} cannot run on {device}: {what}; choose another method, or another device with --device (irradia devices lists what each lacks)"
    )]
    Lacks {
        /// The device's name.
        device: String,
        /// The method, or what every frame has.
        piece: String,
        /// Which of its programs needs what.
        what: String,
    },
    /// Validation was asked for, but its layer is absent.
    #[error(
        "validation was asked for, but the layer VK_LAYER_KHRONOS_validation is absent; install it (Debian, Ubuntu: apt install vulkan-validationlayers)"
    )]
    NoValidationLayer,
    /// The device stopped answering.
    #[error(
        "the device was lost; the last pass that finished is {last_pass}: reduce the work of the one after it, or update the driver"
    )]
    DeviceLost {
        /// The last pass known to have finished.
        last_pass: String,
    },
    /// The device has no memory left.
    #[error(
        "the device has no memory left for {what} ({mib:.1} MiB); last pass that finished: {last_pass}; reduce the frame's size or the piece's settings"
    )]
    OutOfMemory {
        /// The allocation that failed.
        what: String,
        /// Its size.
        mib: f64,
        /// The last pass known to have finished.
        last_pass: String,
    },
    /// A resource is larger than the device allows.
    #[error(
        "{what} is larger than the device allows: {asked}, the limit is {limit}; reduce the frame's size or the piece's settings"
    )]
    TooLarge {
        /// The resource.
        what: String,
        /// What was asked for.
        asked: String,
        /// What the device allows.
        limit: String,
    },
    /// A frame is declared so that it cannot be meant: a fault of the program.
    #[error("the frame is declared wrongly: {0}; that is a fault of the program, report it")]
    Declaration(String),
    /// A shader of the folder that `IRRADIA_SHADERS` names, in a debug build, cannot be used.
    #[error("{0}")]
    Shader(String),
    /// A host's device cannot be used.
    #[error("the device that was handed over cannot be used: {0}")]
    Host(String),
    /// Somebody who watches the frame stopped it.
    #[error("the frame was cancelled")]
    Cancelled,
    /// Any other failed call.
    #[error("the Vulkan call {call} failed: {result}")]
    Call {
        /// The call, and what it was for.
        call: String,
        /// The driver's answer, by its name in Vulkan.
        result: String,
    },
}

/// Names the call in a failure of it.
pub(crate) trait Called<T> {
    fn called(self, call: &str) -> Result<T, VulkanError>;
}

impl<T> Called<T> for Result<T, vk::Result> {
    fn called(self, call: &str) -> Result<T, VulkanError> {
        self.map_err(|result| match result {
            vk::Result::ERROR_DEVICE_LOST => VulkanError::DeviceLost { last_pass: NO_PASS.to_owned() },
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY | vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
                VulkanError::OutOfMemory { what: call.to_owned(), mib: 0.0, last_pass: NO_PASS.to_owned() }
            }
            result => VulkanError::Call { call: call.to_owned(), result: result.to_string() },
        })
    }
}

const NO_PASS: &str = "none of this frame";
const UNMARKED: &str = "not known, for passes left no marks (--crash-markers has them do so, in the library ContextOptions::crash_markers)";

impl VulkanError {
    /// The same error where no pass left a mark.
    pub(crate) fn after_unmarked_passes(self) -> VulkanError {
        self.after_pass(Some(UNMARKED))
    }

    /// The same error, naming the last pass that finished where that matters.
    pub(crate) fn after_pass(self, pass: Option<&str>) -> VulkanError {
        let Some(pass) = pass else { return self };
        match self {
            VulkanError::DeviceLost { .. } => VulkanError::DeviceLost { last_pass: pass.to_owned() },
            VulkanError::OutOfMemory { what, mib, .. } => {
                VulkanError::OutOfMemory { what, mib, last_pass: pass.to_owned() }
            }
            other => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_device_names_the_last_finished_pass() {
        let lost: Result<(), _> = Err(vk::Result::ERROR_DEVICE_LOST);
        let error = lost.called("vkQueueSubmit2").expect_err("it is an error").after_pass(Some("rsm/gather"));
        assert!(error.to_string().contains("last pass that finished is rsm/gather"), "{error}");
        let lost: Result<(), _> = Err(vk::Result::ERROR_DEVICE_LOST);
        let error = lost.called("vkQueueSubmit2").expect_err("it is an error").after_unmarked_passes();
        assert!(error.to_string().contains("--crash-markers"), "{error}");
        let memory: Result<(), _> = Err(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
        let error = memory.called("light_views.flux").expect_err("it is an error").after_pass(Some("gbuffer/plain"));
        assert!(
            error.to_string().contains("light_views.flux") && error.to_string().contains("gbuffer/plain"),
            "{error}"
        );
    }
}
