//! The light of emissive surfaces and of the sky at samples, by rays.

use super::space::{FLOATS, Light, Space, WORDS};
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::TexelBuffer;
use crate::shaders::bounces::{Directions, DirectionsPush, Emitters, EmittersPush};

/// Rays of a sample: to points of emissive surfaces, and into directions drawn by the cosine. A window fills a fiftieth of the directions in a room.
const POINTS: u32 = 64;
const DIRECTIONS: u32 = 256;

/// Whether there is any.
pub(super) fn any(scene: &TracedScene) -> bool {
    scene.emissive_count > 0 || has_sky(scene)
}

fn has_sky(scene: &TracedScene) -> bool {
    scene.sky.iter().any(|&channel| channel > 0.0)
}

/// Declares the passes; none where there is no such light.
pub(super) fn light(graph: &mut Graph<'_>, scene: &TracedScene, space: &Space) -> Option<Light> {
    if !any(scene) {
        return None;
    }
    let slot_count = space.slot_count;
    let density_scale = scene.emissive_density_scale;
    let by_points = (scene.emissive_count > 0).then(|| {
        let arrived = graph.buffer::<[f32; 4]>("bounces.by_points", slot_count as usize);
        let pass = Emitters {
            scene_lights: scene.lights(graph),
            scene_rays: space.rays.clone(),
            samples: space.samples.texels(WORDS),
            arrived: arrived.write(),
            push: EmittersPush {
                slot_count,
                emitter_count: scene.emissive_count,
                point_count: POINTS,
                direction_count: DIRECTIONS,
                density_scale,
            },
        };
        let pass = graph.pass("bounces/light/emitters", pass).note("rays", u64::from(POINTS * slot_count));
        pass.groups(space.groups());
        arrived
    });
    let arrived = graph.buffer::<[f32; 4]>("bounces.of_lamps", slot_count as usize);
    let pass = Directions {
        scene_lights: scene.lights(graph),
        scene_rays: space.rays.clone(),
        samples: space.samples.texels(WORDS),
        finds_emitters: u32::from(by_points.is_some()),
        by_points: by_points.map_or(TexelBuffer::absent(), |by_points| by_points.texels(FLOATS)),
        arrived: arrived.write(),
        push: DirectionsPush {
            sky: scene.sky,
            slot_count,
            direction_count: DIRECTIONS,
            density_scale: density_scale * POINTS as f32 / DIRECTIONS as f32,
        },
    };
    let pass = graph.pass("bounces/light/directions", pass).note("rays", u64::from(DIRECTIONS * slot_count));
    pass.groups(space.groups());
    Some(arrived)
}
