//! The grid: cubic voxels around what matters of the scene, not a cube of them.

use glam::{DVec3, Vec3};

use crate::frame::scene_data::SceneData;
use crate::shaders::types;

/// Voxels along the longest axis; multiples of 8.
pub(crate) const LEAST_RESOLUTION: u32 = 16;
pub(crate) const MOST_RESOLUTION: u32 = 512;

/// Voxels along the longest axis that are not between the scene's two ends: both lie in the middle of a voxel, behind which there is another one.
const BORDER: f64 = 3.0;

/// Coordinates of corners have as many bits (glsl/voxels/grid.glsl).
const COORDINATE_BITS: u32 = 14;
const MOST_UNITS: i32 = 64;

/// Where voxels lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VoxelGrid {
    pub(crate) record: types::VoxelGrid,
}

impl VoxelGrid {
    /// Around what matters of the scene now. `resolution` is rounded up to what the coarsest level is made of.
    pub(crate) fn around(data: &SceneData, resolution: u32) -> VoxelGrid {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for bulk in data.drawn.iter().filter(|drawn| drawn.index_count > 0).filter_map(|drawn| drawn.bulk) {
            let center = Vec3::from(bulk.center_rs).as_dvec3();
            let reach: DVec3 = bulk.half_axes_rs.iter().map(|&axis| Vec3::from(axis).as_dvec3().abs()).sum();
            (low, high) = (low.min(center - reach), high.max(center + reach));
        }
        if low.x > high.x {
            (low, high) = (data.middle_rs - data.radius, data.middle_rs + data.radius);
        }
        VoxelGrid::of(low, high, data.radius, resolution)
    }

    /// Around a box. `radius`: of the scene, m; what is much flatter has voxels all the same.
    pub(super) fn of(low: DVec3, high: DVec3, radius: f64, resolution: u32) -> VoxelGrid {
        let resolution = resolution.clamp(LEAST_RESOLUTION, MOST_RESOLUTION);
        let levels = level_count(resolution);
        let coarsest = 4.max(1_u32 << (levels - 1));
        let resolution = resolution.next_multiple_of(coarsest).min(MOST_RESOLUTION);
        let extent = high - low;
        let size = extent.max_element().max(1e-6 * radius) / (f64::from(resolution) - BORDER);
        // What rounding adds to the longest axis is no voxel more.
        let voxels = (extent / size + BORDER - 1e-6).ceil().as_uvec3();
        let dims = voxels.to_array().map(|count| count.next_multiple_of(coarsest).min(resolution).cast_signed());
        let units = MOST_UNITS.min((1 << COORDINATE_BITS) / resolution.next_power_of_two().cast_signed());
        let origin_rs = (low - 0.5 * BORDER * size).as_vec3().to_array();
        let levels = levels.cast_signed();
        VoxelGrid { record: types::VoxelGrid { origin_rs, size: size as f32, dims, units, levels } }
    }

    pub(crate) fn dims(&self) -> [u32; 3] {
        self.record.dims.map(i32::cast_unsigned)
    }

    pub(crate) fn voxel_count(&self) -> u32 {
        self.dims().iter().product()
    }

    pub(crate) fn levels(&self) -> u32 {
        self.record.levels.cast_unsigned()
    }

    /// Blocks that distances are known of (glsl/voxels/blocks.glsl).
    pub(crate) fn blocks(&self) -> [u32; 3] {
        self.dims().map(|count| count.div_ceil(4))
    }

    /// For hashes.
    pub(crate) fn bits(&self) -> ([u32; 3], u32, [i32; 3]) {
        (self.record.origin_rs.map(f32::to_bits), self.record.size.to_bits(), self.record.dims)
    }
}

/// The coarsest level has eight voxels along the longest axis.
fn level_count(resolution: u32) -> u32 {
    resolution.ilog2() - 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_axis_has_as_many_voxels_as_are_asked_for_and_the_others_as_they_need() {
        for scale in [1e-3, 1.0, 1e3] {
            let (low, high) = (DVec3::new(-2.0, 0.0, 1.0) * scale, DVec3::new(2.0, 1.0, 2.5) * scale);
            let grid = VoxelGrid::of(low, high, 2.2 * scale, 128);
            assert_eq!((grid.dims(), grid.levels(), grid.record.units), ([128, 48, 64], 5, 64));
            let size = f64::from(grid.record.size);
            assert!((size * 125.0 / (4.0 * scale) - 1.0).abs() < 1e-6, "{size}");
            let origin = Vec3::from(grid.record.origin_rs).as_dvec3();
            assert!((origin - (low - 1.5 * size)).abs().max_element() < 1e-6 * scale, "{origin}");
        }
    }

    #[test]
    fn coordinates_fit_and_every_level_halves() {
        for resolution in [1, 16, 17, 40, 100, 128, 200, 256, 300, 512, 4096] {
            let grid = VoxelGrid::of(DVec3::ZERO, DVec3::new(1.0, 0.7, 0.3), 1.0, resolution);
            for count in grid.record.dims {
                assert!(count * grid.record.units <= 1 << COORDINATE_BITS, "{resolution}: {grid:?}");
                assert_eq!(count % (1 << (grid.record.levels - 1)), 0, "{resolution}: {grid:?}");
                assert_eq!(count % 4, 0, "{resolution}: {grid:?}");
            }
            assert!(grid.record.dims[0] >= resolution.min(512).cast_signed());
        }
    }

    #[test]
    fn a_scene_without_thickness_has_a_grid() {
        let grid = VoxelGrid::of(DVec3::ONE, DVec3::ONE, 0.5, 64);
        assert!(grid.record.size > 0.0 && grid.dims().iter().all(|&count| count > 0), "{grid:?}");
        assert_eq!(VoxelGrid::of(DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0), 0.7, 64).dims(), [64, 8, 64]);
    }
}
