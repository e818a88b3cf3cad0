//! The table over all scenes and techniques.

use crate::bench::report::Run;
use crate::bench::{error_rows, rows, units};

/// The header of [`summary_cells`].
pub(super) fn summary_header(runs: &[Run]) -> Vec<&'static str> {
    let times = ["scene", "technique", "frame ms", "serialised ms", "unchanged ms", "memory", "compile ms"];
    let errors = ["error covered", "full image"];
    times.into_iter().chain(errors.into_iter().filter(|_| any_errors(runs))).collect()
}

/// A row for every run of the table over all scenes and techniques; with errors if any run has them.
pub(super) fn summary_cells(runs: &[Run]) -> impl Iterator<Item = Vec<String>> {
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
