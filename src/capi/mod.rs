//! The C interface: `include/irradia.h`, which is written from this module (`cbindgen.toml`).
//!
//! | file | idea |
//! |---|---|
//! | `status` | what a call returns, and the sentence that goes with it |
//! | `border` | what stands around every call: panics, handles, who uses them |
//! | `descriptor` | structs that begin with their size |
//! | `text`, `matrix` | C strings in and out, matrices in |
//! | `log`, `workers` | what the library says, and the threads that it says it from |
//! | `context`, `vulkan` | devices, the library's or the host's |
//! | `scene/` | scenes, and the things in them |
//! | `renderer`, `options` | settings |
//! | `camera`, `slots`, `frame`, `pixels`, `targets`, `shared`, `timings` | frames, what they show, where that goes, what they cost |
//!
//! Every type here is the host's: plain old data by value, or a handle behind a pointer. No number that comes in becomes a Rust enum or `bool` unchecked.

#![allow(unsafe_code, reason = "the border to C: pointers come in")]
#![allow(clippy::missing_safety_doc, reason = "what all pointers must be is said once, on the header's first page")]

#[cfg(not(panic = "unwind"))]
compile_error!("the C library catches panics at its border: build it with panic = \"unwind\"");

mod border;
mod camera;
mod context;
mod descriptor;
mod frame;
mod log;
mod matrix;
mod options;
mod pixels;
mod renderer;
mod scene;
mod shared;
mod slots;
mod status;
mod targets;
mod text;
mod timings;
mod vulkan;
mod workers;

pub use camera::*;
pub use context::*;
pub use frame::*;
pub use log::*;
pub use options::*;
pub use pixels::*;
pub use renderer::*;
pub use scene::*;
pub use shared::*;
pub use slots::*;
pub use status::*;
pub use targets::*;
pub use timings::*;
pub use vulkan::*;

/// Version of this header: major · 10000 + minor · 100 + patch. While the major version is 0, another minor version may change what is here.
pub const IRRADIA_VERSION: u32 = 100;

/// The version of the library, in the form of IRRADIA_VERSION: that of the header that it was built with. Needs nothing, from any thread.
#[unsafe(no_mangle)]
pub extern "C" fn irradia_version() -> u32 {
    IRRADIA_VERSION
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_version_is_the_crates() {
        let parts: Vec<u32> =
            env!("CARGO_PKG_VERSION").split('.').map(|part| part.parse().expect("a number")).collect();
        assert_eq!(super::IRRADIA_VERSION, parts[0] * 10_000 + parts[1] * 100 + parts[2]);
    }
}
