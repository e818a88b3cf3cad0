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
    /// The time between two frames is no time.
    #[error("a frame {0} s after the one before cannot be made; give a time step of zero or more seconds")]
    TimeStep(f32),
    /// The camera cannot be looked through.
    #[error("no frame can be made through this camera: {0}")]
    Camera(String),
    /// An option is out of its range.
    #[error("{0}")]
    Settings(String),
    /// A frame shows what no light can be. That is a fault of the program or the driver, not of the scene.
    #[error(
        "{pixels} pixels of {what} are not finite or are negative; {}: report the scene and the settings, and do without that piece",
        pass.as_ref().map_or_else(|| "no pass is known that wrote such values first".to_owned(), |pass| format!("the first pass that wrote such values is {pass}"))
    )]
    NotFinite {
        /// `image`, or the slot.
        what: String,
        /// How many pixels.
        pixels: u32,
        /// The first pass that wrote such values, when the frame was made again with a check after each.
        pass: Option<String>,
    },
    /// Photons of references do not know which lobes scattered them.
    #[error("the estimator sppm shows caustics of all paths; those of specular paths alone take the estimator path")]
    SppmCaustics,
}
