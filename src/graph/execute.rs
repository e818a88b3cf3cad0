//! Running a declared frame: what is needed, its memory, its commands, and what came of them.

use std::sync::Arc;

use super::bindings::Access;
use super::declare::Graph;
use super::demand::{Needs, Place, Verdict, Version, decide, decide_again};
use super::piece::lies_in;
use super::report::PendingCounter;
use super::resource::{Body, ReadBack};
use super::store::{MAX_PASSES, STAMPS, stamp_of_frame};
use super::timing::{PassTiming, Timing};
use crate::vulkan::VulkanError;

/// A buffer that was too small: its name, what it held and what it needed, in elements.
pub(crate) type Outgrown = (String, [usize; 2]);

/// What a frame did and what it cost.
pub(crate) struct Executed {
    pub(crate) passes: Vec<PassTiming>,
    pub(crate) gpu_ms: f64,
    pub(crate) pipeline_ms: f64,
    /// Buffers that were too small. What was made of them is wrong; the next frame gives them enough.
    pub(crate) outgrown: Vec<Outgrown>,
    read_backs: Vec<Vec<u8>>,
    /// What passes left in places that they say they write whole, if that is to be proved.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests look at it"))]
    pub(super) left: Vec<(String, Vec<u8>)>,
}

impl Executed {
    /// The bytes of a read-back, rows close together.
    pub(crate) fn take(&mut self, read_back: ReadBack) -> Vec<u8> {
        std::mem::take(&mut self.read_backs[read_back.0])
    }
}

impl Graph<'_> {
    /// Whether each pass runs.
    pub(super) fn verdicts(&self) -> Vec<Verdict> {
        decide(&self.needs(), &self.wanted, |place| self.held(place))
    }

    fn needs(&self) -> Vec<Needs> {
        self.passes.iter().map(|pass| pass.needs.clone()).collect()
    }

    /// The key of what memory holds.
    fn held(&self, (resource, part): Place) -> Option<u64> {
        let resource = &self.resources[resource];
        match &resource.body {
            // The host writes them before the frame; the scene's stand anyway.
            Body::Upload(_) | Body::ExternalBuffer(_) | Body::ExternalImage(_) => {
                Some(resource.content[part as usize].0)
            }
            Body::Image(info) if self.store.fits(resource) => self.store.image_key(&resource.name, info, part),
            Body::Buffer { bytes } if self.store.fits(resource) => self.store.buffer_key(&resource.name, *bytes),
            Body::Image(_) | Body::Buffer { .. } => None,
        }
    }

    /// Runs the passes that are needed and waits for them.
    ///
    /// # Errors
    /// A lost device and exhausted memory name the last pass that finished.
    pub(crate) fn run(self, timing: Timing) -> Result<Executed, VulkanError> {
        let verdicts = self.verdicts();
        self.run_passes(&verdicts, timing)
    }

    /// Runs those passes of `piece` once more that the frame needs, and apart from them those alone that make what they read and memory no longer
    /// holds. Nothing is read back. What memory holds afterwards fits the next run of this piece; before anything else it has to be forgotten.
    ///
    /// # Errors
    /// As [`Graph::run`].
    pub(crate) fn run_again(mut self, piece: &str, timing: Timing) -> Result<Executed, VulkanError> {
        let forced: Vec<bool> = self.passes.iter().map(|pass| lies_in(&pass.full_name(), piece)).collect();
        let verdicts = decide_again(&self.needs(), &self.wanted, &forced, |place| self.held(place));
        self.read_backs.clear();
        self.growing.clear();
        self.run_passes(&verdicts, timing)
    }

    fn run_passes(mut self, verdicts: &[Verdict], timing: Timing) -> Result<Executed, VulkanError> {
        if let Some(mistake) = self.mistake.take() {
            return Err(VulkanError::Declaration(mistake));
        }
        self.store.interrupt.check()?;
        let advancing = self.advancing(verdicts);
        self.swap_histories(&advancing);
        let result = self.execute(verdicts, timing);
        match &result {
            Ok(executed) if executed.outgrown.is_empty() => self.note_ages(&advancing),
            // The frame is made again.
            Ok(_) => self.swap_histories(&advancing),
            Err(_) => {
                self.swap_histories(&advancing);
                // Whatever was recorded may not have run.
                self.store.forget();
            }
        }
        result
    }

    fn execute(&mut self, verdicts: &[Verdict], timing: Timing) -> Result<Executed, VulkanError> {
        self.provide_memory(verdicts)?;
        let running: Vec<usize> = (0..verdicts.len()).filter(|&index| verdicts[index] == Verdict::Run).collect();
        if running.len() as u64 > u64::from(MAX_PASSES) {
            return Err(VulkanError::TooLarge {
                what: "the frame".to_owned(),
                asked: format!("{} passes", running.len()),
                limit: MAX_PASSES.to_string(),
            });
        }
        let read_back = self.provide_read_back()?;
        self.store.queries.reset();
        self.store.markers.write(0, &vec![0; MAX_PASSES as usize * 4]);
        let _ = self.store.pipelines.take_spent();
        let mut counters = Vec::new();
        let mut submissions = Vec::new();
        // States change once it is known that every buffer was large enough.
        let waits = self.first_change_of_state(verdicts).filter(|_| !self.growing.is_empty());
        let parts = match waits {
            Some(first) => {
                self.check_growth_before(first, verdicts)?;
                let (before, after) = running.split_at(running.partition_point(|&index| index < first));
                vec![before, after]
            }
            None => vec![&running[..]],
        };
        let mut outgrown = Vec::new();
        let mut read_backs = Vec::new();
        for (number, part) in parts.iter().enumerate() {
            let first_slot = if number == 0 { 0 } else { parts[0].len() };
            submissions.push(self.submit(part, first_slot, timing, (number, &read_back), &mut counters)?);
            read_backs = self.copy_read_backs(&read_back);
            outgrown = self.note_growth(&read_backs)?;
            if !outgrown.is_empty() {
                break;
            }
        }
        let pipeline_ms = self.store.pipelines.take_spent().as_secs_f64() * 1e3;
        let passes = self.report(verdicts, &running, timing, &counters)?;
        let gpu_ms = self.gpu_ms(submissions.len())?;
        let declared: Vec<&str> = self.resources.iter().map(|resource| resource.name.as_str()).collect();
        self.store.retain(|name| declared.contains(&name));
        Ok(Executed { passes, gpu_ms, pipeline_ms, outgrown, read_backs, left: self.take_wholes() })
    }

    /// Whether growing buffers are counted by passes before the one that first changes a state.
    fn check_growth_before(&self, first: usize, verdicts: &[Verdict]) -> Result<(), VulkanError> {
        for growing in &self.growing {
            let (counts, _) = self.read_backs[growing.needed.0];
            let counts_too_late = |index: &usize| {
                verdicts[*index] == Verdict::Run
                    && self.passes[*index].needs.writes.iter().any(|write| write.place.0 == counts)
            };
            if let Some(late) = (first..self.passes.len()).find(counts_too_late) {
                let [late, first] = [late, first].map(|index| self.passes[index].full_name());
                let name = &growing.name;
                let sentence = format!("{late} counts what {name} must hold after {first} has changed a state");
                return Err(VulkanError::Declaration(sentence));
            }
        }
        Ok(())
    }

    /// Records passes and waits for them. `first_slot`: how many passes of the frame ran before.
    fn submit(
        &mut self,
        part: &[usize],
        first_slot: usize,
        timing: Timing,
        (number, read_back): (usize, &[(u64, u64)]),
        counters: &mut Vec<PendingCounter>,
    ) -> Result<(), VulkanError> {
        let programs = part.iter().filter_map(|index| self.passes[*index].program);
        self.store.recorder.begin(&programs.collect())?;
        let stamp = |graph: &Self, place: u32| {
            graph.store.recorder.full_barrier();
            graph.store.recorder.timestamp(&graph.store.queries, stamp_of_frame(number) + place);
            graph.store.recorder.full_barrier();
        };
        stamp(self, 0);
        for (slot, &index) in part.iter().enumerate() {
            let slot = u32::try_from(first_slot + slot).unwrap_or(0);
            self.record_pass(index, slot, timing, counters)?;
        }
        stamp(self, 1);
        self.record_read_backs(read_back);
        if let Err(error) = self.store.recorder.finish() {
            if !self.store.device.marks_passes() {
                return Err(error.after_unmarked_passes());
            }
            return Err(error.after_pass(self.last_finished(part, first_slot).as_deref()));
        }
        for &index in part {
            self.note_contents(index);
        }
        Ok(())
    }

    /// Between the stamps around each of so many submissions.
    fn gpu_ms(&self, submissions: usize) -> Result<f64, VulkanError> {
        let stamps = self.store.queries.read_timestamps(STAMPS)?;
        let of = |number: usize| {
            let first = stamp_of_frame(number) as usize;
            match stamps[first..first + 2] {
                [Some(start), Some(end)] => self.store.queries.milliseconds(start, end),
                _ => 0.0,
            }
        };
        Ok((0..submissions).map(of).sum())
    }

    /// Remembers how much the buffers that were too small need, and a little more, so that not every change outgrows them again.
    fn note_growth(&mut self, read_backs: &[Vec<u8>]) -> Result<Vec<Outgrown>, VulkanError> {
        let mut outgrown = Vec::new();
        for growing in &self.growing {
            let words = read_backs[growing.needed.0].chunks_exact(4);
            let needed = words.skip(growing.index).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
            let needed = needed.take(1).sum::<u32>() as usize;
            if needed > growing.most {
                return Err(VulkanError::TooLarge {
                    what: growing.name.clone(),
                    asked: format!("{needed} elements"),
                    limit: growing.most.to_string(),
                });
            }
            if needed > growing.capacity {
                self.store.grown.insert(growing.name.clone(), needed + needed / 8);
                outgrown.push((growing.name.clone(), [growing.capacity, needed]));
            }
        }
        Ok(outgrown)
    }

    /// Allocates what the running passes touch, and fills what the host supplies.
    fn provide_memory(&mut self, verdicts: &[Verdict]) -> Result<(), VulkanError> {
        let mut used = vec![false; self.resources.len()];
        for (pass, verdict) in self.passes.iter().zip(verdicts) {
            if *verdict == Verdict::Run {
                for access in pass.accesses() {
                    used[resource_of(access)] = true;
                }
            }
        }
        for (resource, _) in self.resources.iter().zip(&used).filter(|(_, used)| **used) {
            self.store.provide(resource)?;
            let Body::Upload(data) = &resource.body else { continue };
            let stored = self.store.buffers.get_mut(&resource.name).expect("provided above");
            let key = resource.content[0].0;
            if stored.key != Some(key) {
                // The device is idle between frames, so nobody else holds the buffer.
                let written = Arc::get_mut(&mut stored.buffer).is_some_and(|buffer| buffer.write(0, data));
                debug_assert!(written, "upload memory is mapped and not shared");
                stored.key = Some(key);
            }
        }
        Ok(())
    }

    /// The name of the last pass of a submission that finished.
    fn last_finished(&self, part: &[usize], first_slot: usize) -> Option<String> {
        let last = self.store.recorder.last_marked(&self.store.markers, first_slot, part.len())?;
        Some(self.passes[part[last - first_slot]].full_name())
    }

    /// Remembers what the outputs of a pass that ran now hold.
    fn note_contents(&mut self, index: usize) {
        for &Version { place: (resource, part), key } in &self.passes[index].needs.writes {
            let resource = &self.resources[resource];
            match &resource.body {
                Body::Image(_) => {
                    if let Some(stored) = self.store.images.get_mut(&resource.name) {
                        stored.keys[part as usize] = Some(key);
                    }
                }
                _ => {
                    if let Some(stored) = self.store.buffers.get_mut(&resource.name) {
                        stored.key = Some(key);
                    }
                }
            }
        }
    }
}

fn resource_of(access: &Access) -> usize {
    match access {
        Access::Image { image, .. } => *image,
        Access::Buffer { buffer, .. } => *buffer,
    }
}
