//! Particles on the surfaces, numbered as they lie on the triangles, and the grid that finds them. All of them are placed anew whenever geometry changes: that
//! takes a hundredth of the time of their links.

use super::cells::{Cells, backs_of};
use super::formats::{FLOAT, WORD, WORDS2, WORDS4};
use crate::frame::rays::TracedScene;
use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph};
use crate::shaders::buckets::{Starts, StartsPush};
use crate::shaders::groups::{Particles, SceneRays};
use crate::shaders::particles::{
    AreaSums, AreaSumsPush, Areas, AreasPush, Crowd, CrowdPush, Fill, FillPush, Place, PlacePush, Sort, SortPush,
};

/// Particles at their places.
pub(super) struct Placed {
    pub(super) rays: SceneRays,
    pub(super) triangle_count: u32,
    /// Diffuse area of each triangle, m², of both sides where both count.
    pub(super) areas: BufferRef<f32>,
    /// Where particles lie closest, m.
    pub(super) spacing: BufferRef<f32>,
    pub(super) cells: Cells,
    pub(super) group: Particles,
}

impl Placed {
    /// Declares so many; `even`: why they lie evenly, if they do.
    pub(super) fn declare(
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        particle_count: u32,
        even: Option<&'static str>,
    ) -> Placed {
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

        let cells = Cells::declare(graph, scene, (areas, backs), particle_count, even);
        let sums = graph.buffer::<f32>("particles.area_sums", cells.weights.count() + 1);
        let spacing = graph.buffer::<f32>("particles.spacing", 1);
        let levels = graph.buffer::<u32>("particles.levels", 1);
        let pass = AreaSums {
            weights: cells.weights.texels(WORDS2),
            cells: cells.records.texels(WORDS2),
            sums: sums.write(),
            spacing: spacing.write(),
            levels: levels.write(),
            push: AreaSumsPush { triangle_count, particle_count },
        };
        graph.pass("diffuse/particles/place/sums", pass).groups([1, 1, 1]);

        let bucket_count = (particle_count / 2).next_power_of_two();
        let counts = graph.buffer::<u32>("particles.bucket_counts", bucket_count as usize);
        graph.fill_buffer("diffuse/particles/place/clear", counts, 0);
        let places = graph.buffer::<[u32; 4]>("particles.places", 2 * particle_count as usize);
        let buckets = graph.buffer::<u32>("particles.buckets", particle_count as usize);
        let pass = Place {
            scene_rays: rays.clone(),
            sums: sums.texels(FLOAT),
            spacing: spacing.texels(FLOAT),
            places: places.write(),
            buckets: buckets.write(),
            counts: counts.read_write(),
            cells: cells.records.texels(WORDS2),
            weights: cells.weights.texels(WORDS2),
            push: PlacePush { triangle_count, particle_count, bucket_count },
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
            levels_of_all: levels.texels(WORD),
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
            particle_levels: levels.uniform(),
            particle_entries: entries.texels(WORDS4),
        };
        Placed { rays, triangle_count, areas, spacing, cells, group }
    }
}
