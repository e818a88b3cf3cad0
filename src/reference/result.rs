//! A reference to compare with: its images and how noisy they are.

use std::collections::BTreeMap;

use super::about::{About, Spent};
use super::blocks::State;
use super::key::ReferenceKey;
use crate::estimator::Noise;
use crate::image::ColorImage;
use crate::metrics::block_rms;
use crate::slot::{IMAGE, Slot};

/// A reference: means over all of its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// What tells it from other references.
    pub key: ReferenceKey,
    /// Samples of every pixel, of both halves together.
    pub spp: u32,
    /// All slots.
    pub slots: BTreeMap<Slot, ColorImage>,
    /// The sum of all slots.
    pub image: ColorImage,
    /// Half the difference of the halves' means, slot by slot: what the noise is measured by.
    pub half_differences: BTreeMap<Slot, ColorImage>,
    /// The noise of every slot by its name, and of the `image`.
    pub noise: BTreeMap<String, Noise>,
    /// Time that the samples took, seconds, on all machines together.
    pub seconds: f64,
    /// Samples of pixels per second.
    pub samples_per_second: f64,
    /// Rays per second; 0 if they were not counted.
    pub rays_per_second: f64,
    /// The devices that made the samples.
    pub devices: Vec<String>,
}

impl Reference {
    pub(crate) fn of(about: &About, spent: &Spent, state: &State) -> Reference {
        let size = about.size;
        let means = state.means();
        let image = ColorImage { size, pixels: means.image };
        let images = |all: Vec<Vec<[f32; 3]>>| {
            Slot::ALL.into_iter().zip(all).map(|(slot, pixels)| (slot, ColorImage { size, pixels })).collect()
        };
        let samples = f64::from(state.samples()) * f64::from(size[0]) * f64::from(size[1]);
        let mut reference = Reference {
            key: about.key.clone(),
            spp: state.samples(),
            slots: images(means.slots),
            image,
            half_differences: images(means.noise),
            noise: BTreeMap::new(),
            seconds: spent.seconds,
            samples_per_second: spent.rate(samples),
            rays_per_second: spent.rate(spent.rays as f64),
            devices: spent.devices.clone(),
        };
        let mut noise: BTreeMap<String, Noise> =
            Slot::ALL.into_iter().map(|slot| (slot.name().to_owned(), reference.noise_of(&[slot]))).collect();
        noise.insert(IMAGE.to_owned(), reference.noise_of(&Slot::ALL));
        reference.noise = noise;
        reference
    }

    /// The noise of the sum of some slots. Slots are not independent of each other, so it does not follow from their own.
    pub fn noise_of(&self, slots: &[Slot]) -> Noise {
        let (images, differences) = (pixels(&self.slots, slots), pixels(&self.half_differences, slots));
        Noise::of_sum(&images, &differences)
    }

    /// The relative noise of blocks of 8×8 pixels of the sum of some slots, as `block_rrmse` counts errors.
    pub fn block_noise_of(&self, slots: &[Slot]) -> f64 {
        let differences = pixels(&self.half_differences, slots);
        let value = |pixel: usize| {
            std::array::from_fn(|channel| differences.iter().map(|slot| f64::from(slot[pixel][channel])).sum())
        };
        let (rms, mean) = (block_rms(self.image.size, value), self.noise_of(slots).mean);
        if rms == 0.0 { 0.0 } else { rms / mean }
    }

    /// The sum of some slots.
    pub fn sum_of(&self, slots: &[Slot]) -> ColorImage {
        ColorImage::sum(self.image.size, slots.iter().filter_map(|slot| self.slots.get(slot)))
    }

    /// The noise of the image: `rrmse` of [`Reference::noise`].
    pub fn image_noise(&self) -> Noise {
        self.noise.get(IMAGE).copied().unwrap_or_default()
    }
}

fn pixels<'a>(images: &'a BTreeMap<Slot, ColorImage>, slots: &[Slot]) -> Vec<&'a [[f32; 3]]> {
    slots.iter().filter_map(|slot| Some(&images.get(slot)?.pixels[..])).collect()
}
