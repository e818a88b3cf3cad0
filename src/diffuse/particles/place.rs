//! Particles on the surfaces, numbered as they lie on the triangles, and the grid that finds them. All of them are placed anew whenever geometry changes: that
//! takes a hundredth of the time of their links.

use super::formats::{FLOAT, WORD, WORDS4};
use crate::frame::rays::TracedScene;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::graph::{Dependence, Graph};
use crate::shaders::buckets::{Starts, StartsPush};
use crate::shaders::groups::{Particles, SceneRays};
use crate::shaders::particles::{
    AreaSums, AreaSumsPush, Areas, AreasPush, CellCounts, CellCountsPush, CellWeights, CellWeightsPush, Crowd,
    CrowdPush, Fill, FillPush, Place, PlacePush, Sort, SortPush,
};

/// Evenly spread particles of a cell that triangles are cut into, as in glsl/particles/cell_counts.comp.
const CELL_PARTICLES: u32 = 16;

/// Particles at their places.
pub(super) struct Placed {
    pub(super) rays: SceneRays,
    pub(super) triangle_count: u32,
    /// Diffuse area of each triangle, m², of both sides where both count.
    pub(super) areas: BufferRef<f32>,
    pub(super) spacing: BufferRef<f32>,
    /// A bit for each one-sided triangle whose back counts too, where there are any.
    pub(super) backs: Option<BufferRef<u32>>,
    pub(super) group: Particles,
}

impl Placed {
    /// Declares so many; `adaptive`: the denser the nearer other surfaces are.
    pub(super) fn declare(graph: &mut Graph<'_>, scene: &TracedScene, particle_count: u32, adaptive: bool) -> Placed {
        let rays = scene.rays(graph);
        let triangle_count = scene.triangle_count;
        let threads = [particle_count, 1, 1];
        let areas = graph.buffer::<f32>("particles.areas", triangle_count as usize);
        let marks = scene.backs();
        let backs = (!marks.is_empty()).then(|| graph.upload("particles.backs", marks, Dependence::GEOMETRY));
        let push = AreasPush { triangle_count };
        let pass = Areas {
            scene_rays: rays.clone(),
            own_areas: scene.own_areas(graph),
            areas: areas.write(),
            has_backs: u32::from(backs.is_some()),
            backs: backs_of(backs),
            push,
        };
        graph.pass("diffuse/particles/place/areas", pass).threads([triangle_count, 1, 1]);

        let weighted = adaptive.then(|| weigh(graph, scene, &rays, (areas, particle_count), backs));
        let cell_count = weighted.map_or(triangle_count, |weighted| weighted.count() as u32);
        let cells = graph.buffer::<[u32; 4]>("particles.cells", cell_count as usize + 1);
        let spacing = graph.buffer::<f32>("particles.spacing", 1);
        let pass = AreaSums {
            adaptive: u32::from(adaptive),
            areas: areas.texels(FLOAT),
            weighted: weighted.map_or_else(TexelBuffer::absent, |weighted| weighted.texels(WORDS4)),
            cells: cells.write(),
            spacing: spacing.write(),
            push: AreaSumsPush { cell_count, particle_count },
        };
        graph.pass("diffuse/particles/place/sums", pass).groups([1, 1, 1]);

        let bucket_count = (particle_count / 2).next_power_of_two();
        let counts = graph.buffer::<u32>("particles.bucket_counts", bucket_count as usize);
        graph.fill_buffer("diffuse/particles/place/clear", counts, 0);
        let places = graph.buffer::<[u32; 4]>("particles.places", 2 * particle_count as usize);
        let buckets = graph.buffer::<u32>("particles.buckets", particle_count as usize);
        let pass = Place {
            scene_rays: rays.clone(),
            cells: cells.texels(WORDS4),
            spacing: spacing.texels(FLOAT),
            places: places.write(),
            buckets: buckets.write(),
            counts: counts.read_write(),
            has_backs: u32::from(backs.is_some()),
            backs: backs_of(backs),
            push: PlacePush { cell_count, particle_count, bucket_count },
        };
        let pass = graph.pass("diffuse/particles/place/points", pass);
        pass.note("particles", u64::from(particle_count)).threads(threads);

        let starts = graph.buffer::<u32>("particles.bucket_starts", bucket_count as usize + 1);
        let push = StartsPush { bucket_count };
        let pass = Starts { counts: counts.texels(WORD), starts: starts.write(), push };
        graph.pass("diffuse/particles/place/starts", pass).groups([1, 1, 1]);
        let order = graph.buffer::<u32>("particles.order", particle_count as usize);
        let pass = Fill {
            buckets: buckets.texels(WORD),
            starts: starts.texels(WORD),
            counts: counts.read_write(),
            order: order.write(),
            push: FillPush { particle_count },
        };
        graph.pass("diffuse/particles/place/fill", pass).threads(threads);
        let sorted = graph.buffer::<[u32; 4]>("particles.sorted", particle_count as usize);
        let numbers = graph.buffer::<u32>("particles.numbers", particle_count as usize);
        let pass = Sort {
            order: order.texels(WORD),
            starts: starts.texels(WORD),
            places: places.texels(WORDS4),
            buckets: buckets.texels(WORD),
            numbers: numbers.write(),
            sorted: sorted.write(),
            push: SortPush { particle_count },
        };
        graph.pass("diffuse/particles/place/sort", pass).threads(threads);
        let entries = graph.buffer::<[u32; 4]>("particles.entries", 2 * particle_count as usize);
        let pass = Crowd {
            scene_rays: rays.clone(),
            sorted: sorted.texels(WORDS4),
            starts: starts.texels(WORD),
            spacing_of_all: spacing.texels(FLOAT),
            numbers: numbers.texels(WORD),
            places: places.texels(WORDS4),
            entries: entries.write(),
            push: CrowdPush { particle_count },
        };
        graph.pass("diffuse/particles/place/crowd", pass).threads(threads);
        let group = Particles {
            particle_places: places.texels(WORDS4),
            particle_starts: starts.texels(WORD),
            particle_spacing: spacing.uniform(),
            particle_entries: entries.texels(WORDS4),
        };
        Placed { rays, triangle_count, areas, spacing, backs, group }
    }
}

/// Cuts triangles into cells, each with its weight; behind the last one there may be some without area.
fn weigh(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    rays: &SceneRays,
    (areas, particle_count): (BufferRef<f32>, u32),
    backs: Option<BufferRef<u32>>,
) -> BufferRef<[u32; 4]> {
    let triangle_count = scene.triangle_count;
    let particles_an_area = f64::from(particle_count) / scene.own_area.max(1e-300);
    let counts = graph.buffer::<u32>("particles.cell_counts", triangle_count as usize);
    let push = CellCountsPush { triangle_count, particles_an_area: particles_an_area as f32 };
    let pass = CellCounts { areas: areas.texels(FLOAT), counts: counts.write(), push };
    graph.pass("diffuse/particles/place/cells", pass).threads([triangle_count, 1, 1]);
    let starts = graph.buffer::<u32>("particles.cell_starts", triangle_count as usize + 1);
    let push = StartsPush { bucket_count: triangle_count };
    let pass = Starts { counts: counts.texels(WORD), starts: starts.write(), push };
    graph.pass("diffuse/particles/place/cell-starts", pass).groups([1, 1, 1]);
    // n² < 4x for n = ⌈√x⌉ and x > 1; two-sided surfaces have twice their area.
    let cell_room = triangle_count + 8 * particle_count / CELL_PARTICLES;
    let weighted = graph.buffer::<[u32; 4]>("particles.weighted_cells", cell_room as usize);
    let pass = CellWeights {
        scene_rays: rays.clone(),
        areas: areas.texels(FLOAT),
        starts: starts.texels(WORD),
        has_backs: u32::from(backs.is_some()),
        backs: backs_of(backs),
        cells: weighted.write(),
        push: CellWeightsPush { triangle_count, cell_room, spacing: particles_an_area.sqrt().recip() as f32 },
    };
    graph.pass("diffuse/particles/place/weights", pass).threads([cell_room, 1, 1]);
    weighted
}

/// As passes bind them.
pub(super) fn backs_of(backs: Option<BufferRef<u32>>) -> TexelBuffer {
    backs.map_or(TexelBuffer::absent(), |backs| backs.texels(WORD))
}
