//! The path tracer of a renderer, and what its samples come to.

use std::collections::BTreeMap;

use super::frame::Estimate;
use crate::estimator::path::PathTracer;
use crate::estimator::{EstimateRequest, Noise, SlotSums};
use crate::image::ColorImage;
use crate::slot::{IMAGE, Slot};
use crate::vulkan::VulkanError;

/// The tracer of a renderer, and its last result.
pub(crate) struct TracedPaths {
    pub(super) tracer: PathTracer,
    pub(super) held: Option<(u64, Traced)>,
}

/// What the samples of a frame come to.
#[derive(Clone)]
pub(super) struct Traced {
    pub(super) slots: BTreeMap<Slot, ColorImage>,
    pub(super) estimate: Estimate,
}

impl TracedPaths {
    pub(super) fn invalidate(&mut self) {
        self.held = None;
    }

    pub(super) fn release_scene(&mut self) {
        self.tracer.release_scene();
    }
}

/// Half of the samples from each of the reference's two halves, A and B, with a and b samples. As the halves are independent, the
/// difference of their means times √(ab)/(a + b) has the variance of the mean of all samples.
pub(super) fn mean_of_samples(
    tracer: &mut PathTracer,
    request: &EstimateRequest,
    spp: u32,
    traced: &[Slot],
) -> Result<Traced, VulkanError> {
    let view = tracer.view(request);
    let (a, b) = (spp.div_ceil(2), spp / 2);
    let first = tracer.sums(&view, 0, 0, a)?;
    let mut estimate = Estimate { spp, ..Estimate::default() };
    let halves: Vec<SlotSums> = if b > 0 { vec![first, tracer.sums(&view, 1, 0, b)?] } else { vec![first] };
    let mut slots = BTreeMap::new();
    let mut differences = Vec::new();
    for (index, slot) in Slot::ALL.into_iter().enumerate().filter(|(_, slot)| traced.contains(slot)) {
        let sum =
            |pixel: usize, channel: usize| halves.iter().map(|half| half.slots[index][pixel][channel]).sum::<f32>();
        let count = halves[0].slots[index].len();
        let pixels = (0..count).map(|pixel| [0, 1, 2].map(|channel| sum(pixel, channel) / spp as f32)).collect();
        slots.insert(slot, ColorImage { size: request.size, pixels });
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
        estimate.noise.insert(slot.name().to_owned(), Noise::of_sum(&[&slots[slot].pixels], &[difference]));
    }
    if !differences.is_empty() {
        let images: Vec<&[[f32; 3]]> = slots.values().map(|image| &image.pixels[..]).collect();
        let halves: Vec<&[[f32; 3]]> = differences.iter().map(|(_, difference)| &difference[..]).collect();
        estimate.noise.insert(IMAGE.to_owned(), Noise::of_sum(&images, &halves));
    }
    Ok(Traced { slots, estimate })
}
