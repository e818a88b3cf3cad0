//! Irradiance from all VPLs, at pixels or at regions.

use ash::vk;

use super::VplInputs;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::shaders::vpl::{GatherPixels, GatherPixelsPush};

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
