//! Sequences and flights on the command line. What renders needs a Vulkan device.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use irradia::bench::report::Report;

use crate::files::{empty_folder, names_in};

fn irradia(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_irradia")).args(arguments).output().expect("the program starts")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn text(path: &Path) -> &str {
    path.to_str().expect("the target folder is UTF-8")
}

#[test]
fn what_belongs_to_sequences_needs_one() {
    for (arguments, word) in [
        (&["--lag"][..], "--animate"),
        (&["--over-time", "x"], "--animate"),
        (&["--animate", "--counter", "x"], "--over-time"),
        (&["--animate=0"], "frames a second"),
        (&["--animate", "--piece", "gbuffer"], "--piece"),
        (&["--flight", "maze", "--camera", "0"], "--camera"),
    ] {
        let output = irradia(&[&["bench", "ring"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(word), "{}", stderr(&output));
    }
}

#[test]
fn a_flight_that_is_none_is_one_sentence_before_anything_is_rendered() {
    let folder = empty_folder("cli", "flights");
    let (flight, image) = (folder.join("way.txt"), folder.join("a.png"));
    fs::write(&flight, "0 0 1 4 0 1 0\n1 0 1\n").expect("the test's own folder");
    for (spec, words) in [
        (text(&flight), "line 2 of the flight way has 3 numbers"),
        ("no-such", "corridor, two-rooms, rooms, maze"),
        ("no/such.txt", "cannot read the flight no/such.txt"),
    ] {
        for command in [&["render", "ring", "-o", text(&image)][..], &["bench", "ring", "--animate"]] {
            let output = irradia(&[command, &["--flight", spec]].concat());
            let message = stderr(&output);
            assert_eq!((output.status.code(), message.lines().count()), (Some(1), 1), "{message}");
            assert!(message.contains(words), "{message}");
        }
    }
    assert_eq!(names_in(&folder), ["way.txt"], "nothing was made");
}

/// The files in the repository are flights of half a minute too.
#[test]
fn the_flights_beside_the_scenes_can_be_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("flights");
    for name in names_in(&folder) {
        let flight = irradia::scene::Flight::open(text(&folder.join(&name))).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(flight.duration(), 30.0, "{name}");
    }
}

#[test]
fn a_sequence_leaves_plots_numbers_and_json() {
    let folder = empty_folder("cli", "over-time");
    let (json, out, cache) = (folder.join("a.json"), folder.join("out"), folder.join("cache"));
    let measured =
        ["bench", "rooms-switched", "--technique", "direct,rsm", "--warmup", "0", "--size", "32x24", "--animate=4"];
    let asked = ["--frames", "3", "--lag", "--reference", "16", "--over-time", text(&out), "--json", text(&json)];
    let mut command = Command::new(env!("CARGO_BIN_EXE_irradia"));
    let output =
        command.args([&measured[..], &asked].concat()).env("IRRADIA_CACHE_DIR", &cache).output().expect("starts");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let tables = String::from_utf8_lossy(&output.stdout);
    assert!(tables.contains("3 frames played at 4 a second") && tables.contains("flicker"), "{tables}");
    let report: Report = serde_json::from_str(&fs::read_to_string(&json).expect("written")).expect("the schema");
    assert_eq!(report.runs.len(), 2);
    for run in &report.runs {
        let over_time = run.over_time.as_ref().expect("played");
        assert_eq!((over_time.fps, over_time.frames.len(), run.frames), (4.0, 3, 3));
        let errors: Vec<f64> =
            over_time.frames.iter().map(|frame| frame.error.as_ref().expect("compared")["direct"].rrmse).collect();
        // The third frame has other lamps, and its own reference: the error stays small.
        assert!(errors.iter().all(|error| *error < 0.2), "{errors:?}");
        assert_eq!(errors[0], errors[1], "nothing moved");
        assert_ne!(errors[1], errors[2], "lamps went off");
    }
    // Two kinds of light paths at two times.
    assert_eq!(names_in(&cache).iter().filter(|name| name.ends_with(".exr")).count(), 4, "{:?}", names_in(&cache));
    let plots = [
        "rooms-switched-direct-default-passes.svg",
        "rooms-switched-frames.svg",
        "rooms-switched-rsm-default-passes.svg",
    ];
    assert_eq!(names_in(&out), [&["frames.csv"], &plots[..]].concat());
    let csv = fs::read_to_string(out.join("frames.csv")).expect("written");
    assert_eq!(csv.lines().count(), 1 + 2 * 3);
    let svg = fs::read_to_string(out.join("rooms-switched-frames.svg")).expect("written");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
}
