//! The light of VPLs at points that mirrors and glass show.

use ash::vk;

use super::gather::ranges_of;
use super::sample::vpl_count;
use super::visibility::Visibility;
use crate::frame::mirrored::{MirroredLight, MirroredPoints};
use crate::graph::bindings::BufferRef;
use crate::method::FrameCx;
use crate::shaders::vpl::{GatherMirrored, GatherMirroredPush};

/// Steps that a VPL takes: it is looked at twice where few get a ray, and those rays take some.
const STEPS: u32 = 4;

/// Declares the passes; returns the irradiance at the points.
pub(super) fn light(
    cx: &mut FrameCx<'_, '_>,
    points: &MirroredPoints,
    vpls: BufferRef<[f32; 4]>,
    visibility: &Visibility,
) -> MirroredLight {
    let shift = cx.frame.traced.map_or([0.0; 3], |scene| (cx.frame.data.origin - scene.origin).as_vec3().to_array());
    let surface = cx.frame.surface;
    let graph = &mut *cx.graph;
    let mut irradiance = Vec::new();
    for (number, list) in points.lists.iter().enumerate() {
        let received = graph.buffer::<[f32; 4]>(&format!("vpl.mirrored.{number}"), list.points.count());
        let name = format!("diffuse/vpl/gather/mirrored.{number}");
        for (name, range) in ranges_of(&name, vpl_count(vpls), STEPS, graph.traits()) {
            let first = range.first == 0;
            let pass = GatherMirrored {
                surface: surface.group.clone(),
                mirrored: list.group(),
                vpls: vpls.texels(vk::Format::R32G32B32A32_SFLOAT),
                received: if first { received.start_then_read() } else { received.read_write() },
                scene_rays: visibility.scene.clone(),
                vpl_visibility: visibility.group.clone(),
                push: GatherMirroredPush { range, shift },
            };
            graph.pass(&name, pass).threads_indirect(list.arguments, 0);
        }
        irradiance.push(received);
    }
    MirroredLight { irradiance }
}
