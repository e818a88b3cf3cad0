//! irradia: a headless Vulkan engine for global illumination.
