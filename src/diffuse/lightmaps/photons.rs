//! The approximated illumination map by photons whose paths are kept: those are sent again whose way changed, group by group.

use super::formats::{FLOATS4, WORD, WORDS4};
use super::lamps::Lamps;
use super::options::{LightmapsInvalidate, LightmapsOptions, LightmapsSource};
use super::rounds::{Counts, Turn, restart};
use super::texels::LightTexels;
use crate::frame::rays::{Motion, TracedScene};
use crate::graph::bindings::{BufferRef, ReadWriteBuffer, TexelBuffer};
use crate::graph::kept::Advance;
use crate::graph::{Dependence, Graph, hash_of};
use crate::shaders::buckets::{Starts, StartsPush};
use crate::shaders::groups::Lobes;
use crate::shaders::lightmaps::{
    Crossed, CrossedPush, Estimate, EstimatePush, Landed, LandedPush, Send, SendPush, Stale, StalePush,
};

/// As in glsl/lightmaps/photons.glsl.
const GROUP: u32 = 40;
const RECORDS: u32 = 16;
/// Photons by the number of surfaces, at least and at most.
const A_SURFACE: u32 = 512;
const LEAST: u32 = 20_000;
const MOST: u32 = 200_000;
/// Steps of a sum that the mean photon has.
const STEPS: f64 = 1_048_576.0;
/// Points of a path that are nearer to each other are the same, over the scene's radius.
const SLACK: f64 = 1e-4;

/// A word whose key, as memory has it, says among which surfaces photons were sent last.
#[derive(Clone, Copy)]
pub(super) struct SentAmong(BufferRef<u32>);

impl SentAmong {
    /// In every frame: memory goes when a frame does not declare it.
    pub(super) fn declare(graph: &mut Graph<'_>) -> SentAmong {
        SentAmong(graph.carried_buffer("lightmaps.sent_among", 1))
    }
}

/// Photons that are kept over frames.
#[derive(Clone, Copy)]
pub(super) struct Sending {
    pub(super) among: SentAmong,
    pub(super) turn: Turn,
}

/// What happened to surfaces since photons were sent last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Since {
    /// Nothing.
    Stand,
    /// The motion of this frame.
    Moved,
    /// Nobody knows: they moved in frames without photons.
    Unknown,
}

/// What is kept of photons.
struct Kept {
    records: BufferRef<[u32; 4]>,
    /// What light each group was sent from.
    keys: BufferRef<u32>,
    received: BufferRef<[f32; 4]>,
    /// Of all rounds; none where there is one.
    past: Option<BufferRef<u32>>,
    /// Where it is noted among which surfaces they are sent, and the key that says it.
    among: BufferRef<u32>,
    among_key: u64,
    since: Since,
    age: u32,
}

impl Kept {
    fn declare(
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        counts: [usize; 4],
        (depends, among): (u64, Option<SentAmong>),
        invalidate: LightmapsInvalidate,
    ) -> Kept {
        let [records, keys, received, past] = counts;
        // Probes may not have found yet what moved.
        let key_among = |surfaces: u64| hash_of(&("lightmaps.sent_among", depends, surfaces, invalidate));
        let among_key = key_among(scene.surfaces_key());
        if let Some(SentAmong(among)) = among {
            let advance = Advance::EveryFrame;
            let (records, age) = graph.state_buffer("lightmaps.photons", records, depends, advance);
            let (keys, _) = graph.state_buffer("lightmaps.photon_keys", keys, depends, advance);
            let (received, _) = graph.state_buffer("lightmaps.photon_map", received, depends, advance);
            let past = (past > 0).then(|| graph.state_buffer("lightmaps.photon_rounds", past, depends, advance).0);
            let before = scene.motion.as_ref().map(|motion| key_among(motion.from));
            let since = match graph.held_key(among) {
                Some(held) if held == among_key => Since::Stand,
                Some(held) if Some(held) == before => Since::Moved,
                _ => Since::Unknown,
            };
            return Kept { records, keys, received, past, among, among_key, since, age };
        }
        let records = graph.buffer("lightmaps.sent", records);
        let keys = graph.buffer("lightmaps.sent_keys", keys);
        let received = graph.buffer("lightmaps.estimated", received);
        graph.fill_buffer("diffuse/lightmaps/photons/clear-paths", records, 0);
        graph.fill_buffer("diffuse/lightmaps/photons/clear-keys", keys, 0);
        graph.fill_buffer("diffuse/lightmaps/photons/clear-map", received, 0);
        let among = graph.buffer("lightmaps.sent_now", 1);
        Kept { records, keys, received, past: None, among, among_key, since: Since::Unknown, age: 0 }
    }

    /// Whether photons are there that surfaces may have moved among.
    fn may_be_crossed(&self) -> bool {
        self.age > 0 && self.since != Since::Stand
    }
}

/// How many frames probes take to go through a group.
pub(super) fn probing_frames(options: &LightmapsOptions) -> u32 {
    if options.invalidate == LightmapsInvalidate::Probes { GROUP } else { 0 }
}

/// Frames since something changed, in which rounds join.
pub(super) fn joining_frames(options: &LightmapsOptions) -> std::ops::Range<u32> {
    // Probes have to find first what changed.
    let first = probing_frames(options).max(1);
    first..first + (options.rounds - 1)
}

/// Which light photons bring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Brought {
    All,
    /// That of punctual lights by specular lobes alone.
    Caustics,
}

/// The caustics of punctual lights, which rays from texels do not find; none where nothing is specular. `sending`: where paths are kept over frames.
pub(super) fn caustics(
    graph: &mut Graph<'_>,
    (scene, lamps): (&TracedScene, &Lamps),
    texels: &LightTexels,
    options: &LightmapsOptions,
    sending: Option<Sending>,
) -> Option<BufferRef<[f32; 4]>> {
    let Some(reason) = without_caustics((scene, lamps), options) else {
        return Some(received(graph, (scene, lamps), texels, options, (Brought::Caustics, sending)));
    };
    graph.skip("diffuse/lightmaps/photons", reason);
    None
}

/// Why there are none.
fn without_caustics((scene, lamps): (&TracedScene, &Lamps), options: &LightmapsOptions) -> Option<&'static str> {
    match (scene.facts.specular, lamps.punctual_count, options.bounces) {
        (false, ..) => Some("no specular surface"),
        (_, 0, _) => Some("no punctual light"),
        (.., Some(1)) => Some("reflections are more bounces than asked for"),
        _ => None,
    }
}

/// Whether any photons are sent.
pub(super) fn are_sent(shone: (&TracedScene, &Lamps), options: &LightmapsOptions) -> bool {
    options.source == LightmapsSource::Photons || without_caustics(shone, options).is_none()
}

/// All light, as photons bring it.
pub(super) fn aim(
    graph: &mut Graph<'_>,
    shone: (&TracedScene, &Lamps),
    texels: &LightTexels,
    options: &LightmapsOptions,
    sending: Option<Sending>,
) -> BufferRef<[f32; 4]> {
    received(graph, shone, texels, options, (Brought::All, sending))
}

fn received(
    graph: &mut Graph<'_>,
    (scene, lamps): (&TracedScene, &Lamps),
    texels: &LightTexels,
    options: &LightmapsOptions,
    (brought, sending): (Brought, Option<Sending>),
) -> BufferRef<[f32; 4]> {
    let sky = scene.sky.iter().any(|&channel| channel > 0.0);
    let lights = match brought {
        Brought::All => lamps.punctual_count + u32::from(scene.emissive_count > 0) + u32::from(sky),
        Brought::Caustics => lamps.punctual_count,
    };
    let by_surfaces = texels.map.surface_count.saturating_mul(A_SURFACE).clamp(LEAST, MOST);
    let wanted = if options.photons > 0 { options.photons } else { by_surfaces };
    let groups_a_light = (wanted / (GROUP * lights.max(1))).max(1);
    let group_count = groups_a_light * lights;
    let photon_count = group_count * GROUP;
    let sides = 2 * texels.map.surface_count;
    let counted = Counts { groups: group_count, groups_a_light, sides };
    let rounds = if sending.is_some() { options.rounds } else { 1 };
    let what = (group_count, options.bounces, options.nearest, scene.radius.to_bits(), brought, rounds > 1, lamps.own);
    // Paths are points in space: they are of these shapes, which stand while things move.
    let depends = hash_of(&(texels.map.key, scene.shapes, scene.emission_key(), what));
    let past = if rounds > 1 { counted.words() } else { 0 };
    let received = texels.count() * lamps.maps() as usize;
    let counts = [(2 * RECORDS * photon_count) as usize, group_count as usize, received, past];
    let kept = Kept::declare(graph, scene, counts, (depends, sending.map(|sending| sending.among)), options.invalidate);
    let turn = sending.map_or(Turn::Renew, |sending| sending.turn);
    if turn == Turn::Stand {
        return kept.received;
    }
    let exact = options.invalidate == LightmapsInvalidate::Exact;

    let stale = graph.buffer::<u32>("lightmaps.stale", group_count as usize);
    let pass = Stale {
        scene_lights: lamps.lights.clone(),
        stale: stale.write(),
        keys: kept.keys.read_write(),
        among: kept.among.write(),
        push: StalePush {
            group_count,
            groups_a_light,
            light_count: lamps.punctual_count,
            sky_key: hash_of(&scene.sky.map(f32::to_bits)) as u32,
            all: u32::from(kept.age == 0 || turn == Turn::Join || (exact && kept.since == Since::Unknown)),
        },
    };
    let pass = graph.pass("diffuse/lightmaps/photons/stale", pass).leaves(kept.among, kept.among_key);
    pass.threads([group_count, 1, 1]);
    let motion = scene.motion.as_ref().filter(|_| kept.age > 0 && kept.since == Since::Moved);
    let moved = motion.map(|motion| boxes_of(graph, motion));
    if let Some(moved) = moved.filter(|_| exact) {
        crossing(graph, moved, (&kept, stale), photon_count);
    }

    let touched = graph.buffer::<u32>("lightmaps.touched", sides as usize + 2);
    graph.fill_buffer("diffuse/lightmaps/photons/clear", touched, 0);
    let facts = &scene.facts;
    let send = |graph: &mut Graph<'_>, probes: u32, probe: u32| {
        let pass = Send {
            probes,
            caustics: u32::from(brought == Brought::Caustics),
            far_surfaces: u32::from(scene.far_surfaces),
            scene_rays: texels.rays.clone(),
            scene_lights: lamps.lights.clone(),
            lightmap: texels.group.clone(),
            lobes: Lobes { specular_lobes: u32::from(facts.specular), transmissive: u32::from(facts.transmissive) },
            records: kept.records.read_write(),
            stale: stale.read_write(),
            touched: touched.read_write(),
            rounds: u32::from(kept.past.is_some()),
            past: kept.past.map_or(ReadWriteBuffer::absent(), |past| past.read_write()),
            push: SendPush {
                group_count,
                groups_a_light,
                light_count: lamps.punctual_count,
                emitter_count: scene.emissive_count,
                density_scale: scene.emissive_density_scale,
                bounces: options.bounces.unwrap_or(u32::MAX),
                probe,
                surface_count: sides,
                sky: scene.sky,
                radius: scene.radius as f32,
                middle: scene.middle_rs.as_vec3().to_array(),
                slack: (SLACK * scene.radius) as f32,
                // Another one in each frame, whatever was sent in it.
                round: if rounds > 1 { kept.age } else { 0 },
            },
        };
        let (name, count) = if probes == 1 { ("probe", group_count) } else { ("send", photon_count) };
        let pass = graph.pass(&format!("diffuse/lightmaps/photons/{name}"), pass);
        let pass = pass.count("sent", touched, sides as usize).count("rays", touched, sides as usize + 1);
        pass.threads([count, 1, 1]);
    };
    if kept.age > 0 && !exact && turn == Turn::Renew {
        // By the age of what is kept: probes go on while something changes in every frame.
        send(graph, 1, kept.age % GROUP);
    }
    if let Some(past) = kept.past.filter(|_| kept.age > 0 && turn == Turn::Renew) {
        restart(graph, texels, counted, (past, stale, touched), moved);
    }
    send(graph, 0, 0);
    // The nearest ones of what is bright on a small part of a surface alone spread it far over the rest: caustics stay in their texels.
    let nearest = if brought == Brought::All { options.nearest } else { 0 };
    let joins = if turn == Turn::Join { rounds } else { 0 };
    let photons = Landing { count: photon_count, a_light: GROUP * groups_a_light, nearest, rounds: joins };
    estimate(graph, (scene, lamps), texels, (&kept, touched), photons);
    kept.received
}

/// Boxes around what moved, before and after, and how many.
fn boxes_of(graph: &mut Graph<'_>, motion: &Motion) -> (BufferRef<[f32; 4]>, u32) {
    let corners = motion.before.iter().chain(&motion.after).flatten();
    let corners: Vec<[f32; 4]> = corners.map(|corner| corner.extend(0.0).to_array()).collect();
    (graph.upload("lightmaps.moved_boxes", &corners, Dependence::GEOMETRY), (corners.len() / 2) as u32)
}

/// Finds the groups whose paths cross what moved.
fn crossing(
    graph: &mut Graph<'_>,
    (boxes, box_count): (BufferRef<[f32; 4]>, u32),
    (kept, stale): (&Kept, BufferRef<u32>),
    photon_count: u32,
) {
    let pass = Crossed {
        records: kept.records.texels(WORDS4),
        boxes: boxes.texels(FLOATS4),
        stale: stale.read_write(),
        push: CrossedPush { photon_count, box_count },
    };
    graph.pass("diffuse/lightmaps/photons/crossed", pass).threads([photon_count, 1, 1]);
}

/// Photons as texels take them.
#[derive(Clone, Copy)]
struct Landing {
    count: u32,
    a_light: u32,
    /// That a texel looks for.
    nearest: u32,
    /// That a texel may have, where one joins.
    rounds: u32,
}

/// Estimates what texels receive of the photons on their surfaces, where these changed, or, where something moved, what texels see of their surfaces.
fn estimate(
    graph: &mut Graph<'_>,
    (scene, lamps): (&TracedScene, &Lamps),
    texels: &LightTexels,
    (kept, touched): (&Kept, BufferRef<u32>),
    photons: Landing,
) {
    let photon_count = photons.count;
    let bucket_count = texels.map.count;
    let counts = graph.buffer::<u32>("lightmaps.hit_counts", bucket_count as usize);
    graph.fill_buffer("diffuse/lightmaps/photons/clear-counts", counts, 0);
    let landed = |lists: u32, starts: TexelBuffer, counts: BufferRef<u32>, hits: ReadWriteBuffer<[u32; 4]>| Landed {
        lists,
        records: kept.records.texels(WORDS4),
        starts,
        counts: counts.read_write(),
        hits,
        push: LandedPush { photon_count, photons_a_light: photons.a_light },
    };
    let pass = landed(0, TexelBuffer::absent(), counts, ReadWriteBuffer::absent());
    graph.pass("diffuse/lightmaps/photons/count", pass).threads([photon_count, 1, 1]);
    let starts = graph.buffer::<u32>("lightmaps.hit_starts", bucket_count as usize + 1);
    let push = StartsPush { bucket_count };
    let pass = Starts { counts: counts.texels(WORD), starts: starts.write(), push };
    graph.pass("diffuse/lightmaps/photons/starts", pass).groups([1, 1, 1]);
    let listed = graph.buffer::<u32>("lightmaps.hit_lengths", bucket_count as usize);
    graph.fill_buffer("diffuse/lightmaps/photons/clear-lists", listed, 0);
    let hits = graph.buffer::<[u32; 4]>("lightmaps.hits", (2 * (RECORDS - 1) * photon_count) as usize);
    let pass = landed(1, starts.texels(WORD), listed, hits.start_then_read());
    graph.pass("diffuse/lightmaps/photons/list", pass).unordered().threads([photon_count, 1, 1]);
    let sky = scene.sky.iter().map(|&channel| f64::from(channel)).fold(0.0, f64::max);
    let sky_power = 4.0 * (std::f64::consts::PI * scene.radius).powi(2) * sky;
    let power = (lamps.power + sky_power).max(1e-30);
    let pass = Estimate {
        scene_rays: texels.rays.clone(),
        lightmap: texels.group.clone(),
        starts: starts.texels(WORD),
        hits: hits.texels(WORDS4),
        touched: touched.texels(WORD),
        areas: texels.map.areas(graph),
        received: kept.received.read_write(),
        push: EstimatePush {
            texel_count: texels.map.count,
            nearest: photons.nearest,
            all: u32::from(kept.may_be_crossed() && (kept.past.is_none() || kept.since == Since::Unknown)),
            steps_a_watt: (STEPS * f64::from(photon_count) / power) as f32,
            own_maps: lamps.own,
            maps: lamps.maps(),
            rounds: photons.rounds,
        },
    };
    graph.pass("diffuse/lightmaps/photons/estimate", pass).threads(texels.threads());
}
