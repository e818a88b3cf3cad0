//! The build script of the published package (`ci/package-crate`), whose shaders were compiled when it was made: it puts them where the library looks for them.

use std::path::{Path, PathBuf};
use std::process::exit;
use std::{env, fs};

fn main() {
    if env::args().len() > 1 {
        // A debug build takes shaders from the folder IRRADIA_SHADERS and asks its build script to compile them.
        eprintln!(
            "this is the published package, which has no compiler of GLSL: unset IRRADIA_SHADERS, or work in a checkout"
        );
        exit(1);
    }
    println!("cargo::rerun-if-changed=compiled");
    let this = env::current_exe().expect("the build script knows where it lies");
    println!("cargo::rustc-env=IRRADIA_SHADER_COMPILER={}", this.display());
    let out_dir = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    if let Err(message) = copy(Path::new("compiled"), &out_dir) {
        println!("cargo::error={message}");
        exit(1);
    }
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let fault = |path: &Path, error| format!("{}: {error}", path.display());
    for entry in fs::read_dir(from).map_err(|error| fault(from, error))? {
        let path = entry.map_err(|error| fault(from, error))?.path();
        let Some(name) = path.file_name() else { continue };
        fs::copy(&path, to.join(name)).map_err(|error| fault(&path, error))?;
    }
    Ok(())
}
