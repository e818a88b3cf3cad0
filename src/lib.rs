//! irradia: a headless Vulkan engine for global illumination.

pub mod bench;
pub mod metrics;
pub mod output;
pub mod reference;
pub mod renderer;
pub mod scene;

mod caustics;
mod diffuse;
mod frame;
#[cfg(test)]
mod gpu_tests;
mod graph;
#[allow(unsafe_code, reason = "the one home of Vulkan calls")]
mod vulkan;

/// The typed side of every shader program, generated from the SPIR-V by build.rs.
#[allow(dead_code, unreachable_pub, reason = "generated: not every struct of every shader is named by the host")]
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}
