//! What tracing paths costs, over all of its submissions.

use std::collections::BTreeMap;

use crate::graph::{Executed, PassTiming, ReadBack, Store};

/// What a run of samples cost.
#[derive(Clone, Debug, Default)]
pub(crate) struct TraceCost {
    /// GPU time, milliseconds.
    pub(crate) gpu_ms: f64,
    /// Time spent creating pipelines, milliseconds.
    pub(crate) pipeline_ms: f64,
    /// Rays cast: from the camera, between vertices, to lights.
    pub(crate) rays: u64,
    /// The passes, those of the same name together.
    pub(crate) passes: Vec<PassTiming>,
    /// The most that each piece held between submissions, bytes.
    pub(crate) memory_bytes: BTreeMap<String, u64>,
}

impl TraceCost {
    /// Notes a piece that the scene does not need.
    pub(super) fn skip(&mut self, piece: &str, pass: &str, reason: &str) {
        if self.passes.iter().all(|row| row.piece != piece) {
            let (piece, pass, skipped) = (piece.to_owned(), pass.to_owned(), Some(reason.to_owned()));
            self.passes.push(PassTiming { piece, pass, ms: None, skipped, work: BTreeMap::new() });
        }
    }

    /// Adds a submission that advanced a wave. Returns how many of its paths go on.
    pub(super) fn add_step(&mut self, mut executed: Executed, totals: ReadBack) -> u32 {
        let totals: Vec<u32> = bytemuck::pod_collect_to_vec(&executed.take(totals));
        self.rays += u64::from(totals[0]);
        self.add(executed);
        totals[1]
    }

    /// Notes what is held between two submissions.
    pub(super) fn note_memory(&mut self, store: &Store) {
        for (piece, bytes) in store.memory_by_piece() {
            let held = self.memory_bytes.entry(piece).or_insert(0);
            *held = bytes.max(*held);
        }
    }

    pub(super) fn add(&mut self, executed: Executed) {
        self.gpu_ms += executed.gpu_ms;
        self.pipeline_ms += executed.pipeline_ms;
        for pass in &executed.passes {
            let same = |known: &&mut PassTiming| known.piece == pass.piece && known.pass == pass.pass;
            match self.passes.iter_mut().find(same) {
                Some(known) => {
                    known.ms = match (known.ms, pass.ms) {
                        (Some(a), Some(b)) => Some(a + b),
                        (a, b) => a.or(b),
                    };
                    for (name, count) in &pass.work {
                        *known.work.entry(name.clone()).or_insert(0) += count;
                    }
                    if pass.skipped.is_none() {
                        known.skipped = None;
                    }
                }
                None => self.passes.push(pass.clone()),
            }
        }
    }
}
