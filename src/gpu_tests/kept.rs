//! What outlasts frames: histories and states grow a year older with each frame that made them, once, whatever else happens.

use ash::vk;

use super::session::Session;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::kept::Advance;
use crate::graph::{Graph, Store};
use crate::renderer::Timing;
use crate::shaders::selftest::{Append, AppendPush, Count, Ramp, RampPush, Step, StepPush};
use crate::vulkan::ImageInfo;

const INFO: ImageInfo =
    ImageInfo { format: vk::Format::R32_UINT, extent: [8, 8, 1], mips: 1, layers: 1, volume: false };

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

fn only(bytes: &[u8]) -> u32 {
    let words = words(bytes);
    assert!(words.iter().all(|&word| word == words[0]), "{words:?}");
    words[0]
}

fn step(graph: &mut Graph<'_>, last: ImageRef, next: ImageRef, step: u32) {
    let push = StepPush { step };
    graph.pass("test/step", Step { last: last.sampled(), next: next.write(), push }).threads([8, 8, 1]);
}

/// A frame that adds `by` to what the last one left: the sum, the age before, and whether the pass ran.
fn frame(store: &mut Store, by: u32, depends: u64, advance: Advance) -> (u32, u32, bool) {
    let mut graph = Graph::new(store);
    let history = graph.history_image("sum", INFO, depends, advance);
    step(&mut graph, history.last, history.next, by);
    let read_back = graph.read_back(history.next);
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    let ran = executed.passes.iter().any(|pass| pass.full_name() == "test/step" && pass.skipped.is_none());
    (only(&executed.take(read_back)), history.age, ran)
}

#[test]
fn a_history_starts_at_zero_and_advances_once_a_frame() {
    let session = Session::open();
    let mut store = session.store();
    let advance = Advance::EveryFrame;
    let sums: Vec<_> = [1, 1, 10, 10].into_iter().map(|by| frame(&mut store, by, 0, advance)).collect();
    assert_eq!(sums, [(1, 0, true), (2, 1, true), (12, 2, true), (22, 3, true)]);
    // Another camera, say: all that was about the old one is gone.
    assert_eq!(frame(&mut store, 5, 1, advance), (5, 0, true));
    assert_eq!(frame(&mut store, 5, 1, advance), (10, 1, true));
    store.reset_history();
    assert_eq!(frame(&mut store, 5, 1, advance), (5, 0, true));
    store.reset_history();
    assert_eq!(frame(&mut store, 5, 1, advance), (5, 0, true), "also right after the first frame");
    // Forgotten results are made again, of the same past.
    store.invalidate();
    assert_eq!(frame(&mut store, 5, 1, advance), (10, 1, true));
}

#[test]
fn a_history_that_advances_on_change_stands_still_without() {
    let session = Session::open();
    let mut store = session.store();
    let advance = Advance::OnChange;
    let sums: Vec<_> = [1, 1, 1, 10, 10, 1].into_iter().map(|by| frame(&mut store, by, 0, advance)).collect();
    let expected = [(1, 0, true), (1, 1, false), (1, 1, false), (11, 1, true), (11, 2, false), (12, 2, true)];
    assert_eq!(sums, expected);
}

#[test]
fn what_is_kept_outlasts_frames_that_do_not_declare_it() {
    let session = Session::open();
    let mut store = session.store();
    assert_eq!(frame(&mut store, 3, 0, Advance::EveryFrame).0, 3);
    let mut graph = Graph::new(&mut store);
    let ramp = graph.image("ramp", vk::Format::R32_SFLOAT, [4, 4]);
    graph.pass("test/ramp", Ramp { image: ramp.write(), push: RampPush { offset: 0.0 } }).threads([4, 4, 1]);
    graph.want(ramp);
    graph.run(Timing::Frame).expect("a frame");
    assert!(store.memory_by_piece()["history"] >= 2 * 8 * 8 * 4);
    assert_eq!(frame(&mut store, 4, 0, Advance::EveryFrame), (7, 1, true));
}

/// Each frame writes its digit behind those before, and asks for more of a buffer than the frame before.
fn digits(store: &mut Store, digit: u32, needed: u32) -> (u32, bool) {
    let mut graph = Graph::new(store);
    let pool = graph.growing_buffer::<u32>("pool", 16);
    let count = graph.buffer::<u32>("count", 1);
    graph.fill_buffer("test/count", count, needed);
    graph.grows(pool, count, 0);
    let (image, _) = graph.state_image("digits", INFO, 0, Advance::EveryFrame);
    let push = AppendPush { digit };
    graph.pass("test/append", Append { image: image.read_write(), push }).threads([8, 8, 1]);
    let history = graph.history_image("frames", INFO, 0, Advance::EveryFrame);
    step(&mut graph, history.last, history.next, 1);
    let frames = graph.read_back(history.next);
    let read_back = graph.read_back(image);
    let mut executed = graph.run(Timing::Passes).expect("a frame");
    let made_again = !executed.outgrown.is_empty();
    if made_again {
        return digits(store, digit, needed);
    }
    // The history counts frames: as many as there are digits.
    let value = only(&executed.take(read_back));
    assert_eq!(only(&executed.take(frames)), value.to_string().len() as u32, "{value}");
    (value, made_again)
}

#[test]
fn a_frame_that_is_made_again_advances_once() {
    let session = Session::open();
    let mut store = session.store();
    let values: Vec<u32> = (1..=5).map(|digit| digits(&mut store, digit, 40 * digit * digit).0).collect();
    assert_eq!(values, [1, 12, 123, 1234, 12345]);
    assert!(store.memory_by_piece()["state"] >= 8 * 8 * 4);
    // The same sequence once more, the same bits.
    store.reset_history();
    let again: Vec<u32> = (1..=5).map(|digit| digits(&mut store, digit, 40 * digit * digit).0).collect();
    assert_eq!(again, values);
}

/// Repeats the pass that appends a digit.
fn repeat(store: &mut Store, digit: u32) {
    let mut graph = Graph::new(store);
    let (image, _) = graph.state_image("digits", INFO, 0, Advance::EveryFrame);
    let push = AppendPush { digit };
    graph.pass("test/append", Append { image: image.read_write(), push }).threads([8, 8, 1]);
    graph.want(image);
    graph.run_again("test/append", Timing::Passes).expect("a repetition");
}

#[test]
fn a_repeated_pass_that_changes_a_state_is_noticed() {
    let session = Session::open();
    let mut store = session.store();
    digits(&mut store, 1, 1);
    let past = store.past();
    repeat(&mut store, 2);
    assert_ne!(store.past(), past, "what is kept went on in a frame that was none");
    store.reset_history();
    assert_eq!(digits(&mut store, 3, 1).0, 3);
}

#[test]
fn a_frame_that_fails_before_it_runs_leaves_the_past_alone() {
    let session = Session::open();
    let mut store = session.store();
    for by in [1, 2] {
        frame(&mut store, by, 0, Advance::EveryFrame);
    }
    digits(&mut store, 7, 1);
    let mut graph = Graph::new(&mut store);
    let history = graph.history_image("sum", INFO, 0, Advance::EveryFrame);
    step(&mut graph, history.last, history.next, 100);
    let (image, _) = graph.state_image("digits", INFO, 0, Advance::EveryFrame);
    graph.pass("test/append", Append { image: image.read_write(), push: AppendPush { digit: 8 } }).threads([8, 8, 1]);
    let ramp = graph.image("ramp", vk::Format::R32_SFLOAT, [4, 4]);
    graph.pass("test/huge", Ramp { image: ramp.write(), push: RampPush { offset: 0.0 } }).groups([u32::MAX, 1, 1]);
    graph.want(history.next);
    graph.want(image);
    graph.want(ramp);
    assert!(graph.run(Timing::Frame).is_err());
    assert_eq!(frame(&mut store, 3, 0, Advance::EveryFrame), (6, 2, true));
    assert_eq!(digits(&mut store, 9, 1).0, 79);
}

#[test]
fn a_state_changes_after_all_that_grows_is_counted() {
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let (image, _) = graph.state_image("digits", INFO, 0, Advance::EveryFrame);
    graph.pass("test/append", Append { image: image.read_write(), push: AppendPush { digit: 1 } }).threads([8, 8, 1]);
    let pool = graph.growing_buffer::<u32>("pool", 16);
    let count = graph.buffer::<u32>("count", 1);
    graph.fill_buffer("test/count", count, 1);
    graph.grows(pool, count, 0);
    graph.want(image);
    let error = graph.run(Timing::Frame).err().expect("too late").to_string();
    assert!(["test/count", "pool", "test/append"].iter().all(|word| error.contains(word)), "{error}");
}

#[test]
fn buffers_are_kept_too() {
    let session = Session::open();
    let mut store = session.store();
    let mut run = |on_change: bool| {
        let mut graph = Graph::new(&mut store);
        let advance = if on_change { Advance::OnChange } else { Advance::EveryFrame };
        let (counters, age): (BufferRef<u32>, u32) = graph.state_buffer("counters", 1, 0, advance);
        graph.pass("test/counts", Count { counters: counters.read_write() }).groups([1, 1, 1]);
        let history = graph.history_buffer::<u32>("pair", 2, 0, advance);
        graph.fill_buffer("test/pair", history.next, 5 + age);
        let read_backs = [
            graph.read_back_buffer(counters),
            graph.read_back_buffer(history.last),
            graph.read_back_buffer(history.next),
        ];
        let mut executed = graph.run(Timing::Frame).expect("a frame");
        (read_backs.map(|read_back| words(&executed.take(read_back))[0]), history.age)
    };
    assert_eq!(run(false), ([64, 0, 5], 0));
    assert_eq!(run(false), ([128, 5, 6], 1));
    assert_eq!(run(false), ([192, 6, 7], 2));
}
