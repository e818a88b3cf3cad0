//! Gather rays, of pixels and of points that mirrors show.

use ash::vk;

use super::map::PhotonMap;
use crate::frame::mirrored::{MirroredLight, MirroredPoints};
use crate::frame::rays::TracedScene;
use crate::graph::bindings::ImageRef;
use crate::method::FrameCx;
use crate::shaders::final_gather::{Gather, GatherMirrored, GatherMirroredPush, GatherPush};
use crate::shaders::types::GatherRays;

/// Steps that the loops of one ray may take: through the hierarchy, and among the points around where it ends.
const STEPS: u32 = 1024;

/// Parts of `count` rays that one pass each may send.
fn parts(map: &PhotonMap, count: u32, loop_steps: u32) -> Vec<GatherRays> {
    let most = ((loop_steps + 1) / STEPS).max(1);
    let part =
        |first: u32| GatherRays { first, end: (first + most).min(count), count, bits: map.bits(), radius: map.radius };
    (0..count).step_by(most as usize).map(part).collect()
}

/// Declares the passes; returns the slot.
pub(super) fn gather(cx: &mut FrameCx<'_, '_>, scene: &TracedScene, map: &PhotonMap, count: u32) -> ImageRef {
    let (frame, surface) = (cx.frame, cx.frame.surface);
    let points = frame.offers.get::<MirroredPoints>();
    let graph = &mut *cx.graph;
    let parts = parts(map, count, graph.traits().loop_steps);
    let rays = scene.rays(graph);
    let diffuse = graph.image("final-gather.diffuse", vk::Format::R32G32B32A32_SFLOAT, surface.size);
    for (number, part) in parts.iter().enumerate() {
        let pass = Gather {
            photon_map: map.group(),
            scene_rays: rays.clone(),
            surface: surface.group.clone(),
            diffuse: if number == 0 { diffuse.start_then_read() } else { diffuse.read_write() },
            push: GatherPush { shift: (frame.data.origin - scene.origin).as_vec3().to_array(), rays: *part },
        };
        let pass = graph.pass(&format!("diffuse/final-gather/gather/pixels.{number}"), pass);
        pass.note("rays a pixel", u64::from(part.end - part.first)).pixels(surface.size);
    }
    if let Some(points) = points {
        let mut irradiance = Vec::new();
        for (number, list) in points.lists.iter().enumerate() {
            let received = graph.buffer::<[f32; 4]>(&format!("final-gather.mirrored.{number}"), list.points.count());
            for (place, part) in parts.iter().enumerate() {
                let pass = GatherMirrored {
                    photon_map: map.group(),
                    scene_rays: rays.clone(),
                    mirrored: list.group(),
                    received: if place == 0 { received.start_then_read() } else { received.read_write() },
                    push: GatherMirroredPush { rays: *part },
                };
                let pass = graph.pass(&format!("diffuse/final-gather/gather/mirrored.{number}.{place}"), pass);
                pass.threads_indirect(list.arguments, 0);
            }
            irradiance.push(received);
        }
        frame.offers.put(MirroredLight { irradiance });
    }
    diffuse
}
