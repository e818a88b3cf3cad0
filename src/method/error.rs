//! Why a frame could not be made.

use crate::vulkan::VulkanError;

/// A failure to make a frame.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The loader, the driver or the device failed.
    #[error(transparent)]
    Vulkan(#[from] VulkanError),
    /// The frame has no pixels.
    #[error("a frame of {0}x{1} pixels cannot be made; ask for at least 1x1")]
    EmptyFrame(u32, u32),
    /// An option is out of its range.
    #[error("{0}")]
    Settings(String),
    /// Photons of references do not know which lobes scattered them.
    #[error("the estimator sppm shows caustics of all paths; those of specular paths alone take the estimator path")]
    SppmCaustics,
}
