//! What is kept of particles from one geometry to the next, so that where a part of the surfaces moved the rest need not be done again.

use super::cells::Cells;
use super::events::Levels;
use super::options::ParticlesOptions;
use crate::frame::rays::TracedScene;
use crate::graph::bindings::BufferRef;
use crate::graph::{Graph, hash_of};

/// Facets for which there is room: for each particle, beside one for each cell. Some 18 fall to a particle, more where triangles are thin.
const FACETS: u32 = 24;
/// Particles whose links are in one buffer: 32 MiB of them at 16×16 a particle, well below the least limit of a buffer.
const CHUNK: u32 = 32_768;
/// As in glsl/particles/lists.glsl.
const LIST_CAPACITY: usize = 48;

/// The links of the particles `first` to `first + count`, gather² of each.
pub(super) struct Chunk {
    pub(super) first: u32,
    pub(super) count: u32,
    pub(super) links: BufferRef<u32>,
}

pub(super) struct Kept {
    /// Names what they are made of, but for the surfaces.
    rest: u64,
    surfaces: u64,
    shapes: u64,
    pub(super) sky_shines: bool,
    /// Of the sky's light.
    pub(super) sky_levels: Levels,
    /// Where the second ends of links for scattering begin.
    pub(super) second_ends: u32,
    /// Records of triangles and of cells (glsl/particles/facets.glsl).
    pub(super) facets: BufferRef<u32>,
    /// Of a facet, at most, m.
    pub(super) facet_size: BufferRef<f32>,
    /// Which particle stands for each facet.
    pub(super) homes: BufferRef<u32>,
    /// Areas and albedos added up at each particle.
    pub(super) tallies: BufferRef<u32>,
    pub(super) chunks: Vec<Chunk>,
    /// First ends; where something is specular, all second ends behind.
    pub(super) scatter_links: BufferRef<u32>,
    /// What the links of each bring of the sky's and of emissive surfaces' light, as in glsl/particles/arrivals.glsl.
    pub(super) arrivals: BufferRef<u32>,
    /// Neighbours of each, in a fixed room.
    pub(super) lists: BufferRef<u32>,
    pub(super) list_lengths: BufferRef<u32>,
}

impl Kept {
    pub(super) fn declare(
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        options: &ParticlesOptions,
        (particle_count, levels): (u32, Levels),
        cells: &Cells,
    ) -> Kept {
        let &ParticlesOptions { scatter, gather, emitter_samples, .. } = options;
        let count = particle_count as usize;
        let chunks = (0..).zip((0..particle_count).step_by(CHUNK as usize)).map(|(number, first)| {
            let count = CHUNK.min(particle_count - first);
            let links = graph.carried_buffer(&format!("particles.links.{number}"), (count * gather * gather) as usize);
            Chunk { first, count, links }
        });
        let chunks = chunks.collect();
        let sky_shines = scene.sky != [0.0; 3];
        let second_ends = scatter * scatter * particle_count;
        let ends = if scene.facts.specular { 2 } else { 1 };
        let arrival_words = if scene.emissive_count > 0 { 9 } else { 3 };
        let sky_levels = if sky_shines { levels } else { Levels::default() };
        let arrival_words = arrival_words + 3 * sky_levels.late() as usize;
        let cell_room = cells.weights.count();
        // Where particles do not lie evenly their places depend on what is around.
        let around = if cells.adaptive > 0 { scene.surfaces_key() } else { 0 };
        Kept {
            rest: hash_of(&(
                scene.emission_key(),
                particle_count,
                scatter,
                gather,
                emitter_samples,
                sky_shines,
                scene.backs(),
                sky_levels,
                around,
            )),
            surfaces: scene.surfaces_key(),
            shapes: scene.shapes,
            sky_shines,
            sky_levels,
            second_ends,
            facets: graph.carried_buffer("particles.facets", 2 * (scene.triangle_count as usize + 1 + cell_room)),
            facet_size: graph.carried_buffer("particles.facet_size", 1),
            homes: graph.carried_buffer("particles.facet_homes", cell_room + FACETS as usize * count),
            tallies: graph.carried_buffer("particles.tallies", 4 * (1 + scene.facts.broad as usize) * count),
            chunks,
            scatter_links: graph.carried_buffer("particles.scatter_links", ends * second_ends as usize),
            arrivals: graph.carried_buffer("particles.arrivals", arrival_words * count),
            lists: graph.carried_buffer("particles.lists", LIST_CAPACITY * count),
            list_lengths: graph.carried_buffer("particles.list_lengths", count),
        }
    }

    /// The key of their contents.
    pub(super) fn key(&self) -> u64 {
        self.key_on(self.surfaces)
    }

    /// The key of how triangles are cut, which stands while they move.
    pub(super) fn cut_key(&self) -> u64 {
        hash_of(&("particles.facets", self.shapes, self.rest))
    }

    fn key_on(&self, surfaces: u64) -> u64 {
        hash_of(&("particles", surfaces, self.rest))
    }

    /// Lets passes start from what memory holds, if it is all of what belongs to the surfaces of that key.
    pub(super) fn carry_on(&self, graph: &mut Graph<'_>, surfaces: u64) -> bool {
        let &Kept { homes, tallies, scatter_links, arrivals, lists, list_lengths, .. } = self;
        let all = [homes, tallies, scatter_links, arrivals, lists, list_lengths];
        let all: Vec<BufferRef<u32>> = all.into_iter().chain(self.chunks.iter().map(|chunk| chunk.links)).collect();
        let key = self.key_on(surfaces);
        if !all.iter().all(|buffer| graph.finds(*buffer, key)) {
            return false;
        }
        all.iter().for_each(|buffer| graph.carry_on(*buffer, key));
        true
    }
}
