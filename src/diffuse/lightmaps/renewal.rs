//! The maps over frames: a frame renews as many texels as it may, those first whose light changed most. What a frame does is bounded by counts, never by time, so that
//! the same frames have the same bits.

use super::aim::Approximated;
use super::formats::{FLOATS4, WORD, WORDS2};
use super::iim::gather;
use super::maps::Maps;
use super::options::{LightmapsOptions, LightmapsSettle, LightmapsShow, LightmapsSource};
use super::photons;
use super::texels::{Chosen, LightTexels};
use crate::frame::rays::TracedScene;
use crate::graph::bindings::BufferRef;
use crate::graph::kept::Advance;
use crate::graph::{Graph, hash_of};
use crate::shaders::lightmaps::{Blend, BlendPush, Choose, ChoosePush, Note, Rank, RankPush};

/// Bounces that a frame adds to what the last one left.
const BOUNCES: u32 = 3;
/// Frames after the last texel was renewed until the maps stand: light goes on along links, and what is shown moves to what was gathered.
const LAST_FRAMES: u32 = 24;
/// Levels of change, as in glsl/lightmaps/rank.comp.
const LEVELS: usize = 1024;

/// What is kept over frames.
struct Kept {
    /// Irradiance that texels gathered, W/m².
    gathered: BufferRef<[f32; 4]>,
    /// What came along their links then.
    then: BufferRef<[f32; 4]>,
    /// What is shown of it.
    shown: BufferRef<[f32; 4]>,
    age: u32,
}

impl Kept {
    fn declare(graph: &mut Graph<'_>, count: usize, depends: u64) -> Kept {
        let mut state = |name: &str| graph.state_buffer::<[f32; 4]>(name, count, depends, Advance::EveryFrame);
        let (gathered, age) = state("lightmaps.iim");
        let [(then, _), (shown, _)] = ["lightmaps.then", "lightmaps.shown"].map(state);
        Kept { gathered, then, shown, age }
    }
}

/// Declares what a frame does for the maps of the scene of that identity.
pub(super) fn renewed(
    graph: &mut Graph<'_>,
    (scene, identity): (&TracedScene, u64),
    texels: &LightTexels,
    light: &Approximated,
    options: &LightmapsOptions,
) -> Maps {
    let &LightmapsOptions { rays, fragments, samples, bounces, source, photons, nearest, show, .. } = options;
    // Frames that show the AIM alone leave the other map behind.
    let aim_alone = show == LightmapsShow::Received;
    let gathering = (options.gather, rays, options.plane.to_bits(), fragments);
    let scattering = (texels.link_count, samples, bounces, source);
    let depends = hash_of(&(aim_alone, identity, texels.map.key, gathering, scattering));
    let content = hash_of(&(depends, scene.key, scene.sky.map(f32::to_bits), photons, nearest));
    let among = photons::SentAmong::declare(graph);
    let kept = Kept::declare(graph, texels.count(), depends);
    // How long nothing else has changed, and whether that is what all texels were gathered of.
    let (turn, frames) = graph.state_buffer::<u32>("lightmaps.turn", 1, content, Advance::EveryFrame);
    let (whole, wholes) = graph.state_buffer::<u32>("lightmaps.whole", 1, content, Advance::EveryFrame);
    let used_count = texels.map.used.len() as u32;
    let renewing = used_count.div_ceil(options.texels).max(photons::probing_frames(options));
    if !aim_alone && (wholes > 0 || frames >= renewing.saturating_add(LAST_FRAMES)) {
        graph.skip("diffuse/lightmaps/renewal", "all texels are renewed");
        return Maps { gathered: kept.shown, received: None };
    }
    let at_once = kept.age == 0 && options.settle == LightmapsSettle::First;
    let aim = match options.source {
        LightmapsSource::Rays => {
            let caustics = photons::caustics(graph, scene, texels, options, Some(among));
            approximated(graph, texels, (light, caustics), (depends, at_once), options)
        }
        LightmapsSource::Photons => photons::aim(graph, scene, texels, options, Some(among)),
    };
    let now = graph.buffer::<[f32; 4]>("lightmaps.now", texels.count());
    graph.fill_buffer("diffuse/lightmaps/renewal/clear-now", now, 0);
    let listed = choose(graph, texels, (aim, &kept, now), options.texels);
    let chosen = if at_once { texels.all() } else { listed };
    gather(graph, texels, (aim, kept.gathered), chosen, options);
    let pass = Note {
        list: chosen.list.texels(WORD),
        head: chosen.head.texels(WORD),
        now: now.texels(FLOATS4),
        then: kept.then.modify(),
    };
    graph.pass("diffuse/lightmaps/renewal/note", pass).threads_indirect(chosen.head, 0);
    let pass = Blend {
        gathered: kept.gathered.texels(FLOATS4),
        now: now.texels(FLOATS4),
        then: kept.then.texels(FLOATS4),
        used: texels.used.texels(WORD),
        shown: kept.shown.read_write(),
        push: BlendPush { used_count, share: if kept.age == 0 { 1.0 } else { options.blend as f32 } },
    };
    graph.pass("diffuse/lightmaps/renewal/blend", pass).threads([used_count, 1, 1]);
    // Another word each frame: what memory holds already is not made again.
    let word = (content as u32).wrapping_add(frames);
    graph.fill_buffer("diffuse/lightmaps/renewal/turn", turn, word);
    graph.want_buffer(turn);
    if at_once {
        graph.fill_buffer("diffuse/lightmaps/renewal/whole", whole, word);
        graph.want_buffer(whole);
    }
    Maps { gathered: kept.shown, received: Some(aim) }
}

/// The AIM: all bounces, or a few more than in the frame before.
fn approximated(
    graph: &mut Graph<'_>,
    texels: &LightTexels,
    (light, caustics): (&Approximated, Option<BufferRef<[f32; 4]>>),
    (depends, at_once): (u64, bool),
    options: &LightmapsOptions,
) -> BufferRef<[f32; 4]> {
    if options.bounces.is_some() {
        return light.settled(graph, texels, caustics);
    }
    let kept = graph.history_buffer::<[f32; 4]>("lightmaps.aim", texels.count(), depends, Advance::EveryFrame);
    // From nothing the first bounce brings what comes of the lights.
    let bounces = if at_once || kept.age == 0 { light.bounces + 1 } else { BOUNCES };
    let aim = light.bounced(graph, texels, (kept.last, caustics), bounces, Some(kept.next));
    graph.want_buffer(aim);
    aim
}

/// Lists the texels whose light changed most, `most` of them.
fn choose(
    graph: &mut Graph<'_>,
    texels: &LightTexels,
    (aim, kept, now): (BufferRef<[f32; 4]>, &Kept, BufferRef<[f32; 4]>),
    most: u32,
) -> Chosen {
    let used_count = texels.map.used.len() as u32;
    let most = most.min(used_count);
    let levels = graph.buffer::<u32>("lightmaps.levels", used_count as usize);
    let histogram = graph.buffer::<u32>("lightmaps.histogram", LEVELS);
    graph.fill_buffer("diffuse/lightmaps/renewal/clear", histogram, 0);
    let pass = Rank {
        links: texels.links.texels(WORDS2),
        received: aim.texels(FLOATS4),
        then: kept.then.texels(FLOATS4),
        used: texels.used.texels(WORD),
        now: now.modify(),
        levels: levels.write(),
        histogram: histogram.read_write(),
        push: RankPush { texel_count: texels.map.count, used_count, link_count: texels.link_count },
    };
    graph.pass("diffuse/lightmaps/renewal/rank", pass).threads([used_count, 1, 1]);
    let list = graph.buffer::<u32>("lightmaps.chosen", most as usize);
    let head = graph.buffer::<u32>("lightmaps.chosen_head", 4);
    let pass = Choose {
        used: texels.used.texels(WORD),
        levels: levels.texels(WORD),
        histogram: histogram.texels(WORD),
        list: list.start(),
        head: head.write(),
        push: ChoosePush { used_count, most },
    };
    graph.pass("diffuse/lightmaps/renewal/choose", pass).groups([1, 1, 1]);
    Chosen { head, list, most }
}
