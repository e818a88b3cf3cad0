//! The maps: what texels see, the light of that, and its levels.

use ash::vk;
use glam::Vec3;

use super::objects::Object;
use super::options::CubemapOptions;
use crate::frame::mirrored::MirroredList;
use crate::frame::mirrored_light::Shining;
use crate::frame::rays::TracedScene;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::graph::{Dependence, Graph};
use crate::method::FrameCx;
use crate::shaders::cubemap::{Coarser, Prefilter, Rays, RaysPush, Resolve, ResolvePush};
use crate::shaders::groups::Lobes;
use crate::shaders::types::MirroredPoint;

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
/// As glsl/cubemap/cube.glsl has it.
const LEAST_LOBE_SIDE: u32 = 8;

/// What the texels of one map see.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub(super) list: MirroredList,
    /// Unlit light, and where it comes from.
    seen: BufferRef<[f32; 4]>,
    /// Direct light at the points.
    light: BufferRef<[f32; 4]>,
}

/// One map.
#[derive(Clone, Copy)]
pub(crate) struct Map {
    /// Itself with depths, and its means over squares.
    pub(crate) boxes: BufferRef<[f32; 4]>,
    /// What lobes take of it.
    pub(crate) lobes: BufferRef<[f32; 4]>,
}

/// Texels of a map.
fn texels(side: u32) -> u32 {
    6 * side * side
}

/// Likewise with the levels above, down to faces of 4².
fn texels_of_boxes(side: u32) -> u32 {
    (0..side.ilog2() - 1).map(|level| texels(side >> level)).sum()
}

/// Likewise of the levels that hold lobes.
fn texels_of_lobes(side: u32) -> u32 {
    (0..side.ilog2()).map(|level| texels((side >> level).max(LEAST_LOBE_SIDE))).sum()
}

/// Declares the passes that find what the texels of all maps see, and direct light there.
pub(super) fn see(
    cx: &mut FrameCx<'_, '_>,
    scene: &TracedScene,
    objects: &[Object],
    options: &CubemapOptions,
) -> Vec<Seen> {
    let frame = cx.frame;
    let shift = (frame.data.origin - scene.origin).as_vec3();
    let side = options.resolution;
    let count = texels(side);
    let graph = &mut *cx.graph;
    let arguments = [count.div_ceil(64), 1, 1, count];
    let arguments = graph.upload::<u32>("cubemap.arguments", &arguments, Dependence::NONE);
    let mut maps = Vec::new();
    for (number, object) in objects.iter().enumerate() {
        let points = graph.buffer::<MirroredPoint>(&format!("cubemap.points.{number}"), count as usize);
        let seen = graph.buffer::<[f32; 4]>(&format!("cubemap.seen.{number}"), count as usize);
        let [first_triangle, end_triangle] = object.triangles;
        let middle = (Vec3::from(object.body.center_rs) + shift).to_array();
        let pass = Rays {
            scene_rays: scene.rays(graph),
            lobes: Lobes { specular_lobes: 1, transmissive: u32::from(frame.facts.transmissive) },
            cube_side: side,
            points: points.write(),
            seen: seen.write(),
            push: RaysPush { middle, first_triangle, sky: scene.sky, end_triangle },
        };
        let pass = graph.pass(&format!("specular/cubemap/rays.{number}"), pass);
        pass.note("rays", u64::from(count)).threads([count, 1, 1]);
        let list = MirroredList { points, arguments };
        let shining = Shining::new(graph, scene, list, ("specular/cubemap/light", number), false);
        let found = shining.find_punctual(graph);
        shining.find_others(graph, found, options.light_samples);
        maps.push(Seen { list, seen, light: shining.light });
    }
    maps
}

/// Declares the passes that make one map of what its texels see; `diffuse`, `caustics`: what its points get of these.
pub(super) fn map(
    graph: &mut Graph<'_>,
    number: usize,
    seen: &Seen,
    [diffuse, caustics]: [Option<BufferRef<[f32; 4]>>; 2],
    options: &CubemapOptions,
) -> Map {
    let side = options.resolution;
    let count = texels(side);
    let irradiance = |of: Option<BufferRef<[f32; 4]>>| of.map_or(TexelBuffer::absent(), |of| of.texels(FLOATS));
    let boxes = graph.buffer::<[f32; 4]>(&format!("cubemap.boxes.{number}"), texels_of_boxes(side) as usize);
    let pass = Resolve {
        has_field: u32::from(diffuse.is_some()),
        has_caustics: u32::from(caustics.is_some()),
        seen: seen.seen.texels(FLOATS),
        points: seen.list.points.texels(WORDS),
        light: seen.light.texels(FLOATS),
        irradiance: irradiance(diffuse),
        caustics: irradiance(caustics),
        boxes: boxes.start(),
        push: ResolvePush { texels: count },
    };
    graph.pass(&format!("specular/cubemap/resolve.{number}"), pass).threads([count, 1, 1]);
    let pass = Coarser { cube_side: side, boxes: boxes.read_write() };
    let coarser = texels_of_boxes(side) - count;
    graph.pass(&format!("specular/cubemap/coarser.{number}"), pass).threads([coarser, 1, 1]);
    let taken = texels_of_lobes(side);
    let lobes = graph.buffer::<[f32; 4]>(&format!("cubemap.lobes.{number}"), taken as usize);
    let pass = Prefilter { cube_side: side, boxes: boxes.texels(FLOATS), lobes: lobes.write() };
    graph.pass(&format!("specular/cubemap/prefilter.{number}"), pass).threads([taken, 1, 1]);
    Map { boxes, lobes }
}
