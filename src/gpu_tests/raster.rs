//! The pass graph's raster features: stencil, passes without attachments, indirect draws.

use ash::vk;

use super::session::Session;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{ClearColor, Graph, Store};
use crate::renderer::Timing;
use crate::shaders::selftest::{
    Arguments, ArgumentsPush, Ground, GroundPush, Mark, MarkPush, Ramp, RampPush, Splat, SplatPush,
};
use crate::vulkan::{DepthState, RasterState, StencilState};

const SIZE: [u32; 2] = [24, 17];

fn state(stencil: Option<StencilState>) -> RasterState {
    RasterState { topology: vk::PrimitiveTopology::TRIANGLE_LIST, stencil, ..RasterState::default() }
}

fn marking(reference: u32) -> RasterState {
    state(Some(StencilState { compare: vk::CompareOp::ALWAYS, pass: vk::StencilOp::REPLACE, reference }))
}

fn testing(reference: u32) -> RasterState {
    state(Some(StencilState { compare: vk::CompareOp::EQUAL, pass: vk::StencilOp::KEEP, reference }))
}

fn rectangle(low: [f32; 2], high: [f32; 2]) -> Mark {
    Mark { push: MarkPush { low, high } }
}

fn splat(depth: ImageRef, hits: BufferRef<u32>) -> Splat {
    Splat { depth: depth.sampled(), hits: hits.read_write(), push: SplatPush { width: SIZE[0] } }
}

/// An image that reads 0 everywhere, and a cleared word a pixel.
fn canvas(graph: &mut Graph<'_>) -> (ImageRef, BufferRef<u32>) {
    let black = graph.image("black", vk::Format::R32_SFLOAT, SIZE);
    let hits = graph.buffer::<u32>("hits", (SIZE[0] * SIZE[1]) as usize);
    graph.clear_image("canvas/black", black, ClearColor::Float([0.0; 4]));
    graph.fill_buffer("canvas/hits", hits, 0);
    (black, hits)
}

fn run(graph: Graph<'_>, hits: BufferRef<u32>) -> Vec<u32> {
    let mut graph = graph;
    let read_back = graph.read_back_buffer(hits);
    let mut executed = graph.run(Timing::Passes).expect("a frame");
    executed.take(read_back).chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

fn expect(hits: &[u32], expected: impl Fn(u32, u32) -> u32) {
    for (index, &found) in (0..).zip(hits) {
        let (x, y) = (index % SIZE[0], index / SIZE[0]);
        assert_eq!(found, expected(x, y), "pixel {x}, {y}");
    }
}

fn inside(x: u32, y: u32, low: [u32; 2], high: [u32; 2]) -> bool {
    (low[0]..high[0]).contains(&x) && (low[1]..high[1]).contains(&y)
}

#[test]
fn stencil_marks_of_one_pass_restrict_another() {
    let session = Session::open();
    for format in [vk::Format::S8_UINT, vk::Format::D32_SFLOAT_S8_UINT] {
        let mut store = session.store();
        let mut graph = Graph::new(&mut store);
        let (black, hits) = canvas(&mut graph);
        let stencil = graph.image("stencil", format, SIZE);
        graph
            .raster("stencil/first", rectangle([2.0, 3.0], [9.0, 12.0]), marking(1))
            .stencil(stencil, Some(0))
            .vertices(3, 1);
        graph
            .raster("stencil/second", rectangle([5.0, 5.0], [20.0, 8.0]), marking(2))
            .stencil(stencil, None)
            .vertices(3, 1);
        graph.raster("stencil/ones", splat(black, hits), testing(1)).stencil(stencil, None).vertices(3, 1);
        graph.raster("stencil/twos", splat(black, hits), testing(2)).stencil(stencil, None).vertices(3, 5);
        expect(&run(graph, hits), |x, y| match () {
            () if inside(x, y, [5, 5], [20, 8]) => 5,
            () if inside(x, y, [2, 3], [9, 12]) => 1,
            () => 0,
        });
    }
}

const DEPTH_WRITTEN: Option<DepthState> = Some(DepthState { compare: vk::CompareOp::ALWAYS, write: true });

/// Passes on one image of depth and stencil, and the hits that they leave.
fn on_one_image(draw: impl FnOnce(&mut Graph<'_>, ImageRef, BufferRef<u32>), expected: impl Fn(u32, u32) -> u32) {
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let (_, hits) = canvas(&mut graph);
    let image = graph.image("depth", vk::Format::D32_SFLOAT_S8_UINT, SIZE);
    draw(&mut graph, image, hits);
    expect(&run(graph, hits), expected);
}

/// Depth and stencil of one image: depth is drawn first, the stencil marked with it attached, then both are used
/// while depth is sampled.
#[test]
fn a_pass_tests_the_stencil_and_samples_depth_of_one_image() {
    let draw = |graph: &mut Graph<'_>, image: ImageRef, hits: BufferRef<u32>| {
        // 0.5 inside the rectangle, 0.75 elsewhere.
        let drawn = RasterState { depth: DEPTH_WRITTEN, ..state(None) };
        graph.raster("both/depth", rectangle([4.0, 0.0], [24.0, 9.0]), drawn).depth(image, Some(0.75)).vertices(3, 1);
        graph.raster("both/clear", rectangle([0.0; 2], [0.0; 2]), marking(0)).stencil(image, Some(3)).vertices(3, 1);
        let greater = Some(DepthState { compare: vk::CompareOp::GREATER_OR_EQUAL, write: false });
        // The triangle's depth of 0.5 passes where the image holds 0.5.
        graph
            .raster("both/mark", rectangle([0.0; 2], [12.0, 17.0]), RasterState { depth: greater, ..marking(1) })
            .depth(image, None)
            .stencil(image, None)
            .vertices(3, 1);
        graph.raster("both/ones", splat(image, hits), testing(1)).stencil(image, None).vertices(3, 1);
        graph.raster("both/threes", splat(image, hits), testing(3)).stencil(image, None).vertices(3, 2);
    };
    on_one_image(draw, |x, y| match () {
        () if inside(x, y, [4, 0], [12, 9]) => 1,
        () if inside(x, y, [4, 0], [24, 9]) => 2,
        () => 202,
    });
}

#[test]
fn depth_and_stencil_cleared_by_one_pass_serve_two_others() {
    let draw = |graph: &mut Graph<'_>, image: ImageRef, hits: BufferRef<u32>| {
        let drawn = RasterState { depth: DEPTH_WRITTEN, ..marking(9) };
        graph
            .raster("clear/both", rectangle([3.0, 3.0], [6.0, 6.0]), drawn)
            .depth(image, Some(1.0))
            .stencil(image, Some(4))
            .vertices(3, 1);
        graph.raster("clear/fours", splat(image, hits), testing(4)).stencil(image, None).vertices(3, 1);
        graph.raster("clear/nines", splat(image, hits), testing(9)).stencil(image, None).vertices(3, 3);
    };
    on_one_image(draw, |x, y| if inside(x, y, [3, 3], [6, 6]) { 3 } else { 101 });
}

fn hits_of_area(store: &mut Store, area: [u32; 2]) -> Vec<u32> {
    let mut graph = Graph::new(store);
    let (black, hits) = canvas(&mut graph);
    graph.raster("area/splat", splat(black, hits), state(None)).area(area).vertices(3, 2);
    run(graph, hits)
}

#[test]
fn a_pass_without_attachments_covers_its_area() {
    let session = Session::open();
    let mut store = session.store();
    for area in [SIZE, [10, 6], [10, 7]] {
        expect(&hits_of_area(&mut store, area), |x, y| if inside(x, y, [0; 2], area) { 2 } else { 0 });
    }
}

/// A ground on which one stands fills all below the horizon, which its corners lie next to: on one line, to the sub-pixels of a small picture.
#[test]
fn a_large_triangle_is_drawn_although_its_corners_lie_on_the_horizon() {
    let session = Session::open();
    let mut store = session.store();
    for (reach, side) in [1e2, 1e4, 1e6].into_iter().flat_map(|reach| [(reach, 1.0), (reach, -1.0)]) {
        let mut graph = Graph::new(&mut store);
        let (_, hits) = canvas(&mut graph);
        let ground = Ground { hits: hits.read_write(), push: GroundPush { reach, side, width: SIZE[0] } };
        graph.raster("ground/draw", ground, state(None)).area(SIZE).vertices(3, 1);
        let found = run(graph, hits);
        let drawn = found.iter().filter(|&&count| count > 0).count();
        println!("{reach} m, {side}: {drawn} pixels");
        // The middle row shows the horizon itself.
        let horizon = SIZE[1] / 2;
        for (index, &count) in (0..).zip(&found).filter(|(index, _)| index / SIZE[0] != horizon) {
            let expected = u32::from(index / SIZE[0] > horizon);
            assert_eq!(
                count,
                expected,
                "pixel {}, {} on {reach} m: {drawn} are drawn",
                index % SIZE[0],
                index / SIZE[0]
            );
        }
    }
}

fn write_draw(graph: &mut Graph<'_>, arguments: BufferRef<u32>, number: u32, instances: u32) {
    let push = ArgumentsPush { words: [3, instances, 0, 0], first: 4 * number };
    let name = format!("indirect/arguments-{number}");
    graph.pass(&name, Arguments { arguments: arguments.read_write(), push }).threads([1, 1, 1]);
}

#[test]
fn indirect_draws_do_what_a_buffer_says() {
    let session = Session::open();
    let mut store = session.store();
    for (first, count, expected) in [(0, 1, 4), (0, 3, 14), (2, 1, 10), (1, 1, 0)] {
        let mut graph = Graph::new(&mut store);
        let (black, hits) = canvas(&mut graph);
        let arguments = graph.buffer::<u32>("arguments", 12);
        graph.fill_buffer("indirect/clear", arguments, 0);
        for (number, instances) in [(0, 4), (1, 0), (2, 10)] {
            write_draw(&mut graph, arguments, number, instances);
        }
        graph.raster("indirect/splat", splat(black, hits), state(None)).area(SIZE).draw_indirect(
            arguments,
            4 * first,
            count,
        );
        expect(&run(graph, hits), |_, _| expected);
    }
}

/// A storage image, sampled by a fragment shader, that the next frame's compute pass overwrites.
#[test]
fn compute_and_raster_take_turns_on_one_image() {
    let session = Session::open();
    let mut store = session.store();
    for offset in [-200.0, -60.0] {
        let mut graph = Graph::new(&mut store);
        let hits = graph.buffer::<u32>("hits", (SIZE[0] * SIZE[1]) as usize);
        graph.fill_buffer("turns/hits", hits, 0);
        let image = graph.image("ramp", vk::Format::R32_SFLOAT, SIZE);
        for turn in 0..3_u8 {
            let ramp = Ramp { image: image.write(), push: RampPush { offset: offset - 100.0 * f32::from(turn) } };
            graph.pass(&format!("turns/ramp-{turn}"), ramp).threads([SIZE[0], SIZE[1], 1]);
            graph.raster(&format!("turns/splat-{turn}"), splat(image, hits), state(None)).area(SIZE).vertices(3, 1);
        }
        expect(&run(graph, hits), |x, y| {
            let value = |turn: u32| offset + (x + y * SIZE[0]) as f32 - 100.0 * turn as f32;
            (0..3).map(|turn| if value(turn) > 0.5 { 101 } else { 1 }).sum()
        });
    }
}
