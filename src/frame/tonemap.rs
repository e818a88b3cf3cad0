//! Display values: tone curve, sRGB encoding, 8 bits. `crate::image` is the same on the host.

use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::image::ToneMap;
use crate::shaders::tonemap::{
    Adaptation, AdaptationPush, LogLuminance, LogLuminancePush, Luminance, LuminancePush, Map, MapPush,
};
use crate::shaders::types;

const PIXELS_PER_INVOCATION: u32 = 16;

/// Declares the passes; returns one word a pixel, red in the lowest byte.
pub(crate) fn tonemap(graph: &mut Graph<'_>, image: ImageRef, curve: ToneMap) -> BufferRef<u32> {
    let [width, height, _] = image.info().extent;
    let pixels = width * height;
    let block_count = pixels.div_ceil(64 * PIXELS_PER_INVOCATION);
    let blocks = graph.buffer::<types::BlockLuminance>("tonemap.blocks", block_count as usize);
    let log_sums = graph.buffer::<types::LogSum>("tonemap.log_sums", block_count as usize);
    let adaptation = graph.buffer::<types::Adaptation>("tonemap.adaptation", 1);
    let display = graph.buffer::<u32>("tonemap.display", pixels as usize);

    if curve == ToneMap::Linear {
        // The linear curve does not look at the rest of the image.
        graph.fill_buffer("tonemap/no-adaptation", adaptation, 0);
    } else {
        let push = LuminancePush { pixels_per_invocation: PIXELS_PER_INVOCATION };
        let pass = Luminance { image: image.sampled(), blocks: blocks.write(), push };
        graph.pass("tonemap/luminance", pass).groups([block_count, 1, 1]);

        let push = LogLuminancePush { pixels_per_invocation: PIXELS_PER_INVOCATION, block_count };
        let pass = LogLuminance { image: image.sampled(), blocks: blocks.read(), log_sums: log_sums.write(), push };
        graph.pass("tonemap/log-luminance", pass).groups([block_count, 1, 1]);

        let push = AdaptationPush { block_count };
        let pass =
            Adaptation { blocks: blocks.read(), log_sums: log_sums.read(), adaptation: adaptation.write(), push };
        graph.pass("tonemap/adaptation", pass).groups([1, 1, 1]);
    }

    let mode = match curve {
        ToneMap::Linear => 0,
        ToneMap::Aces => 1,
        ToneMap::Drago => 2,
    };
    let pass =
        Map { image: image.sampled(), adaptation: adaptation.read(), display: display.write(), push: MapPush { mode } };
    graph.pass("tonemap/map", pass).pixels([width, height]);
    display
}
