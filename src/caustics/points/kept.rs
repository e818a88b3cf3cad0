//! Photons that are kept over frames, and sent again in turns where something changed (Larsen & Christensen 2004, section 5).
//!
//! Photon i belongs to turn i mod F. The first frame sends all turns; where lights or surfaces changed since a turn was sent, each frame sends one of them again, until
//! all are as they would be after a start. Which photons there are depends on the scene alone, so that they stand still with it.

use ash::vk;

use super::options::PointOptions;
use crate::frame::photons::kept::{KEPT_TEXELS, KeptPhotons};
use crate::frame::photons::records::{Arrivals, LARGEST_BUFFER, LandedPhotons, PhotonRays};
use crate::frame::photons::turn::{Discs, Sending, Turn};
use crate::frame::photons::ways::Ways;
use crate::frame::photons::{bvh, choose, send, views};
use crate::frame::rays::TracedScene;
use crate::graph::bindings::BufferRef;
use crate::graph::hash_of;
use crate::method::FrameCx;
use crate::shaders::photons::{Keep, KeepPush};

pub(super) const PIECE: &str = "caustics/points";

const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const WORDS: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// The largest record of a place: that of a pixel on which it alone falls (glsl/points/source.glsl).
const PLACE_BYTES: u32 = 64;

/// How photons land: as ellipses as wide as their neighbours are away.
const DISCS: Discs = Discs { scale: 1.0, by_beams: true };

/// Photons that are sent, of those asked for: turns have as many places each.
pub(super) fn sent(options: &PointOptions) -> u32 {
    let most = LARGEST_BUFFER / PLACE_BYTES / options.bounces.max(1);
    options.photons.min(most / options.frames * options.frames)
}

/// What all turns share.
struct Turns {
    /// Photons of all of them.
    photons: u32,
    frames: u32,
    stages: u32,
    /// Names all that makes photons of another frame useless.
    identity: u64,
}

impl Turns {
    fn sending(&self, first: u32) -> Sending {
        let turn = Turn { first, stride: self.frames };
        Sending { piece: PIECE, turn, stages: self.stages as usize, discs: DISCS }
    }

    /// Photons of the longest turn.
    fn photons_of_turn(&self) -> u32 {
        self.sending(0).turn.count(self.photons)
    }

    /// Places of a turn: each of its photons may land once a stage.
    fn capacity(&self) -> u32 {
        self.photons_of_turn() * self.stages
    }

    /// The key of all photons, by what each turn was sent in.
    fn key(&self, turns: &[u64]) -> u64 {
        hash_of(&(self.identity, turns))
    }
}

/// Declares the passes that send what has to be sent.
pub(super) fn keep(cx: &mut FrameCx<'_, '_>, scene: &TracedScene, options: &PointOptions) -> KeptPhotons {
    let (frame, photons) = (cx.frame, sent(options).max(1));
    let graph = &mut *cx.graph;
    let (frames, stages) = (options.frames.min(photons), options.bounces.max(1));
    let place = frame.data.origin.to_array().map(f64::to_bits);
    let identity = hash_of(&(frame.data.identity, place, photons, frames, stages));
    let turns = Turns { photons, frames, stages, identity };
    let views = views::specular_views(graph, frame, PIECE);
    let choice = choose::choose(graph, frame.set, &turns.sending(0), &views, photons);
    let content = hash_of(&(graph.key_of(choice.choice), graph.key_of(choice.blocks), scene.surfaces_key()));
    let wanted: Vec<u64> = (0..frames).map(|turn| hash_of(&(identity, content, turn))).collect();

    let kept = KeptPhotons {
        photons: graph.carried_buffer("points.photons", KEPT_TEXELS * (turns.capacity() * frames) as usize),
        count: turns.capacity() * frames,
    };
    // Of each turn, how many of its photons were no numbers; its key says in what the turn was sent.
    let dropped: Vec<BufferRef<u32>> =
        (0..frames).map(|turn| graph.carried_buffer(&format!("points.dropped.{turn}"), 1)).collect();
    let held: Option<Vec<u64>> = dropped.iter().map(|dropped| graph.held_key(*dropped)).collect();
    let held = held.filter(|held| graph.finds(kept.photons, turns.key(held)));
    let (mut sent_in, now) = due(held, &wanted, frame.time.index);
    let starts = now.len() == wanted.len();
    if !starts {
        graph.carry_on(kept.photons, turns.key(&sent_in));
    }
    let rays_of_scene = scene.rays(graph);
    let ways = Ways {
        views: &views,
        choice: &choice,
        arrivals: Arrivals::declare(graph, turns.photons_of_turn()),
        rays: PhotonRays::declare(graph, 0, turns.photons_of_turn()),
        landed: LandedPhotons::declare(graph, choice.counts, stages as usize, turns.capacity()),
        scene: Some((scene, &rays_of_scene)),
    };
    for turn in now {
        let index = turn as usize;
        sent_in[index] = wanted[index];
        let sending = turns.sending(turn);
        graph.fill_buffer(&sending.pass("trace/clear"), dropped[index], 0);
        send(graph, frame, &sending, &ways, |graph, rays| {
            bvh::trace(graph, frame.data, &sending, (scene, &rays_of_scene), (rays, choice.counts));
        });
        let pass = Keep {
            landed: ways.landed.photons.texels(RECORDS),
            ellipses: ways.landed.ellipses.texels(FLOATS),
            counts: choice.counts.texels(WORDS),
            photons: if starts && turn == 0 { kept.photons.start() } else { kept.photons.modify() },
            dropped: dropped[index].read_write(),
            push: KeepPush { landed_stage: stages, first: turn * turns.capacity(), capacity: turns.capacity() },
        };
        let pass = graph.pass(&sending.pass("trace/keep"), pass);
        let pass = pass.leaves(kept.photons, turns.key(&sent_in)).leaves(dropped[index], wanted[index]);
        pass.count("dropped", dropped[index], 0).threads([turns.capacity(), 1, 1]);
    }
    kept
}

/// In what each turn was sent before this frame, and the turns to be declared: all of them at a start and, so that the table says so, where all stand; else one
/// that does not.
fn due(held: Option<Vec<u64>>, wanted: &[u64], frame: u32) -> (Vec<u64>, Vec<u32>) {
    let all = (0..wanted.len() as u32).collect();
    let Some(held) = held else { return (vec![0; wanted.len()], all) };
    let count = wanted.len();
    let stale = |turn: &usize| held[*turn] != wanted[*turn];
    let from = frame as usize % count;
    match (0..count).map(|step| (from + step) % count).find(stale) {
        Some(turn) => (held, vec![turn as u32]),
        None => (vec![0; count], all),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::{Options, Preset};

    /// At the ends of the options' ranges, and between.
    #[test]
    fn no_buffer_is_too_large() {
        for photons in [0, 1, 999, 699_050, 1 << 20] {
            for frames in [1, 3, 8, 64] {
                for bounces in [0, 1, 2, 4, 5, 16] {
                    let asked = PointOptions { photons, frames, bounces, ..PointOptions::preset(Preset::Default) };
                    let sent = sent(&asked);
                    assert!(sent <= photons && (sent > 0) == (photons > 0), "{sent} of {photons}");
                    let frames = frames.min(sent.max(1));
                    let places = sent.max(1).div_ceil(frames) * frames * bounces.max(1);
                    assert!(places * PLACE_BYTES <= LARGEST_BUFFER, "{photons}, {frames}, {bounces}: {places} places");
                }
            }
        }
    }
}
