//! Voxels of a scene, read back.

use crate::frame::geometry::Geometry;
use crate::frame::inputs::FrameTime;
use crate::frame::scene_data::SceneData;
use crate::frame::voxels::grid::VoxelGrid;
use crate::frame::voxels::{VoxelSettings, declare};
use crate::graph::{Graph, Store};
use crate::renderer::{PassTiming, Timing};
use crate::scene::Scene;
use crate::shaders::types;

pub(super) struct Read {
    pub(super) grid: VoxelGrid,
    pub(super) bits: Vec<bool>,
    /// In units of the grid, in the order of the list.
    pub(super) triangles: Vec<[[i64; 3]; 3]>,
    pub(super) levels: Vec<Vec<[u8; 4]>>,
    pub(super) passes: Vec<PassTiming>,
    pub(super) outgrown: Vec<String>,
    /// Where render space has its zero.
    pub(super) origin: glam::DVec3,
}

impl Read {
    pub(super) fn dims(&self) -> [usize; 3] {
        self.grid.dims().map(|count| count as usize)
    }

    pub(super) fn count(&self) -> usize {
        self.bits.iter().filter(|bit| **bit).count()
    }

    /// The voxel that a point of the world lies in.
    pub(super) fn voxel_at(&self, point: glam::DVec3) -> [usize; 3] {
        let origin = glam::Vec3::from(self.grid.record.origin_rs).as_dvec3();
        ((point - self.origin - origin) / f64::from(self.grid.record.size)).as_uvec3().to_array().map(|at| at as usize)
    }

    pub(super) fn is_set(&self, [x, y, z]: [usize; 3]) -> bool {
        let [width, height, _] = self.dims();
        self.bits[(z * height + y) * width + x]
    }

    /// Names of the passes that ran.
    pub(super) fn ran(&self) -> Vec<String> {
        self.passes.iter().filter(|pass| pass.skipped.is_none()).map(PassTiming::full_name).collect()
    }
}

fn corners(packed: &types::PackedTriangle) -> [[i64; 3]; 3] {
    let words = packed.first.into_iter().chain(packed.second).flat_map(|word| [word & 0xFFFF, word >> 16]);
    let numbers: Vec<i64> = words.map(i64::from).collect();
    [0, 1, 2].map(|corner| [0, 1, 2].map(|axis| numbers[3 * corner + axis]))
}

/// The voxels of a frame of the scene; made again where buffers grew.
pub(super) fn voxelise(store: &mut Store, scene: &Scene, settings: &VoxelSettings, step: f32) -> Read {
    voxelise_in(store, scene, settings, step, |data| VoxelGrid::around(data, settings.resolution))
}

/// The same in a grid of the caller's.
pub(super) fn voxelise_in(
    store: &mut Store,
    scene: &Scene,
    settings: &VoxelSettings,
    step: f32,
    grid: impl Fn(&SceneData) -> VoxelGrid,
) -> Read {
    let mut outgrown = Vec::new();
    loop {
        let read = attempt(store, scene, settings, step, &grid);
        if read.outgrown.is_empty() {
            return Read { outgrown, ..read };
        }
        assert!(outgrown.len() < 8, "{:?} grow and grow", read.outgrown);
        outgrown.extend(read.outgrown);
    }
}

fn attempt(
    store: &mut Store,
    scene: &Scene,
    settings: &VoxelSettings,
    step: f32,
    grid: impl Fn(&SceneData) -> VoxelGrid,
) -> Read {
    let device = store.device().clone();
    let data = SceneData::update(&device, store.pipelines(), None, scene).expect("the scene fits the device");
    let mut graph = Graph::new(store);
    let geometry = Geometry::import(&mut graph, &data);
    let (made, occupied) = declare(&mut graph, (&data, &geometry), FrameTime { index: 0, step }, grid(&data), settings);
    let bits = graph.read_back_buffer(occupied.bits);
    let lists = [graph.read_back_buffer(occupied.triangles), graph.read_back_buffer(occupied.counts)];
    let levels: Vec<_> = (0..made.grid.levels()).map(|level| graph.read_back(made.opacity.mip(level))).collect();
    let mut executed = graph.run(Timing::Passes).expect("a frame");
    let outgrown: Vec<String> = executed.outgrown.drain(..).map(|(name, _)| name).collect();
    if !outgrown.is_empty() {
        let (bits, triangles, levels) = Default::default();
        return Read {
            grid: made.grid,
            bits,
            triangles,
            levels,
            passes: executed.passes,
            outgrown,
            origin: data.origin,
        };
    }
    let words = bytemuck::pod_collect_to_vec::<u8, u32>(&executed.take(bits));
    let bits = words.iter().flat_map(|word| (0..32).map(move |bit| word >> bit & 1 == 1));
    let bits = bits.take(made.grid.voxel_count() as usize).collect();
    let [packed, counts] = lists.map(|list| executed.take(list));
    let count = bytemuck::pod_collect_to_vec::<u8, u32>(&counts)[0] as usize;
    let packed = bytemuck::pod_collect_to_vec::<u8, types::PackedTriangle>(&packed);
    let triangles = packed[..count].iter().map(corners).collect();
    let levels = levels.into_iter().map(|level| bytemuck::pod_collect_to_vec::<u8, [u8; 4]>(&executed.take(level)));
    let levels = levels.collect();
    Read { grid: made.grid, bits, triangles, levels, passes: executed.passes, outgrown, origin: data.origin }
}
