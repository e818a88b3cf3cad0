//! Machines on which Vulkan is absent or not what was asked for: one sentence that says what to do, status 1, no file.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::files::empty_folder;

fn folder(test: &str) -> PathBuf {
    empty_folder("no-vulkan", test)
}

/// Runs every subcommand that needs a device with `variables` set and `arguments` added.
fn assert_all_fail(test: &str, variables: &[(&str, &Path)], arguments: &[&str], words: &[&str]) {
    let folder = folder(test);
    let file = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let commands: [&[&str]; 6] = [
        &["render", "cornell-point", "-o", &file("a.exr")],
        &["render", "cornell-point", "-o", &file("a.png"), "--frames", "0..2"],
        &[
            "bench",
            "cornell-point",
            "ring",
            "--json",
            &file("a.json"),
            "--md",
            &file("a.md"),
            "--images",
            &file("images"),
        ],
        &["graph", "cornell-point", "--dot", &file("a.dot")],
        &["reference", "cornell-point", "--spp", "16", "--no-cache", "-o", &file("a.exr")],
        &["bake", "cornell-point", "-o", &file("a.glb")],
    ];
    for command in commands {
        let size: &[&str] = if command[0] == "bake" { &[] } else { &["--size", "16x16"] };
        let mut program = Command::new(env!("CARGO_BIN_EXE_irradia"));
        let output = program
            .args(command)
            .args(arguments)
            .args(size)
            .envs(variables.iter().copied())
            .output()
            .expect("the program starts");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{command:?}: {message}");
        assert!(message.starts_with("irradia: "), "{command:?}: {message}");
        assert_eq!(message.lines().count(), 1, "{command:?}: {message}");
        assert!(!message.contains("panicked"), "{command:?}: {message}");
        for word in words {
            assert!(message.contains(word), "{command:?}: {word} is not in: {message}");
        }
        assert!(output.stdout.is_empty(), "{command:?}");
    }
    let left: Vec<_> = fs::read_dir(&folder).expect("the test's own folder").collect();
    assert!(left.is_empty(), "{left:?}");
}

/// A folder whose `libvulkan.so.1` is an empty file: the dynamic linker finds it first and cannot load it.
fn broken_loader(test: &str) -> PathBuf {
    let folder = folder(test);
    fs::write(folder.join("libvulkan.so.1"), []).expect("the test's own folder");
    folder
}

#[test]
#[cfg_attr(not(all(target_os = "linux", target_env = "gnu")), ignore = "hides the loader as glibc does")]
fn without_a_loader() {
    let loader = broken_loader("loader-of-all");
    let words = ["no Vulkan loader was found", "apt install", "libvulkan1"];
    assert_all_fail("loader", &[("LD_LIBRARY_PATH", &loader)], &[], &words);
    let mut program = Command::new(env!("CARGO_BIN_EXE_irradia"));
    let scenes = program.arg("scenes").env("LD_LIBRARY_PATH", &loader).output().expect("the program starts");
    assert!(scenes.status.success(), "a list of scenes needs no Vulkan");
}

/// Loaders before 1.3.207 know the second variable alone.
fn drivers(manifest: &Path) -> [(&'static str, &Path); 2] {
    [("VK_DRIVER_FILES", manifest), ("VK_ICD_FILENAMES", manifest)]
}

#[test]
fn without_a_driver() {
    let words = ["no Vulkan device was found", "apt install", "mesa-vulkan-drivers"];
    assert_all_fail("driver", &drivers(Path::new("/nonexistent/driver.json")), &[], &words);
}

#[test]
fn with_a_driver_that_cannot_be_loaded() {
    let manifest = folder("manifest").join("driver.json");
    let text =
        r#"{"file_format_version":"1.0.0","ICD":{"library_path":"/nonexistent/driver.so","api_version":"1.3.0"}}"#;
    fs::write(&manifest, text).expect("the test's own folder");
    assert_all_fail("broken-driver", &drivers(&manifest), &[], &["no Vulkan device was found"]);
    fs::write(&manifest, "{").expect("the test's own folder");
    assert_all_fail("broken-manifest", &drivers(&manifest), &[], &["no Vulkan device was found"]);
}

#[test]
fn with_a_device_that_does_not_exist() {
    assert_all_fail("device-name", &[], &["--device", "no-such-device"], &["no-such-device"]);
    assert_all_fail("device-index", &[], &["--device", "4096"], &["4096"]);
}

#[test]
#[cfg_attr(not(all(target_os = "linux", target_env = "gnu")), ignore = "hides the loader as glibc does")]
fn devices_says_that_there_are_none() {
    let loader = broken_loader("loader-of-devices");
    let no_loader = [("LD_LIBRARY_PATH", loader.as_path())];
    let no_driver = drivers(Path::new("/nonexistent/driver.json"));
    for variables in [&no_loader[..], &no_driver[..]] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_irradia"));
        let output = program.arg("devices").envs(variables.iter().copied()).output().expect("the program starts");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(message.contains("install"), "{message}");
    }
}

#[test]
fn without_validation_layers_although_asked_for() {
    let empty = folder("no-layers");
    let words = ["VK_LAYER_KHRONOS_validation", "vulkan-validationlayers"];
    assert_all_fail("layers", &[("VK_LAYER_PATH", &empty)], &["--validation", "sync"], &words);
}
