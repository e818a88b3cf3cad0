//! Tests on the device, one file a capability. Scenes are built in memory or come with irradia; results are compared with
//! closed forms, with sums in f64 over what was read back, or with another run.
//!
//! Every test opens a device of its own with validation ([`session`]) and fails on any message and on any allocation
//! that outlives its renderer.

mod bench_slots;
mod bvh;
mod bvh_closed;
mod bvh_speed;
mod crash_markers;
mod direct;
mod emitter_coverage;
mod estimates;
mod far_things;
mod flux;
mod gather;
mod graph;
mod graph_mistakes;
mod graph_places;
mod groups;
mod hybrid;
mod invariance;
mod kept;
mod layouts;
mod leaks;
mod light_share;
mod limits;
mod lists;
mod loader;
mod memory;
mod numbers;
mod path_caustics;
mod path_closed_forms;
mod path_lobes;
mod path_probe;
mod path_repeats;
mod path_robustness;
mod path_targets;
mod path_weights;
mod photon_lists;
mod photon_lists_speed;
mod photon_splat;
mod photon_splat_speed;
mod photon_stage;
mod photons_emit;
mod photons_land;
mod photons_probe;
mod pieces;
mod probe;
mod raster;
mod rays;
mod reference_auto;
mod reference_files;
mod repeats;
mod robustness;
pub(crate) mod scenes;
pub(crate) mod session;
mod skipping;
mod splat_bench;
mod sppm;
mod tonemap;
mod trace;
mod traced_direct;
mod traits;
mod vpl_paths;
mod vpl_regions;
mod vpl_samples;
mod vpl_visibility;
