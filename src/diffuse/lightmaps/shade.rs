//! What pixels, and points that mirrors show, get of the maps.

use ash::vk;

use super::formats::FLOATS4;
use super::maps::Maps;
use super::options::LightmapsShow;
use super::texels::LightTexels;
use crate::frame::mirrored::{MirroredLight, MirroredPoints};
use crate::frame::rays::TracedScene;
use crate::graph::bindings::ImageRef;
use crate::method::FrameCx;
use crate::shaders::lightmaps::{Mirrored, Pixels, PixelsPush};

/// Declares the passes; returns the slot.
pub(super) fn shade(
    cx: &mut FrameCx<'_, '_>,
    scene: &TracedScene,
    texels: &LightTexels,
    maps: &Maps,
    show: LightmapsShow,
) -> ImageRef {
    let seen = maps.received.filter(|_| show == LightmapsShow::Received).unwrap_or(maps.gathered);
    let (frame, surface) = (cx.frame, cx.frame.surface);
    let graph = &mut *cx.graph;
    let diffuse = graph.image("lightmaps.diffuse", vk::Format::R32G32B32A32_SFLOAT, surface.size);
    let pass = Pixels {
        white: u32::from(show != LightmapsShow::Light),
        scene_rays: texels.rays.clone(),
        surface: surface.group.clone(),
        lightmap: texels.group.clone(),
        map: seen.texels(FLOATS4),
        diffuse: diffuse.write(),
        push: PixelsPush { shift: (frame.data.origin - scene.origin).as_vec3().to_array() },
    };
    graph.pass("diffuse/lightmaps/shade/pixels", pass).pixels(surface.size);
    if let Some(points) = frame.offers.get::<MirroredPoints>() {
        let mut irradiance = Vec::new();
        for (number, list) in points.lists.iter().enumerate() {
            let received = graph.buffer::<[f32; 4]>(&format!("lightmaps.mirrored.{number}"), list.points.count());
            let pass = Mirrored {
                scene_rays: texels.rays.clone(),
                mirrored: list.group(),
                lightmap: texels.group.clone(),
                gathered: maps.gathered.texels(FLOATS4),
                received: received.start(),
            };
            let pass = graph.pass(&format!("diffuse/lightmaps/shade/mirrored.{number}"), pass);
            pass.threads_indirect(list.arguments, 0);
            irradiance.push(received);
        }
        frame.offers.put(MirroredLight { irradiance });
    }
    diffuse
}
