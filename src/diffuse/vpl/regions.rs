//! The valid regions: marked in the stencil of the flattened image, or on a list.

use ash::vk;

use super::VplInputs;
use super::pyramid::{Pyramid, signed};
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::shaders::vpl::{ListRegions, ListRegionsPush, MarkRegions, MarkRegionsPush};
use crate::vulkan::{RasterState, StencilState};

/// What the stencil of a valid region holds.
pub(super) const VALID: u32 = 1;
/// Words before the first region of the list: three of an indirect dispatch, the length.
const LIST_HEADER: usize = 4;

/// Size of the image that all levels lie in (glsl/vpl/regions.glsl).
pub(super) fn flattened_size(size: [u32; 2]) -> [u32; 2] {
    [size[0].next_multiple_of(4) + size[0] / 2, size[1]]
}

/// The stencil image with [`VALID`] where a region is valid.
pub(super) fn mark(graph: &mut Graph<'_>, inputs: &VplInputs<'_>, pyramid: &Pyramid) -> ImageRef {
    let size = inputs.buffer.size;
    let stencil = graph.image("vpl.stencil", vk::Format::S8_UINT, flattened_size(size));
    let pass = MarkRegions {
        depth: inputs.buffer.depth.sampled(),
        planes: pyramid.planes.sampled(),
        push: MarkRegionsPush { size: signed(size), level_count: pyramid.level_count.cast_signed() },
    };
    let marks = StencilState { compare: vk::CompareOp::ALWAYS, pass: vk::StencilOp::REPLACE, reference: VALID };
    let state = RasterState {
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        stencil: Some(marks),
        ..RasterState::default()
    };
    graph.raster("diffuse/vpl/mark", pass, state).stencil(stencil, Some(0)).vertices(3, 1);
    stencil
}

/// The list of valid regions, for groups that gather for `group_size` of them each.
pub(super) fn list(
    graph: &mut Graph<'_>,
    inputs: &VplInputs<'_>,
    pyramid: &Pyramid,
    group_size: u32,
) -> BufferRef<u32> {
    let size = inputs.buffer.size;
    // Every region holds a pixel of its own.
    let capacity = size[0] as usize * size[1] as usize;
    let list = graph.buffer::<u32>("vpl.list", LIST_HEADER + capacity);
    graph.fill_buffer("diffuse/vpl/clear-list", list, 0);
    let pass = ListRegions {
        depth: inputs.buffer.depth.sampled(),
        planes: pyramid.planes.sampled(),
        list: list.read_write(),
        push: ListRegionsPush { size: signed(size), level_count: pyramid.level_count.cast_signed(), group_size },
    };
    graph.pass("diffuse/vpl/list", pass).count("regions", list, 3).pixels(flattened_size(size));
    list
}
