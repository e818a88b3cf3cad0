//! The opacity of voxels: of bits, or of what moves towards them over frames; its coarser levels; and how far the next voxel is that has any.

use ash::vk;

use super::grid::VoxelGrid;
use crate::frame::inputs::FrameTime;
use crate::frame::scene_data::SceneData;
use crate::graph::bindings::{BufferRef, ImageRef, TexelBuffer};
use crate::graph::kept::Advance;
use crate::graph::{Graph, hash_of};
use crate::shaders::voxels;
use crate::vulkan::ImageInfo;

/// Levels of opacity: along x, y, z, and the mean (glsl/voxels/coarser.comp). Every device filters and stores the format.
const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;

/// Declares the levels. `adapted`: bytes of the finest one in place of bits.
pub(super) fn levels(
    graph: &mut Graph<'_>,
    grid: &VoxelGrid,
    bits: BufferRef<u32>,
    adapted: Option<BufferRef<u32>>,
) -> ImageRef {
    let (extent, mips) = (grid.dims(), grid.levels());
    let info = ImageInfo { format: FORMAT, extent, mips, layers: 1, volume: true };
    let opacity = graph.image_with("voxels.opacity", info);
    let words = |buffer: BufferRef<u32>| buffer.texels(vk::Format::R32_UINT);
    let pass = voxels::Opacity {
        bits: if adapted.is_some() { TexelBuffer::absent() } else { words(bits) },
        opacities: adapted.map_or(TexelBuffer::absent(), words),
        finest: opacity.mip(0).write(),
        adapted: u32::from(adapted.is_some()),
        push: voxels::OpacityPush { grid: grid.record },
    };
    graph.pass("voxels/opacity", pass).threads(fours(grid));
    for level in 1..mips {
        let pass = voxels::Coarser { finer: opacity.mip(level - 1).sampled(), coarser: opacity.mip(level).write() };
        graph.pass(&format!("voxels/level-{level}"), pass).threads(extent.map(|count| count >> level));
    }
    opacity
}

/// Bytes that follow the bits at `rate` (1/s), over frames.
pub(super) fn adapted(
    graph: &mut Graph<'_>,
    (data, grid): (&SceneData, &VoxelGrid),
    bits: BufferRef<u32>,
    (rate, time): (f32, FrameTime),
) -> BufferRef<u32> {
    let share = 1.0 - (-rate * time.step).exp();
    let depends = hash_of(&(data.identity, grid.bits()));
    let frames = frames_to_settle(share);
    // Its age is the number of frames since something moved.
    let moved = hash_of(&(data.instance_key, grid.bits()));
    let (since, age) = graph.state_buffer::<u32>("voxels.since", 1, moved, Advance::EveryFrame);
    // A content of its own for each of them.
    let word = hash_of(&(moved, age.min(frames))) as u32;
    graph.fill_buffer("voxels/since", since, word);
    graph.want_buffer(since);
    let still = age >= frames;
    let advance = if still { Advance::OnChange } else { Advance::EveryFrame };
    let words = grid.voxel_count().div_ceil(4) as usize;
    let history = graph.history_buffer::<u32>("voxels.adapted", words, depends, advance);
    let push = voxels::AdaptPush { grid: grid.record, share: if still || history.age == 0 { 1.0 } else { share } };
    let words = |buffer: BufferRef<u32>| buffer.texels(vk::Format::R32_UINT);
    let pass = voxels::Adapt { bits: words(bits), last: words(history.last), next: history.next.write(), push };
    graph.pass("voxels/adapt", pass).threads(fours(grid));
    history.next
}

/// Four neighbours along x each.
fn fours(grid: &VoxelGrid) -> [u32; 3] {
    let [x, y, z] = grid.dims();
    [x / 4, y, z]
}

/// Frames after which nothing of a difference of 255 is left (glsl/voxels/adapt.comp).
fn frames_to_settle(share: f32) -> u32 {
    let mut left = 255_u32;
    let mut frames = 0;
    while left > 0 {
        left -= ((share * left as f32).round() as u32).clamp(1, left);
        frames += 1;
    }
    frames
}

/// Declares how far each block is from the nearest one in which any voxel has an opacity.
pub(super) fn distances(graph: &mut Graph<'_>, grid: &VoxelGrid, opacity: ImageRef) -> TexelBuffer {
    let blocks = grid.blocks();
    let count: u32 = blocks.iter().product();
    let names = ["voxels.filled_blocks", "voxels.distances_x", "voxels.distances_xy", "voxels.distances"];
    let [filled, along_x, along_xy, all] = names.map(|name| graph.buffer::<u32>(name, count as usize));
    let pass = voxels::FilledBlocks { opacity: opacity.mip(0).sampled(), distances: filled.write() };
    graph.pass("voxels/distances/filled", pass).threads([count, 1, 1]);
    for (axis, (before, after)) in (0..).zip([(filled, along_x), (along_x, along_xy), (along_xy, all)]) {
        let pass = voxels::Distances {
            before: before.texels(vk::Format::R32_UINT),
            distances: after.write(),
            push: voxels::DistancesPush { blocks: blocks.map(u32::cast_signed), axis },
        };
        graph.pass(&format!("voxels/distances/axis-{axis}"), pass).threads([count, 1, 1]);
    }
    all.texels(vk::Format::R32_UINT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_gone_after_finitely_many_frames() {
        assert_eq!((frames_to_settle(1.0), frames_to_settle(0.0)), (1, 255));
        assert_eq!(frames_to_settle(0.5), 8);
    }
}
