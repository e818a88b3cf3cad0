//! The light of caches at points that mirrors and glass show, which asked for theirs beside the pixels (`frame/caches/allocate.rs`).

use ash::vk;

use super::apply::kind_of;
use super::options::VolumesOptions;
use crate::frame::caches::Caches;
use crate::frame::mirrored::{MirroredLight, MirroredPoints};
use crate::graph::bindings::BufferRef;
use crate::method::FrameCx;
use crate::shaders::volumes::{Mirrored, MirroredPush};

/// Declares the passes; returns the irradiance at the points.
pub(super) fn light(
    cx: &mut FrameCx<'_, '_>,
    points: &MirroredPoints,
    caches: &Caches,
    light: BufferRef<f32>,
    options: &VolumesOptions,
) -> MirroredLight {
    let scene = cx.frame.traced.expect("whoever lists points follows rays");
    let (scene_rays, _) = cx.cache_rays();
    let rays = crate::shaders::types::CacheRays { shift: (cx.frame.data.origin - scene.origin).as_vec3().to_array() };
    let graph = &mut *cx.graph;
    let mut irradiance = Vec::new();
    for (number, list) in points.lists.iter().enumerate() {
        let received = graph.buffer::<[f32; 4]>(&format!("volumes.mirrored.{number}"), list.points.count());
        let pass = Mirrored {
            mirrored: list.group(),
            light_caches: caches.group.clone(),
            scene_rays: scene_rays.clone(),
            light: light.texels(vk::Format::R32G32B32A32_SFLOAT),
            received: received.start(),
            bands: options.bands,
            chroma: options.chroma_bands(),
            weights: kind_of(options.weights),
            push: MirroredPush { rays, capacity: caches.capacity },
        };
        graph.pass(&format!("diffuse/volumes/mirrored.{number}"), pass).threads_indirect(list.arguments, 0);
        irradiance.push(received);
    }
    MirroredLight { irradiance }
}
