//! Programs of other languages that use the C library (`tests/hosts/`). They need a C compiler; those that make frames need a Vulkan device.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use irradia::output::read_exr;

use crate::files::empty_folder;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn succeed(command: &mut Command) -> Output {
    let done = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{command:?}: {}\n{}{said}", done.status, String::from_utf8_lossy(&done.stdout));
    done
}

/// The folder with the shared library, built once: without the program, plots and FLIP, as `ci/package` does.
fn library() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let target = Path::new(env!("CARGO_BIN_EXE_irradia")).parent().and_then(Path::parent).expect("target/debug");
        let mut cargo = Command::new(option_env!("CARGO").unwrap_or("cargo"));
        cargo.current_dir(root()).args(["rustc", "--lib", "--crate-type", "cdylib", "--no-default-features"]);
        cargo.args(["--features", "capi", "--message-format", "short", "--target-dir"]).arg(target);
        succeed(&mut cargo);
        target.join("debug")
    })
}

struct Host {
    program: PathBuf,
}

impl Host {
    /// Compiles a host without a warning.
    fn compile(compiler: &str, name: &str, sources: &[&str], more: &[&str]) -> Host {
        let folder = empty_folder("hosts", name);
        let program = folder.join("host");
        let mut command = Command::new(compiler);
        command.current_dir(root()).args(["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-g", "-Iinclude"]);
        command.args(more).args(sources.iter().map(|source| format!("tests/hosts/{source}")));
        command.arg("-o").arg(&program).arg("-L").arg(library()).args(["-lirradia", "-lm", "-ldl", "-lpthread"]);
        succeed(&mut command);
        Host { program }
    }

    fn c(name: &str) -> Host {
        Host::compile("cc", name, &["host.c"], &["-std=c99"])
    }

    /// With the address and leak sanitizers, which leave out what drivers and the loader leak.
    fn sanitized(name: &str) -> Host {
        let sources = ["host.c", "keep_loaded.c"];
        Host::compile("cc", name, &sources, &["-std=c99", "-fsanitize=address", "-rdynamic"])
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.args(arguments).env("LD_LIBRARY_PATH", library()).env("ASAN_OPTIONS", "detect_leaks=1");
        let suppressions = root().join("tests/hosts/leaks-of-others");
        command.env("LSAN_OPTIONS", format!("suppressions={}", suppressions.display()));
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let done = succeed(&mut self.command(arguments));
        let said = [&done.stdout, &done.stderr].map(|said| String::from_utf8_lossy(said));
        // What is held is the host's own word.
        assert!(
            said[0].is_empty() || arguments[0] == "memory",
            "the library says nothing on the terminal: {}",
            said[0]
        );
        assert!(said[1].is_empty(), "the library says nothing on the terminal: {}", said[1]);
        done
    }

    fn file(&self, name: &str) -> PathBuf {
        self.program.with_file_name(name)
    }
}

/// What the command line makes of the scene that hosts show, as their files have it.
fn shown_by_the_program(folder: &Path) -> Vec<u8> {
    let file = folder.join("program.exr");
    let mut program = Command::new(env!("CARGO_BIN_EXE_irradia"));
    program.args(["render", "cornell-point", "--technique", "hybrid", "--size", "64x48", "-o"]).arg(&file);
    succeed(&mut program);
    let image = read_exr(&file).expect("an image");
    let image = image.image;
    image.pixels.iter().flatten().flat_map(|value| value.to_ne_bytes()).collect()
}

fn assert_same_picture(file: &Path) {
    let host = std::fs::read(file).expect("written by the host");
    let program = shown_by_the_program(file.parent().expect("a folder"));
    assert_eq!(host.len(), program.len());
    assert!(host == program, "the host's picture differs from the program's");
}

#[test]
fn a_c_program_uses_everything_and_sees_what_the_program_shows() {
    let host = Host::c("c");
    let file = host.file("host.raw");
    let mut command = host.command(&["all", file.to_str().expect("UTF-8")]);
    // More than the driver has: the host counts them, and none is to be of a pool that no context owns.
    succeed(command.env("HOST_VALIDATION", "1").env("RAYON_NUM_THREADS", "12"));
    assert_same_picture(&file);
}

/// A device, a queue and images of the host's own; the library opens no loader, and frames come to the host without passing through its memory.
#[test]
fn a_cpp_program_lends_its_device_and_reads_frames_there() {
    let host = Host::compile("c++", "cpp", &["host.cpp"], &["-std=c++17", "-rdynamic", "-O1"]);
    let (shader, file) = (host.file("double.spv"), host.file("host.raw"));
    let source = std::fs::read_to_string(root().join("tests/hosts/double.comp")).expect("a shader");
    let compiler = shaderc::Compiler::new().expect("the compiler of the build");
    let code = compiler.compile_into_spirv(&source, shaderc::ShaderKind::Compute, "double.comp", "main", None);
    std::fs::write(&shader, code.expect("it compiles").as_binary_u8()).expect("the test's own folder");
    let paths = [&shader, &file].map(|path| path.to_str().expect("UTF-8"));
    succeed(host.command(&paths).env("HOST_VALIDATION", "1"));
    assert_same_picture(&file);
}

/// The memory of a frame, handed on as a file descriptor.
#[test]
fn a_second_process_sees_a_frame_where_it_was_left() {
    let more = ["-std=c99", "-Wno-missing-field-initializers", "-Wl,--no-as-needed", "-lvulkan"];
    let host = Host::compile("cc", "share", &["share.c"], &more);
    let file = host.file("host.raw");
    let done = succeed(&mut host.command(&[file.to_str().expect("UTF-8")]));
    let said = String::from_utf8_lossy(&done.stdout);
    if said.starts_with("no export") {
        println!("{said}");
        return;
    }
    assert_same_picture(&file);
}

#[test]
fn wrong_use_is_a_status_and_a_sentence() {
    Host::c("wrong").run(&["wrong"]);
}

#[test]
fn nothing_leaks_and_no_memory_is_misused() {
    let host = Host::sanitized("sanitized");
    let file = host.file("host.raw");
    host.run(&["all", file.to_str().expect("UTF-8")]);
    host.run(&["wrong"]);
    // The host compares what is held after 10 contexts and after all.
    host.run(&["memory", "30"]);
}

/// Valgrind knows nothing of what drivers do, and sees all that the library does without one.
#[test]
fn scenes_are_built_without_a_fault_of_memory() {
    let host = Host::c("scene");
    host.run(&["scene"]);
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("there is no valgrind here");
        return;
    }
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite"]);
    valgrind.args(["--show-leak-kinds=definite"]).arg(&host.program).arg("scene").env("LD_LIBRARY_PATH", library());
    succeed(&mut valgrind);
}

#[test]
fn the_header_is_c_and_cpp() {
    for (compiler, language, standard) in [("cc", "c", "c99"), ("c++", "c++", "c++17")] {
        let mut command = Command::new(compiler);
        command.current_dir(root()).args(["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only"]);
        succeed(command.arg(format!("-std={standard}")).args(["-x", language, "include/irradia.h"]));
    }
}

/// A symbol that others might have too would meet theirs in the host's process.
#[test]
fn the_library_shows_its_own_names_alone() {
    let done = succeed(Command::new("nm").args(["-D", "--defined-only"]).arg(library().join("libirradia.so")));
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    let names: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().last()).collect();
    let strange: Vec<&&str> = names.iter().filter(|name| !name.starts_with("irradia_")).collect();
    assert!(strange.is_empty() && names.len() > 30, "{strange:?}");
    let listed = std::fs::read_to_string(root().join("include/symbols.txt")).expect("the list of symbols");
    let listed: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    let listed: std::collections::BTreeSet<&str> = listed.into_iter().filter(|name| !name.starts_with('#')).collect();
    let names: std::collections::BTreeSet<&str> = names.into_iter().collect();
    assert_eq!(
        names, listed,
        "include/symbols.txt lists what the library shows, each with the version that it came with"
    );
}

#[test]
fn a_python_program_sees_what_the_program_shows() {
    let file = empty_folder("hosts", "python").join("host.raw");
    let mut python = Command::new("python3");
    python.arg(root().join("tests/hosts/host.py")).arg(&file).env("PYTHONPATH", root().join("examples/python"));
    succeed(python.env("IRRADIA_LIBRARY", library().join("libirradia.so")).env("PYTHONDONTWRITEBYTECODE", "1"));
    assert_same_picture(&file);
}
