//! Stochastic progressive photon mapping (Hachisuka & Jensen 2009): the reference where the eye sees a caustic in a mirror or through
//! glass, L S D S E, which path tracing cannot find.
//!
//! A sample of a pixel is a pass. A path from the camera goes on through specular vertices z_1 … z_{m−1} to the first one, z_m, at which
//! the diffuse lobe is drawn: its measurement point. Paths from lights, as many as the image has pixels, leave photons at
//! their vertices; those within a radius of the measurement point are its irradiance. Every light path is found in one way:
//!
//! | light | at | by |
//! |---|---|---|
//! | emitted by z_k, k ≤ m, or the sky behind z_{k−1} | both lobes | running into it ∣ next-event estimation: the path tracer's weights of the two |
//! | from an emitter to z_m | D | the same two: the path goes on from z_m by one ray that only looks for light |
//! | that scattered before z_m | D | photons that scattered at least once |
//! | that scattered before z_m, of the sky or of a light with a range | D | path tracing: these send out no photons |
//!
//! With x = z_1: what the last row but one finds at m = 1 belongs to `diffuse` where the photon's last vertex scattered diffusely, to
//! `caustics` where it did specularly; at m > 1 to `specular`. The other rows go to the slots of the path tracer. What is still found badly:
//! small lights that a mirror shows to a rough mirror (L S S E), as by the path tracer.
//!
//! The radius of pass i is r_i with r_{i+1}² = r_i² (i + α)/(i + 1), α = 2/3 (Knaus & Zwicker 2011): it depends on i alone, so
//! passes may be made in any order, anywhere, and bias and noise both vanish as their number grows. Sample n of half h is pass
//! 2n + h + 1, so that both halves shrink alike.

use super::camera_paths::{self, Sums, Wave};
use super::estimate::{Estimating, Estimator, Samples, Work};
use super::light_paths::{self, Swarm, scale_of};
use super::options::SppmOptions;
use super::paths::{Paths, Walk};
use super::photon_map::{Disc, PhotonMap};
use std::sync::Arc;

use super::sums::{SlotSums, scatter_sums, seed_of_half, seed_of_sample};
use super::view::{EstimateRequest, View};
use crate::frame::rays::TracedScene;
use crate::graph::{Executed, Graph, GraphDescription, ReadBack};
use crate::slot::CausticPaths;
use crate::vulkan::{Pipelines, VulkanError};

/// The share of the photons that a pass keeps.
const ALPHA: f64 = 2.0 / 3.0;
/// The first radius: a disc that gets so many photons where every light path leaves one, spread over all surfaces.
const FIRST_PHOTONS: f64 = 1.0;
/// Camera paths at a time, at most; each run of these traces the pass's photons again.
const RUN_PATHS: u32 = 1 << 20;
/// Light paths at a time, at most.
const SWARM_PATHS: u32 = 1 << 18;
/// Photons that memory is held for, to each of these.
const PHOTONS_PER_PATH: u32 = 4;
/// The largest buffer's bytes a camera path: radiance of five slots, or a vertex of five texels.
const BYTES_PER_PATH: u32 = 80;
/// Vertices that one submission advances paths by, at most.
const DEPTHS_PER_SUBMISSION: u32 = 12;

/// Maps photons of one scene.
pub(crate) struct PhotonMapper {
    work: Work,
}

/// A picture being made.
struct Mapping<'a> {
    work: &'a mut Work,
    scene: &'a TracedScene,
    view: View,
    run_blocks: u32,
    swarm_paths: u32,
}

/// Some pixels of one pass.
#[derive(Clone, Copy, Debug)]
struct Pass {
    wave: Wave,
    half: u32,
    disc: Disc,
    /// Whether its sums start from zero.
    first: bool,
}

impl PhotonMapper {
    pub(crate) fn new(pipelines: &Arc<Pipelines>) -> Result<PhotonMapper, VulkanError> {
        Ok(PhotonMapper { work: Work::new(pipelines)? })
    }

    fn mapping<'a>(&'a mut self, scene: &'a TracedScene, request: &EstimateRequest) -> Mapping<'a> {
        let [width, height] = request.size;
        let blocks = width.div_ceil(8) * height.div_ceil(8);
        let largest = self.work.store.device().limits().max_storage_buffer_range;
        let paths = RUN_PATHS.min(largest / BYTES_PER_PATH).max(64);
        let runs = blocks.div_ceil(paths / 64).max(1);
        let run_blocks = blocks.div_ceil(runs);
        Mapping {
            work: &mut self.work,
            scene,
            view: View::new(request, scene.origin),
            run_blocks,
            swarm_paths: SWARM_PATHS.min(64 * run_blocks),
        }
    }
}

impl Mapping<'_> {
    fn sums_of_passes(&mut self, half: u32, [first, count]: [u32; 2]) -> Result<SlotSums, VulkanError> {
        let [width, height] = self.view.size;
        let blocks = width.div_ceil(8) * height.div_ceil(8);
        let pixels = width as usize * height as usize;
        let mut sums = SlotSums { samples: count, slots: std::array::from_fn(|_| vec![[0.0; 3]; pixels]) };
        if count == 0 {
            return Ok(sums);
        }
        for first_block in (0..blocks).step_by(self.run_blocks as usize) {
            let block_count = self.run_blocks.min(blocks - first_block);
            let seed = seed_of_half(self.view.seed, half);
            for sample in first..first + count {
                let wave = Wave { first_block, block_count, sample_count: 1, first_sample: sample, seed };
                let samples = f64::from(sample - first) / f64::from(count);
                let part = (f64::from(first_block) + f64::from(block_count) * samples) / f64::from(blocks);
                self.work.reached(part);
                let radius =
                    radius_of_pass(first_radius(self.scene, &self.view), 2 * u64::from(sample) + u64::from(half) + 1);
                let disc = Disc { radius: radius as f32, scale: scale_of(self.scene) };
                let pass = Pass { wave, half, disc, first: sample == first };
                self.walk_from_camera(&pass)?;
                if self.scene.emitter_count > 0 && self.view.bounces != Some(0) {
                    self.probe(&pass)?;
                    self.walk_from_lights(&pass)?;
                }
                let texels = self.add_pass(&pass, sample + 1 == first + count)?;
                if let Some(texels) = texels {
                    scatter_sums(&mut sums, &texels, self.view.size, [first_block, block_count]);
                }
            }
        }
        Ok(sums)
    }

    /// Declares what stands between the submissions of a pass.
    fn declare<'s>(&'s mut self, wave: &Wave) -> (Graph<'s>, &'s TracedScene, &'s View, Paths, PhotonMap, Sums) {
        let mut graph = Graph::going_on(&mut self.work.store);
        let mut paths = Paths::declare(&mut graph, self.scene, &self.view, 64 * self.run_blocks);
        let all = self.scene.sky == [0.0; 3] && !self.scene.ranged_lights;
        // PHOTONS_ALL or PHOTONS_SOME of glsl/path/state.glsl; light paths are not connected to the camera, and weigh nothing.
        (paths.variants.photons, paths.variants.light_paths) = (if all { 1 } else { 2 }, 0);
        let map = PhotonMap::declare(&mut graph, &paths, PHOTONS_PER_PATH * self.swarm_paths);
        let sums = Sums::declare(&mut graph, wave);
        (graph, self.scene, &self.view, paths, map, sums)
    }

    /// Finds the light that needs no photons, and the measurement points.
    fn walk_from_camera(&mut self, pass: &Pass) -> Result<(), VulkanError> {
        let all = self.view.bounces.map_or(u32::MAX, |bounces| bounces.saturating_add(2));
        let mut depth = 0;
        loop {
            let timing = self.work.timing;
            let (mut graph, scene, view, paths, map, _) = self.declare(&pass.wave);
            if depth == 0 {
                if pass.first {
                    graph.fill_buffer("path/clear-radiance", paths.radiance, 0);
                }
                map.clear(&mut graph);
                camera_paths::generate(&mut graph, &paths, view, &pass.wave);
            }
            let until = (depth + DEPTHS_PER_SUBMISSION).min(all);
            for depth in depth..until {
                advance_from_camera(&mut graph, &paths, &map, scene, view, depth);
            }
            depth = until;
            map.want(&mut graph);
            graph.want_buffer(paths.radiance);
            let totals = paths.want(&mut graph);
            let executed = graph.run(timing)?;
            if self.work.add_step(executed, totals) == 0 {
                return Ok(());
            }
        }
    }

    /// Lets all light paths of the pass leave their photons. Whenever memory might not hold those of one more vertex they are gathered
    /// and make room.
    fn walk_from_lights(&mut self, pass: &Pass) -> Result<(), VulkanError> {
        let all = self.view.bounces.map_or(u32::MAX, |bounces| bounces.saturating_add(1));
        let path_count = self.view.size[0] * self.view.size[1];
        let capacity = PHOTONS_PER_PATH * self.swarm_paths;
        let seed = seed_of_sample(seed_of_half(self.view.seed, pass.half), pass.wave.first_sample);
        let mut photons = 0;
        for first_path in (0..path_count).step_by(self.swarm_paths as usize) {
            let swarm = Swarm { first_path, path_count: self.swarm_paths.min(path_count - first_path), seed };
            let (mut depth, mut active) = (0, swarm.path_count);
            while active > 0 && depth < all {
                let room = (capacity - photons) / active;
                if room == 0 {
                    self.gather(pass)?;
                    photons = 0;
                    continue;
                }
                let timing = self.work.timing;
                let (mut graph, scene, view, paths, map, _) = self.declare(&pass.wave);
                if depth == 0 {
                    light_paths::emit(&mut graph, &paths, scene, view, &swarm);
                }
                let until = (depth + room.min(DEPTHS_PER_SUBMISSION)).min(all);
                for depth in depth..until {
                    advance_from_light(&mut graph, &paths, &map, scene, view, pass.disc, depth);
                }
                depth = until;
                let stored = map.want(&mut graph);
                let totals = paths.want(&mut graph);
                let mut executed = graph.run(timing)?;
                [.., photons] = words(&mut executed, stored);
                active = self.work.add_step(executed, totals);
            }
        }
        if photons > 0 { self.gather(pass) } else { Ok(()) }
    }

    /// Finds how much surface there is around each measurement point.
    fn probe(&mut self, pass: &Pass) -> Result<(), VulkanError> {
        let timing = self.work.timing;
        let (mut graph, _, _, paths, map, _) = self.declare(&pass.wave);
        map.probe(&mut graph, &paths, pass.disc);
        map.want(&mut graph);
        paths.want(&mut graph);
        graph.run(timing).map(|executed| self.work.cost.add(executed))
    }

    fn gather(&mut self, pass: &Pass) -> Result<(), VulkanError> {
        let timing = self.work.timing;
        let (mut graph, _, view, paths, map, _) = self.declare(&pass.wave);
        map.gather(&mut graph, &paths, view, pass.disc);
        map.want(&mut graph);
        graph.run(timing).map(|executed| self.work.cost.add(executed))
    }

    /// Adds the pass to the sums; after the `last` one these are returned as [`Sums::read_back`] leaves them.
    fn add_pass(&mut self, pass: &Pass, last: bool) -> Result<Option<Vec<[f32; 4]>>, VulkanError> {
        let timing = self.work.timing;
        let (mut graph, _, _, paths, _, sums) = self.declare(&pass.wave);
        if pass.first {
            sums.clear(&mut graph);
        }
        sums.add(&mut graph, &paths, &pass.wave);
        graph.want_buffer(paths.radiance);
        let read_back = last.then(|| sums.read_back(&mut graph));
        let mut executed = graph.run(timing)?;
        let texels = read_back.map(|read_back| bytemuck::pod_collect_to_vec(&executed.take(read_back)));
        self.work.cost.add(executed);
        Ok(texels)
    }
}

impl Estimating for PhotonMapper {
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
        let scene = self.work.scene();
        self.mapping(&scene, request).sums_of_passes(half, [first, count])
    }

    /// The steps of one pass with the first vertices of its paths; those of later vertices are the same.
    fn describe(&mut self, request: &EstimateRequest) -> Result<GraphDescription, VulkanError> {
        let scene = self.work.scene();
        let mut mapping = self.mapping(&scene, request);
        let wave = Wave {
            first_block: 0,
            block_count: mapping.run_blocks,
            sample_count: 1,
            first_sample: 0,
            seed: request.seed,
        };
        let disc = Disc { radius: first_radius(&scene, &mapping.view) as f32, scale: scale_of(&scene) };
        let swarm = Swarm { first_path: 0, path_count: mapping.swarm_paths, seed: request.seed };
        let (mut graph, scene, view, paths, map, sums) = mapping.declare(&wave);
        camera_paths::generate(&mut graph, &paths, view, &wave);
        for depth in 0..2 {
            advance_from_camera(&mut graph, &paths, &map, scene, view, depth);
        }
        map.probe(&mut graph, &paths, disc);
        light_paths::emit(&mut graph, &paths, scene, view, &swarm);
        for depth in 0..2 {
            advance_from_light(&mut graph, &paths, &map, scene, view, disc, depth);
        }
        map.gather(&mut graph, &paths, view, disc);
        sums.add(&mut graph, &paths, &wave);
        Ok(graph.describe())
    }
}

/// Stochastic progressive photon mapping, for caustics that are seen in mirrors or through glass.
pub(crate) struct Sppm;

impl Estimator for Sppm {
    const NAME: &'static str = "sppm";
    const FIRST_PASS: [&'static str; 2] = ["path", "generate"];
    const SHADERS: &'static [&'static str] = &["path/*", "particle/*", "sppm/*", "buckets/*"];
    type Options = SppmOptions;

    fn samples(options: &SppmOptions) -> Samples {
        let SppmOptions { spp, bounces, filter, seed } = *options;
        Samples { spp, bounces, caustics: CausticPaths::All, filter, seed }
    }

    fn open(pipelines: &Arc<Pipelines>) -> Result<Box<dyn Estimating>, VulkanError> {
        Ok(Box::new(PhotonMapper::new(pipelines)?))
    }
}

/// Takes the paths to their vertex number `depth`, counted from 0, and on from there.
fn advance_from_camera(
    graph: &mut Graph<'_>,
    paths: &Paths,
    map: &PhotonMap,
    scene: &TracedScene,
    view: &View,
    depth: u32,
) {
    paths.advance(graph, (scene, view), Walk::FromCamera, depth, |graph| {
        camera_paths::find_light(graph, paths, scene, view, depth);
        // Photons scattered once at least.
        if scene.emitter_count > 0 && view.bounces.is_none_or(|bounces| depth < bounces) {
            map.measure(graph, paths, depth);
        }
    });
}

/// As [`advance_from_camera`].
fn advance_from_light(
    graph: &mut Graph<'_>,
    paths: &Paths,
    map: &PhotonMap,
    scene: &TracedScene,
    view: &View,
    disc: Disc,
    depth: u32,
) {
    paths.advance(graph, (scene, view), Walk::FromLight, depth, |graph| {
        if depth > 0 {
            map.store(graph, paths, disc, depth);
        }
    });
}

/// Four words that were read back.
fn words(executed: &mut Executed, read_back: ReadBack) -> [u32; 4] {
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(&executed.take(read_back));
    [words[0], words[1], words[2], words[3]]
}

/// r_1, metres. Bounded by the scene's extent, where its surfaces are small and far from each other.
fn first_radius(scene: &TracedScene, view: &View) -> f64 {
    let share = FIRST_PHOTONS / f64::from(view.pixel_count());
    (share * scene.area / std::f64::consts::PI).sqrt().clamp(1e-5 * scene.radius, scene.radius)
}

/// r_i: r_1 √(Π_{k=1}^{i−1} (k + α)/(k + 1)).
fn radius_of_pass(first: f64, pass: u64) -> f64 {
    first * (1..pass).map(|k| (k as f64 + ALPHA) / (k as f64 + 1.0)).product::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_shrink_slowly_enough_for_noise_to_vanish() {
        let squares: Vec<f64> = (1..=4096).map(|pass| radius_of_pass(1.0, pass).powi(2)).collect();
        assert_eq!(squares[0], 1.0);
        for (pass, pair) in (1_u32..).zip(squares.windows(2)) {
            let expected = pair[0] * (f64::from(pass) + ALPHA) / (f64::from(pass) + 1.0);
            assert!((pair[1] - expected).abs() < 1e-12, "pass {pass}");
        }
        // r_i² falls as i^(α−1): 4096 passes leave about a sixteenth.
        assert!((0.9..1.3).contains(&(squares[4095] * 16.0)), "{}", squares[4095]);
    }
}
