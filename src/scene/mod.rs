//! Scenes: what there is to light, and from where it is seen. Knows no Vulkan.
//!
//! A [`Scene`] comes from a glTF file ([`Scene::open`], [`Scene::load`]) or is built in memory ([`Scene::empty`]). Nodes place
//! meshes, lights and cameras; all of them can be moved or changed between frames, and [`Scene::revisions`] counts the changes by
//! kind, so that whoever holds something derived from the scene knows when it is stale.
//!
//! | file | idea |
//! |---|---|
//! | `world` | the [`Scene`]: nodes, transforms, instances, revisions |
//! | `editing`, `mesh_editing` | adding things to it and changing them |
//! | `mesh`, `material`, `light`, `camera`, `animation` | the things in it |
//! | `ids` | the indices that name them |
//! | `camera_choice` | which camera the scene is seen from |
//! | `extent`, `bulk` | where it is and how far it reaches, whatever specks lie far from it |
//! | `flight` | a camera's way through it, from a file |
//! | `facts` | what it contains, which decides what need not run |
//! | `content_hash`, `digest` | whether two scenes, of two processes or machines, look alike |
//! | `emission`, `emission_points`, `shining` | what alpha and textures leave of emissive surfaces |
//! | `cutout` | what alpha leaves of a surface, material by material |
//! | `triangle_cells` | a triangle cut into equal cells |
//! | `sampling` | textures read as shaders read them |
//! | `appearance` | what points of a surface reflect diffusely and send out |
//! | `emitters` | emissive surfaces as a bounded number of point emitters |
//! | `emitted` | how much light all lights send out |
//! | `seen` | how much surface pixels show |
//! | `auto_view`, `indoor_view` | a view of a scene that has no camera, from outside or from within |
//! | `bvh` | the hierarchy that shaders trace rays through |
//! | `rays` | rays against all triangles, for those views and `seen` |
//! | `gltf/` | reading files |
//! | `load_options` | what reading may do |
//! | `builtin` | the scenes that come with irradia |
//!
//! Units are metres, radians, seconds and watts; colours are linear Rec. 709. Transforms are f64 throughout.

mod animation;
mod appearance;
mod auto_view;
mod builtin;
mod bulk;
pub(crate) mod bvh;
mod camera;
mod camera_choice;
mod content_hash;
mod cutout;
mod digest;
mod editing;
mod emission;
mod emission_points;
#[cfg(feature = "plots")]
mod emitted;
mod emitters;
mod error;
mod extent;
mod facts;
mod flight;
mod gltf;
mod ids;
mod indoor_view;
mod light;
mod load_options;
mod material;
mod mesh;
mod mesh_editing;
pub(crate) mod rays;
mod refit;
mod sampling;
#[cfg(feature = "plots")]
mod seen;
mod shining;
mod split;
mod tangents;
pub(crate) mod triangle_cells;
mod world;

pub use animation::{Animation, Channel, Interpolation, LightChannel, Property};
pub use builtin::builtin_names;
pub use camera::{Camera, CameraView, Projection};
pub use emitters::EmitterSample;
pub use error::SceneError;
pub use facts::Facts;
pub use flight::{Flight, FlightError};
pub use gltf::ReadFile;
pub use ids::{CameraId, LightId, MaterialId, MeshId, NodeId, TextureId};
pub use light::{Light, LightKind, LightSpec, PlacedLight, parse_sky};
pub use load_options::LoadOptions;
pub use material::{Alpha, Material, Texture, TextureRef, Wrap};
pub use mesh::{Bounds, Instance, Mesh, Primitive};
#[cfg(feature = "capi")]
pub(crate) use mesh::{CHUNK, all_finite, first_endless, largest_index};
#[cfg(feature = "capi")]
pub(crate) use tangents::all_unit;
pub use world::{FRAME_RATE, Node, Revisions, Scene};

pub(crate) use appearance::{Appearance, PointLook};
pub(crate) use cutout::{Cutout, cutout};
pub(crate) use digest::Digest;
pub(crate) use emission::EmissiveCells;
pub(crate) use extent::{Extent, Shape};
pub(crate) use facts::{has_specular_lobe, is_glossy};
