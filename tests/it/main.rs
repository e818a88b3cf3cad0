//! Tests from outside: the library and the program as others use them. One file a capability, one program to link.

mod bake;
mod cli;
mod compare;
mod files;
mod gltf_file;
mod gltf_materials;
mod gltf_meshes;
mod gltf_scenes;
mod header;
mod hosts;
mod house;
mod light_notation;
#[cfg(debug_assertions)]
mod live_shaders;
mod no_vulkan;
mod output_files;
mod over_time;
mod scene;
mod scene_changes;
mod scene_fuzz;
mod settings;
mod shared_scenes;
mod sweeps;
