//! What frames and their passes cost.

use std::collections::BTreeMap;

use serde::Serialize;

use super::piece::{joined, lies_in};

/// How the frame is timed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Timing {
    /// One pair of timestamps around the frame; passes overlap as the driver likes.
    #[default]
    Frame,
    /// Every pass alone, between full barriers, each with its own pair; and the frame as a whole.
    Passes,
}

/// One pass of the frame: its cost, or why it did not run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassTiming {
    /// The piece that the pass belongs to, such as `light-views` or `caustics/photons`.
    pub piece: String,
    /// The pass within its piece, in levels, such as `lists/clear`; empty for a piece that is skipped as a whole.
    pub pass: String,
    /// GPU time in milliseconds; `None` if it was skipped or passes were not timed.
    pub ms: Option<f64>,
    /// Why the pass did not run; `None` if it did.
    pub skipped: Option<String>,
    /// What the pass did: invocations, triangles, VPLs …
    pub work: BTreeMap<String, u64>,
}

impl PassTiming {
    /// The name that the pass goes by in labels and messages: its piece's and its own.
    pub fn full_name(&self) -> String {
        joined(&self.piece, &self.pass)
    }

    /// Whether the pass is part of `piece`: a piece, a level of one, or a pass by its full name.
    pub fn lies_in(&self, piece: &str) -> bool {
        lies_in(&self.full_name(), piece)
    }
}

/// What the frame cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameTimings {
    /// How the frame was timed.
    pub timing: Timing,
    /// GPU time from the start to the end of the frame, milliseconds, by its own pair of timestamps.
    pub gpu_ms: f64,
    /// Host time from the call to the finished frame, milliseconds, read-back included.
    pub host_ms: f64,
    /// Of the host time: bringing what changed of the scene onto the device, milliseconds.
    pub upload_ms: f64,
    /// Bytes that this took: vertices, instances, materials, textures, as rasterisers read them. What rays meet is not counted.
    pub upload_bytes: u64,
    /// Time spent creating pipelines in this frame, milliseconds; zero once they exist.
    pub pipeline_ms: f64,
    /// All passes in the order of their declaration, the skipped ones included.
    pub passes: Vec<PassTiming>,
    /// Bytes of device memory that each piece's images and buffers hold, by piece; `scene` is the scene itself.
    pub memory_bytes: BTreeMap<String, u64>,
    /// The same, each piece's by its images and buffers; without what estimates hold and the scene.
    pub memory_parts: BTreeMap<String, BTreeMap<String, u64>>,
}

impl FrameTimings {
    /// Adds what another part of the same frame cost.
    pub(crate) fn add(&mut self, other: FrameTimings) {
        self.gpu_ms += other.gpu_ms;
        self.upload_ms += other.upload_ms;
        self.upload_bytes += other.upload_bytes;
        self.pipeline_ms += other.pipeline_ms;
        self.passes.extend(other.passes);
        for (piece, bytes) in other.memory_bytes {
            *self.memory_bytes.entry(piece).or_insert(0) += bytes;
        }
        for (piece, parts) in other.memory_parts {
            let held = self.memory_parts.entry(piece).or_default();
            for (name, bytes) in parts {
                *held.entry(name).or_insert(0) += bytes;
            }
        }
    }
}
