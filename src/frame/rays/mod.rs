//! The scene as rays meet it, for whatever sends rays: methods, estimators.

mod alias_table;
mod backs;
mod emissive_cells;
mod emitters;
mod flattened;
mod hierarchy;
mod lightmap;
mod looks;
mod motion;
mod samples;
mod sobol;
mod surfaces;
mod targets;
mod tessellation;
#[cfg(test)]
mod tests;
mod texels;
mod traced_scene;
mod triangles;
mod uploaded;

pub(crate) use self::lightmap::{Lightmap, Texels, TriangleChart};
pub(crate) use self::looks::is_diffuse;
pub(crate) use self::motion::Motion;
pub(crate) use self::surfaces::surfaces_key;
pub(crate) use self::targets::TargetShares;
pub(crate) use self::tessellation::Tessellation;
pub(crate) use self::traced_scene::{TracedScene, traced_key};
