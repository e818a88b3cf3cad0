//! The geometry stage: particles on the surfaces, what they stand for, links between them, and the lists by which their irradiance is read. It stands while
//! geometry and materials do.

use ash::vk;

use super::options::ParticlesOptions;
use super::place::Placed;
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::groups::{Lobes, Particles, SceneRays};
use crate::shaders::particles::{
    Catch, CatchPush, Links, LinksPush, List, ListPush, Matter, MatterPush,
};

/// Points by which the area of a particle is measured, for each.
const POINTS: u32 = 16;
/// Particles whose links are in one buffer: 32 MiB of them at 16×16 a particle, well below the least limit of a buffer.
const CHUNK: u32 = 32_768;
/// As in glsl/particles/lists.glsl.
const LIST_CAPACITY: usize = 48;
/// A particle's spacing over the scene's radius at most and at least, unless the options say how many there are; between these half the size of its finer
/// triangles.
const SPACING: f64 = 0.0125;
const FINEST: f64 = 0.0025;

pub(super) const WORD: vk::Format = vk::Format::R32_UINT;
pub(super) const WORDS4: vk::Format = vk::Format::R32G32B32A32_UINT;
pub(super) const FLOAT: vk::Format = vk::Format::R32_SFLOAT;
pub(super) const FLOATS4: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// The links of the particles `first` to `first + count`, gather² of each.
pub(super) struct Chunk {
    pub(super) first: u32,
    pub(super) count: u32,
    pub(super) links: BufferRef<u32>,
}

/// What the geometry stage leaves.
pub(super) struct ParticleSpace {
    pub(super) count: u32,
    pub(super) rays: SceneRays,
    pub(super) group: Particles,
    /// Where each is, and behind all these on which triangle.
    pub(super) places: BufferRef<[u32; 4]>,
    /// Albedo and area of each.
    pub(super) matter: BufferRef<[f32; 4]>,
    pub(super) chunks: Vec<Chunk>,
    pub(super) scatter_links: BufferRef<u32>,
    /// What the links of each bring of the sky's and of emissive surfaces' light, as in glsl/particles/arrivals.glsl.
    pub(super) arrivals: BufferRef<u32>,
    /// Neighbours of each, in a fixed room.
    pub(super) lists: BufferRef<u32>,
    pub(super) list_lengths: BufferRef<u32>,
}

/// The particles of a scene by its area and detail.
fn count_of(scene: &TracedScene, options: &ParticlesOptions) -> u32 {
    let spacing = (0.5 * scene.fine_size).clamp(FINEST * scene.radius, SPACING * scene.radius);
    let by_area = scene.area / spacing.powi(2);
    if options.count > 0 { options.count } else { by_area.clamp(20_000.0, 200_000.0) as u32 }
}

/// Those that mirrors and glass have.
pub(super) fn lobes_of(scene: &TracedScene) -> Lobes {
    let facts = &scene.facts;
    Lobes { specular_lobes: u32::from(facts.specular), transmissive: u32::from(facts.transmissive) }
}

impl ParticleSpace {
    /// Declares the stage.
    pub(super) fn declare(graph: &mut Graph<'_>, scene: &TracedScene, options: &ParticlesOptions) -> ParticleSpace {
        let particle_count = count_of(scene, options);
        let Placed { rays, triangle_count, sums, group, places } = Placed::declare(graph, scene, particle_count);
        let lost = graph.buffer::<u32>("particles.lost", 2);
        graph.fill_buffer("diffuse/particles/place/clear-lost", lost, 0);
        let lobes = lobes_of(scene);
        let space = Unlinked { lobes, particle_count, triangle_count, rays, group, lost };
        let matter = space.measure(graph, sums);
        let (chunks, scatter_links, arrivals) = space.link(graph, scene, options);
        let (lists, list_lengths) = space.list(graph);
        let Unlinked { rays, group, .. } = space;
        let count = particle_count;
        ParticleSpace { count, rays, group, places, matter, chunks, scatter_links, arrivals, lists, list_lengths }
    }
}

/// Particles at their places.
struct Unlinked {
    particle_count: u32,
    triangle_count: u32,
    rays: SceneRays,
    group: Particles,
    lobes: Lobes,
    /// Points and link ends that no particle stands for.
    lost: BufferRef<u32>,
}

impl Unlinked {
    fn threads(&self) -> [u32; 3] {
        [self.particle_count, 1, 1]
    }

    /// Areas and albedos.
    fn measure(&self, graph: &mut Graph<'_>, sums: BufferRef<f32>) -> BufferRef<[f32; 4]> {
        let (particle_count, triangle_count) = (self.particle_count, self.triangle_count);
        let point_count = POINTS * particle_count;
        let tallies = graph.buffer::<u32>("particles.tallies", 4 * particle_count as usize);
        graph.fill_buffer("diffuse/particles/measure/clear", tallies, 0);
        let pass = Catch {
            scene_rays: self.rays.clone(),
            particles: self.group.clone(),
            sums: sums.texels(FLOAT),
            tallies: tallies.read_write(),
            lost: self.lost.read_write(),
            push: CatchPush { triangle_count, point_count },
        };
        let pass = graph.pass("diffuse/particles/measure/catch", pass).note("points", u64::from(point_count));
        pass.count("lost", self.lost, 0).threads([point_count, 1, 1]);
        let matter = graph.buffer::<[f32; 4]>("particles.matter", particle_count as usize);
        let pass = Matter {
            tallies: tallies.texels(WORDS4),
            sums: sums.texels(FLOAT),
            matter: matter.write(),
            push: MatterPush { triangle_count, point_count, particle_count },
        };
        graph.pass("diffuse/particles/measure/matter", pass).threads(self.threads());
        matter
    }

    fn link(
        &self,
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        options: &ParticlesOptions,
    ) -> (Vec<Chunk>, BufferRef<u32>, BufferRef<u32>) {
        let (gather_side, scatter_side) = (options.gather, options.scatter);
        let link_count = gather_side * gather_side;
        let particle_count = self.particle_count;
        let second_ends = particle_count * scatter_side * scatter_side;
        let ends = if scene.facts.specular { 2 } else { 1 };
        let scatter_links = graph.buffer::<u32>("particles.scatter_links", (ends * second_ends) as usize);
        let emits = scene.emissive_count > 0;
        let arrival_words = if emits { 9 } else { 3 };
        let arrivals = graph.buffer::<u32>("particles.arrivals", arrival_words * particle_count as usize);
        graph.fill_buffer("diffuse/particles/link/clear", arrivals, 0);
        let firsts = (0..particle_count).step_by(CHUNK as usize);
        let chunks: Vec<Chunk> = (0..)
            .zip(firsts)
            .map(|(number, first)| {
                let count = CHUNK.min(particle_count - first);
                let links = graph.buffer::<u32>(&format!("particles.links.{number}"), (count * link_count) as usize);
                let pass = Links {
                    scene_rays: self.rays.clone(),
                    scene_lights: scene.lights(graph),
                    particles: self.group.clone(),
                    links: links.write(),
                    scatter_links: if number == 0 {
                        scatter_links.start_then_read()
                    } else {
                        scatter_links.read_write()
                    },
                    arrivals: arrivals.read_write(),
                    has_emitters: u32::from(emits),
                    lobes: self.lobes.clone(),
                    lost: self.lost.read_write(),
                    push: LinksPush {
                        first,
                        count,
                        gather_side,
                        scatter_side,
                        second_ends,
                        sky_shines: u32::from(scene.sky != [0.0; 3]),
                        density_scale: scene.emissive_density_scale,
                        emitter_samples: options.emitter_samples as f32,
                        greatest_radiance: scene.greatest_radiance,
                    },
                };
                let pass = graph.pass(&format!("diffuse/particles/link/trace.{number}"), pass);
                let pass = pass.note("rays", u64::from(count) * u64::from(link_count)).count("lost", self.lost, 1);
                pass.threads([link_count, count, 1]);
                Chunk { first, count, links }
            })
            .collect();
        (chunks, scatter_links, arrivals)
    }

    /// The lists, each of a fixed room, and how long they are.
    fn list(&self, graph: &mut Graph<'_>) -> (BufferRef<u32>, BufferRef<u32>) {
        let particle_count = self.particle_count;
        let lists = graph.buffer::<u32>("particles.lists", LIST_CAPACITY * particle_count as usize);
        let lengths = graph.buffer::<u32>("particles.list_lengths", particle_count as usize);
        let counts = graph.buffer::<u32>("particles.list_counts", 2);
        graph.fill_buffer("diffuse/particles/lists/clear", counts, 0);
        let pass = List {
            scene_rays: self.rays.clone(),
            particles: self.group.clone(),
            lists: lists.start_then_read(),
            lengths: lengths.write(),
            counts: counts.read_write(),
            push: ListPush { particle_count },
        };
        let pass = graph.pass("diffuse/particles/lists/list", pass);
        pass.count("entries", counts, 0).count("left out", counts, 1).threads(self.threads());
        (lists, lengths)
    }
}
