//! The command line from outside: exit statuses, messages, and files that appear whole or not at all.
//!
//! The tests that render need a Vulkan device; the others run anywhere.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use irradia::bench::report::Report;
use irradia::output::read_exr;
use irradia::renderer::{Slot, ToneMap};
use irradia::scene::builtin_names;

use crate::files::{empty_folder, names_in, read_png};

fn irradia(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_irradia")).args(arguments).output().expect("the program starts")
}

fn folder(test: &str) -> PathBuf {
    empty_folder("cli", test)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("the target folder is UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A failure is one line that begins with the program's name, and nothing on standard output.
fn assert_fails(arguments: &[&str], words: &[&str]) {
    let output = irradia(arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
    assert!(message.starts_with("irradia: "), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(output.stdout.is_empty());
    for word in words {
        assert!(message.contains(word), "{word} is not in: {message}");
    }
}

fn assert_wrong_usage(arguments: &[&str], words: &[&str]) {
    let output = irradia(arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    for word in words {
        assert!(message.contains(word), "{word} is not in: {message}");
    }
}

fn succeed(arguments: &[&str]) -> Output {
    let output = irradia(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    output
}

fn any_scene() -> &'static str {
    builtin_names().first().copied().expect("there are built-in scenes")
}

/// A triangle without a light.
fn write_unlit_scene(folder: &Path) -> PathBuf {
    let path = folder.join("unlit.gltf");
    // Positions (0,0,0), (1,0,0), (0,1,0) as little-endian float32.
    let buffer = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let document = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],
            "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{buffer}"}}]}}"#
    );
    fs::write(&path, document).expect("the test's own folder");
    path
}

#[test]
fn wrong_usage_is_status_2() {
    assert_wrong_usage(&[], &["Usage"]);
    assert_wrong_usage(&["paint"], &["paint"]);
    assert_wrong_usage(&["render", "ring"], &["--output"]);
    assert_wrong_usage(&["bench"], &["SCENE"]);
    assert_wrong_usage(&["bench", "ring", "--frames", "0"], &["--frames"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.png", "--size", "640"], &["WIDTHxHEIGHT"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.png", "--frames", "9..3"], &["FIRST..LAST"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.png", "--frame", "1", "--frames", "0..3"], &["--frame"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.png", "--slots", "all"], &["a PNG holds the image alone"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.exr", "--slots", "sky"], &["emission", "direct", "all"]);
    assert_wrong_usage(&["scenes", "--quiet", "--verbose"], &["--quiet"]);
}

#[test]
fn wrong_usage_of_references_is_status_2() {
    assert_wrong_usage(&["reference"], &["SCENE"]);
    assert_wrong_usage(&["reference", "ring"], &["--spp"]);
    assert_wrong_usage(&["reference", "ring", "--spp", "0"], &["--spp"]);
    assert_wrong_usage(&["reference", "ring", "--spp", "16", "--estimator", "magic"], &["path", "sppm"]);
    assert_wrong_usage(&["reference", "ring", "--spp", "16", "--filter", "wide"], &["center", "box"]);
    assert_wrong_usage(&["reference", "ring", "--spp", "16", "-o", "a.png"], &[".exr"]);
    assert_wrong_usage(&["reference", "ring", "--spp", "16", "--shard", "1/4"], &["--output"]);
    assert_wrong_usage(&["reference", "ring", "--spp", "16", "--shard", "5/4", "-o", "a.exr"], &["I/N"]);
    assert_wrong_usage(&["reference", "ring", "--spp", "16", "--noise", "0%"], &["percentage"]);
    assert_wrong_usage(&["reference", "ring", "--merge", "a.exr"], &["--merge"]);
    assert_wrong_usage(&["reference", "--merge", "a.exr", "--no-cache"], &["-o FILE.exr"]);
    assert_wrong_usage(&["reference", "--list", "--clear", "all"], &["--clear"]);
    assert_wrong_usage(&["reference", "--clear", "ring"], &["hexadecimal"]);
    assert_wrong_usage(&["bench", "ring", "--reference", "0"], &["--reference"]);
    assert_wrong_usage(&["bench", "ring", "--no-cache"], &["--reference"]);
}

#[test]
fn the_cache_of_references_is_listed_and_cleared_without_a_device() {
    let folder = folder("references");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_irradia"));
        command.arg("reference").args(arguments).env("IRRADIA_CACHE_DIR", folder.join("none")).output().expect("starts")
    };
    let listed = run(&["--list"]);
    assert!(listed.status.success() && String::from_utf8_lossy(&listed.stdout).contains("no reference in"));
    assert!(run(&["--clear", "all"]).status.success());
    let unknown = run(&["--clear", "0123abcd"]);
    assert_eq!(unknown.status.code(), Some(1));
    assert!(stderr(&unknown).contains("0123abcd") && stderr(&unknown).contains("--list"), "{}", stderr(&unknown));
    let text_file = folder.join("a.exr");
    fs::write(&text_file, "no image").expect("the test's own folder");
    let merged = run(&["--merge", text(&text_file)]);
    assert_eq!(merged.status.code(), Some(1));
    assert!(stderr(&merged).contains("cannot be used as a reference"), "{}", stderr(&merged));
    assert_eq!(names_in(&folder), ["a.exr"], "nothing was made");
}

#[test]
fn names_that_do_not_exist_list_those_that_do() {
    assert_wrong_usage(&["render", "ring", "-o", "a.exr", "--technique", "magic"], &["magic", "direct", "rsm"]);
    assert_wrong_usage(&["bench", "ring", "--technique", "rsm,magic"], &["magic", "direct", "rsm", "all"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.exr", "--preset", "best"], &["draft", "default", "high", "paper"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.exr", "--diffuse", "magic"], &["none", "rsm"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.exr", "--set", "rsm.vlps=3"], &["rsm.vlps", "rsm.vpls"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.exr", "--set", "lights.resolution=5"], &["16 to 4096"]);
    assert_wrong_usage(&["render", "ring", "-o", "a.jpg"], &["a.jpg", ".exr", ".png"]);
    assert_wrong_usage(&["render", "ring", "-o", "a"], &[".exr", ".png"]);
}

#[test]
fn a_missing_scene_is_one_sentence_and_no_file() {
    let folder = folder("missing-scene");
    let image = folder.join("a.png");
    assert_fails(&["render", "no-such-scene", "-o", text(&image)], &["no-such-scene"]);
    assert_fails(&["render", "no/such/scene.gltf", "-o", text(&image)], &["no/such/scene.gltf"]);
    assert_fails(&["graph", "no-such-scene"], &["no-such-scene"]);
    assert!(names_in(&folder).is_empty());
}

#[test]
fn a_folder_that_does_not_exist_is_found_before_rendering() {
    let missing = folder("missing-folder").join("none");
    assert_fails(&["render", any_scene(), "-o", text(&missing.join("a.png"))], &["there is no folder"]);
    assert_fails(&["bench", any_scene(), "--json", text(&missing.join("a.json"))], &["there is no folder"]);
}

#[test]
fn scenes_lists_all_of_them() {
    let listed = String::from_utf8(succeed(&["scenes"]).stdout).expect("UTF-8");
    assert_eq!(listed.lines().count(), 1 + builtin_names().len(), "a header and a line each");
    for name in builtin_names() {
        assert!(listed.lines().any(|line| line.split_whitespace().next() == Some(name)), "{name} is not in\n{listed}");
    }
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_irradia"));
    let mut child = command.arg("scenes").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("ends");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(output.stderr.is_empty(), "{}", stderr(&output));
}

#[test]
fn devices_marks_one_default() {
    let listed = String::from_utf8(succeed(&["devices"]).stdout).expect("UTF-8");
    assert_eq!(listed.lines().filter(|line| line.starts_with('*')).count(), 1, "{listed}");
}

#[test]
fn a_device_that_does_not_exist_is_a_failure() {
    assert_fails(&["graph", any_scene(), "--device", "no-such-device"], &["no-such-device"]);
}

#[test]
fn an_exr_holds_image_slots_and_how_it_was_made() {
    let folder = folder("exr");
    let path = folder.join("a.exr");
    let output = succeed(&[
        "render",
        any_scene(),
        "-o",
        text(&path),
        "--size",
        "48x32",
        "--slots",
        "all",
        "--set",
        "rsm.vpls=16",
    ]);
    assert!(stderr(&output).contains("wrote"), "{}", stderr(&output));
    assert!(output.stdout.is_empty());
    assert_eq!(names_in(&folder), ["a.exr"]);
    let read = read_exr(&path).expect("an EXR of ours");
    assert_eq!(read.image.size, [48, 32]);
    assert_eq!(read.slots.keys().copied().collect::<Vec<_>>(), Slot::ALL);
    for (pixel, image) in read.image.pixels.iter().enumerate() {
        for (channel, value) in image.iter().enumerate() {
            let sum: f32 = read.slots.values().map(|slot| slot.pixels[pixel][channel]).sum();
            assert!((sum - value).abs() <= 1e-4 * value.abs().max(1e-3), "pixel {pixel}: slots {sum}, image {value}");
        }
    }
    let attribute = |name: &str| read.attributes.get(name).map(String::as_str).unwrap_or_default();
    assert_eq!(attribute("scene"), any_scene());
    assert_eq!(attribute("technique"), "rsm");
    assert_eq!(attribute("size"), "48x32");
    assert_eq!(attribute("frame"), "0");
    assert_eq!(attribute("irradia"), env!("CARGO_PKG_VERSION"));
    assert!(attribute("settings").contains("\"vpls\":16"), "{}", attribute("settings"));
    assert!(!attribute("device").is_empty() && !attribute("driver").is_empty() && !attribute("camera").is_empty());
}

#[test]
fn a_png_shows_what_the_tone_map_makes_of_the_exr() {
    let folder = folder("png");
    let exr = folder.join("a.exr");
    succeed(&["render", any_scene(), "-o", text(&exr), "--size", "48x32"]);
    let image = read_exr(&exr).expect("an EXR of ours").image;
    for (name, map) in [("linear", ToneMap::Linear), ("aces", ToneMap::Aces), ("drago", ToneMap::Drago)] {
        let png = folder.join(name).with_extension("png");
        succeed(&["render", any_scene(), "-o", text(&png), "--size", "48x32", "--tonemap", name]);
        let (_, shown) = read_png(&png);
        let expected = irradia::image::tone_map(&image, map);
        let worst = shown.as_flattened().iter().zip(expected.as_flattened()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(1), "{name}: device and host are {worst:?} levels apart");
    }
}

#[test]
fn a_sequence_is_a_file_a_frame() {
    let folder = folder("sequence");
    let quiet = succeed(&[
        "render",
        any_scene(),
        "-q",
        "-o",
        text(&folder.join("a.png")),
        "--size",
        "16x16",
        "--frames",
        "3..5",
    ]);
    assert!(quiet.stderr.is_empty(), "{}", stderr(&quiet));
    succeed(&["render", any_scene(), "-o", text(&folder.join("b##.exr")), "--size", "16x16", "--frame", "7"]);
    assert_eq!(names_in(&folder), ["a.0003.png", "a.0004.png", "a.0005.png", "b07.exr"]);
    let lead_in = |name: &str| read_exr(&folder.join(name)).expect("an EXR").attributes.get("lead_in").cloned();
    assert_eq!(lead_in("b07.exr"), None, "no method keeps anything");
    for (name, asked, expected) in [("c.exr", "2", "2"), ("d.exr", "9", "7")] {
        let path = folder.join(name);
        let of = ["--size", "16x16", "--frame", "7", "--lead-in", asked];
        succeed(&[&["render", any_scene(), "-q", "-o", text(&path)][..], &of].concat());
        assert_eq!(lead_in(name).as_deref(), Some(expected), "no frame comes before frame 0");
    }
}

#[test]
fn a_scene_without_light_says_so_once_and_is_rendered() {
    let folder = folder("unlit");
    let scene = write_unlit_scene(&folder);
    let image = folder.join("a.exr");
    let output = succeed(&["render", text(&scene), "-o", text(&image), "--size", "16x16", "--frames", "0..2"]);
    let message = stderr(&output);
    assert_eq!(message.matches("has no light").count(), 1, "{message}");
    assert!(message.contains("--light") && message.contains("--sky"), "{message}");
    assert!(folder.join("a.0002.exr").exists());
    let lit = succeed(&["render", text(&scene), "-o", text(&image), "--size", "16x16", "--sky", "1,1,1"]);
    assert!(!stderr(&lit).contains("has no light"), "{}", stderr(&lit));
}

#[test]
fn the_graph_names_the_passes() {
    let folder = folder("graph");
    let dot = folder.join("a.dot");
    let output = succeed(&["graph", any_scene(), "--size", "48x32", "--dot", text(&dot)]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("gbuffer"));
    assert!(fs::read_to_string(&dot).expect("written").starts_with("digraph"));
}

#[test]
fn a_failing_scene_does_not_stop_the_bench() {
    let folder = folder("bench");
    let (json, csv, md, images) =
        (folder.join("a.json"), folder.join("a.csv"), folder.join("a.md"), folder.join("images"));
    let scenes = [any_scene(), "no-such-scene"];
    let measured =
        ["--technique", "all", "--frames", "2", "--warmup", "1", "--size", "48x32", "--set", "particles.count=1000"];
    let files = ["--json", text(&json), "--csv", text(&csv), "--md", text(&md), "--images", text(&images)];
    let output = irradia(&[&["bench"], &scenes[..], &measured, &files].concat());
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).lines().any(|line| line.starts_with("irradia: no-such-scene")), "{}", stderr(&output));
    let tables = String::from_utf8_lossy(&output.stdout);
    assert!(tables.contains("unexplained") && tables.contains("RSM (DEFAULT)"), "{tables}");

    let report: Report = serde_json::from_str(&fs::read_to_string(&json).expect("written")).expect("the schema");
    assert_eq!(report.schema, "irradia-bench/1");
    assert!(!report.device.name.is_empty());
    assert_eq!(report.failures.len(), 1);
    let techniques: Vec<&str> = report.runs.iter().map(|run| run.technique.as_str()).collect();
    assert_eq!(techniques, ["direct", "rsm", "hybrid", "volumes", "particles", "lightmaps", "path", "sppm"]);
    for run in &report.runs {
        assert_eq!((run.frames, run.size), (2, [48, 32]));
        assert!(
            run.frame_ms.min > 0.0
                && run.frame_ms.min <= run.frame_ms.median
                && run.frame_ms.median <= run.frame_ms.p95
        );
        assert!(run.passes.iter().any(|pass| pass.skipped.is_none() && pass.ms.median > 0.0));
        assert!(run.memory_bytes > 0 && run.memory_bytes == run.memory.values().sum::<u64>());
    }
    assert!(fs::read_to_string(&csv).expect("written").starts_with("scene,technique"));
    assert!(fs::read_to_string(&md).expect("written").contains("| pass |"));
    let pictures = report.runs.iter().map(|run| format!("{}-{}-default.png", run.scene, run.technique));
    let mut pictures: Vec<_> = pictures.collect();
    pictures.sort();
    assert_eq!(names_in(&images), pictures);
}

#[test]
fn the_bench_times_a_piece_on_its_own() {
    let json = folder("bench-piece").join("a.json");
    let measured =
        ["bench", "cornell-point", "--technique", "direct,rsm", "--frames", "2", "--warmup", "0", "--size", "32x24"];
    let pieces = ["--piece", "diffuse/rsm", "--piece", "light-views", "--json", text(&json)];
    let output = succeed(&[&measured[..], &pieces].concat());
    let tables = String::from_utf8_lossy(&output.stdout);
    assert!(tables.contains("diffuse/rsm alone") && tables.contains("there is no piece"), "{tables}");
    let report: Report = serde_json::from_str(&fs::read_to_string(&json).expect("written")).expect("the schema");
    for run in &report.runs {
        let [rsm, views] = &run.piece_alone[..] else { panic!("{:?}", run.piece_alone) };
        assert_eq!((&*rsm.piece, rsm.skipped.is_some()), ("diffuse/rsm", run.technique == "direct"));
        assert!(views.ms.median > 0.0 && views.in_frame_ms.median > 0.0 && !views.passes.is_empty(), "{views:?}");
    }
    let unknown = irradia(&[&measured[..], &["--piece", "diffuse/rms"]].concat());
    let message = stderr(&unknown);
    assert_eq!((unknown.status.code(), message.lines().count()), (Some(1), 1), "{message}");
    for word in ["diffuse/rms", "diffuse/rsm", "light-views"] {
        assert!(message.contains(word), "{word} is not in: {message}");
    }
}

#[test]
fn the_bench_says_how_far_techniques_are_from_references() {
    let folder = folder("bench-reference");
    let (json, cache) = (folder.join("a.json"), folder.join("cache"));
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_irradia"));
        let output = command.args(arguments).env("IRRADIA_CACHE_DIR", &cache).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
        String::from_utf8(output.stdout).expect("UTF-8")
    };
    let measured = ["--technique", "direct,rsm", "--frames", "1", "--warmup", "0", "--size", "32x24"];
    let tables =
        run(&[&["bench", "cornell-point"], &measured[..], &["--reference", "16", "--json", text(&json)]].concat());
    assert!(tables.contains("rrmse") && tables.contains("covered"), "{tables}");
    let report: Report = serde_json::from_str(&fs::read_to_string(&json).expect("written")).expect("the schema");
    let [direct, rsm] = &report.runs[..] else { panic!("{} runs", report.runs.len()) };
    let bounces = [direct, rsm].map(|run| run.reference.as_ref().and_then(|reference| reference.bounces));
    assert_eq!(bounces, [Some(0), Some(1)]);
    assert!(rsm.reference_full.as_ref().is_some_and(|full| full.bounces.is_none() && full.spp == 16));
    let rrmse = |run: &irradia::bench::report::Run, part: &str| run.error.as_ref().expect("compared")[part].rrmse;
    assert!(rrmse(direct, "direct") < 0.2, "both are the same light: {}", rrmse(direct, "direct"));
    assert!(rsm.error_full.as_ref().is_some_and(|errors| errors["image"].rrmse < 1.0));
    let kept = || names_in(&cache).iter().filter(|name| name.ends_with(".exr")).count();
    assert_eq!(kept(), 3, "one without, one with one bounce, one without limit");
    let made = run(&["reference", "cornell-point", "--spp", "16", "--size", "32x24"]);
    assert!(made.contains("16 samples per pixel") && made.contains("rays/s"), "{made}");
    assert_eq!(kept(), 3, "the bench made this one");
    assert!(run(&["reference", "--list"]).contains("cornell-point"));
}
