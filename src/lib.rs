//! irradia: a headless Vulkan engine for global illumination.
//!
//! [`renderer`] makes frames of a [`scene`]; [`mod@bake`] writes its light into a scene that any viewer shows; [`metrics`] says how far they are from a [`mod@reference`]. Features: `cli` (the program), `plots` (the module `bench`), `flip` (FLIP among the
//! errors; compiles C++), all on by default, and `capi` (the C interface).

pub mod bake;
#[cfg(feature = "plots")]
pub mod bench;
#[cfg(feature = "capi")]
pub mod capi;
pub mod image;
pub mod metrics;
pub mod output;
pub mod reference;
pub mod renderer;
pub mod scene;
pub mod slot;

/// Vectors and matrices of this interface, in the version that it takes.
pub use glam;

mod caustics;
mod diffuse;
mod direct;
mod estimator;
mod frame;
#[cfg(test)]
mod gpu_tests;
mod graph;
mod method;
#[allow(dead_code, unreachable_pub, reason = "generated: not every struct of every shader is named by the host")]
mod shaders;
mod specular;
#[allow(unsafe_code, reason = "the one home of Vulkan calls")]
mod vulkan;
