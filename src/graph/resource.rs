//! Images and buffers of a frame, as it declares them.

use std::sync::Arc;

use ash::vk;

use super::dependence::Dependence;
use crate::vulkan::{Buffer, Image, ImageInfo};

/// What stands behind a name of the frame.
pub(super) enum Body {
    Image(ImageInfo),
    Buffer {
        bytes: u64,
    },
    /// Written by the host before the frame.
    Upload(Arc<[u8]>),
    /// Owned by the scene: only read, and in its final layout.
    ExternalBuffer(Arc<Buffer>),
    ExternalImage(Arc<Image>),
}

/// An image or a buffer of the frame.
pub(super) struct Resource {
    pub(super) name: String,
    pub(super) body: Body,
    /// Key and dependence of the present content, for each mip level (one for a buffer).
    pub(super) content: Vec<(u64, Dependence)>,
    pub(super) image_usage: vk::ImageUsageFlags,
    pub(super) buffer_usage: vk::BufferUsageFlags,
    /// The piece that first writes it.
    pub(super) piece: Option<String>,
}

/// What a pass left in a place that it says it writes whole.
pub(super) struct Left {
    pub(super) what: String,
    pub(super) buffer: Buffer,
}

/// A frame's places filled with a pattern before each pass that writes them whole.
pub(super) struct Proof {
    pub(super) pattern: u32,
    pub(super) left: Vec<Left>,
}

/// Something that is kept over frames, as a frame declares it (super::kept).
pub(super) struct KeptUse {
    pub(super) name: String,
    /// What passes write of it.
    pub(super) resource: usize,
    /// Of a history, the names of its two copies.
    pub(super) swap: Option<[String; 2]>,
    pub(super) depends: u64,
    pub(super) age: u32,
}

/// The number of a read-back, among all that a frame asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ReadBack(pub(super) usize);
