//! Samples spread over the whole scene's diffuse surfaces as virtual area lights. They receive light of emissive surfaces and of the sky by rays (`lamps.rs`), and that of the
//! lights that light views see, exchange it among themselves bounce by bounce, and shine by all of it. What the light views see is lit already; what they do not see shines by these.
//!
//! Which clusters of samples see each other stands while geometry does.

mod lamps;
mod space;

use std::rc::Rc;

use ash::vk;

use self::space::{FLOATS, Light, Space, WORDS};
use super::caches::{AreaLights, CacheSight, LANES, LightRule, Points, Samples, grouped, spread_lights};
use super::light_set::LightSet;
use super::light_views::LightViews;
use super::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::shaders::bounces::{
    Albedo, AlbedoPush, Exchange, ExchangePush, Lights, LightsPush, Receive, ReceivePush, Sees, SeesPush,
};

const WORD: vk::Format = vk::Format::R32_UINT;

/// Steps of an invocation's loops for a light.
const LIGHT_STEPS: u32 = 1;

/// What samples are to shine by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BounceRule {
    /// Light that was reflected so often when it leaves them, at most.
    pub(crate) bounces: u32,
    pub(crate) samples: u32,
    /// Clusters are of 4^lod samples.
    pub(crate) lod: u32,
    /// They take the light of emissive surfaces and of the sky, which light views know by few samples.
    pub(crate) area_lights: bool,
    /// Lights have their areas in the paper's form.
    pub(crate) paper: bool,
}

impl BounceRule {
    /// Whether any light comes to samples.
    pub(crate) fn wants_samples(&self, scene: &TracedScene) -> bool {
        self.bounces > 1 || self.area_lights && lamps::any(scene)
    }
}

/// Lights of the light views.
pub(crate) enum FirstLights<'l> {
    Made(Rc<AreaLights>),
    /// Small where samples receive much of them.
    BySamples {
        set: &'l LightSet,
        views: &'l LightViews,
        rule: LightRule,
    },
}

/// Declares the passes. `shift`: from render space to that of rays; `first`: lights of the light views, if there are any. None where nothing is diffuse.
pub(crate) fn sample_lights(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    shift: [f32; 3],
    first: Option<FirstLights<'_>>,
    rule: &BounceRule,
) -> Option<AreaLights> {
    let cluster = 1 << (2 * rule.lod);
    let made = scene.surface_samples(rule.samples, cluster);
    let slot_count = made.slot_count;
    if slot_count == 0 {
        return None;
    }
    let (rays, samples) = (scene.rays(graph), made.upload(graph));
    let matter = graph.buffer::<[f32; 4]>("bounces.matter", slot_count as usize);
    let pass = Albedo {
        scene_rays: rays.clone(),
        samples: samples.texels(WORDS),
        matter: matter.write(),
        push: AlbedoPush { slot_count },
    };
    let pass = graph.pass("bounces/samples/albedo", pass).note("samples", u64::from(rule.samples));
    pass.threads([slot_count, 1, 1]);
    let space = Space { rays, samples, matter, slot_count, cluster };
    let sums = light(graph, scene, shift, first, &space, rule)?;
    let slots = graph.buffer::<[f32; 4]>("bounces.slots", 2 * slot_count as usize);
    let pass = Lights {
        samples: samples.texels(WORDS),
        matter: matter.texels(FLOATS),
        sums: sums.texels(FLOATS),
        slots: slots.write(),
        paper: u32::from(rule.paper),
        push: LightsPush { shift, slot_count },
    };
    graph.pass("bounces/lights/make", pass).threads([slot_count, 1, 1]);
    Some(grouped(graph, "bounces/lights", slots, cluster))
}

/// All light that comes to the samples; none where there is none.
fn light(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    shift: [f32; 3],
    first: Option<FirstLights<'_>>,
    space: &Space,
    rule: &BounceRule,
) -> Option<Light> {
    let lamps = if rule.area_lights { lamps::light(graph, scene, space) } else { None };
    if rule.bounces < 2 {
        return lamps;
    }
    let from_views = first.map(|first| {
        let lights = match first {
            FirstLights::Made(lights) => lights,
            FirstLights::BySamples { set, views, rule } => {
                let of = Samples { samples: space.samples, scene_rays: space.rays.clone(), shift };
                Rc::new(spread_lights(graph, set, views, &Points::Samples(of), &rule))
            }
        };
        receive(graph, (shift, rule.paper), &lights, space)
    });
    let mut known = lamps.map(|lamps| (lamps, lamps));
    let mut sees_known = None;
    for number in 2..=rule.bounces {
        let views = if number == 2 { from_views } else { None };
        known = match (known, views) {
            (None, views) => views.map(|views| (views, views)),
            (Some(known), views) => {
                let sees = *sees_known.get_or_insert_with(|| sees(graph, space));
                Some(exchange(graph, space, sees, (known, views), number))
            }
        };
    }
    known.map(|(_, sums)| sums)
}

/// What comes to the samples from the light views' lights, W/m².
fn receive(graph: &mut Graph<'_>, (shift, paper): ([f32; 3], bool), first: &AreaLights, space: &Space) -> Light {
    let arrived = graph.buffer::<[f32; 4]>("bounces.from_views", space.slot_count as usize);
    let loop_steps = graph.traits().loop_steps;
    for chunk in first.chunks(CacheSight::Rays, LIGHT_STEPS * first.group_lights, (LANES, loop_steps)) {
        let (first_group, end_group) = (chunk.first_group, chunk.end_group);
        let pass = Receive {
            area_lights: first.group.clone(),
            scene_rays: space.rays.clone(),
            samples: space.samples.texels(WORDS),
            paper: u32::from(paper),
            arrived: if first_group == 0 { arrived.start_then_read() } else { arrived.read_write() },
            push: ReceivePush { shift, slot_count: space.slot_count, first_group, end_group },
        };
        graph.pass(&chunk.name("bounces/light/receive"), pass).groups(space.groups());
    }
    arrived
}

/// Which clusters each sample sees, a bit each.
fn sees(graph: &mut Graph<'_>, space: &Space) -> BufferRef<u32> {
    let words = space.words();
    let sees = graph.buffer::<u32>("bounces.sees", (space.slot_count * words) as usize);
    let pass = Sees {
        scene_rays: space.rays.clone(),
        samples: space.samples.texels(WORDS),
        sees: sees.write(),
        push: SeesPush { slot_count: space.slot_count, cluster: space.cluster, words },
    };
    graph.pass("bounces/samples/sees", pass).threads([space.slot_count * words, 1, 1]);
    sees
}

/// One more bounce: what arrives in it, and in all so far. `from_views`: what arrives of the light views' lights besides.
fn exchange(
    graph: &mut Graph<'_>,
    space: &Space,
    sees: BufferRef<u32>,
    ((before, sum_before), from_views): ((Light, Light), Option<Light>),
    number: u32,
) -> (Light, Light) {
    let slot_count = space.slot_count;
    let mut buffer = |name: &str| graph.buffer::<[f32; 4]>(&format!("bounces.{name}.{number}"), slot_count as usize);
    let (arrived, sums) = (buffer("arrived"), buffer("sums"));
    let pass = Exchange {
        samples: space.samples.texels(WORDS),
        matter: space.matter.texels(FLOATS),
        sees: sees.texels(WORD),
        before: before.texels(FLOATS),
        sum_before: sum_before.texels(FLOATS),
        arrived: arrived.write(),
        sums: sums.write(),
        has_views: u32::from(from_views.is_some()),
        from_views: from_views.map_or(TexelBuffer::absent(), |views| views.texels(FLOATS)),
        push: ExchangePush { slot_count, cluster: space.cluster, words: space.words() },
    };
    graph.pass(&format!("bounces/light/exchange-{number}"), pass).groups(space.groups());
    (arrived, sums)
}
