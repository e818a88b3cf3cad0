//! From irradiance at regions to radiance at pixels, coarse to fine.

use super::pyramid::{Pyramid, signed};
use super::rule::RegionRule;
use crate::frame::gbuffer::GBuffer;
use crate::graph::Graph;
use crate::graph::bindings::ImageRef;
use crate::shaders::regions::{Interpolate, InterpolatePush, Resolve, ResolvePush};

/// Declares the passes, one a level; `irradiance` is the flattened image.
pub(crate) fn interpolate(
    graph: &mut Graph<'_>,
    buffer: &GBuffer,
    rule: &RegionRule,
    pyramid: &Pyramid,
    irradiance: ImageRef,
    diffuse: ImageRef,
) {
    let size = buffer.size;
    let RegionRule { depth_threshold, normal_threshold, .. } = *rule;
    let planes_of_level = |level: u32| pyramid.planes.mip(level - 1).sampled();
    for level in (1..pyramid.level_count - 1).rev() {
        let pass = Interpolate {
            square_planes: planes_of_level(level),
            region_planes: planes_of_level(level + 1),
            irradiance: irradiance.read_write(),
            surface: buffer.group.clone(),
            push: InterpolatePush { size: signed(size), level: level.cast_signed(), depth_threshold, normal_threshold },
        };
        let regions = size.map(|side| side >> (level + 1));
        graph.pass(&rule.pass(&format!("interpolate/squares-{}", 1 << level)), pass).pixels(regions);
    }
    let pass = Resolve {
        surface: buffer.group.clone(),
        region_planes: planes_of_level(1),
        irradiance: irradiance.sampled(),
        diffuse: diffuse.write(),
        push: ResolvePush { depth_threshold, normal_threshold },
    };
    graph.pass(&rule.pass("interpolate/resolve"), pass).pixels(size.map(|side| side.div_ceil(2)));
}
