//! Debug builds take their shaders from the folder that `IRRADIA_SHADERS` names, if it names one: a change to GLSL then
//! costs no build of Rust. The build script, which lies where cargo left it, compiles each program when it is first used.

use std::collections::HashMap;
use std::ffi::OsString;
use std::process::Command;
use std::sync::{LazyLock, Mutex, PoisonError};

use super::error::VulkanError;

const VARIABLE: &str = "IRRADIA_SHADERS";
const COMPILER: &str = env!("IRRADIA_SHADER_COMPILER");
/// Names of the programs, and of what the host takes for granted about each.
const INTERFACES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/interfaces.rs"));

/// The SPIR-V of each stage.
type Stages = Vec<Vec<u32>>;

static FOLDER: LazyLock<Option<OsString>> =
    LazyLock::new(|| std::env::var_os(VARIABLE).filter(|folder| !folder.is_empty()));
/// Each program that was used so far.
static COMPILED: LazyLock<Mutex<HashMap<&'static str, Stages>>> = LazyLock::new(Mutex::default);

/// The stages of a program as its files are now; `None` if the variable is not set.
pub(super) fn spirv(program: &'static str) -> Result<Option<Stages>, VulkanError> {
    let Some(folder) = &*FOLDER else { return Ok(None) };
    let mut compiled = COMPILED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(stages) = compiled.get(program) {
        return Ok(Some(stages.clone()));
    }
    let stages = compile(folder, program).map_err(VulkanError::Shader)?;
    compiled.insert(program, stages.clone());
    Ok(Some(stages))
}

fn compile(folder: &OsString, program: &str) -> Result<Stages, String> {
    let known = INTERFACES.iter().find(|(name, _)| *name == program);
    let interface = known.map_or("", |(_, interface)| *interface);
    let answer = Command::new(COMPILER).arg(folder).args([program, interface]).output().map_err(|error| {
        format!(
            "{VARIABLE} is set, but the build script that compiles shaders does not start ({error}): run cargo build"
        )
    })?;
    if !answer.status.success() {
        return Err(String::from_utf8_lossy(&answer.stderr).trim_end().to_owned());
    }
    let mut stages = Vec::new();
    let mut rest = &answer.stdout[..];
    while let Some((length, after)) = rest.split_first_chunk() {
        let (bytes, after) = after.split_at(u64::from_le_bytes(*length) as usize);
        stages.push(bytes.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)).collect());
        rest = after;
    }
    Ok(stages)
}
