//! The bench: techniques side by side on one scene, every pass timed, told as JSON, tables, Markdown and CSV.
//!
//! ```text
//! run ──▶ samples ──▶ report ──▶ rows ──▶ text · markdown · csv
//!  │      (one technique's frames) ▲ (JSON)  (what a table says)
//!  ├────▶ alone ──────────────────┤
//!  │      (pieces on their own)    │
//!  ├────▶ leaks ──────────────────┤
//!  │      (in rooms without light) │
//!  └────▶ errors ─────────────────┘
//!         (against references)
//! ```
//!
//! `over_time` plays a sequence instead of rounds, and tells each frame by itself.

mod alone;
pub mod comparison;
mod error_rows;
mod errors;
pub(crate) mod leaks;
pub mod over_time;
pub mod report;
pub mod rows;
mod run;
mod samples;
pub mod statistics;
pub mod sweep;
pub mod tables;
mod units;

pub use errors::{ErrorsUnknown, References};
pub use run::{Finished, Options, PICTURE_TONE_MAP, SlotImages, Subject, run};
