//! Compiles `glsl/` to SPIR-V and generates the typed Rust side of every program (`src/shaders.rs` includes it).
//!
//! `glsl/<piece>/<pass>.<stage>`; files of the same stem are the stages of one program. `glsl/lib/` holds includes, `glsl/groups/`
//! those that declare bindings. A block of push constants is called `Push`; one of another name is one type for all programs that
//! declare it.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::exit;
use std::{env, fs};

#[path = "build/generate.rs"]
mod generate;
#[path = "build/groups.rs"]
mod groups;
#[path = "build/limits.rs"]
pub(crate) mod limits;
#[path = "build/live.rs"]
mod live;
#[path = "build/needs.rs"]
mod needs;
#[path = "build/reflect.rs"]
pub(crate) mod reflect;
#[path = "build/words.rs"]
mod words;

use generate::{CompiledStage, Program};
use groups::{Group, GroupFile};
use limits::Exception;
use shaderc::{CompileOptions, Compiler, EnvVersion, ResolvedInclude, ShaderKind, SpirvVersion, TargetEnv};

fn main() {
    if let [_, folder, program, interface] = &env::args().collect::<Vec<_>>()[..] {
        if let Err(message) = answer(Path::new(folder), program, interface) {
            eprintln!("{message}");
            exit(1);
        }
        return;
    }
    // While a debug build takes its shaders from a folder, a change to one of them need not build it anew.
    println!("cargo::rerun-if-env-changed=IRRADIA_SHADERS");
    if env::var_os("IRRADIA_SHADERS").is_none() || env::var("PROFILE").is_ok_and(|profile| profile != "debug") {
        println!("cargo::rerun-if-changed=glsl");
    }
    println!("cargo::rerun-if-changed=build");
    let compiler = env::current_exe().expect("the build script knows where it lies");
    println!("cargo::rustc-env=IRRADIA_SHADER_COMPILER={}", compiler.display());
    let out_dir = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    if let Err(message) = build(Path::new("glsl"), &out_dir, limits::EXCEPTIONS) {
        for line in message.lines() {
            println!("cargo::error={line}");
        }
        exit(1);
    }
}

pub(crate) fn build(root: &Path, out_dir: &Path, exceptions: &[Exception]) -> Result<(), String> {
    let compiler = compiler()?;
    let groups = read_groups(&compiler, root)?;
    let programs = programs(&compiler, root, &groups, |_, _| true)?;
    limits::check(&programs, exceptions)?;
    for stage in programs.iter().flat_map(|program| &program.stages) {
        fs::write(out_dir.join(&stage.spirv_file), &stage.spirv)
            .map_err(|error| format!("{}: {error}", stage.spirv_file))?;
    }
    live::write_interfaces(&programs, &groups, out_dir)?;
    let source = generate::generate(&programs, &groups)?;
    fs::write(out_dir.join("shaders.rs"), source).map_err(|error| format!("shaders.rs: {error}"))
}

/// Compiles one program for a debug build that runs already.
fn answer(root: &Path, name: &str, interface: &str) -> Result<(), String> {
    let compiler = compiler()?;
    let groups = read_groups(&compiler, root)?;
    let programs = programs(&compiler, root, &groups, |piece, pass| name == format!("{piece}/{pass}"))?;
    live::answer(programs.first(), &groups, name, interface)
}

fn compiler() -> Result<Compiler, String> {
    Compiler::new().map_err(|error| format!("shaderc did not start: {error}"))
}

/// Compiles the shaders below `root` whose piece and pass are `wanted`.
fn programs(
    compiler: &Compiler,
    root: &Path,
    groups: &[Group],
    wanted: impl Fn(&str, &str) -> bool,
) -> Result<Vec<Program>, String> {
    let mut programs: BTreeMap<(String, String), Program> = BTreeMap::new();
    for path in shader_files(root)? {
        let part =
            |part: Option<&std::ffi::OsStr>| part.map(|part| part.to_string_lossy().into_owned()).unwrap_or_default();
        let (piece, pass) = (part(path.parent().and_then(Path::file_name)), part(path.file_stem()));
        let (kind, stage_kind) = match part(path.extension()).as_str() {
            "comp" => ("Compute", ShaderKind::Compute),
            "vert" => ("Vertex", ShaderKind::Vertex),
            "geom" => ("Geometry", ShaderKind::Geometry),
            "frag" => ("Fragment", ShaderKind::Fragment),
            _ => continue,
        };
        if !wanted(&piece, &pass) {
            continue;
        }
        let source = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let (words, included) = compile(compiler, root, &path, &source, stage_kind)?;
        let in_file = |error| format!("{}: {error}", path.display());
        let stage = reflect::reflect(&words).map_err(in_file)?;
        for group in groups {
            group.check(&format!("{piece}/{pass}"), &stage, included.contains(&group.name))?;
        }
        let words = words::without_unused(&words, &words::static_use(&words).map_err(in_file)?).map_err(in_file)?;
        let spirv = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let spirv_file = format!("{piece}.{pass}.{}.spv", part(path.extension()));
        let new = || Program { piece: piece.clone(), pass: pass.clone(), summary: String::new(), stages: Vec::new() };
        let program = programs.entry((piece.clone(), pass.clone())).or_insert_with(new);
        if program.summary.is_empty() || stage_kind == ShaderKind::Fragment {
            program.summary = summary(&source).unwrap_or_else(|| format!("`glsl/{piece}/{pass}`."));
        }
        let needs = needs::needs(&words).map_err(in_file)?;
        program.stages.push(CompiledStage { kind, spirv_file, spirv, stage, needs });
    }
    let mut programs: Vec<Program> = programs.into_values().collect();
    for program in &mut programs {
        program.stages.sort_by_key(|stage| {
            ["Vertex", "Geometry", "Fragment", "Compute"].iter().position(|kind| *kind == stage.kind)
        });
    }
    Ok(programs)
}

/// The groups of `glsl/groups/`, each compiled by itself.
fn read_groups(compiler: &Compiler, root: &Path) -> Result<Vec<Group>, String> {
    let folder = root.join("groups");
    let mut files = Vec::new();
    for path in if folder.is_dir() { list(&folder)? } else { Vec::new() } {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let source = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let alone = format!(
            "#version 460\n#extension GL_EXT_scalar_block_layout : require\n#extension GL_EXT_control_flow_attributes : require\n\
             layout(scalar) uniform;\nlayout(scalar) buffer;\n#include \"groups/{name}.glsl\"\n\
             layout(local_size_x = 1) in;\nvoid main() {{}}\n"
        );
        let (words, mut includes) = compile(compiler, root, &path, &alone, ShaderKind::Compute)?;
        includes.remove(&name);
        let stage = reflect::reflect(&words).map_err(|error| format!("{}: {error}", path.display()))?;
        let summary = summary(&source).unwrap_or_else(|| format!("`glsl/groups/{name}.glsl`."));
        files.push(GroupFile { name, source, summary, stage, includes });
    }
    groups::groups(files)
}

fn list(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    Ok(paths)
}

/// All shader files below `root`, in a fixed order, without the includes.
fn shader_files(root: &Path) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    for folder in list(root)?.into_iter().filter(|path| path.is_dir() && !path.ends_with("lib")) {
        files.extend(list(&folder)?.into_iter().filter(|path| path.is_file()));
    }
    Ok(files)
}

/// The SPIR-V, and the groups that the source includes, directly or not. glslang's message already names file and line.
fn compile(
    compiler: &Compiler,
    root: &Path,
    path: &Path,
    source: &str,
    kind: ShaderKind,
) -> Result<(Vec<u32>, BTreeSet<String>), String> {
    let included = RefCell::new(BTreeSet::new());
    let mut options = CompileOptions::new().map_err(|error| format!("shaderc gave no options: {error}"))?;
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_3 as u32);
    options.set_target_spirv(SpirvVersion::V1_6);
    options.set_warnings_as_errors();
    options.set_include_callback(|name, _, from, _| {
        let path = root.join(name);
        if let Some(group) = name.strip_prefix("groups/").and_then(|file| file.strip_suffix(".glsl")) {
            included.borrow_mut().insert(group.to_owned());
        }
        let content =
            fs::read_to_string(&path).map_err(|error| format!("{from} includes {}: {error}", path.display()))?;
        Ok(ResolvedInclude { resolved_name: path.display().to_string(), content })
    });
    let compiled = compiler.compile_into_spirv(source, kind, &path.display().to_string(), "main", Some(&options));
    let compiled = compiled.map_err(|error| match error {
        shaderc::Error::CompilationError(_, log) => log,
        other => format!("{}: {other}", path.display()),
    })?;
    let words = compiled.as_binary().to_vec();
    drop((compiled, options));
    Ok((words, included.into_inner()))
}

/// The first sentence of the comment that a shader starts with.
fn summary(source: &str) -> Option<String> {
    let lines = source.lines().skip_while(|line| !line.trim_start().starts_with("//"));
    let comment: Vec<&str> = lines
        .take_while(|line| line.trim_start().starts_with("//"))
        .map(|line| line.trim().trim_start_matches('/').trim())
        .collect();
    let text = comment.join(" ");
    let end = text.find(". ").map_or(text.len(), |end| end + 1);
    let sentence = text[..end].trim().replace('[', "\\[").replace(']', "\\]").replace('<', "\\<");
    (!sentence.is_empty()).then_some(sentence)
}
