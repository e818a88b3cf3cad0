//! irradia: a headless Vulkan engine for global illumination.

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
