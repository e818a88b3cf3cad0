//! Irradiance from all VPLs, at pixels or at regions.
//!
//! A pass takes a range of the VPLs, and each adds to what the one before it found: no invocation may take more steps than the device lets it
//! ([`DeviceTraits::loop_steps`]), those of the rays' ways through the hierarchy included.

use ash::vk;

use super::sample::vpl_count;
use super::visibility::{TRACED, Visibility};
use crate::frame::regions::{Pyramid, VALID, flattened_size, signed};
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{ClearColor, Graph};
use crate::method::FrameCx;
use crate::shaders::types::VplRange;
use crate::shaders::vpl::{
    GatherPixels, GatherPixelsPush, GatherRegions, GatherRegionsPush, GatherStencil, GatherStencilPush,
};
use crate::vulkan::{DeviceTraits, RasterState, StencilState};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const BLACK: ClearColor = ClearColor::Float([0.0; 4]);

/// Steps that a VPL takes without rays, and at most with rays from two receivers.
const STEPS: u32 = 2;
const TRACED_STEPS: u32 = 682;

/// What each pass takes, and its name.
fn ranges(name: &str, vpl_count: u32, traced: bool, traits: DeviceTraits) -> Vec<(String, VplRange)> {
    ranges_of(name, vpl_count, if traced { TRACED_STEPS } else { STEPS }, traits)
}

/// The same where each VPL takes so many steps.
pub(super) fn ranges_of(name: &str, vpl_count: u32, steps: u32, traits: DeviceTraits) -> Vec<(String, VplRange)> {
    let most = (traits.loop_steps + 1) / steps;
    let pass = |part: u32| {
        let (first, end) = (part * most, ((part + 1) * most).min(vpl_count));
        let name = if part == 0 { name.to_owned() } else { format!("{name}-{}", part + 1) };
        (name, VplRange { first: first.cast_signed(), end: end.cast_signed() })
    };
    (0..vpl_count.div_ceil(most)).map(pass).collect()
}

/// The slot, gathered at every pixel.
pub(super) fn gather_pixels(
    cx: &mut FrameCx<'_, '_>,
    vpls: BufferRef<[f32; 4]>,
    visibility: &Visibility,
    diffuse: ImageRef,
) {
    let (graph, buffer) = (&mut *cx.graph, cx.frame.surface);
    let [width, height] = buffer.size;
    graph.clear_image("diffuse/vpl/gather/clear", diffuse, BLACK);
    let traced = visibility.group.visibility == TRACED;
    for (name, range) in ranges("diffuse/vpl/gather/pixels", vpl_count(vpls), traced, graph.traits()) {
        let terms = u64::from(width) * u64::from(height) * u64::from((range.end - range.first).cast_unsigned());
        let pass = GatherPixels {
            surface: buffer.group.clone(),
            vpls: vpls.texels(FLOATS),
            diffuse: diffuse.read_write(),
            scene_rays: visibility.scene.clone(),
            vpl_visibility: visibility.group.clone(),
            push: GatherPixelsPush { range },
        };
        graph.pass(&name, pass).note("VPL terms", terms).groups([width.div_ceil(16), height.div_ceil(8), 1]);
    }
}

/// Regions that one group of the list's gather takes.
pub(super) const REGIONS_PER_GROUP: u32 = 128;

/// Irradiance of the regions on the list, in the flattened image; alpha is 0 where there is none.
pub(super) fn gather_list(
    cx: &mut FrameCx<'_, '_>,
    vpls: BufferRef<[f32; 4]>,
    visibility: &Visibility,
    pyramid: &Pyramid,
    list: BufferRef<u32>,
) -> ImageRef {
    let (graph, buffer) = (&mut *cx.graph, cx.frame.surface);
    let irradiance = flattened(graph, buffer.size);
    graph.clear_image("diffuse/vpl/gather/clear-irradiance", irradiance, BLACK);
    let traced = visibility.group.visibility == TRACED;
    for (name, range) in ranges("diffuse/vpl/gather/regions", vpl_count(vpls), traced, graph.traits()) {
        let pass = GatherRegions {
            surface: buffer.group.clone(),
            planes: pyramid.planes.sampled(),
            normals: pyramid.normals.sampled(),
            vpls: vpls.texels(FLOATS),
            list: list.texels(vk::Format::R32_UINT),
            irradiance: irradiance.read_write(),
            scene_rays: visibility.scene.clone(),
            vpl_visibility: visibility.group.clone(),
            push: GatherRegionsPush {
                size: signed(buffer.size),
                level_count: pyramid.level_count.cast_signed(),
                range,
            },
        };
        graph.pass(&name, pass).count("regions", list, 3).threads_indirect(list, 0);
    }
    irradiance
}

/// The same where the stencil is marked. Returns the count of the first pass's invocations besides.
pub(super) fn gather_stencil(
    cx: &mut FrameCx<'_, '_>,
    vpls: BufferRef<[f32; 4]>,
    visibility: &Visibility,
    pyramid: &Pyramid,
    stencil: ImageRef,
) -> (ImageRef, BufferRef<u32>) {
    let (graph, buffer) = (&mut *cx.graph, cx.frame.surface);
    let irradiance = flattened(graph, buffer.size);
    let invocations = graph.buffer::<u32>("vpl.invocations", 1);
    graph.fill_buffer("diffuse/vpl/gather/clear-invocations", invocations, 0);
    let traced = visibility.group.visibility == TRACED;
    for (name, range) in ranges("diffuse/vpl/gather/stencil", vpl_count(vpls), traced, graph.traits()) {
        let pass = GatherStencil {
            surface: buffer.group.clone(),
            planes: pyramid.planes.sampled(),
            normals: pyramid.normals.sampled(),
            vpls: vpls.texels(FLOATS),
            invocations: invocations.read_write(),
            scene_rays: visibility.scene.clone(),
            vpl_visibility: visibility.group.clone(),
            push: GatherStencilPush {
                size: signed(buffer.size),
                level_count: pyramid.level_count.cast_signed(),
                range,
            },
        };
        let tests = StencilState { compare: vk::CompareOp::EQUAL, pass: vk::StencilOp::KEEP, reference: VALID };
        let state = RasterState {
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            stencil: Some(tests),
            additive: range.first > 0,
            ..RasterState::default()
        };
        graph
            .raster(&name, pass, state)
            .count("regions", invocations, 0)
            .color(irradiance, (range.first == 0).then_some(BLACK))
            .stencil(stencil, None)
            .vertices(3, 1);
    }
    (irradiance, invocations)
}

fn flattened(graph: &mut Graph<'_>, size: [u32; 2]) -> ImageRef {
    graph.image("vpl.irradiance", FLOATS, flattened_size(size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_take_what_the_device_lets_one_invocation_do() {
        let lavapipe = DeviceTraits { loop_steps: 65_535, ..DeviceTraits::GPU };
        let all = 196_603;
        let of = |traced, traits| ranges("gather", all, traced, traits);
        assert_eq!((of(true, lavapipe).len(), of(false, lavapipe).len()), (2048, 6));
        assert_eq!((of(true, DeviceTraits::GPU).len(), of(false, DeviceTraits::GPU).len()), (32, 1));
        let parts = of(true, lavapipe);
        assert_eq!((parts[1].0.as_str(), parts[1].1.first, parts[1].1.end), ("gather-2", 96, 192));
        assert!(parts.windows(2).all(|pair| pair[0].1.end == pair[1].1.first));
        assert_eq!(parts.last().map(|(_, range)| range.end), Some(all.cast_signed()));
    }
}
