//! Reports as tables: for people, for documents and for spreadsheets.

mod comparison;
mod csv;
mod markdown;
mod reference;
mod text;

pub use comparison::comparison_text;
pub use csv::csv;
pub(crate) use csv::line as csv_line;
pub use markdown::markdown;
pub use reference::{cache_text, reference_text};
pub(crate) use text::table;
pub use text::{TEXT_WIDTH, scene_text, summary_text};

use super::report::Run;
use super::{error_rows, rows, units};

/// The header of [`summary_cells`].
fn summary_header(runs: &[Run]) -> Vec<&'static str> {
    let times = ["scene", "technique", "frame ms", "serialised ms", "unchanged ms", "memory", "compile ms"];
    let errors = ["error covered", "full image"];
    times.into_iter().chain(errors.into_iter().filter(|_| any_errors(runs))).collect()
}

/// A row for every run of the table over all scenes and techniques; with errors if any run has them.
fn summary_cells(runs: &[Run]) -> impl Iterator<Item = Vec<String>> {
    let with_errors = any_errors(runs);
    runs.iter().map(move |run| {
        let times = [
            run.scene.clone(),
            rows::contender(run),
            units::milliseconds(run.frame_ms.median),
            units::milliseconds(run.serialised_ms.median),
            units::milliseconds(run.unchanged_ms.median),
            units::bytes(run.memory_bytes),
            units::milliseconds(run.compile_ms),
        ];
        times.into_iter().chain(error_rows::summary(run).into_iter().filter(|_| with_errors)).collect()
    })
}

fn any_errors(runs: &[Run]) -> bool {
    runs.iter().any(|run| run.error.is_some() || run.error_full.is_some())
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
