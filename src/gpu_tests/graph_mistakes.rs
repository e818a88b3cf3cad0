//! Mistakes in the declaration of a frame, each made on purpose: an error that names pass and resource, in every build.

use ash::vk;

use super::scenes::{builtin, request};
use super::session::Session;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{ClearColor, Dependence, Graph};
use crate::renderer::{FrameRequest, Preset, Settings, Slot, Technique, Timing};
use crate::shaders::selftest::{Append, AppendPush, Count, Halve, Ramp, RampPush};
use crate::vulkan::ImageInfo;

/// What running a frame says that is declared so.
fn said(session: &Session, declare: impl FnOnce(&mut Graph<'_>)) -> String {
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    declare(&mut graph);
    graph.run(Timing::Frame).err().expect("a mistake").to_string()
}

fn assert_says(session: &Session, words: &[&str], declare: impl FnOnce(&mut Graph<'_>)) {
    let said = said(session, declare);
    assert!(words.iter().all(|word| said.contains(word)), "{said:?} lacks one of {words:?}");
}

fn ramp(graph: &mut Graph<'_>, image: ImageRef, name: &str) {
    graph.pass(name, Ramp { image: image.write(), push: RampPush { offset: 0.0 } }).threads([4, 4, 1]);
}

fn counters(graph: &mut Graph<'_>, words: usize) -> BufferRef<u32> {
    let counters = graph.buffer::<u32>("counters", words);
    graph.fill_buffer("test/clear", counters, 0);
    counters
}

#[test]
fn what_nobody_has_written_is_not_read() {
    let session = Session::open();
    let float = vk::Format::R32_SFLOAT;
    assert_says(&session, &["test/halve reads finer", "nobody has written"], |graph| {
        let [finer, coarser] = [("finer", 8), ("coarser", 4)].map(|(name, side)| graph.image(name, float, [side; 2]));
        graph.pass("test/halve", Halve { finer: finer.sampled(), coarser: coarser.write() }).threads([4, 4, 1]);
    });
    assert_says(&session, &["test/halve reads level 1 of pyramid"], |graph| {
        let info = ImageInfo { format: float, extent: [8, 8, 1], mips: 3, layers: 1, volume: false };
        let pyramid = graph.image_with("pyramid", info);
        ramp(graph, pyramid.mip(0), "test/ramp");
        let halve = Halve { finer: pyramid.mip(1).sampled(), coarser: pyramid.mip(2).write() };
        graph.pass("test/halve", halve).threads([2, 2, 1]);
    });
    assert_says(&session, &["test/append reads digits"], |graph| {
        let digits = graph.image("digits", vk::Format::R32_UINT, [4, 4]);
        graph
            .pass("test/append", Append { image: digits.read_write(), push: AppendPush { digit: 1 } })
            .threads([4, 4, 1]);
    });
}

/// Memory that still holds the last frame's content makes no difference: frames do not hand anything on by accident.
#[test]
fn what_the_last_frame_wrote_is_not_read_either() {
    let session = Session::open();
    let mut store = session.store();
    let mut run = |write: bool, goes_on: bool| {
        let mut graph = if goes_on { Graph::going_on(&mut store) } else { Graph::new(&mut store) };
        let counters = graph.buffer::<u32>("counters", 1);
        if write {
            graph.fill_buffer("test/clear", counters, 0);
        }
        graph.pass("test/count", Count { counters: counters.read_write() }).groups([1, 1, 1]);
        let read_back = graph.read_back_buffer(counters);
        graph.run(Timing::Frame).map(|mut executed| executed.take(read_back)[0])
    };
    assert_eq!(run(true, false).expect("a frame"), 64);
    assert!(run(false, false).expect_err("a read of nothing").to_string().contains("test/count reads counters"));
    assert_eq!(run(true, true).expect("a submission"), 64);
    assert_eq!(run(false, true).expect("a submission that goes on"), 128);
}

#[test]
fn names_are_used_once() {
    let session = Session::open();
    assert_says(&session, &["two resources are called a"], |graph| {
        for _ in 0..2 {
            graph.image("a", vk::Format::R32_SFLOAT, [4, 4]);
        }
    });
    assert_says(&session, &["two resources are called a"], |graph| {
        graph.upload("a", &[1_u32], Dependence::NONE);
        graph.buffer::<u32>("a", 1);
    });
    assert_says(&session, &["two passes are called test/ramp"], |graph| {
        for name in ["a", "b"] {
            let image = graph.image(name, vk::Format::R32_SFLOAT, [4, 4]);
            ramp(graph, image, "test/ramp");
        }
    });
}

#[test]
fn an_image_has_one_layout_in_a_pass() {
    let session = Session::open();
    assert_says(&session, &["test/halve uses the image same in two layouts"], |graph| {
        let same = graph.image("same", vk::Format::R32_SFLOAT, [4, 4]);
        graph.clear_image("test/clear", same, ClearColor::Float([1.0; 4]));
        graph.pass("test/halve", Halve { finer: same.sampled(), coarser: same.write() }).threads([2, 2, 1]);
    });
}

#[test]
fn counters_and_arguments_lie_in_their_buffers() {
    let session = Session::open();
    assert_says(&session, &["test/count counts what in other", "does not use"], |graph| {
        let counters = counters(graph, 1);
        let other = graph.buffer::<u32>("other", 1);
        graph.fill_buffer("test/other", other, 0);
        let pass = graph.pass("test/count", Count { counters: counters.read_write() });
        pass.count("what", other, 0).groups([1, 1, 1]);
    });
    assert_says(&session, &["test/count takes 1 words from word 2 on of counters, which has 2"], |graph| {
        let counters = counters(graph, 2);
        let pass = graph.pass("test/count", Count { counters: counters.read_write() });
        pass.count("what", counters, 2).groups([1, 1, 1]);
    });
    assert_says(&session, &["test/count takes 3 words from word 1 on of arguments, which has 3"], |graph| {
        let counters = counters(graph, 1);
        let arguments = graph.upload("arguments", &[1_u32; 3], Dependence::NONE);
        graph.pass("test/count", Count { counters: counters.read_write() }).threads_indirect(arguments, 1);
    });
    assert_says(&session, &["pool grows by word 4 of a buffer of 1"], |graph| {
        let counters = counters(graph, 1);
        let pool = graph.growing_buffer::<u32>("pool", 16);
        graph.grows(pool, counters, 4);
    });
}

#[test]
fn a_slot_more_makes_nothing_else_again() {
    let session = Session::open();
    let scene = builtin("cornell-panel");
    let camera = scene.camera_view(None).expect("a camera");
    let mut renderer = session.renderer(&Settings::new(Technique::Rsm, Preset::Draft));
    let asked = |slots: &[Slot]| FrameRequest { image: false, ..request([32, 32], camera.clone(), slots) };
    renderer.render(&scene, &asked(&[Slot::Direct, Slot::Diffuse])).expect("a frame");
    let frame = renderer.render(&scene, &asked(&[Slot::Emission, Slot::Direct, Slot::Diffuse])).expect("a frame");
    let again = frame.timings.passes.iter().filter(|pass| pass.skipped.is_none()).map(|pass| pass.full_name());
    let again: Vec<String> =
        again.filter(|name| !name.starts_with("check/") && !name.starts_with("gbuffer/")).collect();
    let lights: Vec<&String> =
        again.iter().filter(|name| name.starts_with("light-views") || name.contains("vpls")).collect();
    assert!(lights.is_empty(), "{lights:?} ran again");
}

/// Under two patterns that fill what passes say they write whole, no word of either is left.
#[test]
fn what_is_said_to_be_written_whole_is() {
    let session = Session::open();
    let hybrid = |changes: &[(&str, &str)]| {
        let mut settings = Settings::new(Technique::Hybrid, Preset::Draft);
        for (key, value) in
            [("photons.max", "700"), ("vpl.count", "64"), ("lights.resolution", "64")].iter().chain(changes)
        {
            settings.set(key, value).expect("within its range");
        }
        settings
    };
    let supersampled = Settings::new(Technique::Direct, Preset::Draft).with(|settings| {
        settings.methods.set(Slot::Direct, "traced").expect("a method");
        settings.methods.set(Slot::Diffuse, "vpl").expect("a method");
        settings.methods.set(Slot::Specular, "trace").expect("a method");
        (settings.vpl.count, settings.trace.supersamples) = (32, 4);
    });
    let points = Settings::new(Technique::Direct, Preset::Draft).with(|settings| {
        settings.methods.set(Slot::Caustics, "points").expect("a method");
        (settings.points.photons, settings.points.frames) = (700, 3);
    });
    let cubemap = Settings::new(Technique::Direct, Preset::Draft).with(|settings| {
        settings.methods.set(Slot::Specular, "cubemap").expect("a method");
        settings.cubemap.resolution = 32;
    });
    let hemicubes = Settings::new(Technique::Direct, Preset::Draft).with(|settings| {
        settings.methods.set(Slot::Diffuse, "lightmaps").expect("a method");
        for (key, value) in [("lightmaps.gather", "hemicube"), ("lightmaps.settle", "always")] {
            settings.set(key, value).expect("a choice");
        }
        (settings.lightmaps.count, settings.lightmaps.fragments) = (300, 5);
    });
    let frames = [
        ("ring", points),
        ("ring", hemicubes),
        ("lights", cubemap.clone()),
        ("cornell-glossy", cubemap),
        ("lights", supersampled),
        ("ring", hybrid(&[("photons.downscale", "2"), ("vpl.bounces", "2"), ("vpl.visibility", "traced")])),
        ("ring", hybrid(&[("photons.splat", "tiles"), ("vpl.visibility", "ism"), ("photons.trace", "march")])),
        ("ring", hybrid(&[("photons.splat", "discs"), ("photons.trace", "lines"), ("vpl.shading", "stencil")])),
        ("textured", Settings::new(Technique::Rsm, Preset::Draft)),
        ("textured", Settings::new(Technique::Volumes, Preset::Draft)),
        ("lights", hybrid(&[("vpl.shading", "pixels")])),
    ];
    for (name, settings) in frames {
        let scene = builtin(name);
        let request = request([45, 34], scene.camera_view(None).expect("a camera"), &Slot::ALL);
        let unwritten = session.renderer(&settings).unwritten(&scene, &request).expect("a frame");
        assert!(unwritten.is_empty(), "{name}: {unwritten:#?}");
    }
}
