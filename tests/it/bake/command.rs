//! The command: its files, and what it says of what cannot be baked.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use irradia::output::read_exr;
use irradia::renderer::Slot;
use irradia::scene::Scene;

use crate::files::{empty_folder, names_in};

fn folder(test: &str) -> PathBuf {
    empty_folder("bake", test)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("the target folder is UTF-8")
}

fn irradia(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_irradia")).arg("bake").args(arguments).output().expect("the program starts")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Coarse, so that it takes next to no time.
const COARSE: [&str; 4] = ["--set", "lightmaps.count=200", "--set", "lightmaps.rays=16"];

#[test]
fn two_files_appear_and_replace_older_ones() {
    let folder = folder("files");
    let (glb, exr) = (folder.join("a.b.glb"), folder.join("a.b.irradiance.exr"));
    fs::write(&glb, "old").expect("the test's own folder");
    for detail in ["1", "2"] {
        let lamp = "point:0,1,0,2";
        let arguments =
            ["cornell-point", "-o", text(&glb), "--detail", detail, "--validation", "sync", "--light", lamp];
        let output = irradia(&[&arguments[..], &COARSE].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(stderr(&output).contains("a.b.irradiance.exr") && output.stdout.is_empty(), "{}", stderr(&output));
        assert_eq!(names_in(&folder), ["a.b.glb", "a.b.irradiance.exr"]);
        let read = read_exr(&exr).expect("an EXR of ours");
        assert_eq!((&*read.attributes["quantity"], &*read.attributes["detail"]), ("irradiance, W/m²", detail));
        let said = |name: &str, word: &str| assert!(read.attributes[name].contains(word), "{:?}", read.attributes);
        said("settings", "\"settle\":\"always\"");
        said("lights", lamp);
        said("sky", "[0.0,0.0,0.0]");
        assert!(["device", "driver", "api"].iter().all(|name| !read.attributes[*name].is_empty()));
        assert_eq!(read.slots.keys().copied().collect::<Vec<_>>(), [Slot::Direct, Slot::Diffuse, Slot::Caustics]);
        let scene = Scene::open(text(&glb)).expect("a scene");
        assert_eq!([scene.textures()[0].width, scene.textures()[0].height], read.image.size);
        for (number, pixel) in read.image.pixels.iter().enumerate() {
            let sum: f32 = read.slots.values().map(|slot| slot.pixels[number][0]).sum();
            assert!((sum - pixel[0]).abs() <= 1e-4 * pixel[0], "{number}: {sum} {}", pixel[0]);
        }
    }
}

#[test]
fn what_cannot_be_baked_is_said_in_one_sentence() {
    let folder = folder("failures");
    let glb = folder.join("a.glb");
    let own = folder.join("own.glb");
    fs::write(&own, fs::read("scenes/plane.glb").expect("a scene of ours")).expect("the test's own folder");
    let missing = folder.join("none/a.glb");
    let cases: [(&[&str], &[&str]); 6] = [
        (&["no-such-scene", "-o", text(&glb)], &["no-such-scene"]),
        (&["cornell-point", "-o", text(&missing)], &["there is no folder"]),
        (&[text(&own), "-o", text(&own)], &["is the scene itself"]),
        (&["cornell-point", "-o", text(&glb), "--preset", "paper"], &["lightmaps.source=rays"]),
        (&["cornell-point", "-o", text(&glb), "--set", "lightmaps.bounces=0"], &["nothing to bake"]),
        (&["cornell-point", "-o", text(&glb), "--texel=-1"], &["lightmaps.texel", "0 to 1000000"]),
    ];
    for (arguments, words) in cases {
        let output = irradia(&[arguments, &["-q"]].concat());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
        assert!(message.starts_with("irradia: ") && message.lines().count() == 1, "{arguments:?}: {message}");
        assert!(words.iter().all(|word| message.contains(word)), "{arguments:?}: {message}");
        assert_eq!(names_in(&folder), ["own.glb"], "{arguments:?}");
    }
    let wrong: [(&[&str], &str); 5] = [
        (&["cornell-point", "-o", text(&glb), "--set", "lightmaps.show=received"], "change nothing"),
        (&["cornell-point", "-o", "a.gltf"], ".glb"),
        (&["cornell-point"], "--output"),
        (&["cornell-point", "-o", text(&glb), "--set", "rsm.vpls=64"], "lightmaps"),
        (&["cornell-point", "-o", text(&glb), "--detail", "0"], "--detail"),
    ];
    for (arguments, word) in wrong {
        let output = irradia(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(word), "{arguments:?}: {}", stderr(&output));
    }
}

/// Of two files that belong together one is not replaced alone.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_both_files() {
    let folder = folder("full");
    let both = [folder.join("a.glb"), folder.join("a.irradiance.exr")];
    for (full, stays) in [(0, 1), (1, 0)] {
        both.iter().for_each(|path| drop(fs::remove_file(path)));
        std::os::unix::fs::symlink("/dev/full", &both[full]).expect("the test's own folder");
        fs::write(&both[stays], "old").expect("the test's own folder");
        let output = irradia(&[&["cornell-point", "-o", text(&both[0]), "--detail", "1", "-q"][..], &COARSE].concat());
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        assert!(stderr(&output).contains("No space left"), "{}", stderr(&output));
        assert!(fs::read(&both[stays]).expect("there") == b"old", "{full}");
        assert_eq!(names_in(&folder), ["a.glb", "a.irradiance.exr"]);
    }
}
