//! Reports as tables: for people, for documents and for spreadsheets.

mod comparison;
mod csv;
mod markdown;
mod text;

pub use comparison::comparison_text;
pub use csv::csv;
pub(crate) use csv::line as csv_line;
pub use markdown::markdown;
pub(crate) use text::table;
pub use text::{TEXT_WIDTH, scene_text, summary_text};

use super::report::Run;
use super::{rows, units};

/// The header of [`summary_cells`].
const SUMMARY_HEADER: [&str; 7] =
    ["scene", "technique", "frame ms", "serialised ms", "unchanged ms", "memory", "compile ms"];

/// One row of the table over all scenes and techniques.
fn summary_cells(run: &Run) -> [String; 7] {
    [
        run.scene.clone(),
        rows::contender(run),
        units::milliseconds(run.frame_ms.median),
        units::milliseconds(run.serialised_ms.median),
        units::milliseconds(run.unchanged_ms.median),
        units::bytes(run.memory_bytes),
        units::milliseconds(run.compile_ms),
    ]
}

/// The runs of every scene together, in the order of their first run.
fn by_scene(runs: &[Run]) -> Vec<Vec<&Run>> {
    let mut scenes: Vec<Vec<&Run>> = Vec::new();
    for run in runs {
        match scenes.iter_mut().find(|scene| scene.iter().any(|other| other.scene == run.scene)) {
            Some(scene) => scene.push(run),
            None => scenes.push(vec![run]),
        }
    }
    scenes
}
