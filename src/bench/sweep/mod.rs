//! Sweeps: time against error over a grid of techniques, presets and settings, on several scenes.
//!
//! ```text
//! TOML ──▶ grid ──▶ points ──▶ execute ──▶ result ──▶ lines · pareto ──▶ table · csv · plot
//!                  (the product,  (groups, saved  (JSON, resumed,
//!                   ids, shards)   one by one)     merged)
//! ```

pub(super) mod canvas;
pub(super) mod chart;
mod csv;
mod execute;
mod fit;
mod grid;
mod grid_file;
mod growth;
mod lines;
mod pareto;
mod plot;
mod points;
mod result;
mod text;

pub use csv::csv;
pub use execute::{Group, Outcomes, groups, run};
pub use fit::{EqualTime, equal_time, slope};
pub use grid::{Compare, FRAME_COLUMN, Grid, GridScene, GrowsWith, Interleave, Metric, Published, Series};
pub use grid_file::GridError;
pub use growth::growth_text;
pub use lines::{Line, Mark, lines};
pub use pareto::pareto_front;
pub use plot::plot;
pub use points::{Point, PointsError, Shard};
pub use result::{Measured, PointFailure, Sweep, SweepError};
pub use text::scene_text;
