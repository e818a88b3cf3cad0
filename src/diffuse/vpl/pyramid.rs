//! Which regions are flat: a pyramid of planes with a bound of what is off them, and of the least and the greatest normals.

use ash::vk;

use super::VplInputs;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::vpl::{FirstRegions, FirstRegionsPush, LargerRegions, LargerRegionsPush};
use crate::vulkan::ImageInfo;

/// The pyramid: mip l − 1 is level l of the regions (glsl/vpl/regions.glsl).
pub(super) struct Pyramid {
    pub(super) planes: ImageRef,
    pub(super) normals: ImageRef,
    /// Sizes of regions, pixels included; at least 2.
    pub(super) level_count: u32,
}

/// As many levels as the settings ask for and the image holds regions of.
pub(super) fn level_count(size: [u32; 2], wanted: u32) -> u32 {
    wanted.min(size[0].min(size[1]).max(1).ilog2() + 1)
}

/// Declares the passes, one a level; `level_count` is at least 2.
pub(super) fn pyramid(graph: &mut Graph<'_>, inputs: &VplInputs<'_>, level_count: u32) -> Pyramid {
    let buffer = inputs.buffer;
    let size = buffer.size;
    let thresholds = (inputs.settings.depth_threshold as f32, inputs.settings.normal_threshold as f32);
    let (depth_threshold, normal_threshold) = thresholds;
    let info = |format| ImageInfo {
        format,
        extent: [size[0] / 2, size[1] / 2, 1],
        mips: level_count - 1,
        layers: 1,
        volume: false,
    };
    let planes = graph.image_with("vpl.planes", info(vk::Format::R32G32B32A32_SFLOAT));
    let normals = graph.image_with("vpl.normals", info(vk::Format::R32G32B32A32_UINT));
    let pass = FirstRegions {
        camera: buffer.camera.clone(),
        depth: buffer.depth.sampled(),
        surface: buffer.surface.sampled(),
        planes: planes.mip(0).write(),
        normals: normals.mip(0).write(),
        push: FirstRegionsPush { size: signed(size), depth_threshold, normal_threshold },
    };
    graph.pass("diffuse/vpl/regions-2", pass).pixels(size.map(|side| side / 2));
    for level in 2..level_count {
        let regions = size.map(|side| side >> level);
        let pass = LargerRegions {
            camera: buffer.camera.clone(),
            quarter_planes: planes.mip(level - 2).sampled(),
            quarter_normals: normals.mip(level - 2).sampled(),
            planes: planes.mip(level - 1).write(),
            normals: normals.mip(level - 1).write(),
            push: LargerRegionsPush {
                size: signed(regions),
                side: (1_u32 << (level - 1)) as f32,
                depth_threshold,
                normal_threshold,
            },
        };
        graph.pass(&format!("diffuse/vpl/regions-{}", 1 << level), pass).pixels(regions);
    }
    Pyramid { planes, normals, level_count }
}

pub(super) fn signed(size: [u32; 2]) -> [i32; 2] {
    size.map(u32::cast_signed)
}
