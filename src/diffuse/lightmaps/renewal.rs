//! The maps over frames: a frame renews as many texels as it may, those first whose light changed most. Once no change is left, texels gather again by other rays, as many
//! a frame, and keep the mean over their rounds; a change begins the rounds of those anew whose light it changes. What a frame does is bounded by counts, never by time, so
//! that the same frames have the same bits.

use super::aim::Approximated;
use super::formats::{FLOATS4, WORD, WORDS2};
use super::iim::gather;
use super::lamps::Lamps;
use super::maps::Maps;
use super::options::{LightmapsGather, LightmapsOptions, LightmapsSettle, LightmapsShow, LightmapsSource};
use super::photons::{self, Sending, joining_frames};
use super::rounds::Turn;
use super::texels::{Chosen, LightTexels};
use crate::frame::rays::TracedScene;
use crate::graph::bindings::BufferRef;
use crate::graph::kept::Advance;
use crate::graph::{Graph, hash_of};
use crate::shaders::lightmaps::{Blend, BlendPush, Choose, ChoosePush, Note, NotePush, Rank, RankPush};

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
    (texels, lamps): (&LightTexels, &Lamps),
    light: &Approximated,
    options: &LightmapsOptions,
) -> Maps {
    let &LightmapsOptions { rays, fragments, samples, bounces, source, photons, nearest, show, .. } = options;
    // The fragments of a hemicube are the same in every round.
    let rounds = if options.gather == LightmapsGather::Hemicube { 1 } else { options.rounds };
    // Frames that show the AIM alone leave the other map behind.
    let aim_alone = show == LightmapsShow::Received;
    let gathering = (options.gather, rays, options.plane.to_bits(), fragments);
    let scattering = (texels.link_count, samples, bounces, source);
    let what = (aim_alone, gathering, scattering, [lamps.own, lamps.maps()]);
    let depends = hash_of(&(identity, texels.map.key, what));
    let content = hash_of(&(depends, lamps.key, photons, nearest, options.rounds > 1));
    let among = photons::SentAmong::declare(graph);
    let count = texels.count() * lamps.maps() as usize;
    let kept = Kept::declare(graph, count, depends);
    // How long nothing else has changed, and whether that is what all texels were gathered of.
    let (turn, frames) = graph.state_buffer::<u32>("lightmaps.turn", 1, content, Advance::EveryFrame);
    let (whole, wholes) = graph.state_buffer::<u32>("lightmaps.whole", 1, content, Advance::EveryFrame);
    let used_count = texels.map.used.len() as u32;
    let joining = if photons::are_sent((scene, lamps), options) { joining_frames(options) } else { 0..0 };
    let renewing = used_count.div_ceil(options.texels).max(photons::probing_frames(options));
    let changing = if wholes > 0 { 1 } else { renewing.saturating_add(LAST_FRAMES).saturating_add(joining.end) };
    // Each frame of these takes as many as there may be, until all have all of their rounds, and what is shown moves there.
    let gatherings = u64::from(rounds) * u64::from(used_count);
    let refining = if rounds > 1 { gatherings.div_ceil(u64::from(options.texels)) + u64::from(LAST_FRAMES) } else { 0 };
    let stands = !aim_alone && frames >= changing;
    if stands && u64::from(frames - changing) >= refining {
        graph.skip("diffuse/lightmaps/renewal", "all texels are renewed");
        return Maps { gathered: kept.shown, received: None };
    }
    let at_once = kept.age == 0 && options.settle == LightmapsSettle::First;
    let photons_turn = match joining.contains(&frames) {
        _ if stands => Turn::Stand,
        true => Turn::Join,
        false => Turn::Renew,
    };
    let sending = Some(Sending { among, turn: photons_turn });
    let aim = match options.source {
        LightmapsSource::Rays => {
            let caustics = photons::caustics(graph, (scene, lamps), texels, options, sending);
            let bounces = match (stands, at_once) {
                (true, _) => Bounces::None,
                (_, true) => Bounces::All,
                _ => Bounces::Few,
            };
            approximated(graph, texels, (light, caustics), (depends, bounces), options)
        }
        LightmapsSource::Photons => photons::aim(graph, (scene, lamps), texels, options, sending),
    };
    let now = graph.buffer::<[f32; 4]>("lightmaps.now", count);
    graph.fill_buffer("diffuse/lightmaps/renewal/clear-now", now, 0);
    let listed = choose(graph, (texels, lamps), (aim, &kept, now), (options.texels, if stands { rounds } else { 0 }));
    let chosen = if at_once { texels.all() } else { listed };
    gather(graph, texels, (aim, kept.gathered, lamps.maps()), chosen, options);
    let pass = Note {
        list: chosen.list.texels(WORD),
        head: chosen.head.texels(WORD),
        now: now.texels(FLOATS4),
        gathered: kept.gathered.texels(FLOATS4),
        then: kept.then.modify(),
        push: NotePush { texel_count: texels.map.count, maps: lamps.maps() },
    };
    graph.pass("diffuse/lightmaps/renewal/note", pass).threads_indirect(chosen.head, 0);
    let pass = Blend {
        gathered: kept.gathered.texels(FLOATS4),
        now: now.texels(FLOATS4),
        then: kept.then.texels(FLOATS4),
        used: texels.used.texels(WORD),
        shown: kept.shown.read_write(),
        push: BlendPush {
            used_count,
            share: if kept.age == 0 { 1.0 } else { options.blend as f32 },
            texel_count: texels.map.count,
            maps: lamps.maps(),
        },
    };
    graph.pass("diffuse/lightmaps/renewal/blend", pass).threads([lamps.maps() * used_count, 1, 1]);
    // Another word each frame: what memory holds already is not made again.
    let word = (content as u32).wrapping_add(frames);
    graph.fill_buffer("diffuse/lightmaps/renewal/turn", turn, word);
    graph.want_buffer(turn);
    if at_once && joining.is_empty() {
        graph.fill_buffer("diffuse/lightmaps/renewal/whole", whole, word);
        graph.want_buffer(whole);
    }
    Maps { gathered: kept.shown, received: Some(aim) }
}

/// Which bounces a frame adds to those of the frame before.
#[derive(Clone, Copy)]
enum Bounces {
    None,
    Few,
    All,
}

/// The AIM: all bounces, or a few more than in the frame before.
fn approximated(
    graph: &mut Graph<'_>,
    texels: &LightTexels,
    (light, caustics): (&Approximated, Option<BufferRef<[f32; 4]>>),
    (depends, bounces): (u64, Bounces),
    options: &LightmapsOptions,
) -> BufferRef<[f32; 4]> {
    if options.bounces.is_some() {
        return light.settled(graph, texels, caustics);
    }
    let count = light.direct.count();
    let (aim, age) = graph.state_buffer::<[f32; 4]>("lightmaps.aim", count, depends, Advance::EveryFrame);
    // From nothing the first bounce brings what comes of the lights.
    let bounces = match bounces {
        Bounces::None => return aim,
        Bounces::Few if age > 0 => BOUNCES,
        Bounces::Few | Bounces::All => light.bounces + 1,
    };
    // Two bounces at least: no pass reads what it writes.
    light.bounced(graph, texels, (aim, caustics), bounces, Some(aim));
    graph.want_buffer(aim);
    aim
}

/// Lists the texels whose light changed most, `most` of them, and then those that have fewer `rounds`.
fn choose(
    graph: &mut Graph<'_>,
    (texels, lamps): (&LightTexels, &Lamps),
    (aim, kept, now): (BufferRef<[f32; 4]>, &Kept, BufferRef<[f32; 4]>),
    (most, rounds): (u32, u32),
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
        gathered: kept.gathered.read_write(),
        tints: lamps.tints.texels(FLOATS4),
        push: RankPush {
            texel_count: texels.map.count,
            used_count,
            link_count: texels.link_count,
            maps: lamps.maps(),
            rounds,
        },
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
