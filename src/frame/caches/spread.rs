//! Virtual area lights that are small where they give the picture much, and large where they give it little: a cut through the squares of light views, by what points of the picture
//! receive of their blocks (in the manner of Walter et al. 2005, lightcuts, one cut for all of a picture).

use ash::vk;

use super::lights::{AreaLights, LightRule, reduced};
use crate::frame::gbuffer::GBuffer;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::LightViews;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::bounces;
use crate::shaders::caches::{
    Coarser, CoarserPush, Cut, CutPush, Merge, MergePush, ScanCuts, ScanCutsPush, Total, TotalPush, Weigh, WeighPush,
};
use crate::shaders::groups::{self, SceneRays};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const PAIRS: vk::Format = vk::Format::R32G32_SFLOAT;
const WORD: vk::Format = vk::Format::R32_UINT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// Blocks are finer by this factor of their side than if all were alike, and lights of this many levels of them.
const FINER: u32 = 4;
const LEVELS: u32 = 4;
/// Points that each block is weighed by.
const RAYS: u32 = 8;

/// The picture, and the scene that its rays meet.
pub(crate) struct Picture<'p> {
    pub(crate) surface: &'p GBuffer,
    pub(crate) scene_rays: SceneRays,
    /// From render space to that of rays.
    pub(crate) shift: [f32; 3],
}

/// Samples of all surfaces (glsl/bounces/samples.glsl), and the scene that their rays meet.
pub(crate) struct Samples {
    pub(crate) samples: BufferRef<[u32; 4]>,
    pub(crate) scene_rays: SceneRays,
    pub(crate) shift: [f32; 3],
}

/// What lights matter to.
pub(crate) enum Points<'p> {
    Picture(Picture<'p>),
    Samples(Samples),
}

impl Points<'_> {
    /// The level of their passes.
    fn level(&self) -> &'static str {
        match self {
            Points::Picture(_) => "caches/spread",
            Points::Samples(_) => "bounces/spread",
        }
    }
}

/// Declares the passes.
pub(crate) fn spread_lights(
    graph: &mut Graph<'_>,
    set: &LightSet,
    views: &LightViews,
    points: &Points<'_>,
    rule: &LightRule,
) -> AreaLights {
    let finer = LightRule { side: FINER * rule.side, lod: LEVELS, ..*rule };
    let level = points.level();
    let slots = reduced(graph, set, views, &finer, level);
    let slot_count = slots.count() as u32 / 2;
    let matter = weigh(graph, points, slots, slot_count);
    let total = graph.buffer::<[f32; 2]>(&format!("{level}.matter.total"), 1);
    let pass =
        Total { matter: matter.texels(PAIRS), total: total.write(), push: TotalPush { slot_count, level: LEVELS } };
    graph.pass(&format!("{level}/total"), pass).groups([1, 1, 1]);
    // Lights that the bound leaves matter between a quarter of it and all: about side² of them.
    let group_lights = 1 << (2 * rule.lod);
    let light_bound = 2.0 / (rule.side as f32).powi(2);
    let cuts = graph.buffer::<u32>(&format!("{level}.cuts"), slot_count as usize);
    let pass = Cut {
        matter: matter.texels(PAIRS),
        total: total.texels(PAIRS),
        cuts: cuts.write(),
        push: CutPush { slot_count, last_level: LEVELS, light_bound, group_bound: light_bound * group_lights as f32 },
    };
    graph.pass(&format!("{level}/cut"), pass).threads([slot_count, 1, 1]);
    merge(graph, level, (slots, cuts), (slot_count, most_groups(slot_count, rule), group_lights))
}

/// A group's parent matters more than the bound, or it is of the last level.
fn most_groups(slot_count: u32, rule: &LightRule) -> u32 {
    let parents = LEVELS * (rule.side.pow(2) >> (2 * rule.lod + 1)).max(1);
    slot_count.min((slot_count >> (2 * LEVELS)) + 4 * parents)
}

/// What the nodes of all levels matter.
fn weigh(
    graph: &mut Graph<'_>,
    points: &Points<'_>,
    slots: BufferRef<[f32; 4]>,
    slot_count: u32,
) -> BufferRef<[f32; 2]> {
    let node_count: u32 = (0..=LEVELS).map(|level| slot_count >> (2 * level)).sum();
    let level = points.level();
    let matter = graph.buffer::<[f32; 2]>(&format!("{level}.matter"), node_count as usize);
    let weigh = format!("{level}/weigh");
    let pass = match points {
        Points::Picture(picture) => {
            let pass = Weigh {
                surface: picture.surface.group.clone(),
                scene_rays: picture.scene_rays.clone(),
                slots: slots.texels(FLOATS),
                matter: matter.start(),
                push: WeighPush { shift: picture.shift, slot_count, ray_count: RAYS },
            };
            graph.pass(&weigh, pass)
        }
        Points::Samples(of) => {
            let sample_count = of.samples.count() as u32 / 2;
            let pass = bounces::Weigh {
                scene_rays: of.scene_rays.clone(),
                slots: slots.texels(FLOATS),
                samples: of.samples.texels(WORDS),
                matter: matter.start(),
                push: bounces::WeighPush { shift: of.shift, slot_count, sample_count, ray_count: RAYS },
            };
            graph.pass(&weigh, pass)
        }
    };
    pass.note("rays at most", u64::from(RAYS * slot_count)).threads([slot_count, 1, 1]);
    for number in 1..=LEVELS {
        let pass = Coarser { matter: matter.read_write(), push: CoarserPush { slot_count, level: number } };
        graph.pass(&format!("{level}/coarser.{number}"), pass).threads([slot_count >> (2 * number), 1, 1]);
    }
    matter
}

fn merge(
    graph: &mut Graph<'_>,
    level: &str,
    (slots, cuts): (BufferRef<[f32; 4]>, BufferRef<u32>),
    (slot_count, group_count, group_lights): (u32, u32, u32),
) -> AreaLights {
    let offsets = graph.buffer::<[u32; 2]>(&format!("{level}.offsets"), slot_count as usize + 1);
    let counts = graph.buffer::<u32>(&format!("{level}.light_counts"), 2);
    // On each level fewer nodes of a group than its lights are to be matter more than a light's bound.
    let most_lights = 3 * LEVELS * group_lights + 1;
    let pass = ScanCuts {
        cuts: cuts.texels(WORD),
        offsets: offsets.write(),
        counts: counts.write(),
        push: ScanCutsPush { slot_count, group_count },
    };
    let pass = graph.pass(&format!("{level}/scan"), pass).count("lights", counts, 0).count("groups", counts, 1);
    pass.groups([1, 1, 1]);
    let lights = graph.buffer::<[f32; 4]>(&format!("{level}.lights"), 2 * slot_count as usize);
    let lists = graph.buffer::<[u32; 4]>(&format!("{level}.light_groups"), 2 * group_count as usize);
    let pass = Merge {
        slots: slots.texels(FLOATS),
        cuts: cuts.texels(WORD),
        offsets: offsets.texels(vk::Format::R32G32_UINT),
        lights: lights.start(),
        groups: lists.start(),
        push: MergePush { slot_count, group_count },
    };
    graph.pass(&format!("{level}/merge"), pass).threads([slot_count, 1, 1]);
    let group = groups::AreaLights {
        area_lights: lights.texels(FLOATS),
        area_light_groups: lists.texels(WORDS),
        area_light_counts: counts.texels(WORD),
    };
    AreaLights { group, group_count, group_lights: most_lights, lights, counts }
}
