//! The truth: images by unbiased light transport, split into slots by their definition, with an honest estimate of their noise.
//!
//! A reference is made of samples of two independent halves, A and B, which differ in the scrambling of their sample sequences. The
//! image is the mean over all samples; half the difference of the halves' means has the variance of that mean, which is the
//! noise that reports state.
//!
//! ```text
//! source ──▶ blocks ──▶ file ──▶ cache, shards
//! (samples)  (exact      └────▶ result (images, noise)
//!             sums)
//! ```

mod about;
mod auto;
mod blocks;
mod cache;
mod cache_lock;
mod error;
mod file;
mod key;
mod merge;
mod obtain;
mod request;
mod result;
mod shard;
#[cfg(test)]
mod tests;

pub use self::blocks::{CHUNK_SAMPLES, MAX_SPP};
pub use self::cache::{Cache, Entry, EntryContent};
pub use self::error::ReferenceError;
pub use self::file::ReferenceFile;
pub use self::key::{REFERENCE_VERSION, ReferenceKey, estimator_name};
pub use self::merge::merge;
pub use self::obtain::{Goal, Job, Progress, obtain};
pub use self::request::{Estimator, ReferenceRequest};
pub use self::result::Reference;
pub use self::shard::Shard;
pub use crate::estimator::{Noise, SampleSource, SlotSums};
pub use crate::slot::{CausticPaths, IMAGE, PixelFilter};
