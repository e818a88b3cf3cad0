//! The path tracer: waves of paths through small kernels, sums of what they find per slot.
//!
//! A wave holds some samples of a run of pixels, one path each. Its paths advance together, vertex by vertex, through the kernels of
//! [`super::camera_paths`]; each leaves a queue of the paths that go on, and the next one is dispatched for so many. Nothing two paths do
//! touches the same memory, so the same samples give the same bits on one device.

use std::sync::Arc;

use super::camera_paths::{self, Sums, Wave};
use super::estimate::{Estimating, Estimator, Samples, Work};
use super::light_paths::{self, Splats, Swarm, add_splats};
use super::options::PathOptions;
use super::paths::Paths;
use super::sums::{SlotSums, scatter_sums, seed_of_half, seed_of_sample};
use super::view::{EstimateRequest, LIGHT_PATHS_PER_PIXEL, View};
use crate::frame::rays::TracedScene;
use crate::graph::{Graph, GraphDescription};
use crate::slot::CausticPaths;
use crate::vulkan::{Pipelines, VulkanError};

/// Paths of a wave at most: on a GPU enough to fill it, on a CPU few enough to stay near the caches.
const WAVE_PATHS: u32 = 1 << 18;
/// Vertices that one submission advances a wave by.
const DEPTHS_PER_SUBMISSION: u32 = 12;

/// Why lights send out no paths ([`TracedScene::needs_light_paths`]).
const NO_LIGHT_PATHS: &str = "no glossy surface, or no light but the sky's, or direct light alone";

/// Traces paths through one scene.
pub(crate) struct PathTracer {
    work: Work,
}

/// Of the time that samples take, about, where lights send out paths too.
const CAMERA_SHARE: f64 = 0.5;

impl PathTracer {
    pub(crate) fn new(pipelines: &Arc<Pipelines>) -> Result<PathTracer, VulkanError> {
        Ok(PathTracer { work: Work::new(pipelines)? })
    }

    /// Lets the lights of the scene send out paths or not, whatever it contains: the expectation is the same. Only where something
    /// scatters specularly do paths carry what their weights need.
    #[cfg(test)]
    pub(crate) fn set_light_paths(&mut self, wanted: bool) {
        let scene = self.work.scene.as_mut().and_then(Arc::get_mut).expect("a scene that nobody else holds");
        scene.light_paths = wanted && scene.facts.specular && scene.emitter_count > 0;
    }

    /// The picture that a request asks for of the scene.
    pub(crate) fn view(&self, request: &EstimateRequest) -> View {
        let origin = self.work.scene.as_ref().map(|scene| scene.origin).unwrap_or_default();
        View::new(request, origin)
    }

    /// The sums over samples `first .. first + count` of half `half` of every pixel.
    pub(crate) fn sums(&mut self, view: &View, half: u32, first: u32, count: u32) -> Result<SlotSums, VulkanError> {
        let [width, height] = view.size;
        let blocks = width.div_ceil(8) * height.div_ceil(8);
        let pixels = width as usize * height as usize;
        let mut sums = SlotSums { samples: count, slots: std::array::from_fn(|_| vec![[0.0; 3]; pixels]) };
        // Runs of blocks of equal length, so that the memory serves all.
        let blocks_per_run = blocks_per_run(blocks);
        for first_block in (0..blocks).step_by(blocks_per_run as usize) {
            let block_count = blocks_per_run.min(blocks - first_block);
            let texels = self.trace_from_camera(view, [first_block, block_count], half, [first, count])?;
            scatter_sums(&mut sums, &texels, view.size, [first_block, block_count]);
        }
        let scene = self.work.scene();
        if view.needs_light_paths(&scene) {
            self.trace_from_lights(view, half, [first, count], &mut sums)?;
        } else {
            self.work.cost.skip("particle", "emit", NO_LIGHT_PATHS);
        }
        Ok(sums)
    }

    /// The sums of the pixels of some blocks: [`Slot::ALL`] after each other, in the order of paths.
    fn trace_from_camera(
        &mut self,
        view: &View,
        [first_block, block_count]: [u32; 2],
        half: u32,
        [first, count]: [u32; 2],
    ) -> Result<Vec<[f32; 4]>, VulkanError> {
        let scene = self.work.scene();
        let capacity = capacity(&scene, view, count);
        let samples_per_wave = (capacity / (64 * block_count)).min(count);
        let mut texels = Vec::new();
        for done in (0..count).step_by(samples_per_wave as usize) {
            let wave = Wave {
                first_block,
                block_count,
                sample_count: samples_per_wave.min(count - done),
                first_sample: first + done,
                seed: seed_of_half(view.seed, half),
            };
            let mut depth = 0;
            loop {
                let mut graph = Graph::going_on(&mut self.work.store);
                let paths = Paths::declare(&mut graph, &scene, view, capacity);
                // What is added to later: memory that a submission does not name is returned.
                let _sums = Sums::declare(&mut graph, &wave);
                if depth == 0 {
                    if done == 0 {
                        graph.fill_buffer("path/clear-radiance", paths.radiance, 0);
                    }
                    camera_paths::generate(&mut graph, &paths, view, &wave);
                }
                let until = last_depth(view.camera_bounces(), depth, 1);
                for depth in depth..until {
                    camera_paths::advance(&mut graph, &paths, &scene, view, depth);
                }
                depth = until;
                graph.want_buffer(paths.radiance);
                let totals = paths.want(&mut graph);
                let executed = graph.run(self.work.timing)?;
                if self.work.add_step(executed, totals) == 0 {
                    break;
                }
            }
            let mut graph = Graph::going_on(&mut self.work.store);
            let paths = Paths::declare(&mut graph, &scene, view, capacity);
            let sums = Sums::declare(&mut graph, &wave);
            if done == 0 {
                sums.clear(&mut graph);
            }
            sums.add(&mut graph, &paths, &wave);
            graph.want_buffer(paths.radiance);
            let last = done + wave.sample_count == count;
            let read_back = last.then(|| sums.read_back(&mut graph));
            let mut executed = graph.run(self.work.timing)?;
            if let Some(read_back) = read_back {
                texels = bytemuck::pod_collect_to_vec(&executed.take(read_back));
            }
            self.work.cost.add(executed);
            let samples = f64::from(done + wave.sample_count) / f64::from(count);
            let blocks = view.size[0].div_ceil(8) * view.size[1].div_ceil(8);
            let part = (f64::from(first_block) + f64::from(block_count) * samples) / f64::from(blocks);
            self.work.reached(part * if scene.needs_light_paths(view.bounces) { CAMERA_SHARE } else { 1.0 });
        }
        Ok(texels)
    }

    /// Adds what light paths find, one path a pixel and sample.
    fn trace_from_lights(
        &mut self,
        view: &View,
        half: u32,
        [first, count]: [u32; 2],
        sums: &mut SlotSums,
    ) -> Result<(), VulkanError> {
        let scene = self.work.scene();
        let limit = self.work.store.device().limits().max_storage_buffer_range;
        let all = view.light_path_count();
        let capacity = capacity(&scene, view, count);
        for sample in first..first + count {
            let part = f64::from(sample - first) / f64::from(count);
            self.work.reached(CAMERA_SHARE + (1.0 - CAMERA_SHARE) * part);
            for first_path in (0..all).step_by(capacity as usize) {
                let swarm = Swarm {
                    first_path: first_path as u32,
                    path_count: (all - first_path).min(u64::from(capacity)) as u32,
                    seed: seed_of_sample(seed_of_half(view.seed, half), sample),
                };
                let mut depth = 0;
                loop {
                    let mut graph = Graph::going_on(&mut self.work.store);
                    let paths = Paths::declare(&mut graph, &scene, view, capacity);
                    let splats = Splats::declare(&mut graph, &scene, view, limit)?;
                    if depth == 0 {
                        if sample == first && first_path == 0 {
                            splats.clear(&mut graph);
                        }
                        light_paths::emit(&mut graph, &paths, &scene, view, &swarm);
                    }
                    let until = last_depth(view.bounces, depth, 0);
                    for depth in depth..until {
                        light_paths::advance(&mut graph, &paths, &splats, &scene, view, depth);
                    }
                    depth = until;
                    splats.want(&mut graph);
                    let totals = paths.want(&mut graph);
                    let executed = graph.run(self.work.timing)?;
                    if self.work.add_step(executed, totals) == 0 {
                        break;
                    }
                }
            }
        }
        let mut graph = Graph::going_on(&mut self.work.store);
        let splats = Splats::declare(&mut graph, &scene, view, limit)?;
        let read_back = splats.read_back(&mut graph);
        let mut executed = graph.run(self.work.timing)?;
        add_splats(sums, &executed.take(read_back), &scene);
        self.work.cost.add(executed);
        Ok(())
    }
}

impl Estimating for PathTracer {
    fn work(&mut self) -> &mut Work {
        &mut self.work
    }

    fn add_up(
        &mut self,
        request: &EstimateRequest,
        half: u32,
        first: u32,
        count: u32,
    ) -> Result<SlotSums, VulkanError> {
        let view = self.view(request);
        self.sums(&view, half, first, count)
    }

    fn describe(&mut self, request: &EstimateRequest) -> Result<GraphDescription, VulkanError> {
        let scene = self.work.scene();
        let view = &self.view(request);
        let limit = self.work.store.device().limits().max_storage_buffer_range;
        let block_count = blocks_per_run(view.size[0].div_ceil(8) * view.size[1].div_ceil(8));
        let wave = Wave { first_block: 0, block_count, sample_count: 1, first_sample: 0, seed: view.seed };
        let mut graph = Graph::going_on(&mut self.work.store);
        let paths = Paths::declare(&mut graph, &scene, view, capacity(&scene, view, 1));
        let sums = Sums::declare(&mut graph, &wave);
        camera_paths::generate(&mut graph, &paths, view, &wave);
        for depth in 0..last_depth(view.camera_bounces(), 0, 1).min(2) {
            camera_paths::advance(&mut graph, &paths, &scene, view, depth);
        }
        sums.add(&mut graph, &paths, &wave);
        if view.needs_light_paths(&scene) {
            let splats = Splats::declare(&mut graph, &scene, view, limit)?;
            let swarm = Swarm { first_path: 0, path_count: paths.capacity, seed: view.seed };
            light_paths::emit(&mut graph, &paths, &scene, view, &swarm);
            for depth in 0..2 {
                light_paths::advance(&mut graph, &paths, &splats, &scene, view, depth);
            }
            splats.want(&mut graph);
        } else {
            graph.skip("particle/emit", NO_LIGHT_PATHS);
        }
        paths.want(&mut graph);
        Ok(graph.describe())
    }
}

/// Path tracing with next-event estimation, and light tracing for what it finds badly.
pub(crate) struct Path;

impl Estimator for Path {
    const NAME: &'static str = "path";
    const FIRST_PASS: [&'static str; 2] = ["path", "generate"];
    const SHADERS: &'static [&'static str] = &["path/*", "particle/*"];
    type Options = PathOptions;

    fn samples(options: &PathOptions) -> Samples {
        let PathOptions { spp, bounces, filter, seed } = *options;
        Samples { spp, bounces, caustics: CausticPaths::All, filter, seed }
    }

    fn open(pipelines: &Arc<Pipelines>) -> Result<Box<dyn Estimating>, VulkanError> {
        Ok(Box::new(PathTracer::new(pipelines)?))
    }
}

fn blocks_per_run(blocks: u32) -> u32 {
    let runs = (blocks * 64).div_ceil(WAVE_PATHS).max(1);
    blocks.div_ceil(runs)
}

/// Paths that memory is held for, when `count` samples of every pixel are taken.
fn capacity(scene: &TracedScene, view: &View, count: u32) -> u32 {
    let paths = 64 * blocks_per_run(view.size[0].div_ceil(8) * view.size[1].div_ceil(8));
    let per_pixel = if view.needs_light_paths(scene) { LIGHT_PATHS_PER_PIXEL } else { 1 };
    paths * (WAVE_PATHS / paths).clamp(1, count.saturating_mul(per_pixel).max(1))
}

/// Up to which vertex a submission goes that starts with vertex number `depth`; the last vertex has number `bounces + beyond`.
fn last_depth(bounces: Option<u32>, depth: u32, beyond: u32) -> u32 {
    let all = bounces.map_or(u32::MAX, |bounces| bounces.saturating_add(1 + beyond));
    (depth + DEPTHS_PER_SUBMISSION).min(all)
}
