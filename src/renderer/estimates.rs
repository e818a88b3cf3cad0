//! What estimators add to a frame: means of samples, which become images of the frame's graph.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::frame::Estimate;
use super::methods::EstimatorEntry;
use crate::estimator::{EstimateRequest, Estimating, Noise, Samples, SlotSums, TraceCost};
use crate::frame::rays::TracedScene;
use crate::graph::{FrameTimings, GraphDescription, Interrupt, PassTiming, Timing, hash_of};
use crate::slot::{IMAGE, Slot};
use crate::vulkan::{Pipelines, VulkanError};

/// The means of a picture's samples.
pub(crate) struct Means {
    /// Names them within this process.
    pub(crate) key: u64,
    /// Three floats a pixel, row by row.
    pub(crate) slots: BTreeMap<Slot, Arc<[u8]>>,
    pub(super) estimate: Estimate,
}

impl Means {
    /// What stands for means that nobody has estimated, where a frame is described only.
    pub(super) fn unknown(slots: &[Slot], size: [u32; 2]) -> Means {
        let bytes: Arc<[u8]> = vec![0; 12 * size[0] as usize * size[1] as usize].into();
        let slots = slots.iter().map(|&slot| (slot, bytes.clone())).collect();
        Means { key: 0, slots, estimate: Estimate::default() }
    }
}

/// The estimator of a renderer, and its last result.
pub(super) struct Estimates {
    name: &'static str,
    running: Box<dyn Estimating>,
    held: Option<Arc<Means>>,
    /// What stands for its passes while nothing changes.
    unchanged: PassTiming,
    /// The most that it held, by piece.
    memory_bytes: BTreeMap<String, u64>,
}

impl Estimates {
    /// The estimator at work on `scene`; `held` if it is the same one.
    pub(super) fn update(
        held: Option<Estimates>,
        entry: &EstimatorEntry,
        pipelines: &Arc<Pipelines>,
        (scene, interrupt): (Arc<TracedScene>, Interrupt),
    ) -> Result<Estimates, VulkanError> {
        let held = held.filter(|held| held.name == entry.name);
        let made = || {
            let [piece, pass] = entry.first_pass.map(str::to_owned);
            let skipped = Some("unchanged: geometry, materials, lights, camera".to_owned());
            let unchanged = PassTiming { piece, pass, ms: None, skipped, work: BTreeMap::new() };
            let (running, memory_bytes) = ((entry.open)(pipelines)?, BTreeMap::new());
            Ok(Estimates { name: entry.name, running, held: None, unchanged, memory_bytes })
        };
        let mut estimates = held.map_or_else(made, Ok)?;
        estimates.running.set_scene(scene);
        estimates.running.work().store.interrupt = interrupt;
        Ok(estimates)
    }

    /// Forgets the last result.
    pub(super) fn invalidate(&mut self) {
        self.held = None;
    }

    pub(super) fn release_scene(&mut self) {
        self.running.release_scene();
    }

    /// The means of the samples that are asked for; those held if nothing changed. `seen` names what the scene shows.
    pub(super) fn means(
        &mut self,
        request: &EstimateRequest,
        samples: Samples,
        timing: Timing,
        seen: u64,
        timings: &mut FrameTimings,
    ) -> Result<Arc<Means>, VulkanError> {
        let key = hash_of(&(seen, format!("{:?}", (request, samples.spp))));
        let means = match &self.held {
            Some(held) if held.key == key => {
                timings.passes = vec![self.unchanged.clone()];
                timings.memory_bytes.clone_from(&self.memory_bytes);
                held.clone()
            }
            _ => {
                self.running.set_timing(timing);
                let mut made = mean_of_samples(&mut *self.running, request, samples.spp, key)?;
                let TraceCost { gpu_ms, pipeline_ms, passes, rays, memory_bytes } = self.running.take_cost();
                (timings.gpu_ms, timings.pipeline_ms, timings.passes) = (gpu_ms, pipeline_ms, passes);
                (made.estimate.rays, made.estimate.seconds) = (rays, 1e-3 * gpu_ms);
                self.memory_bytes.clone_from(&memory_bytes);
                timings.memory_bytes = memory_bytes;
                self.held.insert(Arc::new(made)).clone()
            }
        };
        Ok(means)
    }

    /// The passes that the samples take.
    pub(super) fn describe(&mut self, request: &EstimateRequest) -> Result<GraphDescription, VulkanError> {
        self.running.describe(request)
    }
}

/// Half of the samples from each of the reference's two halves, A and B, with a and b samples. As the halves are independent, the
/// difference of their means times √(ab)/(a + b) has the variance of the mean of all samples.
fn mean_of_samples(
    running: &mut dyn Estimating,
    request: &EstimateRequest,
    spp: u32,
    key: u64,
) -> Result<Means, VulkanError> {
    let (a, b) = (spp.div_ceil(2), spp / 2);
    let share = f64::from(a) / f64::from(spp);
    running.work().span = [0.0, share];
    let first = running.add_up(request, 0, 0, a)?;
    running.work().span = [share, 1.0];
    let mut estimate = Estimate { spp, ..Estimate::default() };
    let halves: Vec<SlotSums> = if b > 0 { vec![first, running.add_up(request, 1, 0, b)?] } else { vec![first] };
    let mut slots: BTreeMap<Slot, Vec<[f32; 3]>> = BTreeMap::new();
    let mut differences = Vec::new();
    for (index, slot) in Slot::ALL.into_iter().enumerate() {
        let sum =
            |pixel: usize, channel: usize| halves.iter().map(|half| half.slots[index][pixel][channel]).sum::<f32>();
        let count = halves[0].slots[index].len();
        let pixels: Vec<[f32; 3]> =
            (0..count).map(|pixel| [0, 1, 2].map(|channel| sum(pixel, channel) / spp as f32)).collect();
        slots.insert(slot, pixels);
        if let [first, second] = &halves[..] {
            let scale = (a as f32 * b as f32).sqrt() / spp as f32;
            let difference: Vec<[f32; 3]> = first.slots[index]
                .iter()
                .zip(&second.slots[index])
                .map(|(x, y)| [0, 1, 2].map(|channel| (x[channel] / a as f32 - y[channel] / b as f32) * scale))
                .collect();
            differences.push((slot, difference));
        }
    }
    for (slot, difference) in &differences {
        estimate.noise.insert(slot.name().to_owned(), Noise::of_sum(&[&slots[slot]], &[difference]));
    }
    if !differences.is_empty() {
        let images: Vec<&[[f32; 3]]> = slots.values().map(|pixels| &pixels[..]).collect();
        let halves: Vec<&[[f32; 3]]> = differences.iter().map(|(_, difference)| &difference[..]).collect();
        estimate.noise.insert(IMAGE.to_owned(), Noise::of_sum(&images, &halves));
    }
    let slots = slots.into_iter().map(|(slot, pixels)| (slot, bytemuck::cast_slice(&pixels).into())).collect();
    Ok(Means { key, slots, estimate })
}
