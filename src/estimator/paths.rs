//! Waves of paths: their buffers, and the passes that paths from the camera and from lights share (glsl/path/).
//!
//! `intersect` finds what each path meets, `surface` what that is made of, `scatter` sends the path on. What is between `surface` and
//! `scatter` differs: [`super::camera_paths`] looks for light, [`super::light_paths`] for the camera.

use ash::vk;

use super::view::View;
use crate::frame::rays::{TargetShares, TracedScene};
use crate::graph::bindings::{BufferRef, Uniform};
use crate::graph::{Dependence, Graph, ReadBack};
use crate::shaders::groups::{self, Connections, LightTargets, Lobes, NewPaths, SceneLights, SceneRays};
use crate::shaders::{path as shaders, types};
use crate::slot::{CausticPaths, PixelFilter, Slot};

pub(super) const WORD: vk::Format = vk::Format::R32_UINT;
pub(super) const PAIR: vk::Format = vk::Format::R32G32_UINT;
pub(super) const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
pub(super) const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Words before the numbers of the paths in a queue.
const QUEUE_HEADER: usize = 4;

/// Where the paths of a wave start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Walk {
    FromCamera,
    FromLight,
}

impl Walk {
    fn flag(self) -> u32 {
        u32::from(self == Walk::FromLight)
    }

    /// The piece that the passes are counted to.
    /// Scatterings at most between the light and the first visible surface, those in mirrors included.
    fn bounces(self, view: &View) -> Option<u32> {
        if self == Walk::FromLight { view.bounces } else { view.camera_bounces() }
    }

    fn pass(self, pass: &str) -> String {
        let piece = if self == Walk::FromLight { "particle" } else { "path" };
        format!("{piece}/{pass}")
    }
}

/// What kernels are compiled for, from the scene's facts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variants {
    pub(super) light_paths: u32,
    /// A camera's path leaves light to photons (PHOTONS_ of glsl/path/state.glsl).
    pub(super) photons: u32,
    /// The slot `caustics` leaves out light that some diffuse lobe scattered on its way.
    pub(super) specular_caustics: u32,
    /// The slots `specular` and `direct` are as rays that follow reflections divide them (FOLLOWED_ of glsl/groups/paths.glsl).
    pub(super) followed: u32,
    /// Between the lights and the first visible surface light scatters diffusely alone.
    pub(super) diffuse_alone: u32,
    /// Reflections and refractions between the eye and what mirrors show at most, and scatterings from there on; 0: they are scatterings like others.
    pub(super) mirrors: u32,
    pub(super) bounces: u32,
}

impl Variants {
    fn of(scene: &TracedScene, view: &View) -> Variants {
        Variants {
            light_paths: u32::from(view.needs_light_paths(scene)),
            photons: 0,
            specular_caustics: u32::from(view.caustics == CausticPaths::Specular),
            followed: match view.caustics {
                CausticPaths::Unmirrored => 1,
                CausticPaths::Mirrored => 2,
                _ => 0,
            },
            diffuse_alone: u32::from(view.caustics == CausticPaths::None),
            mirrors: view.mirrors.unwrap_or(0),
            bounces: view.bounces.unwrap_or(u32::MAX),
        }
    }
}

/// The buffers of a wave.
pub(super) struct Paths {
    pub(super) rays: SceneRays,
    pub(super) lights: SceneLights,
    pub(super) targets: LightTargets,
    pub(super) lobes: Lobes,
    pub(super) variants: Variants,
    pub(super) camera: Uniform<types::Camera>,
    ways: BufferRef<[f32; 4]>,
    states: BufferRef<[f32; 4]>,
    flags: BufferRef<u32>,
    seeds: BufferRef<[u32; 2]>,
    hits: BufferRef<[f32; 4]>,
    vertices: BufferRef<[u32; 4]>,
    pub(super) connection_rays: BufferRef<[f32; 4]>,
    pub(super) connection_light: BufferRef<[f32; 4]>,
    active: [BufferRef<u32>; 2],
    pub(super) alive: BufferRef<u32>,
    pub(super) connections: BufferRef<u32>,
    totals: BufferRef<u32>,
    pub(super) radiance: BufferRef<[f32; 4]>,
    pub(super) capacity: u32,
}

impl Paths {
    /// Buffers for `capacity` paths.
    pub(super) fn declare(graph: &mut Graph<'_>, scene: &TracedScene, view: &View, capacity: u32) -> Paths {
        let facts = &scene.facts;
        let paths = capacity as usize;
        let lobe_count = 1 + usize::from(facts.specular);
        let vertex_texels = if facts.specular { 5 } else { 2 };
        let queue = QUEUE_HEADER + paths;
        let totals = graph.buffer("path.totals", 4);
        graph.fill_buffer("path/clear-totals", totals, 0);
        Paths {
            rays: scene.rays(graph),
            lights: scene.lights(graph),
            targets: scene.targets(graph),
            lobes: Lobes { specular_lobes: u32::from(facts.specular), transmissive: u32::from(facts.transmissive) },
            variants: Variants::of(scene, view),
            camera: graph.upload("path.camera", &[view.camera], Dependence::CAMERA).uniform(),
            ways: graph.buffer("path.rays", 2 * paths),
            states: graph.buffer("path.states", paths),
            flags: graph.buffer("path.flags", paths),
            seeds: graph.buffer("path.seeds", paths),
            hits: graph.buffer("path.hits", paths),
            vertices: graph.buffer("path.vertices", vertex_texels * paths),
            connection_rays: graph.buffer("path.connection_rays", 2 * paths),
            connection_light: graph.buffer("path.connection_light", lobe_count * paths),
            active: [graph.buffer("path.active.0", queue), graph.buffer("path.active.1", queue)],
            alive: graph.buffer("path.alive", queue),
            connections: graph.buffer("path.connections", queue),
            totals,
            radiance: graph.buffer("path.radiance", Slot::ALL.len() * paths),
            capacity,
        }
    }

    /// The queue of the paths that are on their way to vertex number `depth`, counted from 0.
    pub(super) fn active(&self, depth: u32) -> BufferRef<u32> {
        self.active[depth as usize % 2]
    }

    /// The paths on their way to vertex number `depth` and at it, as kernels read them.
    pub(super) fn group(&self, walk: Walk, depth: u32) -> groups::Paths {
        groups::Paths {
            path_rays: self.ways.texels(FLOATS),
            path_states: self.states.texels(FLOATS),
            path_flags: self.flags.texels(WORD),
            path_seeds: self.seeds.texels(PAIR),
            path_vertices: self.vertices.texels(WORDS),
            active_paths: self.active(depth).texels(WORD),
            alive_paths: self.alive.texels(WORD),
            from_light: walk.flag(),
            light_paths: self.variants.light_paths,
            photons: self.variants.photons,
            specular_caustics: self.variants.specular_caustics,
            followed: self.variants.followed,
            diffuse_alone: self.variants.diffuse_alone,
            mirrors: self.variants.mirrors,
            bounces: self.variants.bounces,
        }
    }

    /// Paths that start: nothing of what was there matters.
    pub(super) fn started(&self) -> NewPaths {
        NewPaths {
            new_rays: self.ways.write_then_read(),
            new_states: self.states.write_then_read(),
            new_flags: self.flags.write_then_read(),
            new_seeds: self.seeds.write_then_read(),
            new_paths: self.active(0).read_write(),
        }
    }

    /// The connections as kernels follow them.
    pub(super) fn connected(&self) -> Connections {
        Connections {
            connections: self.connections.texels(WORD),
            connection_rays: self.connection_rays.texels(FLOATS),
            connection_light: self.connection_light.texels(FLOATS),
        }
    }

    /// Takes the paths to vertex number `depth`, counted from 0, lets them `meet` there what they look for, and sends them on.
    pub(super) fn advance(
        &self,
        graph: &mut Graph<'_>,
        (scene, view): (&TracedScene, &View),
        walk: Walk,
        depth: u32,
        meet: impl FnOnce(&mut Graph<'_>),
    ) {
        self.intersect(graph, walk, depth);
        self.surface(graph, scene, view, walk, depth);
        meet(graph);
        // What scatters at the first visible surface is no bounce, and that is where the paths of the camera begin.
        if walk.bounces(view).is_none_or(|bounces| depth + walk.flag() <= bounces) {
            self.scatter(graph, scene, view, walk, depth);
        }
        self.tally(graph, walk, depth);
    }

    /// Empties all queues, for a wave that starts.
    pub(super) fn clear_queues(&self, graph: &mut Graph<'_>, walk: Walk) {
        let clear = shaders::Clear {
            active_paths: self.active(0).start_then_read(),
            next_paths: self.active(1).start_then_read(),
            alive_paths: self.alive.start_then_read(),
            connections: self.connections.start_then_read(),
        };
        graph.pass(&walk.pass("clear"), clear).groups([1, 1, 1]);
    }

    /// Counts the rays of the step to vertex number `depth` and empties its queues.
    fn tally(&self, graph: &mut Graph<'_>, walk: Walk, depth: u32) {
        let tally = shaders::Tally {
            active_paths: self.active(depth).read_write(),
            alive_paths: self.alive.read_write(),
            connections: self.connections.read_write(),
            next_paths: self.active(depth + 1).texels(WORD),
            totals: self.totals.read_write(),
        };
        graph.pass(&walk.pass("tally"), tally).groups([1, 1, 1]);
    }

    /// What the paths of vertex number `depth` meet.
    fn intersect(&self, graph: &mut Graph<'_>, walk: Walk, depth: u32) {
        let active = self.active(depth);
        let intersect = shaders::Intersect {
            scene_rays: self.rays.clone(),
            paths: self.group(walk, depth),
            path_hits: self.hits.write(),
        };
        graph.pass(&walk.pass("intersect"), intersect).count("rays", active, 3).threads_indirect(active, 0);
    }

    /// What it is made of; where nothing scatters the paths end.
    fn surface(&self, graph: &mut Graph<'_>, scene: &TracedScene, view: &View, walk: Walk, depth: u32) {
        let active = self.active(depth);
        let ends = walk.bounces(view).is_some_and(|bounces| depth > bounces);
        let pixels = view.size.map(|side| side as f32);
        let surface = shaders::Surface {
            scene_rays: self.rays.clone(),
            light_targets: self.targets.clone(),
            paths: self.group(walk, depth),
            path_hits: self.hits.texels(FLOATS),
            camera: self.camera.clone(),
            vertices: self.vertices.write(),
            path_radiance: self.radiance.read_write(),
            alive_queue: self.alive.read_write(),
            lobes: self.lobes.clone(),
            pixel_footprint: u32::from(view.filter == PixelFilter::Center && scene.facts.textured),
            push: shaders::SurfacePush {
                sky: scene.sky,
                depth,
                rays: camera_rays(view),
                pixel_size: pixels.map(|side| 2.0 / side),
                light_paths: light_paths(scene, view),
                path_count: self.capacity,
                ends: u32::from(ends),
            },
        };
        graph.pass(&walk.pass("surface"), surface).threads_indirect(active, 0);
    }

    /// Sends the paths on from vertex number `depth`.
    fn scatter(&self, graph: &mut Graph<'_>, scene: &TracedScene, view: &View, walk: Walk, depth: u32) {
        let scatter = shaders::Scatter {
            scene_rays: self.rays.clone(),
            paths: self.group(walk, depth),
            new_paths: NewPaths {
                new_rays: self.ways.read_write(),
                new_states: self.states.read_write(),
                new_flags: self.flags.read_write(),
                new_seeds: self.seeds.read_write(),
                new_paths: self.active(depth + 1).read_write(),
            },
            lobes: self.lobes.clone(),
            push: shaders::ScatterPush { depth, flux: self.flux(scene), light_paths: light_paths(scene, view) },
        };
        graph.pass(&walk.pass("scatter"), scatter).threads_indirect(self.alive, 0);
    }

    /// What a light's path carries at its first vertex, on the average, W (luminance).
    fn flux(&self, scene: &TracedScene) -> f32 {
        let sent = if self.variants.photons == 0 { scene.target_shares.flux } else { 1.0 };
        (scene.power * sent) as f32
    }

    /// Asks for all that the next submission goes on from, and for the totals of this one: rays, and paths that go on.
    pub(super) fn want(&self, graph: &mut Graph<'_>) -> ReadBack {
        graph.want_buffer(self.ways);
        graph.want_buffer(self.states);
        graph.want_buffer(self.flags);
        graph.want_buffer(self.seeds);
        for queue in self.active.into_iter().chain([self.alive, self.connections]) {
            graph.want_buffer(queue);
        }
        graph.read_back_buffer(self.totals)
    }
}

/// How many light paths there are for a sample of all pixels, and where they are sent.
pub(super) fn light_paths(scene: &TracedScene, view: &View) -> types::LightPaths {
    let TargetShares { anywhere, targeted, .. } = scene.target_shares;
    types::LightPaths { count: view.light_path_count() as f32, anywhere: anywhere as f32, targeted: targeted as f32 }
}

/// Camera rays per solid angle on the axis, or per area across an orthographic view, for one sample of every pixel.
pub(super) fn camera_rays(view: &View) -> types::CameraRays {
    let length = |axis: [f32; 3]| glam::Vec3::from(axis).length();
    let area = 4.0 * length(view.camera.right_scaled) * length(view.camera.down_scaled);
    let pixels = view.size[0] as f32 * view.size[1] as f32;
    types::CameraRays { density: pixels / area, orthographic: f32::from(view.camera.depth_range > 0.0) }
}
