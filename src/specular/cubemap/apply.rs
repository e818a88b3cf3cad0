//! What every pixel reflects, from the map of its object.

use ash::vk;

use super::maps::Map;
use super::objects::{Object, records};
use super::options::CubemapOptions;
use crate::frame::lobe_albedos::lobe_albedos;
use crate::frame::rays::TracedScene;
use crate::graph::Dependence;
use crate::graph::bindings::{ImageRef, SampledImage};
use crate::method::FrameCx;
use crate::shaders::cubemap::{Apply, ApplyPush, Find, FindPush, Through, ThroughPush};
use crate::shaders::groups::Lobes;

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// Declares the passes; returns the slot.
pub(super) fn apply(
    cx: &mut FrameCx<'_, '_>,
    scene: &TracedScene,
    objects: &[Object],
    maps: &[Map],
    options: &CubemapOptions,
) -> ImageRef {
    let (frame, surface) = (cx.frame, cx.frame.surface);
    let shift = (frame.data.origin - scene.origin).as_vec3();
    let graph = &mut *cx.graph;
    let owners = graph.image("cubemap.owners", vk::Format::R32_UINT, surface.size);
    let (listed, records) = records(objects, shift);
    let records = graph.upload("cubemap.objects", &records, Dependence::GEOMETRY | Dependence::CAMERA);
    let pass = Find {
        scene_rays: scene.rays(graph),
        surface: surface.group.clone(),
        objects: records.texels(WORDS),
        owners: owners.write(),
        push: FindPush { shift: shift.to_array(), object_count: u32::try_from(objects.len()).unwrap_or(0) },
    };
    graph.pass("specular/cubemap/find", pass).pixels(surface.size);
    let glass = frame.facts.transmissive.then(|| {
        let exits = graph.image("cubemap.exits", WORDS, surface.size);
        let transmitted = graph.image("cubemap.transmitted", FLOATS, surface.size);
        let pass = Through {
            scene_rays: scene.rays(graph),
            surface: surface.group.clone(),
            lobes: Lobes { specular_lobes: 1, transmissive: 1 },
            exits: exits.write(),
            transmitted: transmitted.write(),
            push: ThroughPush { shift: shift.to_array() },
        };
        graph.pass("specular/cubemap/through", pass).pixels(surface.size);
        (exits, transmitted)
    });
    if glass.is_none() {
        graph.skip("specular/cubemap/through", "nothing transmits light");
    }
    let albedos = graph.upload("cubemap.albedos", lobe_albedos(), Dependence::NONE);
    let specular = graph.image("cubemap.specular", FLOATS, surface.size);
    let unanswered = graph.image("cubemap.unanswered", vk::Format::R32_UINT, surface.size);
    // Each object's own pixels first; then those of others that their own maps do not answer.
    let others = if objects.len() > 1 { 2 } else { 1 };
    for (takes_others, (number, (object, map))) in
        (0..others).flat_map(|others| (0..).zip(objects.iter().zip(maps)).map(move |each| (others, each)))
    {
        let is_first = takes_others == 0 && number == 0;
        let place = listed.iter().position(|&listed| listed == number as usize).unwrap_or(0);
        let pass = Apply {
            surface: surface.group.clone(),
            is_first: u32::from(is_first),
            has_glass: u32::from(glass.is_some()),
            takes_others,
            cube_side: options.resolution,
            owners: owners.sampled(),
            boxes: map.boxes.texels(FLOATS),
            lobes: map.lobes.texels(FLOATS),
            albedos: albedos.texels(FLOATS),
            exits: SampledImage::of(glass.map(|(exits, _)| exits)),
            transmitted: SampledImage::of(glass.map(|(_, transmitted)| transmitted)),
            objects: records.texels(WORDS),
            reflected: if is_first { specular.write() } else { specular.modify() },
            unanswered: if is_first { unanswered.start_then_read() } else { unanswered.read_write() },
            push: ApplyPush {
                middle_rs: object.body.center_rs,
                owner: number + 1,
                object: u32::try_from(place).unwrap_or(0),
            },
        };
        let name = if takes_others == 0 { "apply" } else { "apply-others" };
        graph.pass(&format!("specular/cubemap/{name}.{number}"), pass).pixels(surface.size);
    }
    specular
}
