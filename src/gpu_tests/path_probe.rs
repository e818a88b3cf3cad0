//! What the path tracer finds of a scene: the mean of every slot in every pixel, and how sure it is.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::session::Session;
use crate::estimator::TraceCost;
use crate::estimator::path::PathTracer;
use crate::estimator::{EstimateRequest, Estimating};
use crate::frame::rays::TracedScene;
use crate::renderer::Slot;
use crate::scene::{CameraView, MaterialId, Primitive, Projection, Scene};
use crate::slot::{CausticPaths, PixelFilter};
use crate::vulkan::Device;

/// A picture and what it is made of.
#[derive(Clone)]
pub(super) struct Ask {
    pub(super) size: [u32; 2],
    pub(super) camera: CameraView,
    pub(super) bounces: Option<u32>,
    pub(super) caustics: CausticPaths,
    pub(super) mirrors: Option<u32>,
    pub(super) filter: PixelFilter,
    pub(super) seed: u32,
    /// Of each half.
    pub(super) samples: u32,
    /// `None`: as the scene has it.
    pub(super) light_paths: Option<bool>,
}

impl Ask {
    /// All bounces, all over the pixels.
    pub(super) fn new(size: [u32; 2], samples: u32, camera: CameraView) -> Ask {
        Ask {
            size,
            camera,
            bounces: None,
            caustics: CausticPaths::All,
            mirrors: None,
            filter: PixelFilter::Box,
            seed: 0,
            samples,
            light_paths: None,
        }
    }
}

/// Means over the samples of two halves, W/(m² sr).
pub(super) struct Traced {
    /// One row-major image for each of [`Slot::ALL`], for each half.
    pub(super) halves: [[Vec<DVec3>; 5]; 2],
    pub(super) cost: TraceCost,
}

pub(super) struct Tracer {
    device: Arc<Device>,
    tracer: PathTracer,
}

impl Tracer {
    pub(super) fn new(session: &Session) -> Tracer {
        let device = session.context.shared_device().clone();
        Tracer { tracer: PathTracer::new(session.context.pipelines()).expect("a tracer"), device }
    }

    pub(super) fn trace(&mut self, scene: &Scene, ask: &Ask) -> Traced {
        let Tracer { device, tracer } = self;
        tracer.take_cost();
        tracer.set_scene(Arc::new(TracedScene::new(device, scene).expect("the scene fits the device")));
        if let Some(wanted) = ask.light_paths {
            tracer.set_light_paths(wanted);
        }
        let view = tracer.view(&EstimateRequest {
            size: ask.size,
            camera: ask.camera.clone(),
            bounces: ask.bounces,
            caustics: ask.caustics,
            mirrors: ask.mirrors,
            filter: ask.filter,
            seed: ask.seed,
        });
        let halves = [0, 1].map(|half| {
            let sums = tracer.sums(&view, half, 0, ask.samples).expect("samples");
            let mean = |sum: &[f32; 3]| DVec3::from(sum.map(f64::from)) / f64::from(ask.samples);
            sums.slots.map(|pixels| pixels.iter().map(mean).collect())
        });
        Traced { halves, cost: tracer.take_cost() }
    }
}

fn place_of(slot: Slot) -> usize {
    Slot::ALL.iter().position(|known| *known == slot).expect("a slot")
}

impl Traced {
    /// Means of the pixels.
    pub(super) fn slot(&self, slot: Slot) -> Vec<DVec3> {
        let [a, b] = [0, 1].map(|half| &self.halves[half][place_of(slot)]);
        a.iter().zip(b).map(|(a, b)| 0.5 * (*a + *b)).collect()
    }

    /// Means of the pixels, all slots together.
    pub(super) fn image(&self) -> Vec<DVec3> {
        let slots = Slot::ALL.map(|slot| self.slot(slot));
        (0..slots[0].len()).map(|pixel| slots.iter().map(|slot| slot[pixel]).sum()).collect()
    }

    /// Mean over all pixels.
    pub(super) fn mean(&self, slot: Slot) -> DVec3 {
        mean(&self.slot(slot))
    }

    /// Standard error of the mean over all pixels, from the difference of the halves, as if pixels knew nothing of each other.
    pub(super) fn error(&self, slot: Slot) -> f64 {
        let [a, b] = [0, 1].map(|half| &self.halves[half][place_of(slot)]);
        let squares: f64 = a.iter().zip(b).map(|(a, b)| (0.5 * (*a - *b)).length_squared() / 3.0).sum();
        squares.sqrt() / a.len() as f64
    }

    pub(super) fn assert_finite(&self, what: &str) {
        for (slot, pixel) in
            Slot::ALL.iter().flat_map(|slot| self.slot(*slot).into_iter().map(move |pixel| (slot, pixel)))
        {
            assert!(pixel.is_finite() && pixel.min_element() >= 0.0, "{what}: {pixel} in {slot}");
        }
    }
}

pub(super) fn mean(pixels: &[DVec3]) -> DVec3 {
    pixels.iter().sum::<DVec3>() / pixels.len() as f64
}

/// Asserts that two colours differ by no more than `tolerance` of the expected one.
pub(super) fn assert_near(what: &str, found: DVec3, expected: DVec3, tolerance: f64) {
    let error = ((found - expected) / expected).abs().max_element();
    println!("{what}: {found:.5} of {expected:.5}, relative error {error:.2e}");
    assert!(error <= tolerance, "{what}: {found} in place of {expected}, {error:.2e} apart");
}

/// Straight down on a square of 2·`half` from a height, seen from there on.
pub(super) fn down(middle: DVec3, half: f64) -> CameraView {
    let projection = Projection::Orthographic { half_width: half, half_height: half, near: 0.0, far: 1e3 };
    CameraView::look_at(middle, middle - DVec3::Y, DVec3::NEG_Z, projection)
}

/// The box from `low` to `high`, seen from outside as front.
pub(super) fn solid_box(low: DVec3, high: DVec3, material: MaterialId) -> Vec<Primitive> {
    let half = (0.5 * (high - low)).as_vec3().to_array();
    let middle = (0.5 * (high + low)).as_vec3().to_array();
    let mut faces = super::scenes::box_faces(half, [material; 6]);
    for face in &mut faces {
        face.indices = vec![0, 2, 1, 0, 3, 2];
        for position in &mut face.positions {
            *position = [0, 1, 2].map(|axis| position[axis] + middle[axis]);
        }
    }
    faces
}

/// A sphere of radius 1 with `rings` bands of latitude, with vertex normals or with flat faces.
pub(super) fn sphere(rings: u32, smooth: bool, material: MaterialId) -> Primitive {
    let sectors = 2 * rings;
    let point = |ring: u32, sector: u32| {
        let polar = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        let azimuth = std::f64::consts::TAU * f64::from(sector % sectors) / f64::from(sectors);
        DVec3::new(polar.sin() * azimuth.sin(), polar.cos(), polar.sin() * azimuth.cos()).as_vec3().to_array()
    };
    let positions: Vec<[f32; 3]> =
        (0..=rings).flat_map(|ring| (0..=sectors).map(move |sector| point(ring, sector))).collect();
    let mut indices = Vec::new();
    for ring in 0..rings {
        for sector in 0..sectors {
            let first = ring * (sectors + 1) + sector;
            let below = first + sectors + 1;
            if ring > 0 {
                indices.extend([first, below, first + 1]);
            }
            if ring + 1 < rings {
                indices.extend([first + 1, below, below + 1]);
            }
        }
    }
    Primitive { normals: smooth.then(|| positions.clone()), positions, indices, material, ..Primitive::default() }
}

/// A place in the world, turned so that no axis is special.
pub(super) fn turned(scale: f64, middle: DVec3) -> DAffine3 {
    let turn = DMat3::from_rotation_x(0.3) * DMat3::from_rotation_y(0.5) * DMat3::from_rotation_z(0.2);
    DAffine3 { matrix3: turn * scale, translation: middle }
}
