//! Debug builds take shaders from the folder that `IRRADIA_SHADERS` names, without a build. These tests render, so they need a
//! Vulkan device.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use irradia::output::read_exr;

use crate::files::empty_folder;

const COMPOSITION: &str = "compose/image.comp";
const RESULT: &str = "vec4(radiance, 1.0)";
const LAST_CONSTANT: &str = "uint slots;";

/// A copy of `glsl/`.
fn shaders(test: &str) -> PathBuf {
    fn copy(from: &Path, to: &Path) {
        fs::create_dir_all(to).expect("the target folder is writable");
        for entry in fs::read_dir(from).expect("a folder") {
            let (path, to) = entry.map(|entry| (entry.path(), to.join(entry.file_name()))).expect("readable");
            if path.is_dir() { copy(&path, &to) } else { assert!(fs::copy(&path, &to).is_ok()) }
        }
    }
    let folder = empty_folder("live-shaders", test).join("shaders");
    copy(&Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl"), &folder);
    folder
}

fn edit(shaders: &Path, before: &str, after: &str) {
    let path = shaders.join(COMPOSITION);
    let source = fs::read_to_string(&path).expect("the shader is there");
    assert!(source.contains(before), "{COMPOSITION} holds no {before}");
    fs::write(path, source.replace(before, after)).expect("the test's own folder");
}

fn render(shaders: Option<&Path>, to: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_irradia"));
    command.args(["render", "cornell-point", "--size", "24x16", "-o"]).arg(to).env_remove("IRRADIA_SHADERS");
    if let Some(folder) = shaders {
        command.env("IRRADIA_SHADERS", folder);
    }
    command.output().expect("the program starts")
}

fn picture(shaders: Option<&Path>, to: &Path) -> Vec<[f32; 3]> {
    let output = render(shaders, to);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    read_exr(to).expect("an EXR of ours").image.pixels
}

fn complaint(shaders: &Path) -> String {
    let output = render(Some(shaders), &shaders.with_file_name("none.exr"));
    assert_eq!(output.status.code(), Some(1));
    String::from_utf8(output.stderr).expect("text")
}

#[test]
fn a_changed_shader_changes_the_picture_without_a_build() {
    let shaders = shaders("picture");
    let file = |name: &str| shaders.with_file_name(name);
    let built_in = picture(None, &file("built-in.exr"));
    assert!(built_in.iter().flatten().any(|value| *value > 0.0));
    assert_eq!(picture(Some(&shaders), &file("same.exr")), built_in);
    edit(&shaders, RESULT, "vec4(2.0 * radiance, 1.0) /* what it computes is no part of its interface */");
    let doubled: Vec<[f32; 3]> = built_in.iter().map(|pixel| pixel.map(|value| 2.0 * value)).collect();
    assert_eq!(picture(Some(&shaders), &file("doubled.exr")), doubled);
}

#[test]
fn a_shader_that_binds_other_things_than_the_program_is_refused() {
    let shaders = shaders("interface");
    edit(&shaders, LAST_CONSTANT, "uint slots; float gain;");
    let message = complaint(&shaders);
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(message.starts_with("irradia: the interface of compose/image has changed"), "{message}");
}

#[test]
fn a_shader_that_does_not_compile_is_named_with_its_line() {
    let shaders = shaders("error");
    edit(&shaders, RESULT, "vec4(radiant, 1.0)");
    let message = complaint(&shaders);
    assert!(message.contains("image.comp:") && message.contains("radiant"), "{message}");
    fs::remove_file(shaders.join(COMPOSITION)).expect("it was there");
    let message = complaint(&shaders);
    assert!(message.contains("holds no compose/image"), "{message}");
}
