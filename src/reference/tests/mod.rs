//! References made by a source on the host, whose noise is known.

mod cache;
mod files;
mod keys;
mod merging;
mod noise;

use std::cell::RefCell;
use std::rc::Rc;

use glam::DVec3;

use super::about::About;
use super::obtain::Work;
use super::*;
use crate::method::Error;
use crate::scene::{CameraView, Projection, Scene};
use crate::slot::Slot;

pub(super) const SIZE: [u32; 2] = [24, 16];

/// What a pixel of a slot is in expectation.
pub(super) fn expected(slot: usize, pixel: usize, channel: usize) -> f64 {
    if slot == 3 { 0.0 } else { 0.25 * (1 + slot) as f64 + 0.01 * (pixel % 7) as f64 + 0.1 * channel as f64 }
}

/// Samples are even around the expectation, with this standard deviation; the slot `caustics` is black.
pub(super) const DEVIATION: f64 = 0.5;

/// Hashes instead of light: sample `sample` of a half is the same whenever and wherever it is made.
struct Mock {
    pixel_count: usize,
    rays: u64,
    /// Chunks made so far, by half and first sample.
    made: Rc<RefCell<Vec<(u32, u32)>>>,
    /// How many chunks are left until the device is lost.
    left: u32,
}

impl SampleSource for Mock {
    fn sums(&mut self, half: u32, first: u32, count: u32) -> Result<SlotSums, Error> {
        if self.left == 0 {
            return Err(Error::EmptyFrame(0, 0));
        }
        self.left -= 1;
        self.made.borrow_mut().push((half, first));
        self.rays += u64::from(count) * 10;
        let value = |slot: usize, pixel: usize, channel: usize| {
            let sum = (first..first + count).fold(0.0, |sum, sample| {
                let place = ((slot as u64 * 3 + channel as u64) << 52) | ((pixel as u64) << 33);
                let bits = mix(place | (u64::from(half) << 32) | u64::from(sample));
                let uniform = (bits >> 11) as f64 / (1_u64 << 53) as f64;
                let deviation = if slot == 3 { 0.0 } else { DEVIATION };
                sum + expected(slot, pixel, channel) + deviation * 12_f64.sqrt() * (uniform - 0.5)
            });
            sum as f32
        };
        let slots = std::array::from_fn(|slot| {
            (0..self.pixel_count).map(|pixel| std::array::from_fn(|channel| value(slot, pixel, channel))).collect()
        });
        Ok(SlotSums { samples: count, slots })
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}

/// SplitMix64's finaliser (Steele, Lea & Flood 2014).
fn mix(state: u64) -> u64 {
    let state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    state ^ (state >> 31)
}

pub(super) fn request(size: [u32; 2]) -> ReferenceRequest {
    let projection = Projection::Perspective { vertical_fov: 1.0, aspect: None, near: 0.1 };
    ReferenceRequest {
        size,
        camera: CameraView::look_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y, projection),
        estimator: Estimator::Path,
        bounces: None,
        caustics: CausticPaths::All,
        mirrors: None,
        filter: PixelFilter::Center,
        seed: 0,
    }
}

/// Makes references of one scene and counts what was made.
pub(super) struct Maker {
    pub(super) about: About,
    pub(super) made: Rc<RefCell<Vec<(u32, u32)>>>,
    /// Halves of chunks until the device is lost.
    pub(super) left: u32,
}

impl Maker {
    pub(super) fn new() -> Maker {
        Maker::of(&request(SIZE))
    }

    pub(super) fn of(request: &ReferenceRequest) -> Maker {
        let scene = Scene::open("plane").expect("a built-in scene");
        Maker { about: About::new(&scene, "a plane", request), made: Rc::default(), left: u32::MAX }
    }

    pub(super) fn work(&self) -> Work<'static> {
        let [width, height] = self.about.size;
        let (made, left) = (self.made.clone(), self.left);
        let source = move || -> Result<Box<dyn SampleSource>, Error> {
            let pixel_count = width as usize * height as usize;
            Ok(Box::new(Mock { pixel_count, rays: 0, made: made.clone(), left }))
        };
        Work { about: self.about.clone(), device: "mock".to_owned(), source: Box::new(source) }
    }

    pub(super) fn make(&self, goal: impl Into<Goal>, cache: Option<&Cache>) -> ReferenceFile {
        self.work().make(goal.into(), cache, &mut |_| ()).expect("made")
    }
}

/// What two references must have in common to be the same to the bit.
pub(super) fn bits(file: &ReferenceFile) -> Vec<u32> {
    let Reference { slots, image, half_differences, .. } = file.reference();
    let images = slots.values().chain([&image]).chain(half_differences.values());
    images.flat_map(|image| image.pixels.as_flattened()).map(|value| value.to_bits()).collect()
}

#[test]
fn slots_are_what_their_samples_are_around() {
    let reference = Maker::new().make(1024, None).reference();
    assert_eq!(reference.spp, 1024);
    for (index, slot) in Slot::ALL.into_iter().enumerate() {
        for (pixel, value) in reference.slots[&slot].pixels.iter().enumerate() {
            for (channel, value) in value.iter().enumerate() {
                let error = f64::from(*value) - expected(index, pixel, channel);
                assert!(error.abs() < 5.0 * DEVIATION / 32.0, "{slot} at {pixel}: {error}");
            }
        }
    }
    let sum = reference.sum_of(&Slot::ALL);
    let close = |a: &[f32; 3], b: &[f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(sum.pixels.iter().zip(&reference.image.pixels).all(|(a, b)| close(a, b)));
    assert_eq!(reference.devices, ["mock"]);
    assert!(reference.rays_per_second > 0.0 && reference.samples_per_second > 0.0);
}

#[test]
fn samples_beyond_all_counting_are_refused() {
    let error = Maker::new().work().make(u32::MAX.into(), None, &mut |_| ()).expect_err("too many").to_string();
    assert!(error.contains("1073741824"), "{error}");
}
