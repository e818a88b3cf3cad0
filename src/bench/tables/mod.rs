//! Reports as tables: for people, for documents and for spreadsheets.

mod comparison;
mod csv;
mod markdown;
mod reference;
mod summary;
mod text;

pub use comparison::comparison_text;
pub use csv::csv;
pub(crate) use csv::line as csv_line;
pub use markdown::markdown;
pub use reference::{cache_text, reference_text};
pub(crate) use text::table;
pub use text::{TEXT_WIDTH, scene_text, summary_text};
