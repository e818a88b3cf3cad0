//! Where files go, and what becomes of a file that is already there. The tests render, so they need a Vulkan device.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::files::{empty_folder, names_in};

fn folder(test: &str) -> PathBuf {
    empty_folder("output-files", test)
}

fn render(output: &Path, more: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_irradia"));
    program.args(["render", "cornell-point", "--size", "16x16", "-o"]).arg(output).args(more);
    program.output().expect("the program starts")
}

/// Fails with one sentence that names the file or its folder.
fn assert_fails(output: &Path, words: &[&str]) {
    let done = render(output, &[]);
    let message = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{message}");
    assert!(message.starts_with("irradia: ") && message.lines().count() == 1, "{message}");
    for word in words {
        assert!(message.contains(word), "{word} is not in: {message}");
    }
}

#[test]
fn a_file_that_is_there_is_replaced_not_overwritten() {
    let folder = folder("replace");
    let (file, other_name) = (folder.join("a.png"), folder.join("b"));
    fs::write(&file, "old").expect("the test's own folder");
    fs::hard_link(&file, &other_name).expect("the target folder knows hard links");
    let done = render(&file, &[]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(fs::read(&file).expect("written").starts_with(b"\x89PNG"));
    assert_eq!(fs::read(&other_name).expect("the old file"), b"old", "the old file itself was written to");
    assert_eq!(names_in(&folder), ["a.png", "b"]);
}

#[test]
fn a_failure_leaves_the_file_that_is_there() {
    let folder = folder("keep");
    let file = folder.join("a.png");
    fs::write(&file, "old").expect("the test's own folder");
    assert_eq!(render(&file, &["--device", "no-such-device"]).status.code(), Some(1));
    assert_eq!(fs::read(&file).expect("the old file"), b"old");
    assert_eq!(names_in(&folder), ["a.png"]);
}

#[test]
fn a_place_that_takes_no_file_is_a_failure() {
    let folder = folder("no-place");
    assert_fails(&folder.join("none").join("a.png"), &["none", "there is no folder"]);
    fs::create_dir(folder.join("a.png")).expect("the test's own folder");
    assert_fails(&folder.join("a.png"), &["a.png"]);
    fs::write(folder.join("file"), []).expect("the test's own folder");
    assert_fails(&folder.join("file").join("a.png"), &["file"]);
    assert_eq!(names_in(&folder), ["a.png", "file"]);
}

/// A pipe of a name, and a thread that reads it to its end.
#[cfg(unix)]
fn named_pipe(path: &Path) -> std::thread::JoinHandle<Vec<u8>> {
    let made = Command::new("mkfifo").arg(path).status().expect("mkfifo is there");
    assert!(made.success());
    let path = path.to_owned();
    std::thread::spawn(move || fs::read(path).expect("the pipe can be read"))
}

#[cfg(unix)]
#[test]
fn a_pipe_is_opened_once_and_gets_everything() {
    let folder = folder("pipe");
    let (picture, graph) = (folder.join("a.exr"), folder.join("a.dot"));
    let reader = named_pipe(&picture);
    let done = render(&picture, &[]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(reader.join().expect("it reads").starts_with(&[0x76, 0x2f, 0x31, 0x01]), "the magic number of an EXR");
    let reader = named_pipe(&graph);
    let mut program = Command::new(env!("CARGO_BIN_EXE_irradia"));
    let done = program.args(["graph", "plane", "--size", "16x16", "--dot"]).arg(&graph).output().expect("it starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(reader.join().expect("it reads").starts_with(b"digraph"));
    assert_eq!(names_in(&folder), ["a.dot", "a.exr"]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_goes_to_the_standard_output_joins_what_is_there() {
    let folder = folder("standard-output");
    let path = folder.join("all.txt");
    fs::write(&path, "before\n").expect("the test's own folder");
    let output = fs::OpenOptions::new().append(true).open(&path).expect("it is there");
    let mut program = Command::new(env!("CARGO_BIN_EXE_irradia"));
    program.args(["graph", "plane", "--size", "16x16", "--dot", "/dev/stdout"]).stdout(output);
    assert!(program.status().expect("it starts").success());
    let text = fs::read_to_string(&path).expect("it is there");
    let graph = text.find("digraph").expect("what the option asks for");
    let table = text.find("\npass").or(text.find("compose")).expect("what the command prints");
    assert!(text.starts_with("before\n") && graph < text.len() && table > 0, "{text}");
    assert_eq!(names_in(&folder), ["all.txt"]);
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "a folder that even root cannot write to")]
fn a_folder_that_cannot_be_written_to_is_a_failure() {
    assert_fails(Path::new("/proc/a.png"), &["/proc"]);
}
