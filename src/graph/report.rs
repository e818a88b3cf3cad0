//! What the passes of a frame cost and did: counters on their way to the host, and the rows of the table.

use std::collections::{BTreeMap, HashMap};

use super::declare::Graph;
use super::demand::Verdict;
use super::pass::Work;
use super::store::{MAX_COUNTERS, stamp_of_pass};
use super::timing::{PassTiming, Timing};
use crate::vulkan::VulkanError;

/// A word of the counter buffer, and what it means.
pub(super) struct PendingCounter {
    pub(super) pass: usize,
    pub(super) name: String,
    /// Three words of an indirect dispatch: their product times the local size.
    pub(super) invocations_of_group: Option<u64>,
    pub(super) slot: u64,
}

impl Graph<'_> {
    /// Copies what the pass counted to where the host reads it. Full barriers stand around this.
    pub(super) fn record_counters(&self, index: usize, counters: &mut Vec<PendingCounter>) {
        let pass = &self.passes[index];
        let recorder = &self.store.recorder;
        let mut slot = counters
            .last()
            .map_or(0, |last: &PendingCounter| last.slot + if last.invocations_of_group.is_some() { 3 } else { 1 });
        let mut add = |name: &str, buffer: usize, offset: u64, invocations_of_group: Option<u64>| {
            let words = if invocations_of_group.is_some() { 3 } else { 1 };
            if slot + words <= MAX_COUNTERS {
                recorder.copy(&self.memory_of_buffer(buffer), offset, &self.store.counters, slot * 4, words * 4);
                counters.push(PendingCounter { pass: index, name: name.to_owned(), invocations_of_group, slot });
                slot += words;
            }
        };
        if let Work::DispatchIndirect { buffer, offset } = pass.work {
            let local: u64 =
                pass.program.map_or(1, |program| program.local_size.iter().map(|&length| u64::from(length)).product());
            add("invocations", buffer, offset, Some(local));
        }
        for counter in &pass.counters {
            add(&counter.name, counter.buffer, counter.offset, None);
        }
    }

    pub(super) fn report(
        &self,
        verdicts: &[Verdict],
        order: &[usize],
        timing: Timing,
        counters: &[PendingCounter],
    ) -> Result<Vec<PassTiming>, VulkanError> {
        let stamps = match timing {
            Timing::Passes => {
                self.store.queries.read_timestamps(stamp_of_pass(u32::try_from(order.len()).unwrap_or(0)))?
            }
            Timing::Frame => Vec::new(),
        };
        let words: &[u32] =
            self.store.counters.mapped().and_then(|bytes| bytemuck::try_cast_slice(bytes).ok()).unwrap_or(&[]);
        let mut slots: HashMap<usize, usize> = HashMap::new();
        slots.extend(order.iter().enumerate().map(|(slot, &index)| (index, slot)));
        let mut rows = Vec::new();
        for (index, (pass, verdict)) in self.passes.iter().zip(verdicts).enumerate() {
            let mut work: BTreeMap<String, u64> = BTreeMap::new();
            let mut ms = None;
            if let Some(&slot) = slots.get(&index) {
                work.clone_from(&pass.notes);
                let first = stamp_of_pass(u32::try_from(slot).unwrap_or(0)) as usize;
                if let [Some(Some(start)), Some(Some(end))] = [stamps.get(first), stamps.get(first + 1)] {
                    ms = Some(self.store.queries.milliseconds(*start, *end));
                }
                if let (Work::Dispatch(groups), Some(program)) = (&pass.work, pass.program) {
                    let product = |lengths: [u32; 3]| lengths.iter().map(|&length| u64::from(length)).product::<u64>();
                    work.insert("invocations".to_owned(), product(*groups) * product(program.local_size));
                }
                if pass.raster.is_some()
                    && timing == Timing::Passes
                    && let Some(statistics) = self.store.queries.read_statistics(u32::try_from(slot).unwrap_or(0))
                {
                    work.insert("vertices".to_owned(), statistics.vertices);
                    work.insert("triangles".to_owned(), statistics.triangles);
                    work.insert("fragments".to_owned(), statistics.fragments);
                }
            }
            for counter in counters.iter().filter(|counter| counter.pass == index) {
                let word = |offset: u64| {
                    usize::try_from(counter.slot + offset)
                        .ok()
                        .and_then(|slot| words.get(slot))
                        .map_or(0, |&word| u64::from(word))
                };
                let value =
                    counter.invocations_of_group.map_or_else(|| word(0), |local| word(0) * word(1) * word(2) * local);
                work.insert(counter.name.clone(), value);
            }
            rows.push(PassTiming {
                piece: pass.piece.clone(),
                pass: pass.name.clone(),
                ms,
                skipped: pass.skip_reason(*verdict),
                work,
            });
        }
        Ok(rows)
    }
}
