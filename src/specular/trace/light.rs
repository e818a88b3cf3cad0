//! The sum at each pixel of the light at its points.

use ash::vk;

use super::walk::Walked;
use crate::frame::mirrored::{MirroredCaustics, MirroredLight};
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef, TexelBuffer};
use crate::shaders::trace::{Resolve, ResolvePush};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// What other methods say of the light at the points: the first lists of it are those of bands.
pub(super) struct Indirect<'a> {
    pub(super) diffuse: Option<&'a MirroredLight>,
    pub(super) caustics: Option<&'a MirroredCaustics>,
}

/// Declares the passes that add up what pixels see; returns the slot. `light`: of each band's points.
pub(super) fn resolve(
    graph: &mut Graph<'_>,
    walked: &Walked,
    light: &[BufferRef<[f32; 4]>],
    indirect: &Indirect<'_>,
) -> ImageRef {
    let size = walked.heads.size();
    let specular = graph.image("trace.specular", FLOATS, size);
    for (number, (band, light)) in walked.bands.iter().zip(light).enumerate() {
        let irradiance = indirect.diffuse.map(|diffuse| diffuse.irradiance[number]);
        let caustics = indirect.caustics.map(|caustics| caustics.irradiance[number]);
        let pass = Resolve {
            has_field: u32::from(irradiance.is_some()),
            has_caustics: u32::from(caustics.is_some()),
            heads: walked.heads.sampled(),
            shining: walked.shining.sampled(),
            points: band.list.points.texels(WORDS),
            light: light.texels(FLOATS),
            irradiance: irradiance.map_or(TexelBuffer::absent(), |irradiance| irradiance.texels(FLOATS)),
            caustics: caustics.map_or(TexelBuffer::absent(), |caustics| caustics.texels(FLOATS)),
            specular: if number == 0 { specular.start() } else { specular.modify() },
            push: ResolvePush { first_row: band.first_row },
        };
        graph.pass(&format!("specular/trace/resolve.{number}"), pass).pixels([size[0], band.row_count]);
    }
    specular
}
