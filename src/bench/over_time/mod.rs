//! A sequence of frames, each measured by itself: the scene's animation or a camera's flight. What a frame costs, how far it is from the truth of that very frame, how
//! much of it is still late, how it flickers.
//!
//! ```text
//! play ──▶ record ──▶ table · csv · errors_plot · passes_plot
//!  │       (JSON)
//!  └─ lag  (of two pictures and the truth)
//! ```

mod axis;
mod csv;
mod errors_plot;
mod frames_axis;
mod lag;
mod layers;
mod passes_plot;
mod play;
mod player;
mod record;
mod sequence;
mod table;

pub use csv::csv;
pub use errors_plot::errors_plot;
pub use passes_plot::passes_plot;
pub use play::{Played, play, steps_per_contender};
pub use record::{Flicker, FrameRecord, Lag, OverTime};
pub use sequence::{Comparing, Sequence};
pub use table::over_time_text;
