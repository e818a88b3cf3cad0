//! What every technique shares: the scene on the device, what rays meet, G-buffer, light views, composition, tone mapping.
//!
//! Everything here works in *render space* (suffix `_rs`): the world's axes in metres, minus an origin among
//! its surfaces (`src/scene/extent.rs`), so that a scene far from the world's origin loses no precision in 32-bit floats.

pub(crate) mod bounces;
pub(crate) mod caches;
pub(crate) mod camera;
pub(crate) mod check;
mod closed_meshes;
pub(crate) mod compose;
pub(crate) mod direct_light;
mod drawn_triangles;
pub(crate) mod gbuffer;
pub(crate) mod geometry;
pub(crate) mod inputs;
pub(crate) mod instances;
pub(crate) mod light_set;
pub(crate) mod light_views;
pub(crate) mod lobe_albedos;
pub(crate) mod materials;
mod mesh_data;
pub(crate) mod mirrored;
pub(crate) mod mirrored_light;
pub(crate) mod octahedral;
pub(crate) mod offers;
pub(crate) mod photons;
mod plane_depth;
pub(crate) mod rays;
pub(crate) mod regions;
pub(crate) mod scene_data;
mod sent_list;
pub(crate) mod stored_light;
pub(crate) mod textures;
pub(crate) mod tonemap;
#[cfg(test)]
pub(crate) mod twins;
pub(crate) mod view_layout;
pub(crate) mod voxels;
