//! Running a declared frame: what is needed, its memory, its commands, and what came of them.

use std::sync::Arc;

use super::bindings::Access;
use super::declare::Graph;
use super::demand::{Needs, Place, Verdict, Version, decide, decide_again};
use super::piece::lies_in;
use super::resource::{Body, ReadBack};
use super::store::MAX_PASSES;
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
    fn held(&self, (resource, mip): Place) -> Option<u64> {
        let resource = &self.resources[resource];
        match &resource.body {
            // The host writes them before the frame; the scene's stand anyway.
            Body::Upload(_) | Body::ExternalBuffer(_) | Body::ExternalImage(_) => {
                Some(resource.content[mip as usize].0)
            }
            Body::Image(info) if self.store.fits(resource) => self.store.image_key(&resource.name, info, mip),
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
        let result = self.execute(verdicts, timing);
        if result.is_err() {
            // Whatever was recorded may not have run.
            self.store.forget();
        }
        result
    }

    fn execute(&mut self, verdicts: &[Verdict], timing: Timing) -> Result<Executed, VulkanError> {
        self.provide_memory(verdicts)?;
        let running = verdicts.iter().filter(|verdict| **verdict == Verdict::Run).count();
        if running as u64 > u64::from(MAX_PASSES) {
            return Err(VulkanError::TooLarge {
                what: "the frame".to_owned(),
                asked: format!("{running} passes"),
                limit: MAX_PASSES.to_string(),
            });
        }
        let read_back = self.provide_read_back()?;
        self.store.queries.reset();
        self.store.markers.write(0, &vec![0; MAX_PASSES as usize * 4]);
        let _ = self.store.pipelines.take_spent();
        self.store.recorder.begin(u32::try_from(running).unwrap_or(MAX_PASSES))?;
        let mut counters = Vec::new();
        self.store.recorder.full_barrier();
        self.store.recorder.timestamp(&self.store.queries, 0);
        self.store.recorder.full_barrier();
        let mut order = Vec::new();
        for (index, verdict) in verdicts.iter().enumerate() {
            if *verdict == Verdict::Run {
                let slot = u32::try_from(order.len()).unwrap_or(0);
                order.push(index);
                self.record_pass(index, slot, timing, &mut counters)?;
            }
        }
        self.store.recorder.full_barrier();
        self.store.recorder.timestamp(&self.store.queries, 1);
        self.store.recorder.full_barrier();
        self.record_read_backs(&read_back);
        let pipeline_ms = self.store.pipelines.take_spent().as_secs_f64() * 1e3;
        if let Err(error) = self.store.recorder.finish() {
            return Err(error.after_pass(self.last_finished(&order).as_deref()));
        }
        for &index in &order {
            self.note_contents(index);
        }
        let passes = self.report(verdicts, &order, timing, &counters)?;
        let stamps = self.store.queries.read_timestamps(2)?;
        let gpu_ms = match stamps[..] {
            [Some(start), Some(end)] => self.store.queries.milliseconds(start, end),
            _ => 0.0,
        };
        let declared: Vec<&str> = self.resources.iter().map(|resource| resource.name.as_str()).collect();
        self.store.retain(|name| declared.contains(&name));
        let read_backs = self.copy_read_backs(&read_back);
        let outgrown = self.note_growth(&read_backs)?;
        Ok(Executed { passes, gpu_ms, pipeline_ms, outgrown, read_backs, left: self.take_wholes() })
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

    /// The name of the last pass whose marker was written.
    fn last_finished(&self, order: &[usize]) -> Option<String> {
        let words: &[u32] = bytemuck::try_cast_slice(self.store.markers.mapped()?).ok()?;
        let last = words.iter().take(order.len()).rposition(|word| *word != 0)?;
        Some(self.passes[order[last]].full_name())
    }

    /// Remembers what the outputs of a pass that ran now hold.
    fn note_contents(&mut self, index: usize) {
        for &Version { place: (resource, mip), key } in &self.passes[index].needs.writes {
            let resource = &self.resources[resource];
            match &resource.body {
                Body::Image(_) => {
                    if let Some(stored) = self.store.images.get_mut(&resource.name) {
                        stored.keys[mip as usize] = Some(key);
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
