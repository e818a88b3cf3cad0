//! What a table says of a run's errors, part by part: against the reference of equal light paths and, beside it, against full
//! light transport.

use std::collections::BTreeMap;

use super::comparison::NOISE_BOUND;
use super::errors::COVERED;
use super::report::{ImageErrors, Run};
use super::units;
use crate::reference::IMAGE;
use crate::renderer::Slot;

/// The errors of one slot, of the slots that are filled together, or of the image.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ErrorRow<'a> {
    /// A slot, `covered` or `image`.
    pub(crate) part: &'static str,
    /// Against equal light paths.
    pub(crate) equal: Measured<'a>,
    /// Against full light transport.
    pub(crate) full: Measured<'a>,
}

/// Errors and the relative noise of what they are against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Measured<'a> {
    pub(crate) errors: Option<&'a ImageErrors>,
    pub(crate) noise: Option<f64>,
}

/// The header of [`ErrorRow::cells`].
pub(crate) const ERROR_HEADER: [&str; 9] =
    ["error", "rrmse", "full", "relmse", "full", "flip", "full", "noise", "full"];

/// What stands below a table of errors.
pub(crate) const ERROR_NOTE: &str =
    "full: against full light transport, else against equal light paths. <: less than twice the reference's noise.";

/// A row for every part that was compared, the image last; none if nothing was.
pub(crate) fn error_rows(run: &Run) -> Vec<ErrorRow<'_>> {
    let parts = Slot::ALL.into_iter().map(Slot::name).chain([COVERED, IMAGE]);
    parts.filter_map(|part| error_row(run, part)).collect()
}

fn error_row<'a>(run: &'a Run, part: &'static str) -> Option<ErrorRow<'a>> {
    let row = ErrorRow {
        part,
        equal: Measured::of_part(part, &run.error, &run.noise),
        full: Measured::of_part(part, &run.error_full, &run.noise_full),
    };
    (row.equal.errors.is_some() || row.full.errors.is_some()).then_some(row)
}

/// What a summary says of a run's errors: `covered` against equal light paths, `image` against full light transport.
pub(crate) fn summary(run: &Run) -> [String; 2] {
    let row = |part| error_row(run, part);
    [row(COVERED).map(|row| row.equal.relative()), row(IMAGE).map(|row| row.full.relative())]
        .map(Option::unwrap_or_default)
}

impl ErrorRow<'_> {
    /// The cells, the part first.
    pub(crate) fn cells(&self) -> [String; 9] {
        let ErrorRow { part, equal, full } = self;
        [
            (*part).to_owned(),
            equal.relative(),
            full.relative(),
            equal.of(|errors| units::error(errors.relmse)),
            full.of(|errors| units::error(errors.relmse)),
            equal.of(|errors| format!("{:.4}", errors.flip)),
            full.of(|errors| format!("{:.4}", errors.flip)),
            equal.noise.map(percent).unwrap_or_default(),
            full.noise.map(percent).unwrap_or_default(),
        ]
    }
}

impl<'a> Measured<'a> {
    fn of_part(
        part: &str,
        errors: &'a Option<BTreeMap<String, ImageErrors>>,
        noise: &Option<BTreeMap<String, f64>>,
    ) -> Measured<'a> {
        let noise = noise.as_ref().and_then(|noise| noise.get(part).copied());
        Measured { errors: errors.as_ref().and_then(|errors| errors.get(part)), noise }
    }

    /// The relative error; if the noise hides it, the least that would show.
    fn relative(&self) -> String {
        self.of(|errors| match self.noise.map(|noise| NOISE_BOUND * noise) {
            Some(bound) if errors.rrmse < bound => format!("< {}", percent(bound)),
            _ => percent(errors.rrmse),
        })
    }

    fn of(&self, cell: impl FnOnce(&ImageErrors) -> String) -> String {
        self.errors.map(cell).unwrap_or_default()
    }
}

/// With three digits that count.
fn percent(share: f64) -> String {
    format!("{} %", units::error(100.0 * share))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::bench::samples::tests::example_run;

    /// A run of which `direct` is within the noise of the reference of equal light paths.
    pub(crate) fn compared_run() -> Run {
        let errors = |values: [f64; 4]| {
            let parts = ["direct", "diffuse", "covered", "image"].into_iter().zip(values);
            parts.map(|(part, rrmse)| {
                (
                    part.to_owned(),
                    ImageErrors { rrmse, relmse: 0.5 * rrmse, flip: 0.25 * rrmse, ..ImageErrors::default() },
                )
            })
        };
        let noise = |value: f64| ["direct", "diffuse", "covered", "image"].map(|part| (part.to_owned(), value));
        Run {
            error: Some(errors([0.005, 0.125, 0.05, 0.2]).collect()),
            error_full: Some(errors([0.02, 0.5, 0.25, 0.4]).collect()),
            noise: Some(noise(0.004).into_iter().collect()),
            noise_full: Some(noise(0.002).into_iter().collect()),
            ..example_run()
        }
    }

    #[test]
    fn errors_within_the_noise_are_bounds() {
        let run = compared_run();
        let rows = error_rows(&run);
        assert!(rows.iter().map(|row| row.part).eq(["direct", "diffuse", "covered", "image"]));
        let cells = ["direct", "< 0.800 %", "2.00 %", "0.00250", "0.0100", "0.0013", "0.0050", "0.400 %", "0.200 %"];
        assert_eq!(rows[0].cells(), cells);
        assert_eq!(rows[1].cells()[1..3], ["12.5 %", "50.0 %"]);
        assert_eq!(summary(&run), ["5.00 %", "40.0 %"]);
        assert!(error_rows(&example_run()).is_empty());
        assert_eq!(summary(&example_run()), ["", ""]);
    }
}
