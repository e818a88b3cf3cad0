//! Scenes as per-pixel lists and as a hierarchy of triangles, and rays through either.

use glam::Vec3;

use super::rays::{NO_TRIANGLE, Random, Ray, ray, trace_in};
use super::session::Session;
use crate::caustics::photons::lists::{build, build_from};
use crate::caustics::photons::scene_lists::ListInputs;
use crate::caustics::photons::{lines, march};
use crate::frame::camera::camera;
use crate::frame::geometry::Geometry;
use crate::frame::photons::records::PhotonRays;
use crate::frame::scene_data::SceneData;
use crate::frame::twins::unpack_direction;
use crate::graph::{Dependence, Graph, Store};
use crate::renderer::options::{PhotonOptions, PhotonTracing};
use crate::renderer::{PassTiming, Preset, Settings, Technique, Timing};
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::scene::{CameraView, Scene};
use crate::shaders::types;

pub(super) const HIT_NONE: u32 = u32::MAX;

pub(super) fn photon_options(changes: &[(&str, &str)]) -> PhotonOptions {
    let mut settings = Settings::new(Technique::Hybrid, Preset::Default);
    for (key, value) in changes {
        settings.set(&format!("photons.{key}"), value).expect("a setting and its value");
    }
    settings.photons
}

/// A scene ready for lists and for the hierarchy.
pub(super) struct Stage {
    pub(super) scene: Scene,
    pub(super) data: SceneData,
    pub(super) store: Store,
    pub(super) triangles: Vec<BvhTriangle>,
    pub(super) bvh: Bvh,
}

impl Stage {
    pub(super) fn new(session: &Session, scene: Scene) -> Stage {
        let store = session.store();
        let device = store.device().clone();
        let data = SceneData::update(&device, store.pipelines(), None, &scene).expect("the scene fits the device");
        let triangles = Bvh::triangles_of(&scene, data.origin, |_| 0);
        let bvh = Bvh::build(&triangles);
        Stage { scene, data, store, triangles, bvh }
    }

    pub(super) fn view(&self) -> CameraView {
        self.scene.camera_view(None).expect("a view")
    }

    /// Rays from free points of the scene's box.
    pub(super) fn free_rays(&self, count: usize, seed: u64) -> Vec<Ray> {
        let mut random = Random::new(seed);
        let bounds = self.scene.bounds().expect("triangles");
        let half = ((bounds.max - bounds.min) * 0.5).as_vec3();
        (0..count).map(|_| ray(random.point() * half * 0.999, direction(&mut random), f32::MAX)).collect()
    }

    /// Rays from points of surfaces into the side that other rays saw them from.
    pub(super) fn surface_rays(&mut self, count: usize, seed: u64) -> Vec<Ray> {
        let from = self.free_rays(count, seed);
        let found = trace_in(&mut self.store, &self.bvh, &from);
        let mut random = Random::new(seed + 1);
        let lift = 1e-5 * self.data.radius as f32;
        let leave = |(from, hit): (&Ray, &types::Hit)| {
            let [start, along] = from.map(|texel| Vec3::from_slice(&texel[..3]));
            let normal = self.normal(hit.triangle);
            let side = if normal.dot(along) < 0.0 { normal } else { -normal };
            let way = direction(&mut random);
            let way = if way.dot(side) < 0.0 { -way } else { way };
            ray(start + along * hit.distance + side * lift, way, f32::MAX)
        };
        from.iter().zip(&found.hits).filter(|(_, hit)| hit.triangle != NO_TRIANGLE).map(leave).collect()
    }

    pub(super) fn normal(&self, triangle: u32) -> Vec3 {
        let [a, b, c] = self.triangles[triangle as usize].corners.map(Vec3::from);
        (b - a).cross(c - a).normalize_or_zero()
    }

    pub(super) fn lists(&mut self, settings: &PhotonOptions, pool: Option<usize>) -> Lists {
        let camera = camera(&self.view(), [64, 64], self.data.origin);
        let mut graph = Graph::new(&mut self.store);
        let geometry = Geometry::import(&mut graph, &self.data);
        let inputs = ListInputs { data: &self.data, geometry: &geometry, camera: Some(&camera), options: settings };
        let lists = match pool {
            None => build(&mut graph, &inputs),
            Some(nodes) => build_from(&mut graph, &inputs, nodes),
        };
        let reads = [
            graph.read_back_buffer(lists.pixels),
            graph.read_back_buffer(lists.nodes),
            graph.read_back_buffer(lists.node_count),
        ];
        let mut executed = graph.run(Timing::Passes).expect("a frame");
        let [pixels, nodes, count] = reads.map(|read| bytemuck::pod_collect_to_vec::<u8, u32>(&executed.take(read)));
        Lists { pixels, nodes, count: count[0], outgrown: executed.outgrown, passes: executed.passes }
    }

    pub(super) fn trace(&mut self, settings: &PhotonOptions, rays: &[Ray]) -> Found {
        self.store.invalidate();
        self.trace_again(settings, rays, 0)
    }

    /// Lists that are made already stand; another `salt` traces the rays again.
    pub(super) fn trace_again(&mut self, settings: &PhotonOptions, rays: &[Ray], salt: u32) -> Found {
        self.trace_in(settings, rays, salt, None)
    }

    /// Through these lists, if there are any, in place of those that the frame makes.
    pub(super) fn trace_in(
        &mut self,
        settings: &PhotonOptions,
        rays: &[Ray],
        salt: u32,
        held: Option<&Lists>,
    ) -> Found {
        let camera = camera(&self.view(), [64, 64], self.data.origin);
        let bits = |vector: &[f32; 4]| [vector[0].to_bits(), vector[1].to_bits(), vector[2].to_bits(), 0];
        let records: Vec<[u32; 4]> =
            rays.iter().flat_map(|[start, way]| [bits(start), bits(way), [0, 0, 0, 0]]).collect();
        let count = rays.len() as u32;
        loop {
            let mut graph = Graph::new(&mut self.store);
            let geometry = Geometry::import(&mut graph, &self.data);
            let inputs = ListInputs { data: &self.data, geometry: &geometry, camera: Some(&camera), options: settings };
            let mut lists = build(&mut graph, &inputs);
            if let Some(held) = held {
                let (pixels, nodes) = held.reversed();
                lists.pixels = graph.upload("reversed.pixels", &pixels, Dependence::NONE);
                lists.nodes = graph.upload("reversed.nodes", &nodes, Dependence::NONE);
            }
            let counts = [count.div_ceil(64), 1, 1, count, 6, count, 0, salt];
            let counts = graph.upload("counts", &counts, Dependence::NONE);
            // A record more than there are rays: there may be none.
            let padded: Vec<[u32; 4]> = records.iter().copied().chain([[0; 4]; 3]).collect();
            let capacity = count + 1;
            let hits = graph.buffer("hits", 4 * capacity as usize);
            let of_test = graph.upload("rays", &padded, Dependence::NONE);
            let traced = PhotonRays { rays: of_test, hits, ..PhotonRays::declare(&mut graph, 0, capacity) };
            match settings.trace {
                PhotonTracing::Lines => lines::trace(&mut graph, &lists, &traced, counts),
                _ => march::trace(&mut graph, &lists, &traced, counts),
            }
            let read = graph.read_back_buffer(hits);
            let mut executed = graph.run(Timing::Passes).expect("a frame");
            if executed.outgrown.is_empty() {
                let words: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(&executed.take(read));
                return Found { hits: words[..rays.len()].to_vec(), passes: executed.passes };
            }
        }
    }

    pub(super) fn compare(&mut self, settings: &PhotonOptions, rays: &[Ray]) -> Comparison {
        let found = self.trace(settings, rays);
        let truth = trace_in(&mut self.store, &self.bvh, rays);
        let bounds = self.scene.bounds().expect("triangles");
        let texel = (bounds.max - bounds.min).max_element() as f32 / settings.resolution as f32;
        let mut compared = Comparison { rays: rays.len(), ..Comparison::default() };
        for (hit, real) in found.hits.iter().zip(&truth.hits) {
            let distance = f32::from_bits(hit[0]);
            match (hit[0] != HIT_NONE, real.triangle != NO_TRIANGLE) {
                (false, false) => compared.right += 1,
                (false, true) => compared.missed += 1,
                (true, false) => compared.wrong += 1,
                (true, true) => {
                    let off = (distance - real.distance).abs() / texel;
                    let normal = unpack_direction(hit[1]);
                    let same = normal.dot(self.normal(real.triangle)) > 0.9;
                    if off < 1.0 && same {
                        compared.right += 1;
                        compared.error += f64::from(off);
                    } else if off < 3.0 {
                        compared.near += 1;
                    } else {
                        compared.wrong += 1;
                    }
                }
            }
        }
        compared.error /= compared.right.max(1) as f64;
        compared
    }
}

/// All directions from the middle of the scene, neighbours side by side.
pub(super) fn coherent_rays(side: u16) -> Vec<Ray> {
    let at = |index: u16| (2.0 * f32::from(index) + 1.0) / f32::from(side) - 1.0;
    let places = (0..side).flat_map(|y| (0..side).map(move |x| (at(x), at(y))));
    let way = |(x, y): (f32, f32)| {
        let z = 1.0 - x.abs() - y.abs();
        let fold = (-z).max(0.0);
        Vec3::new(x - fold * x.signum(), y - fold * y.signum(), z).normalize()
    };
    places.map(|place| ray(Vec3::new(0.013, 0.017, 0.019), way(place), f32::MAX)).collect()
}

pub(super) fn direction(random: &mut Random) -> Vec3 {
    loop {
        let point = random.point();
        if (1e-3..1.0).contains(&point.length_squared()) {
            return point.normalize();
        }
    }
}

#[derive(Debug, Default)]
pub(super) struct Comparison {
    pub(super) rays: usize,
    /// The same surface within a texel of the distance; nothing where there is nothing.
    pub(super) right: usize,
    /// Another surface within three texels.
    pub(super) near: usize,
    pub(super) missed: usize,
    pub(super) wrong: usize,
    /// Mean error of the distance of the right ones, texels.
    pub(super) error: f64,
}

impl std::fmt::Display for Comparison {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let share = |count: usize| 100.0 * count as f64 / self.rays as f64;
        write!(
            f,
            "right {:.3}% (off by {:.5} texels), near {:.3}%, missed {:.3}%, wrong {:.3}%",
            share(self.right),
            self.error,
            share(self.near),
            share(self.missed),
            share(self.wrong)
        )
    }
}

pub(super) struct Lists {
    pub(super) pixels: Vec<u32>,
    pub(super) nodes: Vec<u32>,
    pub(super) count: u32,
    pub(super) outgrown: Vec<(String, [usize; 2])>,
    pub(super) passes: Vec<PassTiming>,
}

pub(super) const NO_NODE: u32 = u32::MAX;

impl Lists {
    /// The nodes of a texel: depth, normal, next, material.
    pub(super) fn of_texel(&self, texel: usize) -> Vec<[u32; 4]> {
        let node = |index: u32| -> Option<[u32; 4]> {
            let first = 4 * index as usize;
            (index != NO_NODE).then(|| self.nodes[first..first + 4].try_into().expect("four words"))
        };
        std::iter::successors(node(self.pixels[4 * texel]), |found| node(found[2])).collect()
    }

    /// The same lists, from their ends.
    pub(super) fn reversed(&self) -> (Vec<u32>, Vec<[u32; 4]>) {
        let mut pixels = self.pixels.clone();
        let mut nodes: Vec<[u32; 4]> = self.nodes.chunks_exact(4).map(|node| node.try_into().expect("four")).collect();
        for head in pixels.iter_mut().step_by(4) {
            let (mut index, mut before) = (*head, NO_NODE);
            while index != NO_NODE {
                let next = std::mem::replace(&mut nodes[index as usize][2], before);
                (before, index) = (index, next);
            }
            *head = before;
        }
        (pixels, nodes)
    }
}

pub(super) struct Found {
    pub(super) hits: Vec<[u32; 4]>,
    pub(super) passes: Vec<PassTiming>,
}

impl Found {
    pub(super) fn ms(&self, pass: &str) -> f64 {
        let of = self.passes.iter().filter(|timing| timing.pass.starts_with(pass));
        of.filter_map(|timing| timing.ms).sum()
    }

    pub(super) fn work(&self, pass: &str, name: &str) -> u64 {
        let of = self.passes.iter().find(|timing| timing.pass.starts_with(pass) && timing.work.contains_key(name));
        of.map_or(0, |timing| timing.work[name])
    }
}
