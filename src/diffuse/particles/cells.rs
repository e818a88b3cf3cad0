//! Cells that triangles are cut into (glsl/particles/facets.glsl): over each of them particles are equally far apart. Where they lie evenly a triangle is one cell a
//! side.

use super::formats::{FLOAT, FLOATS4, WORD, WORDS2};
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::shaders::particles::{
    Cells as CutCells, CellsPush, TriangleSizes, TriangleSizesPush, Weights, WeightsPush, Whole, WholePush,
};

/// How large cells are, in spacings of evenly spread particles.
const SIZE: f64 = 6.0;
/// Particles for each of which there is room for a cell, beside one for each side of a triangle: even squares would take a fourteenth.
const PARTICLES_A_CELL: usize = 6;

/// Particles lie closest where what is around is no farther than this, over the scene's radius, as the harmonic mean.
const NEAREST: f64 = 0.5;

#[derive(Clone, Copy)]
pub(super) struct Cells {
    /// Longest edge and height of each triangle, m, the corner across, and how many sides count.
    pub(super) sizes: BufferRef<[f32; 4]>,
    /// First cell of each triangle and how it is cut; behind all of them the number of cells.
    pub(super) records: BufferRef<u32>,
    /// Of each cell the weighted area and how far apart its particles are (glsl/particles/widths.glsl).
    pub(super) weights: BufferRef<[u32; 2]>,
    /// 1: particles do not lie evenly.
    pub(super) adaptive: u32,
}

impl Cells {
    /// Declares them, by the areas of triangles and which of their backs count; `even`: why all are alike, if they are.
    pub(super) fn declare(
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        (areas, backs): (BufferRef<f32>, Option<BufferRef<u32>>),
        particle_count: u32,
        even: Option<&'static str>,
    ) -> Cells {
        let triangle_count = scene.triangle_count;
        let threads = [triangle_count, 1, 1];
        let scene_rays = scene.rays(graph);
        let has_backs = u32::from(backs.is_some());
        let sizes = graph.buffer::<[f32; 4]>("particles.triangle_sizes", triangle_count as usize);
        let pass = TriangleSizes {
            scene_rays: scene_rays.clone(),
            areas: areas.texels(FLOAT),
            has_backs,
            backs: backs_of(backs),
            sizes: sizes.write(),
            push: TriangleSizesPush { triangle_count },
        };
        graph.pass("diffuse/particles/place/sizes", pass).threads(threads);

        let spacing = (scene.own_area.max(1e-300) / f64::from(particle_count)).sqrt();
        let (size, more) = match even {
            Some(_) => (f32::MAX, 0),
            None => ((SIZE * spacing) as f32, particle_count as usize / PARTICLES_A_CELL),
        };
        let room = 2 * triangle_count as usize + more;
        let records = graph.buffer::<u32>("particles.cells", 2 * (triangle_count as usize + 1));
        let pass = CutCells {
            sizes: sizes.texels(FLOATS4),
            cells: records.write(),
            push: CellsPush { triangle_count, room: room as u32, size },
        };
        graph.pass("diffuse/particles/place/cells", pass).groups([1, 1, 1]);

        let weights = graph.buffer::<[u32; 2]>("particles.cell_weights", room);
        let pass = Weights {
            adaptive: u32::from(even.is_none()),
            scene_rays,
            areas: areas.texels(FLOAT),
            cells: records.texels(WORDS2),
            weights: weights.write(),
            has_backs,
            backs: backs_of(backs),
            push: WeightsPush {
                triangle_count,
                room: room as u32,
                spacing: spacing as f32,
                nearest: (NEAREST * scene.radius) as f32,
            },
        };
        if let Some(reason) = even {
            graph.skip("diffuse/particles/place/distances", reason);
        }
        let name = if even.is_some() { "diffuse/particles/place/weights" } else { "diffuse/particles/place/distances" };
        let pass = graph.pass(name, pass).count("cells", records, 2 * triangle_count as usize);
        pass.threads([room as u32, 1, 1]);
        let pass =
            Whole { cells: records.texels(WORDS2), weights: weights.read_write(), push: WholePush { triangle_count } };
        graph.pass("diffuse/particles/place/whole", pass).threads([2 * triangle_count, 1, 1]);
        Cells { sizes, records, weights, adaptive: u32::from(even.is_none()) }
    }
}

/// The bits of triangles whose backs count, as passes bind them.
pub(super) fn backs_of(backs: Option<BufferRef<u32>>) -> TexelBuffer {
    backs.map_or(TexelBuffer::absent(), |backs| backs.texels(WORD))
}
