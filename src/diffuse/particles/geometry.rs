//! The geometry stage: particles on the surfaces, what they stand for, links between them, and the lists by which their irradiance is read. It stands while
//! geometry and materials do.

use super::events::Levels;
use super::kept::{Chunk, Kept};
use super::links::link;
use super::lists::list;
use super::measure::measure;
use super::moved::Moved;
use super::options::{ParticleDensity, ParticlesOptions, ParticlesReceivers};
use super::place::Placed;
use super::stage::Stage;
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::groups::{Particles, SceneRays};

/// A particle's spacing over the scene's radius at most and at least, unless the options say how many there are; between these half the size of its finer
/// triangles.
const SPACING: f64 = 0.0125;
const FINEST: f64 = 0.0025;

/// What the geometry stage leaves.
pub(super) struct ParticleSpace {
    pub(super) count: u32,
    /// 1: normal maps turn surfaces against their particles.
    pub(super) turns: u32,
    /// How light is told apart by specular events.
    pub(super) levels: Levels,
    pub(super) rays: SceneRays,
    pub(super) group: Particles,
    /// Records of triangles and of cells; the particle that stands for each facet (glsl/particles/facets.glsl).
    pub(super) facets: BufferRef<u32>,
    pub(super) homes: BufferRef<u32>,
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
    let by_area = scene.own_area / spacing.powi(2);
    if options.count > 0 { options.count } else { by_area.clamp(20_000.0, 200_000.0) as u32 }
}

/// Why particles lie evenly, if they do.
pub(super) fn why_even(scene: &TracedScene, options: &ParticlesOptions) -> Option<&'static str> {
    if options.density == ParticleDensity::Even {
        Some("particles lie evenly")
    } else if options.receivers == ParticlesReceivers::Mesh {
        Some("radiance particles take evenly spread ones")
    } else if scene.facts.animated {
        Some("particles lie evenly where something is animated")
    } else if !scene.facts.sky && scene.facts.directional_lights == 0 {
        Some("neither a sky nor a sun shines")
    } else {
        None
    }
}

impl ParticleSpace {
    /// Declares the stage.
    pub(super) fn declare(graph: &mut Graph<'_>, scene: &TracedScene, options: &ParticlesOptions) -> ParticleSpace {
        let particle_count = count_of(scene, options);
        let placed = Placed::declare(graph, scene, particle_count, why_even(scene, options));
        let levels = Levels::new(scene, options);
        let kept = Kept::declare(graph, scene, options, (particle_count, levels), &placed.cells);
        let moved = scene.motion.as_ref().filter(|motion| kept.carry_on(graph, motion.from));
        let moved = moved.map(|motion| Moved::declare(graph, motion, &placed, particle_count));
        let lost = graph.buffer::<u32>("particles.lost", 2);
        graph.fill_buffer("diffuse/particles/place/clear-lost", lost, 0);
        let stage = Stage { particle_count, broad_lobes: u32::from(scene.facts.broad), placed, kept, moved, lost };
        let matter = measure(graph, &stage);
        link(graph, scene, options, &stage);
        list(graph, &stage);
        let Stage { placed: Placed { rays, group, .. }, kept, .. } = stage;
        let Kept { facets, homes, chunks, scatter_links, arrivals, lists, list_lengths, .. } = kept;
        ParticleSpace {
            count: particle_count,
            turns: u32::from(scene.facts.normal_mapped),
            levels,
            rays,
            group,
            facets,
            homes,
            matter,
            chunks,
            scatter_links,
            arrivals,
            lists,
            list_lengths,
        }
    }
}
