//! One frame with its intermediate results read back: light views, virtual point lights, G-buffer.

use glam::{DVec3, UVec4, Vec3, Vec4};

use super::session::Session;
use crate::diffuse::{rsm, volumes, vpl};
use crate::frame::gbuffer::GBuffer;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::ReflectiveViews;
use crate::frame::rays::TracedScene;
use crate::frame::scene_data::SceneData;
use crate::frame::twins;
use crate::graph::bindings::ImageRef;
use crate::graph::{Graph, ReadBack};
use crate::method::{FrameCx, Rays};
use crate::renderer::declare::{Shared, inputs_of, wanted_methods};
use crate::renderer::{DiffuseMethod, FrameRequest, Settings, Slot, SpecularMethod, Timing};
use crate::scene::{Bounds, Scene};
use crate::shaders::types;
use crate::specular::{cubemap, radiance_maps};

/// The scene and its lights as the device has them.
pub(super) struct Probe {
    pub(super) set: LightSet,
    pub(super) camera: types::Camera,
    pub(super) origin: DVec3,
    reads: Vec<Vec<u8>>,
}

/// A declared frame, and what its methods made on the way to their slots.
pub(super) struct Declared {
    pub(super) gbuffer: GBuffer,
    pub(super) reflective: Option<ReflectiveViews>,
    pub(super) rsm: Option<rsm::Made>,
    pub(super) volumes: Option<volumes::Made>,
    pub(super) vpl: Option<vpl::Made>,
    pub(super) maps: Option<radiance_maps::Made>,
    pub(super) cubemaps: Option<cubemap::Made>,
    slots: Vec<(Slot, ImageRef)>,
}

impl Declared {
    fn slot(&self, slot: Slot) -> Option<ImageRef> {
        self.slots.iter().find(|(known, _)| *known == slot).map(|(_, image)| *image)
    }
}

/// Makes a frame and reads back what `wanted` names.
pub(super) fn probe(
    session: &Session,
    scene: &Scene,
    settings: &Settings,
    request: &FrameRequest,
    wanted: impl Fn(&mut Graph<'_>, &Declared) -> Vec<ReadBack>,
) -> Probe {
    let mut store = session.store();
    let device = store.device().clone();
    let data = SceneData::update(&device, store.pipelines(), None, scene).expect("the scene fits the device");
    let detail = settings.lights.detail(settings.shadow_map.filter_radius);
    let set = LightSet::update(LightSet::default(), scene, &data, detail, &device);
    let camera = crate::frame::camera::camera(&request.camera, request.size, data.origin);
    let methods = wanted_methods(settings, &scene.facts(), &set, |slot| request.wants(slot));
    let inputs = inputs_of(&methods);
    let traced =
        (inputs.rays != Rays::None).then(|| TracedScene::new(&device, scene).expect("the scene fits the device"));
    let mut graph = Graph::new(&mut store);
    let shared = Shared::declare(&mut graph, scene, &data, request, settings);
    let frame = shared.inputs(&mut graph, &data, &set, traced.as_ref(), inputs, settings);
    let mut declared = Declared {
        gbuffer: shared.surface.clone(),
        reflective: frame.lights.as_ref().and_then(|lights| lights.reflective),
        rsm: None,
        volumes: None,
        vpl: None,
        maps: None,
        cubemaps: None,
        slots: Vec::new(),
    };
    for wanted in methods.iter().filter(|wanted| wanted.skipped.is_none()) {
        let cx = &mut FrameCx::new(&mut graph, &frame, wanted.inputs);
        let image = match settings.methods.diffuse {
            DiffuseMethod::Rsm if wanted.method.slot == Slot::Diffuse => {
                Some(declared.rsm.insert(rsm::rsm(cx, &settings.rsm)).diffuse)
            }
            DiffuseMethod::Volumes if wanted.method.slot == Slot::Diffuse => {
                Some(declared.volumes.insert(volumes::volumes(cx, &settings.volumes)).diffuse)
            }
            DiffuseMethod::Vpl if wanted.method.slot == Slot::Diffuse => {
                Some(declared.vpl.insert(vpl::vpl(cx, &settings.vpl)).diffuse)
            }
            _ if wanted.method.slot == Slot::Specular && settings.methods.specular == SpecularMethod::RadianceMaps => {
                Some(declared.maps.insert(radiance_maps::radiance_maps(cx, &settings.radiance_maps)).specular)
            }
            _ if wanted.method.slot == Slot::Specular && settings.methods.specular == SpecularMethod::Cubemap => {
                (wanted.method.prepare)(cx, settings);
                declared.cubemaps = cubemap::cubemap(cx, &settings.cubemap);
                declared.cubemaps.as_ref().map(|made| made.specular)
            }
            _ => (wanted.method.declare)(cx, settings).expect("the device allows it"),
        };
        declared.slots.extend(image.map(|image| (wanted.method.slot, image)));
    }
    let wanted = wanted(&mut graph, &declared);
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    let reads = wanted.into_iter().map(|read_back| executed.take(read_back)).collect();
    Probe { set, camera, origin: data.origin, reads }
}

/// The flux image of the light views.
pub(super) fn light_flux(graph: &mut Graph<'_>, declared: &Declared) -> ReadBack {
    graph.read_back(declared.reflective.expect("some pass takes reflected flux").flux)
}

/// The virtual point lights of `rsm`.
pub(super) fn vpls(graph: &mut Graph<'_>, declared: &Declared) -> ReadBack {
    graph.read_back_buffer(declared.rsm.as_ref().expect("rsm runs").vpls)
}

pub(super) fn slot(graph: &mut Graph<'_>, declared: &Declared, slot: Slot) -> ReadBack {
    graph.read_back(declared.slot(slot).expect("something fills the slot"))
}

/// What a pixel's diffuse light is checked by: depth, surface, the slot, and the virtual point lights.
pub(super) fn diffuse_and_its(lights: ReadBack, graph: &mut Graph<'_>, declared: &Declared) -> Vec<ReadBack> {
    let buffer = &declared.gbuffer;
    let [depth, surface] = [buffer.depth, buffer.surface].map(|image| graph.read_back(image));
    vec![depth, surface, slot(graph, declared, Slot::Diffuse), lights]
}

fn word(bytes: &[u8]) -> u32 {
    u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

/// A virtual point light as the shaders unpack it.
pub(super) struct Vpl {
    pub(super) texels: [Vec4; 2],
    pub(super) flux: DVec3,
}

/// A pixel of the G-buffer.
pub(super) struct Pixel {
    pub(super) position_rs: DVec3,
    pub(super) normal: DVec3,
    pub(super) albedo: DVec3,
}

impl Vpl {
    /// The cosines at the light and at the pixel, multiplied, and the square of their distance, m².
    pub(super) fn cosines_and_square(&self, pixel: &Pixel) -> (f64, f64) {
        let difference = self.texels[0].truncate().as_dvec3() - pixel.position_rs;
        let squared = difference.length_squared();
        let toward = difference / squared.sqrt();
        let normal = twins::unpack_direction_in_float_unnormalized(self.texels[1].w).as_dvec3().normalize();
        (normal.dot(-toward).max(0.0) * pixel.normal.dot(toward).max(0.0), squared)
    }
}

impl Probe {
    /// The sums of what all texels of the light views reflect, and of what all virtual point lights carry, W. `reads` are the flux image and
    /// the lights.
    pub(super) fn reflected_and_carried(&self, reads: [usize; 2], count: u32) -> (DVec3, DVec3) {
        let vpls = self.vpls(reads[1]);
        assert_eq!(vpls.len(), count as usize);
        assert!(vpls.iter().all(|vpl| vpl.flux.min_element() >= 0.0 && vpl.texels[0].w > 0.0));
        (self.flux_of_lights(reads[0]).into_iter().sum(), vpls.iter().map(|vpl| vpl.flux).sum())
    }

    /// That the virtual point lights lie on the straight walls of a room of these bounds, and face it.
    pub(super) fn assert_vpls_on_walls(&self, read: usize, bounds: &Bounds) {
        for vpl in self.vpls(read) {
            let point = vpl.texels[0].truncate().as_dvec3() + self.origin;
            let normal = twins::unpack_direction_in_float_unnormalized(vpl.texels[1].w).normalize();
            let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
            assert!(normal[axis].abs() > 0.999, "every wall is straight, not {normal}");
            let wall = if normal[axis] > 0.0 { bounds.min[axis] } else { bounds.max[axis] };
            let off = (point[axis] - wall).abs();
            assert!(off < 1e-3 * bounds.radius(), "a light {off} m off its wall at {point}, normal {normal}");
        }
    }

    pub(super) fn floats(&self, read: usize) -> Vec<f32> {
        self.reads[read].chunks_exact(4).map(|bytes| f32::from_bits(word(bytes))).collect()
    }

    /// RGB of an image of four floats a texel.
    pub(super) fn colors(&self, read: usize) -> Vec<DVec3> {
        let floats = self.floats(read);
        floats.chunks_exact(4).map(|texel| Vec3::new(texel[0], texel[1], texel[2]).as_dvec3()).collect()
    }

    /// What the texels of each light's views reflect, W. `read` is the flux image.
    pub(super) fn flux_of_lights(&self, read: usize) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.set.lights.len()];
        let bytes = &self.reads[read];
        for view in self.set.atlas.views.iter().map(|view| view.record) {
            let [[left, top], [width, height]] =
                [view.rect_origin, view.rect_size].map(|pair| pair.map(i32::cast_unsigned));
            let mut sum = DVec3::ZERO;
            for y in top..top + height {
                for x in left..left + width {
                    let at = 16 * (y * self.set.atlas.size[0] + x) as usize;
                    let channel = |index: usize| f64::from(f32::from_bits(word(&bytes[at + 4 * index..])));
                    sum += DVec3::new(channel(0), channel(1), channel(2));
                }
            }
            sums[view.light as usize] += sum * f64::from(view.flux_scale);
        }
        sums
    }

    pub(super) fn vpls(&self, read: usize) -> Vec<Vpl> {
        let floats = self.floats(read);
        let unpack = |texels: &[f32]| {
            let texels = [Vec4::from_slice(&texels[..4]), Vec4::from_slice(&texels[4..])];
            Vpl { texels, flux: twins::vpl_flux(texels).as_dvec3() }
        };
        floats.chunks_exact(8).map(unpack).collect()
    }

    /// The G-buffer's pixels, `None` where there is no surface. `reads` are its depth and its surface texels.
    pub(super) fn pixels(&self, reads: [usize; 2], size: [u32; 2]) -> Vec<Option<Pixel>> {
        let depths = self.floats(reads[0]);
        let pixel = |(index, (depth, bytes)): (u32, (&f32, &[u8]))| {
            let texel = UVec4::new(word(bytes), word(&bytes[4..]), word(&bytes[8..]), word(&bytes[12..]));
            let (normal, _, albedo, _) = twins::unpack_surface(texel);
            let ray = self.ray(index % size[0], index / size[0], size);
            (*depth > 0.0).then(|| Pixel {
                position_rs: self.eye() + ray * (f64::from(self.camera.near) / f64::from(*depth)),
                normal: normal.as_dvec3(),
                albedo: albedo.as_dvec3(),
            })
        };
        (0..).zip(depths.iter().zip(self.reads[reads[1]].chunks_exact(16))).map(pixel).collect()
    }

    /// Where the camera is, in render space.
    pub(super) fn eye(&self) -> DVec3 {
        Vec3::from(self.camera.position_rs).as_dvec3()
    }

    /// Through the centre of a pixel, of length 1 along the camera's axis.
    pub(super) fn ray(&self, x: u32, y: u32, size: [u32; 2]) -> DVec3 {
        let axis = |axis: [f32; 3]| Vec3::from(axis).as_dvec3();
        let ndc = |place: u32, side: u32| (2.0 * f64::from(place) + 1.0) / f64::from(side) - 1.0;
        axis(self.camera.forward)
            + ndc(x, size[0]) * axis(self.camera.right_scaled)
            + ndc(y, size[1]) * axis(self.camera.down_scaled)
    }
}
