//! The valid regions, marked in the stencil of the flattened image.

use ash::vk;

use super::pyramid::{Pyramid, signed};
use super::rule::RegionRule;
use crate::frame::gbuffer::GBuffer;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::regions::{Mark, MarkPush};
use crate::vulkan::{RasterState, StencilState};

/// What the stencil of a valid region holds.
pub(crate) const VALID: u32 = 1;

/// Size of the image that all levels lie in (glsl/regions/regions.glsl).
pub(crate) fn flattened_size(size: [u32; 2]) -> [u32; 2] {
    [size[0].next_multiple_of(4) + size[0] / 2, size[1]]
}

/// The stencil image with [`VALID`] where a region is valid.
pub(crate) fn mark(graph: &mut Graph<'_>, buffer: &GBuffer, rule: &RegionRule, pyramid: &Pyramid) -> ImageRef {
    let size = buffer.size;
    let stencil = graph.image(&rule.resource("stencil"), vk::Format::S8_UINT, flattened_size(size));
    let pass = Mark {
        surface: buffer.group.clone(),
        planes: pyramid.planes.sampled(),
        push: MarkPush { size: signed(size), level_count: pyramid.level_count.cast_signed() },
    };
    let marks = StencilState { compare: vk::CompareOp::ALWAYS, pass: vk::StencilOp::REPLACE, reference: VALID };
    let state =
        RasterState { topology: vk::PrimitiveTopology::TRIANGLE_LIST, stencil: Some(marks), ..RasterState::default() };
    graph.raster(&rule.pass("regions/mark"), pass, state).stencil(stencil, Some(0)).vertices(3, 1);
    stencil
}
