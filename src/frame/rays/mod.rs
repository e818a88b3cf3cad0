//! The scene as rays meet it, for whatever sends rays: methods, estimators.

mod alias_table;
mod emissive_cells;
mod emitters;
mod sobol;
mod targets;
mod texels;
mod traced_scene;
mod triangles;

pub(crate) use self::targets::TargetShares;
pub(crate) use self::traced_scene::{TracedScene, surfaces_key, traced_key};
