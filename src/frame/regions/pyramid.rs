//! Which regions are flat: a pyramid of planes with a bound of what is off them, and of the least and the greatest normals.

use ash::vk;

use super::rule::RegionRule;
use crate::frame::gbuffer::GBuffer;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::shaders::regions::{First, FirstPush, Larger, LargerPush};
use crate::vulkan::ImageInfo;

/// The pyramid: mip l − 1 is level l of the regions (glsl/regions/regions.glsl).
pub(crate) struct Pyramid {
    pub(crate) planes: ImageRef,
    pub(crate) normals: ImageRef,
    /// Sizes of regions, pixels included; at least 2.
    pub(crate) level_count: u32,
    /// The valid regions (glsl/regions/list.glsl), if they are asked for.
    pub(crate) list: Option<BufferRef<u32>>,
}

/// The largest region is at most one part of so many of the image's shorter side: over more of it, light is not linear. Sixteen adds 0.005 to the
/// rrmse of a Cornell box, thirty-two 0.001 at 13 % more regions.
const LEAST_REGIONS: u32 = 32;
/// Words of the list before its first region: three of an indirect dispatch, the length.
const LIST_HEADER: usize = 4;

/// As many levels as the settings ask for and the image is large enough for.
pub(crate) fn level_count(size: [u32; 2], wanted: u32) -> u32 {
    let largest = size[0].min(size[1]) / LEAST_REGIONS;
    wanted.min(largest.max(1).ilog2() + 1)
}

/// Declares the passes, one a level; `level_count` is at least 2. `group_regions`: asks for the list of valid regions, for groups that gather for so
/// many of them each.
pub(crate) fn pyramid(
    graph: &mut Graph<'_>,
    buffer: &GBuffer,
    rule: &RegionRule,
    level_count: u32,
    group_regions: Option<u32>,
) -> Pyramid {
    let size = buffer.size;
    let RegionRule { depth_threshold, normal_threshold, slope_threshold, .. } = *rule;
    let info = |format| ImageInfo {
        format,
        extent: [size[0] / 2, size[1] / 2, 1],
        mips: level_count - 1,
        layers: 1,
        volume: false,
    };
    let planes = graph.image_with(&rule.resource("planes"), info(vk::Format::R32G32B32A32_SFLOAT));
    let normals = graph.image_with(&rule.resource("normals"), info(vk::Format::R32G32B32A32_UINT));
    // Every region holds a pixel of its own.
    let capacity = if group_regions.is_some() { size[0] as usize * size[1] as usize } else { 0 };
    let list = graph.buffer::<u32>(&rule.resource("regions"), LIST_HEADER + capacity);
    graph.fill_buffer(&rule.pass("regions/clear-list"), list, 0);
    let (lists, group_regions) = (u32::from(group_regions.is_some()), group_regions.unwrap_or(1));
    let pass = First {
        surface: buffer.group.clone(),
        planes: planes.mip(0).write(),
        normals: normals.mip(0).write(),
        list: list.read_write(),
        lists,
        group_regions,
        push: FirstPush {
            size: signed(size),
            level_count: level_count.cast_signed(),
            depth_threshold,
            normal_threshold,
            slope_threshold,
        },
    };
    graph.pass(&rule.pass("regions/squares-2"), pass).unordered().pixels(size.map(|side| side.div_ceil(2)));
    for level in 2..level_count {
        let pass = Larger {
            surface: buffer.group.clone(),
            quarter_planes: planes.mip(level - 2).sampled(),
            quarter_normals: normals.mip(level - 2).sampled(),
            planes: planes.mip(level - 1).write(),
            normals: normals.mip(level - 1).write(),
            list: list.read_write(),
            lists,
            group_regions,
            push: LargerPush {
                size: signed(size),
                level: level.cast_signed(),
                level_count: level_count.cast_signed(),
                depth_threshold,
                normal_threshold,
                slope_threshold,
            },
        };
        // Those that the image cuts off too: their quarters may be valid.
        let regions = size.map(|side| (side >> (level - 1)).div_ceil(2));
        graph.pass(&rule.pass(&format!("regions/squares-{}", 1 << level)), pass).unordered().pixels(regions);
    }
    Pyramid { planes, normals, level_count, list: (lists == 1).then_some(list) }
}

pub(crate) fn signed(size: [u32; 2]) -> [i32; 2] {
    size.map(u32::cast_signed)
}
