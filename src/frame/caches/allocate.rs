//! Light caches at the nodes of grids around the eye, where surfaces that it sees ask for them (Reich 2015, sections 4.2 and 4.5.3).

use ash::vk;
use glam::{DVec3, Vec3};

use super::cascades::CascadeRule;
use super::settings::PlaceRule;
use crate::frame::inputs::FrameInputs;
use crate::frame::mirrored::MirroredPoints;
use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph};
use crate::shaders::caches::{
    Allocate, AllocatePush, Ask, AskMirrored, AskMirroredPush, AskPush, Look, LookPush, Move, MovePush, Settle,
    SettlePush,
};
use crate::shaders::groups::LightCaches;
use crate::shaders::types;

const WORD: vk::Format = vk::Format::R32_UINT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Caches, and what pixels ask for, that memory is held for at first.
const LEAST: usize = 8192;
const LEAST_ASKS: usize = 32768;
/// Of a cache's horizons (glsl/caches/horizons.glsl).
const HORIZON_WORDS: usize = 6 * 8;
/// Ways along the axes (glsl/caches/moves.glsl).
const WAYS: usize = 6;
/// How often caches move: two planes at a right angle, however they stand, take two.
const ROUNDS: u32 = 2;

/// The caches of a frame.
pub(crate) struct Caches {
    pub(crate) group: LightCaches,
    /// Words 0 to 2: work groups of eight caches; word 3: how many there are.
    pub(crate) head: BufferRef<u32>,
    /// Their addresses (glsl/caches/cascades.glsl), and what these are among.
    pub(crate) nodes: BufferRef<u32>,
    pub(crate) cascades: types::Cascades,
    /// Where they lie, in render space.
    pub(crate) positions: BufferRef<[f32; 4]>,
    /// How many there is room for.
    pub(crate) capacity: u32,
}

/// A list that passes append to. Words 0 to 2 of its head are the work groups that take it; word 3 counts what it ought to hold.
struct List<T> {
    items: BufferRef<T>,
    head: BufferRef<u32>,
}

impl<T> List<T> {
    fn declare(graph: &mut Graph<'_>, name: &str, least: usize) -> List<T> {
        let items = graph.growing_buffer(&format!("caches.{name}"), least);
        let head = graph.buffer(&format!("caches.{name}.head"), 4);
        graph.fill_buffer(&format!("caches/places/clear-{name}"), head, 0);
        List { items, head }
    }

    fn capacity(&self) -> u32 {
        self.items.count() as u32
    }
}

/// Declares the passes; what mirrors show has caches too, if somebody listed it.
pub(crate) fn allocate(graph: &mut Graph<'_>, frame: &FrameInputs<'_>, places: &PlaceRule) -> Caches {
    let rule = &places.cascades;
    let (surface, data) = (frame.surface, frame.data);
    let eye: DVec3 = Vec3::from(frame.camera.position_rs).as_dvec3();
    let cascades = rule.around(eye, data.middle_rs, data.radius, data.reach);
    let asks = List::<types::Ask>::declare(graph, "asks", LEAST_ASKS);
    let pass = Ask {
        surface: surface.group.clone(),
        asks: asks.items.start(),
        head: asks.head.read_write(),
        push: AskPush { cascades, capacity: asks.capacity() },
    };
    graph.pass("caches/places/ask", pass).unordered().count("asks", asks.head, 3).pixels(surface.size);
    if let (Some(points), Some(traced)) = (frame.offers.get::<MirroredPoints>(), frame.traced) {
        let shift = (data.origin - traced.origin).as_vec3().to_array();
        for (number, list) in points.lists.iter().enumerate() {
            let pass = AskMirrored {
                mirrored: list.group(),
                asks: asks.items.modify(),
                head: asks.head.read_write(),
                push: AskMirroredPush { cascades, shift, capacity: asks.capacity() },
            };
            let pass = graph.pass(&format!("caches/places/ask-mirrored.{number}"), pass).unordered();
            pass.threads_indirect(list.arguments, 0);
        }
    }
    graph.grows(asks.items, asks.head, 3);

    let addresses = graph.buffer::<u32>("caches.addresses", rule.count as usize * (rule.resolution as usize).pow(3));
    graph.fill_buffer("caches/places/clear-addresses", addresses, 0);
    let nodes = List::<u32>::declare(graph, "nodes", LEAST);
    let pass = Allocate {
        asks: asks.items.read(),
        ask_head: asks.head.texels(WORD),
        addresses: addresses.read_write(),
        head: nodes.head.read_write(),
        nodes: nodes.items.start(),
        push: AllocatePush {
            resolution: cascades.resolution,
            ask_capacity: asks.capacity(),
            capacity: nodes.capacity(),
        },
    };
    let pass = graph.pass("caches/places/allocate", pass).unordered();
    pass.count("caches", nodes.head, 3).threads_indirect(asks.head, 0);
    graph.grows(nodes.items, nodes.head, 3);
    let positions = positions(graph, &cascades, (&asks, &nodes), addresses, places);
    let group = LightCaches {
        cascades: graph.upload("caches.cascades", &[cascades], Dependence::CAMERA).uniform(),
        cache_head: nodes.head.texels(WORD),
        cache_positions: positions.texels(FLOATS),
        cache_addresses: addresses.texels(WORD),
        cache_horizons: horizons(graph, rule, (&asks, &nodes), addresses, positions).texels(WORDS),
    };
    Caches { group, head: nodes.head, nodes: nodes.items, cascades, positions, capacity: nodes.capacity() }
}

/// What the surfaces that ask for each cache have in front of them.
fn horizons(
    graph: &mut Graph<'_>,
    rule: &CascadeRule,
    (asks, nodes): (&List<types::Ask>, &List<u32>),
    addresses: BufferRef<u32>,
    positions: BufferRef<[f32; 4]>,
) -> BufferRef<u32> {
    let capacity = nodes.capacity();
    let horizons = graph.buffer::<u32>("caches.horizons", HORIZON_WORDS * capacity as usize);
    graph.fill_buffer("caches/places/clear-horizons", horizons, 0);
    let pass = Look {
        asks: asks.items.read(),
        ask_head: asks.head.texels(WORD),
        addresses: addresses.texels(WORD),
        positions: positions.texels(FLOATS),
        horizons: horizons.read_write(),
        push: LookPush { resolution: rule.resolution.cast_signed(), ask_capacity: asks.capacity(), capacity },
    };
    graph.pass("caches/places/look", pass).unordered().threads_indirect(asks.head, 0);
    horizons
}

/// Where the caches lie.
fn positions(
    graph: &mut Graph<'_>,
    cascades: &types::Cascades,
    (asks, nodes): (&List<types::Ask>, &List<u32>),
    addresses: BufferRef<u32>,
    rule: &PlaceRule,
) -> BufferRef<[f32; 4]> {
    let capacity = nodes.capacity();
    let ways = graph.buffer::<u32>("caches.moves", WAYS * capacity as usize);
    graph.fill_buffer("caches/places/clear-moves", ways, 0);
    let positions = graph.buffer::<[f32; 4]>("caches.positions", capacity as usize);
    for round in 0..=if rule.moves { ROUNDS } else { 0 } {
        if round > 0 {
            let pass = Move {
                asks: asks.items.read(),
                ask_head: asks.head.texels(WORD),
                addresses: addresses.texels(WORD),
                positions: positions.texels(FLOATS),
                moves: ways.read_write(),
                push: MovePush { cascades: *cascades, ask_capacity: asks.capacity(), capacity },
            };
            graph.pass(&format!("caches/places/move.{round}"), pass).unordered().threads_indirect(asks.head, 0);
        }
        let pass = Settle {
            head: nodes.head.texels(WORD),
            nodes: nodes.items.texels(WORD),
            moves: ways.read_write(),
            positions: if round == 0 { positions.start_then_read() } else { positions.read_write() },
            push: SettlePush { cascades: *cascades, capacity, moves_on: u32::from(round > 0), jitter: rule.jitter },
        };
        graph.pass(&format!("caches/places/settle.{round}"), pass).threads([capacity, 1, 1]);
    }
    positions
}
