//! The path tracer: waves of paths through small kernels, sums of what they find per slot.
//!
//! A wave holds some samples of a run of pixels, one path each. Its paths advance together, vertex by vertex, through the kernels of
//! [`super::camera_paths`]; each leaves a queue of the paths that go on, and the next one is dispatched for so many. Nothing two paths do
//! touches the same memory, so the same samples give the same bits on one device.

use std::sync::Arc;

use super::camera_paths::{CameraPaths, Wave};
use super::traced_scene::TracedScene;
pub(crate) use super::traced_scene::traced_key;
use super::{PixelFilter, ReferenceRequest, SampleSource, SlotSums};
use crate::frame::camera::camera;
use crate::graph::{Graph, Store};
use crate::renderer::{Context, Error, PassTiming, Slot, Timing};
use crate::scene::Scene;
use crate::shaders::types;
use crate::vulkan::{Device, VulkanError};

/// Paths of a wave at most: on a GPU enough to fill it, on a CPU few enough to stay near the caches.
const WAVE_PATHS: u32 = 1 << 18;
/// Vertices that one submission advances a wave by.
const DEPTHS_PER_SUBMISSION: u32 = 12;

/// What a run of samples cost.
#[derive(Clone, Debug, Default)]
pub(crate) struct TraceCost {
    /// GPU time, milliseconds.
    pub(crate) gpu_ms: f64,
    /// Time spent creating pipelines, milliseconds.
    pub(crate) pipeline_ms: f64,
    /// Rays cast: from the camera, between vertices, to lights.
    pub(crate) rays: u64,
    /// The passes, those of the same name together.
    pub(crate) passes: Vec<PassTiming>,
}

/// Traces paths through one scene.
pub(crate) struct PathTracer {
    store: Store,
    scene: Option<TracedScene>,
    timing: Timing,
    cost: TraceCost,
}

/// The picture that is traced.
#[derive(Clone, Debug)]
pub(crate) struct View {
    pub(crate) size: [u32; 2],
    pub(crate) camera: types::Camera,
    pub(crate) bounces: Option<u32>,
    pub(crate) filter: PixelFilter,
    pub(crate) seed: u32,
}

impl PathTracer {
    pub(crate) fn new(device: &Arc<Device>) -> Result<PathTracer, VulkanError> {
        Ok(PathTracer { store: Store::new(device)?, scene: None, timing: Timing::Frame, cost: TraceCost::default() })
    }

    /// Brings the scene onto the device, if it is not there as it is now.
    pub(crate) fn prepare(&mut self, scene: &Scene) -> Result<(), VulkanError> {
        let key = traced_key(scene);
        if self.scene.as_ref().is_none_or(|held| held.key != key) {
            self.scene = None;
            self.scene = Some(TracedScene::new(self.store.device(), scene)?);
        }
        Ok(())
    }

    /// The picture that a request asks for of the prepared scene.
    pub(crate) fn view(&self, request: &ReferenceRequest) -> View {
        let origin = self.scene.as_ref().map(|scene| scene.origin).unwrap_or_default();
        View {
            size: request.size,
            camera: camera(&request.camera, request.size, origin),
            bounces: request.bounces,
            filter: request.filter,
            seed: request.seed,
        }
    }

    /// How the passes to come are timed.
    pub(crate) fn set_timing(&mut self, timing: Timing) {
        self.timing = timing;
    }

    /// What was spent since this was last asked.
    pub(crate) fn take_cost(&mut self) -> TraceCost {
        std::mem::take(&mut self.cost)
    }

    /// The passes of a frame in which nothing changed.
    pub(crate) fn unchanged_passes(&self) -> Vec<PassTiming> {
        vec![PassTiming {
            piece: "path".to_owned(),
            pass: String::new(),
            ms: None,
            skipped: Some("unchanged: geometry, materials, lights, camera".to_owned()),
            work: std::collections::BTreeMap::new(),
        }]
    }

    /// Device memory, bytes, by piece; `scene` is the scene itself.
    pub(crate) fn memory_bytes(&self) -> std::collections::BTreeMap<String, u64> {
        let mut bytes = self.store.memory_by_piece();
        bytes.insert("scene".to_owned(), self.scene.as_ref().map_or(0, TracedScene::bytes));
        bytes
    }

    /// The sums over samples `first .. first + count` of half `half` of every pixel.
    pub(crate) fn sums(&mut self, view: &View, half: u32, first: u32, count: u32) -> Result<SlotSums, VulkanError> {
        let [width, height] = view.size;
        let blocks_per_row = width.div_ceil(8);
        let blocks = blocks_per_row * height.div_ceil(8);
        let pixels = width as usize * height as usize;
        let mut sums = SlotSums { samples: count, slots: std::array::from_fn(|_| vec![[0.0; 3]; pixels]) };
        // Runs of blocks of equal length, so that the memory serves all.
        let runs = (blocks * 64).div_ceil(WAVE_PATHS).max(1);
        let blocks_per_run = blocks.div_ceil(runs);
        for first_block in (0..blocks).step_by(blocks_per_run as usize) {
            let block_count = blocks_per_run.min(blocks - first_block);
            let texels = self.run_of_blocks(view, [first_block, block_count], half, [first, count])?;
            scatter_sums(&mut sums, &texels, view.size, [first_block, block_count]);
        }
        Ok(sums)
    }

    /// The sums of the pixels of some blocks: [`Slot::ALL`] after each other, in the order of paths.
    fn run_of_blocks(
        &mut self,
        view: &View,
        [first_block, block_count]: [u32; 2],
        half: u32,
        [first, count]: [u32; 2],
    ) -> Result<Vec<[f32; 4]>, VulkanError> {
        let scene = self.scene.as_ref().expect("prepared before it is traced");
        let paths_per_sample = 64 * block_count;
        let samples_per_wave = (WAVE_PATHS / paths_per_sample).clamp(1, count.max(1));
        let mut done = 0;
        let mut texels = Vec::new();
        while done < count {
            let samples = samples_per_wave.min(count - done);
            let mut wave = Wave {
                first_block,
                block_count,
                sample_count: samples,
                path_capacity: paths_per_sample * samples_per_wave,
                first_sample: first + done,
                seed: view.seed.wrapping_mul(2).wrapping_add(half),
                clear_sums: done == 0,
                depth: 0,
            };
            done += samples;
            let depths = view.bounces.map_or(u32::MAX, |bounces| bounces.saturating_add(2));
            loop {
                let until = wave.depth.saturating_add(DEPTHS_PER_SUBMISSION).min(depths);
                let mut graph = Graph::new(&mut self.store);
                let mut paths = CameraPaths::declare(&mut graph, scene, view, &wave);
                if wave.depth == 0 {
                    paths.generate(&mut graph, view, &wave);
                }
                for depth in wave.depth..until {
                    paths.advance(&mut graph, scene, view, depth);
                }
                paths.resolve(&mut graph, &wave);
                let last = until == depths;
                let read_back = (done == count).then(|| paths.read_sums(&mut graph));
                paths.want(&mut graph);
                let mut executed = graph.run(self.timing)?;
                self.cost.add(&executed.passes, executed.gpu_ms, executed.pipeline_ms);
                let alive = executed.passes.iter().rev().find_map(|pass| pass.work.get("paths on").copied());
                wave.depth = until;
                wave.clear_sums = false;
                if last || alive.unwrap_or(0) == 0 {
                    if let Some(read_back) = read_back {
                        texels = bytemuck::pod_collect_to_vec(&executed.take(read_back));
                    }
                    break;
                }
            }
        }
        Ok(texels)
    }
}

impl TraceCost {
    fn add(&mut self, passes: &[PassTiming], gpu_ms: f64, pipeline_ms: f64) {
        self.gpu_ms += gpu_ms;
        self.pipeline_ms += pipeline_ms;
        for pass in passes {
            self.rays += pass.work.get("rays").copied().unwrap_or(0);
            let same = |known: &&mut PassTiming| known.piece == pass.piece && known.pass == pass.pass;
            match self.passes.iter_mut().find(same) {
                Some(known) => {
                    known.ms = match (known.ms, pass.ms) {
                        (Some(a), Some(b)) => Some(a + b),
                        (a, b) => a.or(b),
                    };
                    for (name, count) in &pass.work {
                        *known.work.entry(name.clone()).or_insert(0) += count;
                    }
                    if pass.skipped.is_none() {
                        known.skipped = None;
                    }
                }
                None => self.passes.push(pass.clone()),
            }
        }
    }
}

/// Puts the sums of a run of blocks where their pixels are (glsl/path/pixels.glsl).
fn scatter_sums(sums: &mut SlotSums, texels: &[[f32; 4]], size: [u32; 2], [first_block, block_count]: [u32; 2]) {
    let [width, height] = size;
    let blocks_per_row = width.div_ceil(8);
    let paths = 64 * block_count;
    for place in 0..paths {
        let block = first_block + place / 64;
        let (lane, part) = (place & 7, place >> 3 & 7);
        let x = block % blocks_per_row * 8 + (part & 1) * 4 + (lane & 3);
        let y = block / blocks_per_row * 8 + (part >> 1) * 2 + (lane >> 2);
        if x < width && y < height {
            let pixel = y as usize * width as usize + x as usize;
            for slot in 0..Slot::ALL.len() {
                let [red, green, blue, _] = texels[slot * paths as usize + place as usize];
                sums.slots[slot][pixel] = [red, green, blue];
            }
        }
    }
}

/// A request's samples by the path tracer.
pub(super) struct PathSource {
    tracer: PathTracer,
    view: View,
}

impl PathSource {
    /// # Errors
    /// A scene that does not fit the device.
    pub(super) fn new(context: &Context, scene: &Scene, request: &ReferenceRequest) -> Result<PathSource, Error> {
        let mut tracer = PathTracer::new(context.shared_device())?;
        tracer.prepare(scene)?;
        let view = tracer.view(request);
        Ok(PathSource { tracer, view })
    }
}

impl SampleSource for PathSource {
    fn sums(&mut self, half: u32, first: u32, count: u32) -> Result<SlotSums, Error> {
        Ok(self.tracer.sums(&self.view, half, first, count)?)
    }
}
