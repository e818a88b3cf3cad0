//! The pass graph's compute features: several writers, mip levels, transfers, indirect dispatch, counters, skipping,
//! recovery from a failed frame.

use ash::vk;

use super::session::Session;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{ClearColor, Dependence, Graph, Store};
use crate::renderer::{PassTiming, Timing};
use crate::shaders::selftest::{Append, AppendPush, Arguments, ArgumentsPush, Count, Halve, Ramp, RampPush};
use crate::vulkan::ImageInfo;

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    words(bytes).into_iter().map(f32::from_bits).collect()
}

fn row<'t>(passes: &'t [PassTiming], name: &str) -> &'t PassTiming {
    passes.iter().find(|pass| pass.full_name() == name).expect("a pass of this name")
}

fn write_arguments(graph: &mut Graph<'_>, arguments: BufferRef<u32>, first: u32, groups: [u32; 3]) {
    let [x, y, z] = groups;
    let push = ArgumentsPush { words: [x, y, z, 0], first };
    let name = format!("test/arguments-{first}");
    graph.pass(&name, Arguments { arguments: arguments.read_write(), push }).threads([1, 1, 1]);
}

#[test]
fn an_indirect_dispatch_does_what_a_buffer_says() {
    let session = Session::open();
    let mut store = session.store();
    for (groups, expected) in [([5, 2, 1], 640), ([0, 7, 1], 0), ([1, 1, 3], 192)] {
        let mut graph = Graph::new(&mut store);
        let arguments = graph.buffer::<u32>("arguments", 8);
        let counters = graph.buffer::<u32>("counters", 1);
        graph.fill_buffer("test/clear-arguments", arguments, 99);
        write_arguments(&mut graph, arguments, 2, groups);
        graph.fill_buffer("test/clear-counters", counters, 0);
        graph
            .pass("test/count", Count { counters: counters.read_write() })
            .count("counted", counters, 0)
            .threads_indirect(arguments, 2);
        let read_back = graph.read_back_buffer(counters);
        let mut executed = graph.run(Timing::Passes).expect("a frame");
        assert_eq!(words(&executed.take(read_back)), [expected], "{groups:?} groups");
        let work = &row(&executed.passes, "test/count").work;
        assert_eq!((work["invocations"], work["counted"]), (u64::from(expected), u64::from(expected)));
    }
}

#[test]
fn the_place_of_indirect_arguments_decides_about_the_result() {
    let session = Session::open();
    let mut store = session.store();
    let mut run = |index: usize| {
        let mut graph = Graph::new(&mut store);
        let arguments = graph.upload("arguments", &[1_u32, 1, 1, 2, 1, 1], Dependence::NONE);
        let counters = graph.buffer::<u32>("counters", 1);
        graph.fill_buffer("test/clear", counters, 0);
        graph.pass("test/count", Count { counters: counters.read_write() }).threads_indirect(arguments, index);
        let read_back = graph.read_back_buffer(counters);
        let mut executed = graph.run(Timing::Frame).expect("a frame");
        words(&executed.take(read_back))[0]
    };
    assert_eq!((run(0), run(3), run(0)), (64, 128, 64));
}

#[test]
fn transfers_fill_every_word_and_texel() {
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let buffer = graph.buffer::<[u32; 3]>("buffer", 11);
    let heads = graph.image("heads", vk::Format::R32_UINT, [7, 5]);
    let color = graph.image("color", vk::Format::R32G32B32A32_SFLOAT, [3, 9]);
    graph.fill_buffer("test/fill", buffer, 0xdead_beef);
    graph.clear_image("test/heads", heads, ClearColor::Uint([u32::MAX; 4]));
    graph.clear_image("test/color", color, ClearColor::Float([1.5, -2.0, 1e30, 0.0]));
    let read_backs = [graph.read_back_buffer(buffer), graph.read_back(heads), graph.read_back(color)];
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    let [buffer, heads, color] = read_backs.map(|read_back| executed.take(read_back));
    assert_eq!(words(&buffer), [0xdead_beef; 33]);
    assert_eq!(words(&heads), [u32::MAX; 35]);
    assert_eq!(floats(&color), [1.5, -2.0, 1e30, 0.0].repeat(27));
}

fn append(graph: &mut Graph<'_>, image: ImageRef, name: &str, digit: u32) {
    graph.pass(name, Append { image: image.read_write(), push: AppendPush { digit } }).threads([32, 32, 1]);
}

/// One digit a pass; the last two are given. Returns the image's only value and the passes that ran.
fn digits(store: &mut Store, last: [u32; 2]) -> (u32, usize) {
    let mut graph = Graph::new(store);
    let image = graph.image("chain", vk::Format::R32_UINT, [32, 32]);
    graph.clear_image("chain/clear", image, ClearColor::Uint([7, 0, 0, 0]));
    for digit in 1..=4 {
        append(&mut graph, image, &format!("chain/append-{digit}"), digit);
    }
    append(&mut graph, image, "chain/append-5", last[0]);
    append(&mut graph, image, "chain/append-6", last[1]);
    let read_back = graph.read_back(image);
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    let values = words(&executed.take(read_back));
    assert!(values.iter().all(|&value| value == values[0]), "a writer overtook another: {values:?}");
    (values[0], executed.passes.iter().filter(|pass| pass.skipped.is_none()).count())
}

#[test]
fn writers_of_one_image_follow_each_other() {
    let session = Session::open();
    let mut store = session.store();
    assert_eq!(digits(&mut store, [5, 6]), (7_123_456, 7));
    assert_eq!(digits(&mut store, [5, 6]), (7_123_456, 0), "nothing changed");
    assert_eq!(digits(&mut store, [5, 8]), (7_123_458, 7), "the version before the last writer is gone");
    store.invalidate();
    assert_eq!(digits(&mut store, [9, 8]), (7_123_498, 7));
}

fn sum_of_four(level: &[f32], size: u32) -> Vec<f32> {
    let texel = |x: u32, y: u32| if x < size && y < size { level[(y * size + x) as usize] } else { 0.0 };
    let half = (size / 2).max(1);
    let sum = |x: u32, y: u32| {
        texel(2 * x, 2 * y) + texel(2 * x + 1, 2 * y) + texel(2 * x, 2 * y + 1) + texel(2 * x + 1, 2 * y + 1)
    };
    (0..half * half).map(|index| sum(index % half, index / half)).collect()
}

#[test]
fn a_pyramid_is_built_level_by_level_in_one_image() {
    const LEVELS: u32 = 6;
    let session = Session::open();
    let mut store = session.store();
    for offset in [0.0, 3.0] {
        let mut graph = Graph::new(&mut store);
        let info =
            ImageInfo { format: vk::Format::R32_SFLOAT, extent: [32, 32, 1], mips: LEVELS, layers: 1, volume: false };
        let pyramid = graph.image_with("pyramid", info);
        let ramp = Ramp { image: pyramid.mip(0).write(), push: RampPush { offset } };
        graph.pass("pyramid/level-0", ramp).threads([32, 32, 1]);
        for level in 1..LEVELS {
            let halve = Halve { finer: pyramid.mip(level - 1).sampled(), coarser: pyramid.mip(level).write() };
            let side = 32 >> level;
            graph.pass(&format!("pyramid/level-{level}"), halve).threads([side, side, 1]);
        }
        let read_backs: Vec<_> = (0..LEVELS).map(|level| graph.read_back(pyramid.mip(level))).collect();
        let mut executed = graph.run(Timing::Passes).expect("a frame");
        let mut expected: Vec<f32> = (0..1024_u16).map(|index| f32::from(index) + offset).collect();
        for (level, read_back) in (0..LEVELS).zip(read_backs) {
            assert_eq!(floats(&executed.take(read_back)), expected, "level {level}");
            expected = sum_of_four(&expected, 32 >> level);
        }
    }
}

/// The sum of an image of ones, 8x8 at most, into one texel.
fn sum_of_ones(store: &mut Store, size: u32) -> f32 {
    let mut graph = Graph::new(store);
    let ones = graph.image("ones", vk::Format::R32_SFLOAT, [size; 2]);
    let sums = graph.image("sums", vk::Format::R32_SFLOAT, [4; 2]);
    graph.clear_image("size/ones", ones, ClearColor::Float([1.0; 4]));
    graph.pass("size/sums", Halve { finer: ones.sampled(), coarser: sums.write() }).threads([4, 4, 1]);
    let read_back = graph.read_back(sums);
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    floats(&executed.take(read_back)).iter().sum()
}

#[test]
fn what_was_made_of_an_image_of_another_size_does_not_stand() {
    let session = Session::open();
    let mut store = session.store();
    assert_eq!(sum_of_ones(&mut store, 8), 64.0);
    assert_eq!(sum_of_ones(&mut store, 5), 25.0);
    assert_eq!(sum_of_ones(&mut store, 8), 64.0);
}

#[test]
fn memory_of_names_that_are_no_longer_declared_is_returned() {
    let session = Session::open();
    let mut store = session.store();
    sum_of_ones(&mut store, 8);
    assert!(store.memory_by_piece().contains_key("size"), "{:?}", store.memory_by_piece());
    digits(&mut store, [5, 6]);
    assert!(!store.memory_by_piece().contains_key("size"), "{:?}", store.memory_by_piece());
    assert!(store.memory_by_piece()["chain"] >= 32 * 32 * 4);
}

#[test]
fn a_frame_that_fails_leaves_the_next_one_sound() {
    let session = Session::open();
    let mut store = session.store();
    digits(&mut store, [5, 6]);
    let mut graph = Graph::new(&mut store);
    let image = graph.image("chain", vk::Format::R32_UINT, [32, 32]);
    let ramp = graph.image("ramp", vk::Format::R32_SFLOAT, [4, 4]);
    graph.clear_image("chain/clear", image, ClearColor::Uint([0; 4]));
    append(&mut graph, image, "chain/append", 1);
    graph.pass("ramp/huge", Ramp { image: ramp.write(), push: RampPush { offset: 0.0 } }).groups([u32::MAX, 1, 1]);
    graph.want(image);
    graph.want(ramp);
    let error = graph.run(Timing::Frame).err().expect("too many groups").to_string();
    assert!(error.contains("ramp/huge") && error.contains("limit"), "{error}");
    assert_eq!(digits(&mut store, [5, 6]), (7_123_456, 7));
}

#[test]
fn buffers_grow_up_to_what_the_device_allows() {
    let session = Session::open();
    let mut store = session.store();
    let most = store.device().limits().max_storage_buffer_range / 4;
    let mut run = |needed: u32| {
        let mut graph = Graph::new(&mut store);
        let pool = graph.growing_buffer::<u32>("pool", 16);
        let count = graph.buffer::<u32>("count", 1);
        graph.fill_buffer("test/count", count, needed);
        graph.grows(pool, count, 0);
        (pool.count(), graph.run(Timing::Frame).map(|executed| executed.outgrown))
    };
    let failure = run(most + 1).1.expect_err("more than the device allows").to_string();
    assert!(failure.starts_with("pool is larger than the device allows"), "{failure}");
    let (count, outgrown) = run(most - 1);
    assert_eq!((count, outgrown.expect("a frame")), (16, vec![("pool".to_owned(), [16, most as usize - 1])]));
    let (count, outgrown) = run(most - 1);
    assert_eq!((count, outgrown.expect("a frame")), (most as usize, vec![]));
}
