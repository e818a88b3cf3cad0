//! Which pixels' centres do not stand for all of the pixel (Jin et al. 2009): what differs from a neighbour is marked.

use ash::vk;

use super::options::TraceOptions;
use super::walk::{Walked, count};
use crate::frame::direct_light::SharpLight;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef, SampledImage, TexelBuffer};
use crate::method::FrameCx;
use crate::shaders::trace::{Marks, MarksPush, Reflected, ReflectedPush};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
/// Pixels that a list has room for at first: few, since each takes memory for the points of all its samples.
const SHARE: u32 = 32;

/// Marked pixels of some rows.
#[derive(Clone, Copy)]
pub(super) struct MarkedPixels {
    /// x and y, 16 bits each.
    pub(super) pixels: BufferRef<u32>,
    /// Groups of 64 that take one each, in three words, and how many there are.
    pub(super) arguments: BufferRef<u32>,
}

/// What smooth surfaces show at the centres of pixels.
#[derive(Clone, Copy)]
pub(super) struct ReflectedImages {
    light: ImageRef,
    surface: ImageRef,
}

impl ReflectedImages {
    pub(super) fn new(graph: &mut Graph<'_>, size: [u32; 2]) -> ReflectedImages {
        ReflectedImages {
            light: graph.image("trace.reflected_light", FLOATS, size),
            surface: graph.image("trace.reflected_surface", WORDS, size),
        }
    }

    /// Declares the pass that sums up what each pixel of a band shows at its centre, if it is smooth. `light`: of the band's points, if there is some that has no
    /// noise.
    pub(super) fn sum(
        self,
        cx: &mut FrameCx<'_, '_>,
        walked: &Walked,
        number: usize,
        light: Option<BufferRef<[f32; 4]>>,
    ) {
        let band = walked.bands[number];
        let written = |image: ImageRef| if number == 0 { image.start() } else { image.modify() };
        let pass = Reflected {
            surface: cx.frame.surface.group.clone(),
            has_light: u32::from(light.is_some()),
            heads: walked.heads.sampled(),
            shining: walked.shining.sampled(),
            points: band.list.points.texels(WORDS),
            light: light.map_or(TexelBuffer::absent(), |light| light.texels(FLOATS)),
            reflected_light: written(self.light),
            reflected_surface: written(self.surface),
            push: ReflectedPush { first_row: band.first_row },
        };
        let pass = cx.graph.pass(&format!("specular/trace/supersample/reflected.{number}"), pass);
        pass.pixels([self.light.size()[0], band.row_count]);
    }
}

/// Declares the passes that mark pixels of some rows.
pub(super) fn mark(
    cx: &mut FrameCx<'_, '_>,
    reflected: Option<ReflectedImages>,
    (number, first_row, row_count): (usize, u32, u32),
    options: &TraceOptions,
) -> MarkedPixels {
    let direct = cx.frame.offers.get::<SharpLight>();
    let surface = cx.frame.surface;
    let graph = &mut *cx.graph;
    let least = (surface.size[0] * row_count / SHARE).max(64) as usize;
    let pixels = graph.growing_buffer::<u32>(&format!("trace.marked.{number}"), least);
    let counts = graph.buffer::<u32>(&format!("trace.marked_counts.{number}"), 1);
    graph.fill_buffer(&format!("specular/trace/supersample/clear-marks.{number}"), counts, 0);
    let capacity = pixels.count() as u32;
    let pass = Marks {
        surface: surface.group.clone(),
        has_emission: u32::from(surface.emission.is_some()),
        has_direct: u32::from(direct.is_some()),
        has_reflected: u32::from(reflected.is_some()),
        emission: SampledImage::of(surface.emission),
        direct: SampledImage::of(direct.map(|direct| direct.0)),
        reflected_light: SampledImage::of(reflected.map(|images| images.light)),
        reflected_surface: SampledImage::of(reflected.map(|images| images.surface)),
        marked: pixels.start(),
        counts: counts.read_write(),
        push: MarksPush { first_row, row_count, capacity, contrast: options.contrast as f32 },
    };
    let pass = graph.pass(&format!("specular/trace/supersample/marks.{number}"), pass);
    pass.count("pixels", counts, 0).unordered().pixels([surface.size[0], row_count]);
    graph.grows(pixels, counts, 0);
    let arguments = graph.buffer::<u32>(&format!("trace.marked_arguments.{number}"), 4);
    count(graph, &format!("specular/trace/supersample/marked.{number}"), counts, capacity, arguments);
    MarkedPixels { pixels, arguments }
}
