//! Splatting of photons: energy, order, edges, sizes; against closed forms and one way against the other.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3, Vec3};

use super::scenes::{floor, lambert, place, quad, view};
use super::session::Session;
use crate::caustics::photons::records::LandedPhotons;
use crate::caustics::photons::splat::{SplatInputs, splat};
use crate::frame::camera::camera;
use crate::frame::gbuffer::{View, gbuffer};
use crate::frame::geometry::Geometry;
use crate::frame::octahedral::pack_direction;
use crate::frame::scene_data::SceneData;
use crate::graph::{Dependence, Graph, Store};
use crate::renderer::{PassTiming, PhotonSettings, Preset, Settings, Technique, Timing};
use crate::scene::{CameraView, Projection, Scene};
use crate::shaders::types;

#[derive(Clone, Copy)]
struct Landed {
    position: DVec3,
    normal: DVec3,
    flux: [f32; 3],
    radius: f64,
}

/// A view of a scene that photons are splatted in.
struct Bench<'s> {
    store: Store,
    scene: &'s Scene,
    data: SceneData,
    camera: types::Camera,
    size: [u32; 2],
}

impl<'s> Bench<'s> {
    fn new(session: &Session, scene: &'s Scene, view: &CameraView, size: [u32; 2]) -> Bench<'s> {
        let store = session.store();
        let device = store.device().clone();
        let data = SceneData::update(&device, store.pipelines(), None, scene).expect("the scene fits the device");
        let camera = camera(view, size, data.origin);
        Bench { store, scene, data, camera, size }
    }

    /// π·L of a white diffuse surface, which is E, and the passes.
    fn run(&mut self, settings: &PhotonSettings, photons: &[Landed], timing: Timing) -> (Vec<DVec3>, Vec<PassTiming>) {
        let mut graph = Graph::new(&mut self.store);
        let geometry = Geometry::import(&mut graph, &self.data);
        let view = View { camera: self.camera, size: self.size, sky: [0.0; 3], emission: false };
        let buffer = gbuffer(&mut graph, &self.data, &geometry, &self.scene.facts(), &view);
        let words: Vec<[u32; 4]> = photons
            .iter()
            .flat_map(|photon| {
                let [x, y, z] = (photon.position - self.data.origin).as_vec3().to_array().map(f32::to_bits);
                let [red, green, blue] = photon.flux.map(f32::to_bits);
                let normal = pack_direction(photon.normal.as_vec3());
                [[x, y, z, normal], [red, green, blue, (photon.radius as f32).to_bits()]]
            })
            .chain([[0; 4]; 2])
            .collect();
        let count = photons.len() as u32;
        let counts = [count.div_ceil(64), 1, 1, count, 6, count, 0, 0];
        let landed = LandedPhotons {
            photons: graph.upload("photons.landed", &words, Dependence::LIGHTS),
            counts: graph.upload("photons.counts", &counts, Dependence::LIGHTS),
            stage: 0,
            capacity: count + 1,
        };
        let inputs = SplatInputs { buffer: &buffer, settings, length: 1.0 };
        let slot = splat(&mut graph, &inputs, &landed);
        let read = graph.read_back(slot);
        let mut executed = graph.run(timing).expect("a frame");
        let bytes = executed.take(read);
        let floats: Vec<f64> =
            bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])) * PI).collect();
        let colors = floats.chunks_exact(4).map(|texel| DVec3::new(texel[0], texel[1], texel[2])).collect();
        (colors, executed.passes)
    }

    fn irradiance(&mut self, settings: &PhotonSettings, photons: &[Landed]) -> Vec<DVec3> {
        let found = self.run(settings, photons, Timing::Frame).0;
        assert!(found.iter().all(|color| color.is_finite() && color.min_element() >= 0.0));
        found
    }

    /// Through a continuous place on the image, of length 1 along the camera's axis when perspective.
    fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let axis = |axis: [f32; 3]| Vec3::from(axis).as_dvec3();
        let across = (2.0 * x / f64::from(self.size[0]) - 1.0) * axis(self.camera.right_scaled)
            + (2.0 * y / f64::from(self.size[1]) - 1.0) * axis(self.camera.down_scaled);
        let (eye, forward) = (axis(self.camera.position_rs) + self.data.origin, axis(self.camera.forward));
        if self.camera.depth_range > 0.0 { (eye + across, forward) } else { (eye, forward + across) }
    }

    /// The point of the plane y = 0 at a place on the image.
    fn on_floor(&self, x: f64, y: f64) -> DVec3 {
        let (start, ray) = self.ray(x, y);
        start - ray * (start.y / ray.y)
    }

    /// ΣE·A over the pixels, A the area of the plane y = 0 that each shows, W.
    fn flux_on_floor(&self, irradiance: &[DVec3]) -> DVec3 {
        let area = |index: usize| {
            let (x, y) = ((index as u32 % self.size[0]) as f64, (index as u32 / self.size[0]) as f64);
            let corner = self.on_floor(x, y);
            let [right, down] = [self.on_floor(x + 1.0, y), self.on_floor(x, y + 1.0)];
            let other = self.on_floor(x + 1.0, y + 1.0);
            0.5 * ((right - corner).cross(down - corner).length() + (right - other).cross(down - other).length())
        };
        irradiance.iter().enumerate().map(|(index, light)| *light * area(index)).sum()
    }
}

fn settings(changes: &[(&str, &str)]) -> PhotonSettings {
    let mut settings = Settings::new(Technique::Hybrid, Preset::Default);
    for (key, value) in changes {
        settings.set(&format!("photons.{key}"), value).expect("a setting and its value");
    }
    settings.photons
}

fn white_floor() -> Scene {
    floor(4.0, lambert([1.0; 3]))
}

/// Straight down from a height of 2 m.
fn from_above() -> CameraView {
    view(DVec3::new(0.1, 2.0, -0.2), DVec3::new(0.1, 0.0, -0.2))
}

fn oblique() -> CameraView {
    view(DVec3::new(0.1, 1.0, 2.0), DVec3::new(0.1, 0.0, 0.0))
}

fn orthographic() -> CameraView {
    let projection = Projection::Orthographic { half_width: 1.0, half_height: 1.0, near: 0.1, far: 10.0 };
    CameraView::look_at(DVec3::new(0.0, 2.0, 1.0), DVec3::ZERO, DVec3::Y, projection)
}

/// A reproducible number in [0, 1).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 40) as f64 / f64::from(1 << 24)
}

const WAYS: [&str; 2] = ["tiles", "discs"];

#[test]
fn a_photon_delivers_its_flux_whatever_its_radius() {
    const SIZE: [u32; 2] = [120, 96];
    let session = Session::open();
    let scene = white_floor();
    for (what, camera) in [("above", from_above()), ("oblique", oblique()), ("orthographic", orthographic())] {
        let mut bench = Bench::new(&session, &scene, &camera, SIZE);
        for (way, kernel) in [("tiles", "cone"), ("tiles", "gaussian"), ("discs", "cone"), ("discs", "gaussian")] {
            let settings = settings(&[("splat", way), ("kernel", kernel), ("downscale", "1")]);
            let mut seed = 7;
            for radius_in_pixels in [1e-4, 0.3, 0.8, 1.3, 2.1, 2.9, 3.5, 5.0, 8.0, 16.0, 30.0] {
                let [x, y] = [60.0 + random(&mut seed), 50.0 + random(&mut seed)];
                let position = bench.on_floor(x, y);
                let pixel = (bench.on_floor(x + 1.0, y) - position).length();
                let radius = radius_in_pixels * pixel;
                let photon = Landed { position, normal: DVec3::Y, flux: [1.0, 0.5, 2.0], radius };
                let light = bench.irradiance(&settings, &[photon]);
                let found = bench.flux_on_floor(&light);
                let error = (found / DVec3::new(1.0, 0.5, 2.0) - 1.0).abs().max_element();
                println!("{what}, {way}, {kernel}, {radius_in_pixels} pixels: flux off by {error:.2e}");
                assert!(error < 0.01, "{found}");
            }
        }
    }
}

/// Photons, their radius in pixels of 512, how much of the image they cover.
const CASES: [(usize, f64, f64); 6] = [
    (38_000, 8.0, 1.0),
    (38_000, 8.0, 0.4),
    (200_000, 8.0, 1.0),
    (200_000, 3.5, 1.0),
    (200_000, 3.5, 0.4),
    (0, 1.0, 1.0),
];

/// Seconds that all threads but this one have computed, on Linux: those of a software driver.
fn driver_seconds() -> f64 {
    let own = std::fs::read_link("/proc/thread-self").unwrap_or_default();
    let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let others = tasks.map(|task| task.path()).filter(|path| path.file_name() != own.file_name());
    let nanoseconds = |path: std::path::PathBuf| -> Option<f64> {
        std::fs::read_to_string(path.join("schedstat")).ok()?.split(' ').next()?.parse().ok()
    };
    others.filter_map(nanoseconds).sum::<f64>() * 1e-9
}

/// Milliseconds of the splatting's passes, at best, and of a frame in processor time over two cores, which other work disturbs less.
#[test]
#[ignore = "a measurement"]
fn times() {
    let session = Session::open();
    let scene = white_floor();
    let choice = |name: &str, all: &str| std::env::var(name).unwrap_or_else(|_| all.to_owned());
    for side in choice("SPLAT_SIDES", "512 1024").split(' ').map(|side| side.parse::<u32>().expect("a number")) {
        let mut bench = Bench::new(&session, &scene, &from_above(), [side; 2]);
        let pixel = (bench.on_floor(1.0, 0.0) - bench.on_floor(0.0, 0.0)).length() * f64::from(side) / 512.0;
        for (count, radius, spread) in CASES.into_iter().take(choice("SPLAT_CASES", "9").parse().expect("a number")) {
            let mut seed = 3;
            let photons: Vec<Landed> = (0..count)
                .map(|_| {
                    let place = [0, 1].map(|_| {
                        let flat = random(&mut seed) - 0.5;
                        f64::from(side) * (0.5 + spread * flat)
                    });
                    let radius = radius * pixel * (0.7 + 0.6 * random(&mut seed));
                    let position = bench.on_floor(place[0], place[1]);
                    Landed { position, normal: DVec3::Y, flux: [1.0; 3], radius }
                })
                .collect();
            for downscale in choice("SPLAT_DOWNSCALES", "1 2 4").split(' ') {
                for way in choice("SPLAT_WAYS", "tiles discs").split(' ') {
                    let settings = settings(&[("splat", way), ("downscale", downscale)]);
                    let mut best = std::collections::BTreeMap::<String, f64>::new();
                    let (mut total, mut computed) = (f64::MAX, f64::MAX);
                    for _ in 0..5 {
                        bench.store.invalidate();
                        let before = driver_seconds();
                        let passes = bench.run(&settings, &photons, Timing::Passes).1;
                        let mut sum = 0.0;
                        for pass in passes.iter().filter(|pass| pass.piece == "caustics/photons") {
                            let time = best.entry(pass.pass.clone()).or_insert(f64::MAX);
                            *time = time.min(pass.ms.unwrap_or(0.0));
                            sum += pass.ms.unwrap_or(0.0);
                        }
                        total = total.min(sum);
                        computed = computed.min((driver_seconds() - before) * 500.0);
                    }
                    let parts: Vec<String> =
                        best.iter().filter(|(_, ms)| **ms > 0.05).map(|(name, ms)| format!("{name} {ms:.2}")).collect();
                    println!(
                        "{side}² {count} r={radius} spread {spread} 1/{downscale} {way}: {total:.2} ms, computed {computed:.2} ms ({})",
                        parts.join(", ")
                    );
                }
            }
        }
    }
}
