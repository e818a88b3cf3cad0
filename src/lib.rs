//! irradia: a headless Vulkan engine for global illumination.

pub mod scene;
