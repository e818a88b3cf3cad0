//! Irradiance from all VPLs, at pixels or at regions.

use ash::vk;

use super::VplInputs;
use super::pyramid::{Pyramid, signed};
use super::regions::{VALID, flattened_size};
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{ClearColor, Graph};
use crate::shaders::vpl::{
    GatherPixels, GatherPixelsPush, GatherRegions, GatherRegionsPush, GatherStencil, GatherStencilPush,
};
use crate::vulkan::{RasterState, StencilState};

/// The slot, gathered at every pixel.
pub(super) fn gather_pixels(
    graph: &mut Graph<'_>,
    inputs: &VplInputs<'_>,
    vpls: BufferRef<[f32; 4]>,
    diffuse: ImageRef,
) {
    let buffer = inputs.buffer;
    let vpl_count = inputs.settings.count;
    let (specular, has_specular) = buffer.specular();
    let pass = GatherPixels {
        camera: buffer.camera.clone(),
        depth: buffer.depth.sampled(),
        surface: buffer.surface.sampled(),
        specular: specular.sampled(),
        vpls: vpls.texels(vk::Format::R32G32B32A32_SFLOAT),
        diffuse: diffuse.write(),
        push: GatherPixelsPush { vpl_count, has_specular },
    };
    let [width, height] = buffer.size;
    let terms = u64::from(width) * u64::from(height) * u64::from(vpl_count);
    graph.pass("diffuse/vpl/gather-pixels", pass).note("VPL terms", terms).groups([
        width.div_ceil(16),
        height.div_ceil(8),
        1,
    ]);
}

/// Regions that one group of the list's gather takes.
pub(super) const REGIONS_PER_GROUP: u32 = 128;

/// Irradiance of the regions on the list, in the flattened image; alpha is 0 where there is none.
pub(super) fn gather_list(
    graph: &mut Graph<'_>,
    inputs: &VplInputs<'_>,
    vpls: BufferRef<[f32; 4]>,
    pyramid: &Pyramid,
    list: BufferRef<u32>,
) -> ImageRef {
    let buffer = inputs.buffer;
    let irradiance = flattened(graph, buffer.size);
    graph.clear_image("diffuse/vpl/clear-irradiance", irradiance, ClearColor::Float([0.0; 4]));
    let pass = GatherRegions {
        camera: buffer.camera.clone(),
        depth: buffer.depth.sampled(),
        surface: buffer.surface.sampled(),
        planes: pyramid.planes.sampled(),
        normals: pyramid.normals.sampled(),
        vpls: vpls.texels(vk::Format::R32G32B32A32_SFLOAT),
        list: list.texels(vk::Format::R32_UINT),
        irradiance: irradiance.modify(),
        push: GatherRegionsPush {
            size: signed(buffer.size),
            level_count: pyramid.level_count.cast_signed(),
            vpl_count: inputs.settings.count,
        },
    };
    graph.pass("diffuse/vpl/gather-regions", pass).count("regions", list, 3).threads_indirect(list, 0);
    irradiance
}

/// The same where the stencil is marked. Returns the count of invocations besides.
pub(super) fn gather_stencil(
    graph: &mut Graph<'_>,
    inputs: &VplInputs<'_>,
    vpls: BufferRef<[f32; 4]>,
    pyramid: &Pyramid,
    stencil: ImageRef,
) -> (ImageRef, BufferRef<u32>) {
    let buffer = inputs.buffer;
    let irradiance = flattened(graph, buffer.size);
    let invocations = graph.buffer::<u32>("vpl.invocations", 1);
    graph.fill_buffer("diffuse/vpl/clear-invocations", invocations, 0);
    let pass = GatherStencil {
        camera: buffer.camera.clone(),
        depth: buffer.depth.sampled(),
        surface: buffer.surface.sampled(),
        planes: pyramid.planes.sampled(),
        normals: pyramid.normals.sampled(),
        vpls: vpls.texels(vk::Format::R32G32B32A32_SFLOAT),
        invocations: invocations.read_write(),
        push: GatherStencilPush {
            size: signed(buffer.size),
            level_count: pyramid.level_count.cast_signed(),
            vpl_count: inputs.settings.count,
        },
    };
    let tests = StencilState { compare: vk::CompareOp::EQUAL, pass: vk::StencilOp::KEEP, reference: VALID };
    let state =
        RasterState { topology: vk::PrimitiveTopology::TRIANGLE_LIST, stencil: Some(tests), ..RasterState::default() };
    graph
        .raster("diffuse/vpl/gather-stencil", pass, state)
        .count("regions", invocations, 0)
        .color(irradiance, Some(ClearColor::Float([0.0; 4])))
        .stencil(stencil, None)
        .vertices(3, 1);
    (irradiance, invocations)
}

fn flattened(graph: &mut Graph<'_>, size: [u32; 2]) -> ImageRef {
    graph.image("vpl.irradiance", vk::Format::R32G32B32A32_SFLOAT, flattened_size(size))
}
