//! From irradiance at regions to radiance at pixels, coarse to fine.

use super::VplInputs;
use super::pyramid::{Pyramid, signed};
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::vpl::{Interpolate, InterpolatePush, Resolve, ResolvePush};

/// Declares the passes, one a level; `irradiance` is the flattened image.
pub(super) fn interpolate(
    graph: &mut Graph<'_>,
    inputs: &VplInputs<'_>,
    pyramid: &Pyramid,
    irradiance: ImageRef,
    diffuse: ImageRef,
) {
    let buffer = inputs.buffer;
    let size = buffer.size;
    let (depth_threshold, normal_threshold) =
        (inputs.settings.depth_threshold as f32, inputs.settings.normal_threshold as f32);
    let depth_scale = 0.0;
    for level in (1..pyramid.level_count - 1).rev() {
        let pass = Interpolate {
            planes: pyramid.planes.sampled(),
            irradiance: irradiance.read_write(),
            push: InterpolatePush {
                size: signed(size),
                level: level.cast_signed(),
                depth_threshold,
                depth_scale,
                normal_threshold,
            },
        };
        graph
            .pass(&format!("diffuse/vpl/interpolate-{}", 1 << level), pass)
            .pixels(size.map(|side| side >> level));
    }
    let (specular, has_specular) = buffer.specular();
    let pass = Resolve {
        depth: buffer.depth.sampled(),
        surface: buffer.surface.sampled(),
        specular: specular.sampled(),
        planes: pyramid.planes.sampled(),
        irradiance: irradiance.sampled(),
        diffuse: diffuse.write(),
        push: ResolvePush { depth_threshold, depth_scale, normal_threshold, has_specular },
    };
    graph.pass("diffuse/vpl/resolve", pass).pixels(size);
}
