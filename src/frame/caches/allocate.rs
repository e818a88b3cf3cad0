//! Light caches at the nodes of grids around the eye, where surfaces that it sees ask for them (Reich 2015, sections 4.2 and 4.5.3).

use ash::vk;
use glam::{DVec3, Vec3};

use super::cascades::CascadeRule;
use crate::frame::inputs::FrameInputs;
use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph};
use crate::shaders::caches::{Allocate, AllocatePush, Move, MovePush, Settle, SettlePush};
use crate::shaders::groups::LightCaches;

const WORD: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Caches that memory is held for at first.
const LEAST: usize = 2048;
/// Ways along the axes (glsl/caches/moves.glsl).
const WAYS: usize = 6;
/// How often caches move: two planes at a right angle, however they stand, take two.
const ROUNDS: u32 = 2;

/// The caches of a frame.
pub(crate) struct Caches {
    pub(crate) group: LightCaches,
    /// Words 0 to 2: work groups of one cache each; word 3: how many there are.
    pub(crate) head: BufferRef<u32>,
    /// How many there is room for.
    pub(crate) capacity: u32,
}

/// Declares the passes. `moves`: caches behind surfaces move before them.
pub(crate) fn allocate(graph: &mut Graph<'_>, frame: &FrameInputs<'_>, rule: &CascadeRule, moves: bool) -> Caches {
    let (surface, data) = (frame.surface, frame.data);
    let eye: DVec3 = Vec3::from(frame.camera.position_rs).as_dvec3();
    let cascades = rule.around(eye, data.middle_rs, data.radius, data.reach);
    let node_count = rule.count as usize * (rule.resolution as usize).pow(3);
    let addresses = graph.buffer::<u32>("caches.addresses", node_count);
    graph.fill_buffer("caches/places/clear", addresses, 0);
    let head = graph.buffer::<u32>("caches.head", 4);
    graph.fill_buffer("caches/places/clear-head", head, 0);
    let nodes = graph.growing_buffer::<u32>("caches.nodes", LEAST);
    let capacity = nodes.count() as u32;
    let pass = Allocate {
        surface: surface.group.clone(),
        addresses: addresses.read_write(),
        head: head.read_write(),
        nodes: nodes.start(),
        push: AllocatePush { cascades, capacity },
    };
    graph.pass("caches/places/allocate", pass).unordered().count("caches", head, 3).pixels(surface.size);
    graph.grows(nodes, head, 3);

    let ways = graph.buffer::<u32>("caches.moves", WAYS * nodes.count());
    graph.fill_buffer("caches/places/clear-moves", ways, 0);
    let positions = graph.buffer::<[f32; 4]>("caches.positions", nodes.count());
    for round in 0..=if moves { ROUNDS } else { 0 } {
        if round > 0 {
            let pass = Move {
                surface: surface.group.clone(),
                addresses: addresses.texels(WORD),
                positions: positions.texels(FLOATS),
                moves: ways.read_write(),
                push: MovePush { cascades, capacity },
            };
            graph.pass(&format!("caches/places/move.{round}"), pass).unordered().pixels(surface.size);
        }
        let pass = Settle {
            head: head.texels(WORD),
            nodes: nodes.texels(WORD),
            moves: ways.read_write(),
            positions: if round == 0 { positions.start_then_read() } else { positions.read_write() },
            push: SettlePush { cascades, capacity, moves_on: u32::from(round > 0) },
        };
        graph.pass(&format!("caches/places/settle.{round}"), pass).threads([capacity, 1, 1]);
    }
    let group = LightCaches {
        cascades: graph.upload("caches.cascades", &[cascades], Dependence::CAMERA).uniform(),
        cache_head: head.texels(WORD),
        cache_positions: positions.texels(FLOATS),
        cache_addresses: addresses.texels(WORD),
    };
    Caches { group, head, capacity }
}
