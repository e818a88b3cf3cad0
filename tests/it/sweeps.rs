//! The sweeps that are checked in and the one that the documentation shows; the command from outside.
//!
//! The tests that render need a Vulkan device; the others run anywhere.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use irradia::bench::sweep::{Grid, Sweep};
use irradia::scene::LoadOptions;

use crate::files::empty_folder;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn irradia(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_irradia")).args(arguments).output().expect("the program starts")
}

fn succeed(arguments: &[&str]) -> (String, String) {
    let output = irradia(arguments);
    let [out, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {error}");
    (out, error)
}

fn assert_fails(arguments: &[&str], words: &[&str]) {
    let output = irradia(arguments);
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
    assert_eq!(message.lines().count(), 1, "{message}");
    for word in words {
        assert!(message.contains(word), "{word} is not in: {message}");
    }
}

fn folder(test: &str) -> PathBuf {
    empty_folder("sweeps", test)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("the target folder is UTF-8")
}

fn point_count(toml: &str, path: &str) -> usize {
    let grid = Grid::parse(toml, Path::new(path)).unwrap_or_else(|error| panic!("{error}"));
    for scene in &grid.scenes {
        scene.open(&root().join("sweeps"), &LoadOptions::default()).expect("the scenes of a grid are there");
    }
    grid.points().expect("checked when it was read").len()
}

#[test]
fn the_grids_that_are_checked_in_are_sound() {
    let counts = [
        ("quick", 6),
        ("rsm-path", 30),
        ("quyen", 120),
        ("chang", 36),
        ("particles-growth", 44),
        ("particles-growth-scenes", 14),
        ("reich", 50),
        ("reich-pixels", 3),
        ("reich-maps", 61),
        ("larsen", 44),
        ("larsen-maps", 50),
    ];
    for (name, count) in counts {
        let path = format!("sweeps/{name}.toml");
        let toml = fs::read_to_string(root().join(&path)).expect("it is checked in");
        assert_eq!(point_count(&toml, &path), count, "{path}");
    }
}

#[test]
fn the_documented_grid_is_sound_and_its_defaults_are_right() {
    let page = fs::read_to_string(root().join("docs/sweeps.md")).expect("it is checked in");
    let toml = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a block of TOML");
    assert_eq!(point_count(toml, "docs/sweeps.md"), 50);

    let optional = ["size", "frames", "warmup", "interleave", "compare", "entry", "metric", "preset"];
    let named = |line: &&str| !optional.iter().any(|key| line.starts_with(&format!("{key} =")));
    let short: String = toml.lines().filter(named).map(|line| format!("{line}\n")).collect();
    assert_eq!(toml.lines().count(), short.lines().count() + optional.len());
    let parse = |toml: &str| Grid::parse(toml, Path::new("docs/sweeps.md")).expect("sound");
    assert_eq!(parse(&short), parse(toml));
}

#[test]
fn shards_of_a_sweep_resume_and_merge() {
    let folder = folder("merge");
    let grid = root().join("sweeps/quick.toml");
    let [one, two, whole, csv] = ["1.json", "2.json", "whole.json", "whole.csv"].map(|name| folder.join(name));
    let sweep = |arguments: &[&str]| succeed(&[&["sweep", text(&grid)], arguments].concat());
    let (out, error) = sweep(&["--shard", "1/2", "--json", text(&one)]);
    assert!(out.contains("rsm.vpls 16") && error.contains("3 of the 6 points"), "{out}{error}");
    let before = fs::read(&one).expect("it was written");
    let (_, error) = sweep(&["--shard", "1/2", "--json", text(&one)]);
    assert!(error.contains("3 of 3 points are done"), "{error}");
    assert_eq!(fs::read(&one).expect("still there"), before, "nothing is measured twice");
    sweep(&["--shard", "2/2", "--json", text(&two)]);
    let merge = ["sweep", "--merge", text(&one), text(&two), "--json", text(&whole), "--csv", text(&csv)];
    let (out, error) = succeed(&merge);
    assert!(!error.contains("missing"), "{error}");
    assert_eq!(out.matches("rsm.vpls").count(), 6, "{out}");
    assert_eq!(fs::read_to_string(&csv).expect("it was written").lines().count(), 7);
    let sweep = Sweep::read(&whole).expect("its own");
    let order: Vec<String> = sweep.grid.points().expect("sound").into_iter().map(|point| point.id).collect();
    assert_eq!(sweep.points.iter().map(|measured| measured.id.clone()).collect::<Vec<_>>(), order);
    for measured in &sweep.points {
        assert_eq!(measured.run.settings["rsm"]["vpls"], measured.values["rsm.vpls"]);
        assert_eq!((measured.run.size, measured.run.frames, measured.run.preset.as_str()), ([64, 48], 1, "draft"));
        assert!(measured.run.frame_ms.median > 0.0);
    }
    let other = ["sweep", text(&grid), "--json", text(&whole), "--size", "32x32"];
    assert_fails(&other, &["whole.json", "6 of the 6", "--restart"]);
}

#[test]
fn points_are_compared_with_references_and_plotted() {
    let folder = folder("compared");
    let [json, plots, cache] = ["out.json", "plots", "cache"].map(|name| folder.join(name));
    let grid = root().join("sweeps/quick.toml");
    let arguments = ["sweep", text(&grid), "--size", "32x24", "--reference", "16", "--json", text(&json)];
    let mut command = Command::new(env!("CARGO_BIN_EXE_irradia"));
    command.args(arguments).args(["--plots", text(&plots)]).env("IRRADIA_CACHE_DIR", &cache);
    let output = command.output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let sweep = Sweep::read(&json).expect("its own");
    assert_eq!((sweep.grid.size, sweep.grid.reference, sweep.points.len()), ([32, 24], Some(16), 6));
    for measured in &sweep.points {
        assert!(sweep.grid.error(&measured.run).is_some_and(|error| error > 0.0), "{}", measured.id);
        let equal = measured.run.reference.as_ref().expect("compared");
        assert_eq!(equal.bounces, Some(1), "the light paths of rsm");
    }
    for scene in ["cornell-point", "ring"] {
        let svg = fs::read_to_string(plots.join(scene).with_extension("svg")).expect("a plot for every scene");
        assert!(svg.contains(scene) && svg.contains("noise of the reference"), "{svg}");
    }
}

#[test]
fn failed_points_do_not_stop_the_others() {
    let folder = folder("failures");
    let [grid, json, broken] = ["grid.toml", "out.json", "broken.glb"].map(|name| folder.join(name));
    fs::write(&broken, "no scene").expect("the target folder is writable");
    let toml = "size = [32, 32]\nframes = 5\nwarmup = 3\nmax_seconds = 1e-6\n\
        scenes = [\"broken.glb\", \"ring\"]\n[[series]]\ntechnique = \"direct\"\n";
    fs::write(&grid, toml).expect("the target folder is writable");
    assert_fails(&["sweep", text(&grid), "--json", text(&json)], &["broken, direct: ", "not a glTF document"]);
    let sweep = Sweep::read(&json).expect("its own");
    assert_eq!((sweep.points.len(), sweep.failures.len()), (1, 1));
    assert_eq!(sweep.points[0].run.frames, 1, "max_seconds leaves one round");
}

#[test]
fn what_is_no_sweep_is_refused_in_a_sentence() {
    let folder = folder("refused");
    assert_fails(&["sweep", "no-such.toml"], &["no-such.toml cannot be read"]);
    let grid = folder.join("grid.toml");
    for (scene, words) in [("a.glb", ["\"a\"", "no file"]), ("rings", ["\"rings\"", "cornell-point"])] {
        let toml = format!("scenes = [\"ring\", {scene:?}]\n[[series]]\ntechnique = \"direct\"\n");
        fs::write(&grid, toml).expect("the target folder is writable");
        assert_fails(&["sweep", text(&grid)], &[&["grid.toml: scene"], &words[..]].concat());
    }
    let json = folder.join("bench.json");
    fs::write(&json, "{\"schema\": \"irradia-bench/1\"}").expect("the target folder is writable");
    assert_fails(&["sweep", "--merge", text(&json)], &["bench.json is no result of a sweep", "irradia-bench/1"]);
    assert_eq!(irradia(&["sweep"]).status.code(), Some(2));
    assert_eq!(irradia(&["sweep", "a.toml", "--shard", "3/2", "--json", "a.json"]).status.code(), Some(2));
}
