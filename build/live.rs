//! Shaders for a debug build that runs already: it calls its build script when `IRRADIA_SHADERS` names a folder
//! (src/vulkan/live_shaders.rs is the other side).

use std::fmt::Write as _;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write as _;
use std::path::Path;
use std::{fs, io, slice};

use super::generate::{CompiledStage, Program, generate};
use super::groups::Group;

/// Names what host and shaders agree on: bindings, push constants, specialisation constants, sizes, shared structs. What a
/// shader computes, and its comments, are no part of it.
fn interface(program: &Program, groups: &[Group]) -> Result<String, String> {
    let source = generate(slice::from_ref(program), groups)?;
    let mut hasher = DefaultHasher::new();
    source.lines().filter(|line| !line.trim_start().starts_with("///")).for_each(|line| line.hash(&mut hasher));
    Ok(format!("{:016x}", hasher.finish()))
}

/// Writes the interfaces that the host is built with.
pub(crate) fn write_interfaces(programs: &[Program], groups: &[Group], out_dir: &Path) -> Result<(), String> {
    let mut list = String::from("&[\n");
    for program in programs {
        writeln!(list, "(\"{}/{}\", \"{}\"),", program.piece, program.pass, interface(program, groups)?).ok();
    }
    list.push_str("]\n");
    fs::write(out_dir.join("interfaces.rs"), list).map_err(|error| format!("interfaces.rs: {error}"))
}

/// Writes to standard output the SPIR-V of a program, stage by stage, each behind its length in bytes.
///
/// # Errors
/// A sentence, when there is no such program, or it has another interface than the host was built with.
pub(crate) fn answer(program: Option<&Program>, groups: &[Group], name: &str, expected: &str) -> Result<(), String> {
    let program = program.ok_or_else(|| format!("the folder that IRRADIA_SHADERS names holds no {name}"))?;
    if interface(program, groups)? != expected {
        return Err(format!(
            "the interface of {name} has changed since the program was built: build again without IRRADIA_SHADERS"
        ));
    }
    let mut out = io::stdout().lock();
    for CompiledStage { spirv, .. } in &program.stages {
        let length = (spirv.len() as u64).to_le_bytes();
        out.write_all(&length).and_then(|()| out.write_all(spirv)).map_err(|error| error.to_string())?;
    }
    out.flush().map_err(|error| error.to_string())
}
