//! Photons splatted into a view of a scene, without what makes them.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::scenes::{floor, lambert, view};
use super::session::Session;
use crate::caustics::photons::splat::{SplatInputs, splat};
use crate::caustics::photons::sums::TILES_AT_ONCE;
use crate::frame::camera::camera;
use crate::frame::gbuffer::{GBuffer, View, gbuffer};
use crate::frame::geometry::Geometry;
use crate::frame::octahedral::pack_direction;
use crate::frame::photons::records::LandedPhotons;
use crate::frame::scene_data::SceneData;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{Dependence, Graph, Store};
use crate::renderer::options::PhotonOptions;
use crate::renderer::{PassTiming, Preset, Settings, Technique, Timing};
use crate::scene::{CameraView, Projection, Scene};
use crate::shaders::types;

#[derive(Clone, Copy)]
pub(super) struct Landed {
    pub(super) position: DVec3,
    pub(super) normal: DVec3,
    pub(super) flux: [f32; 3],
    pub(super) radius: f64,
}

/// A view of a scene that photons are splatted in.
pub(super) struct Bench<'s> {
    pub(super) store: Store,
    scene: &'s Scene,
    data: SceneData,
    camera: types::Camera,
    pub(super) size: [u32; 2],
    /// The smaller radius of discs over the larger one, and the way that it points.
    pub(super) squeeze: (f64, DVec3),
    pub(super) tiles_at_once: usize,
}

impl<'s> Bench<'s> {
    pub(super) fn new(session: &Session, scene: &'s Scene, view: &CameraView, size: [u32; 2]) -> Bench<'s> {
        let store = session.store();
        let device = store.device().clone();
        let data = SceneData::update(&device, store.pipelines(), None, scene).expect("the scene fits the device");
        let camera = camera(view, size, data.origin);
        Bench { store, scene, data, camera, size, squeeze: (1.0, DVec3::X), tiles_at_once: TILES_AT_ONCE }
    }

    /// π·L of a white diffuse surface, which is E, and the passes.
    pub(super) fn run(
        &mut self,
        settings: &PhotonOptions,
        photons: &[Landed],
        timing: Timing,
    ) -> (Vec<DVec3>, Vec<PassTiming>) {
        let count = photons.len() as u32;
        let counts = [count.div_ceil(64), 1, 1, count, 6, count, 0, 0];
        let (ratio, towards) = self.squeeze;
        let ellipses = photons.iter().map(|photon| {
            let direction = towards.reject_from(photon.normal).normalize_or_zero().as_vec3();
            direction.extend((photon.radius * ratio) as f32).to_array()
        });
        let ellipses: Vec<[f32; 4]> = ellipses.chain([[0.0; 4]]).collect();
        let tiles_at_once = self.tiles_at_once;
        self.frame(photons, None, timing, |graph, buffer, photons| {
            let landed = LandedPhotons {
                photons,
                ellipses: graph.upload("photons.ellipses", &ellipses, Dependence::LIGHTS),
                counts: graph.upload("photons.counts", &counts, Dependence::LIGHTS),
                stage: 0,
                capacity: count + 1,
            };
            splat(graph, &SplatInputs { buffer, options: settings, length: 1.0, tiles_at_once }, &landed)
        })
    }

    /// The same of any way to make the slot of photons, whose records are two texels each, and a third if they have `ellipses`; one more holds nothing.
    pub(super) fn frame(
        &mut self,
        photons: &[Landed],
        ellipses: Option<f64>,
        timing: Timing,
        draw: impl FnOnce(&mut Graph<'_>, &GBuffer, BufferRef<[u32; 4]>) -> ImageRef,
    ) -> (Vec<DVec3>, Vec<PassTiming>) {
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
                let ellipse = ellipses.map(|ratio| {
                    let towards = photon.normal.any_orthonormal_vector().as_vec3();
                    [pack_direction(towards), ((photon.radius * ratio) as f32).to_bits(), 0, 0]
                });
                let record = [[x, y, z, normal], [red, green, blue, (photon.radius as f32).to_bits()]];
                record.into_iter().chain(ellipse)
            })
            .chain([[0; 4]; 3])
            .collect();
        let records = graph.upload("photons.landed", &words, Dependence::LIGHTS);
        let slot = draw(&mut graph, &buffer, records);
        let read = graph.read_back(slot);
        let mut executed = graph.run(timing).expect("a frame");
        let bytes = executed.take(read);
        let texels = bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&bytes);
        let color = |[red, green, blue, _]: [f32; 4]| DVec3::new(red.into(), green.into(), blue.into()) * PI;
        let colors: Vec<DVec3> = texels.into_iter().map(color).collect();
        assert!(colors.iter().all(|color| color.is_finite() && color.min_element() >= 0.0));
        (colors, executed.passes)
    }

    pub(super) fn irradiance(&mut self, settings: &PhotonOptions, photons: &[Landed]) -> Vec<DVec3> {
        self.run(settings, photons, Timing::Frame).0
    }

    /// Through a continuous place on the image, of length 1 along the camera's axis when perspective.
    pub(super) fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let axis = |axis: [f32; 3]| Vec3::from(axis).as_dvec3();
        let across = (2.0 * x / f64::from(self.size[0]) - 1.0) * axis(self.camera.right_scaled)
            + (2.0 * y / f64::from(self.size[1]) - 1.0) * axis(self.camera.down_scaled);
        let (eye, forward) = (axis(self.camera.position_rs) + self.data.origin, axis(self.camera.forward));
        if self.camera.depth_range > 0.0 { (eye + across, forward) } else { (eye, forward + across) }
    }

    /// The point of the plane y = 0 at a place on the image.
    pub(super) fn on_floor(&self, x: f64, y: f64) -> DVec3 {
        let (start, ray) = self.ray(x, y);
        start - ray * (start.y / ray.y)
    }

    /// The pixel that a point falls on, seen in perspective.
    pub(super) fn pixel_of(&self, point: DVec3) -> usize {
        let axis = |axis: [f32; 3]| Vec3::from(axis).as_dvec3();
        let (eye, forward) = (axis(self.camera.position_rs) + self.data.origin, axis(self.camera.forward));
        let away = (point - eye) / (point - eye).dot(forward);
        let place = |scaled: [f32; 3], side: u32| {
            let across = axis(scaled);
            let ndc = away.dot(across) / across.length_squared();
            (0.5 * (ndc + 1.0) * f64::from(side)).floor() as usize
        };
        place(self.camera.down_scaled, self.size[1]) * self.size[0] as usize
            + place(self.camera.right_scaled, self.size[0])
    }

    /// ΣE·A over the pixels, A the area of the plane y = 0 that each shows, W.
    pub(super) fn flux_on_floor(&self, irradiance: &[DVec3]) -> DVec3 {
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

pub(super) fn settings(changes: &[(&str, &str)]) -> PhotonOptions {
    let mut settings = Settings::new(Technique::Hybrid, Preset::Default);
    for (key, value) in [("footprint", "way")].iter().chain(changes) {
        settings.set(&format!("photons.{key}"), value).expect("a setting and its value");
    }
    settings.photons
}

pub(super) fn white_floor() -> Scene {
    floor(4.0, lambert([1.0; 3]))
}

/// Straight down from a height of 2 m.
pub(super) fn from_above() -> CameraView {
    view(DVec3::new(0.1, 2.0, -0.2), DVec3::new(0.1, 0.0, -0.2))
}

pub(super) fn oblique() -> CameraView {
    view(DVec3::new(0.1, 1.0, 2.0), DVec3::new(0.1, 0.0, 0.0))
}

pub(super) fn orthographic() -> CameraView {
    let projection = Projection::Orthographic { half_width: 1.0, half_height: 1.0, near: 0.1, far: 10.0 };
    CameraView::look_at(DVec3::new(0.0, 2.0, 1.0), DVec3::ZERO, DVec3::Y, projection)
}

/// A reproducible number in [0, 1).
pub(super) fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 40) as f64 / f64::from(1 << 24)
}

pub(super) const WAYS: [&str; 2] = ["tiles", "discs"];

pub(super) fn largest(light: &[DVec3]) -> f64 {
    light.iter().map(|color| color.max_element()).fold(0.0, f64::max)
}
