//! Rays for tests: made from seeds, traced through a hierarchy.

use ash::vk;
use glam::Vec3;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{Rng, SeedableRng};

use super::session::Session;
use crate::graph::{Dependence, Graph, Store};
use crate::renderer::Timing;
use crate::scene::bvh::Bvh;
use crate::shaders::groups::SceneRays;
use crate::shaders::trace::{Closest, Occluded};
use crate::shaders::types;

const NODES: vk::Format = vk::Format::R32G32B32A32_UINT;
pub(super) const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
pub(super) const NO_TRIANGLE: u32 = u32::MAX;

/// Origin, end, direction, nothing.
pub(super) type Ray = [[f32; 4]; 2];

pub(super) fn ray(origin: Vec3, direction: Vec3, end: f32) -> Ray {
    [origin.extend(end).to_array(), direction.extend(0.0).to_array()]
}

pub(super) struct Random(Pcg32);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(Pcg32::seed_from_u64(seed))
    }

    pub(super) fn below(&mut self, count: usize) -> usize {
        self.0.next_u32() as usize % count
    }

    /// From -1 to 1.
    pub(super) fn signed(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    pub(super) fn point(&mut self) -> Vec3 {
        Vec3::from_array([0; 3].map(|_| self.signed()))
    }
}

/// What rays meet, and how long the device took.
pub(super) struct Traced {
    pub(super) hits: Vec<types::Hit>,
    /// Whether anything lies on the ray.
    pub(super) blocked: Vec<bool>,
    /// Milliseconds for `hits` and for `blocked`.
    pub(super) ms: [f64; 2],
}

/// A hierarchy and nothing else of a scene.
pub(super) fn scene_rays(graph: &mut Graph<'_>, bvh: &Bvh) -> SceneRays {
    SceneRays {
        bvh_nodes: graph.upload("bvh.nodes", &bvh.nodes, Dependence::NONE).texels(NODES),
        bvh_triangles: graph.upload("bvh.triangles", &bvh.triangles, Dependence::NONE).texels(FLOATS),
        ..SceneRays::absent()
    }
}

pub(super) fn trace(session: &Session, bvh: &Bvh, rays: &[Ray]) -> Traced {
    trace_in(&mut session.store(), bvh, rays)
}

pub(super) fn trace_in(store: &mut Store, bvh: &Bvh, rays: &[Ray]) -> Traced {
    store.invalidate();
    let mut graph = Graph::new(store);
    let scene_rays = scene_rays(&mut graph, bvh);
    let list = graph.upload("rays", rays, Dependence::NONE);
    let hits = graph.buffer::<types::Hit>("hits", rays.len());
    let blocked = graph.buffer::<u32>("blocked", rays.len());
    let threads = [rays.len() as u32, 1, 1];
    let closest = Closest { scene_rays: scene_rays.clone(), rays: list.texels(FLOATS), hits: hits.write() };
    graph.pass("test/closest", closest).threads(threads);
    let occluded = Occluded { scene_rays, rays: list.texels(FLOATS), blocked: blocked.write() };
    graph.pass("test/occluded", occluded).threads(threads);
    let reads = (graph.read_back_buffer(hits), graph.read_back_buffer(blocked));
    let mut executed = graph.run(Timing::Passes).expect("a frame");
    let words = bytemuck::pod_collect_to_vec::<u8, u32>(&executed.take(reads.1));
    let ms = |pass: usize| executed.passes[pass].ms.expect("it ran");
    Traced {
        ms: [ms(0), ms(1)],
        hits: bytemuck::pod_collect_to_vec(&executed.take(reads.0)),
        blocked: words.into_iter().map(|word| word == 1).collect(),
    }
}
