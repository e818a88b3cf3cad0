//! The valid regions, marked in the stencil of the flattened image.

use ash::vk;

use super::pyramid::{Pyramid, signed};
use crate::graph::bindings::ImageRef;
use crate::method::FrameCx;
use crate::shaders::vpl::{MarkRegions, MarkRegionsPush};
use crate::vulkan::{RasterState, StencilState};

/// What the stencil of a valid region holds.
pub(super) const VALID: u32 = 1;

/// Size of the image that all levels lie in (glsl/vpl/regions.glsl).
pub(crate) fn flattened_size(size: [u32; 2]) -> [u32; 2] {
    [size[0].next_multiple_of(4) + size[0] / 2, size[1]]
}

/// The stencil image with [`VALID`] where a region is valid.
pub(super) fn mark(cx: &mut FrameCx<'_, '_>, pyramid: &Pyramid) -> ImageRef {
    let (graph, buffer) = (&mut *cx.graph, cx.frame.surface);
    let size = buffer.size;
    let stencil = graph.image("vpl.stencil", vk::Format::S8_UINT, flattened_size(size));
    let pass = MarkRegions {
        surface: buffer.group.clone(),
        planes: pyramid.planes.sampled(),
        push: MarkRegionsPush { size: signed(size), level_count: pyramid.level_count.cast_signed() },
    };
    let marks = StencilState { compare: vk::CompareOp::ALWAYS, pass: vk::StencilOp::REPLACE, reference: VALID };
    let state =
        RasterState { topology: vk::PrimitiveTopology::TRIANGLE_LIST, stencil: Some(marks), ..RasterState::default() };
    graph.raster("diffuse/vpl/regions/mark", pass, state).stencil(stencil, Some(0)).vertices(3, 1);
    stencil
}
