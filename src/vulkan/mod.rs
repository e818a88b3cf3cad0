//! Vulkan, made safe enough for the rest of the crate: with `capi/` the only home of `unsafe`.
//!
//! What is created here frees itself, carries a name, and keeps its device alive. Lifetimes of use are the frame's:
//! one frame is in flight at a time, and nothing is freed or overwritten before its fence has been waited for
//! ([`Recorder::finish`] waits), which is the invariant that most `SAFETY` comments below lean on.

mod copy;
mod crash_markers;
mod descriptor_counts;
mod descriptors;
mod device;
mod draw;
mod error;
mod features;
#[cfg(feature = "capi")]
mod hand_out;
#[cfg(feature = "capi")]
mod host;
#[cfg(feature = "capi")]
mod host_features;
mod instance;
pub(crate) mod limits;
#[cfg(debug_assertions)]
mod live_shaders;
mod loader_lock;
mod marks;
mod memory;
mod messages;
mod pipelines;
pub(crate) mod program;
mod queries;
mod recorder;
mod report;
#[cfg(feature = "capi")]
mod shared_buffer;
mod storage_texels;
mod traits;
mod transfer;

pub use crash_markers::CrashMarkers;
pub(crate) use descriptors::{Descriptor, MaterialSets};
pub use device::ContextOptions;
pub(crate) use device::Device;
#[cfg(feature = "capi")]
pub(crate) use device::TakeTurns;
pub(crate) use draw::{Attachment, Attachments};
pub use error::VulkanError;
#[cfg(feature = "capi")]
pub(crate) use hand_out::{ForeignPlace, ForeignTarget, ForeignUse, HandOut, TimelinePoint};
#[cfg(feature = "capi")]
pub(crate) use host::{AnyFunction, HostDevice, HostInstance, Requirements};
pub use instance::Validation;
pub(crate) use memory::{Buffer, Image, ImageInfo, Location, SubresourceView, texel_bytes};
#[allow(unused_imports, reason = "passes of the methods to come; tests use it already")]
pub(crate) use pipelines::StencilState;
pub(crate) use pipelines::{
    DepthState, Pipeline, Pipelines, RasterState, SamplerKind, TargetFormats, VertexAttribute, VertexLayout,
    pipeline_stages,
};
pub(crate) use queries::Queries;
pub(crate) use recorder::{Barriers, ImageBarrier, Recorder, Scope};
pub use report::DeviceReport;
pub(crate) use report::{Survey, devices};
#[cfg(feature = "capi")]
pub(crate) use shared_buffer::SharedBuffer;
pub(crate) use storage_texels::TexelFormats;
pub(crate) use traits::DeviceTraits;
pub(crate) use transfer::{buffer_with, image_with, overwrite};
