//! Scenes: made empty, from a file, or from bytes; and what is in them, by identifiers.

mod handle;
mod light;
mod load;
mod material;
mod mesh;
mod node;
mod texture;
mod whole;

pub use handle::*;
pub use light::*;
pub use load::*;
pub use material::*;
pub use mesh::*;
pub use node::*;
pub use texture::*;
pub use whole::*;
