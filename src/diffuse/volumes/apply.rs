//! Every pixel's light, from the caches around it.

use ash::vk;

use super::options::{VolumesOptions, VolumesWeights};
use crate::frame::caches::Caches;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::method::FrameCx;
use crate::shaders::volumes::{Apply, ApplyPush};

/// The kinds of glsl/caches/weights.glsl.
pub(super) fn kind_of(weights: VolumesWeights) -> u32 {
    match weights {
        VolumesWeights::Trilinear => 0,
        VolumesWeights::Rays => 1,
    }
}

/// Declares the pass; returns the slot. It counts caches that pixels looked for and did not find, of which there are none.
pub(super) fn apply(
    cx: &mut FrameCx<'_, '_>,
    caches: &Caches,
    light: BufferRef<f32>,
    options: &VolumesOptions,
) -> ImageRef {
    let (scene_rays, rays) = cx.cache_rays();
    let (graph, surface) = (&mut *cx.graph, cx.frame.surface);
    let diffuse = graph.image("volumes.diffuse", vk::Format::R32G32B32A32_SFLOAT, surface.size);
    let missing = graph.buffer::<u32>("volumes.missing", 1);
    graph.fill_buffer("diffuse/volumes/clear-missing", missing, 0);
    let pass = Apply {
        light_caches: caches.group.clone(),
        surface: surface.group.clone(),
        light: light.texels(vk::Format::R32G32B32A32_SFLOAT),
        diffuse: diffuse.write(),
        missing: missing.read_write(),
        scene_rays,
        bands: options.bands,
        chroma: options.chroma_bands(),
        weights: kind_of(options.weights),
        push: ApplyPush { rays, capacity: caches.capacity },
    };
    graph.pass("diffuse/volumes/apply", pass).count("missing", missing, 0).pixels(surface.size);
    diffuse
}
