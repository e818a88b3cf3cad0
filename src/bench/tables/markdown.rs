//! Reports as Markdown, for documents: the summary first, then every scene pass by pass.

use std::fmt::Write;

use super::summary::{summary_cells, summary_header};
use crate::bench::error_rows::{ERROR_HEADER, ERROR_NOTE, error_rows};
use crate::bench::report::{Report, Run};
use crate::bench::rows::{self, HEADER};

/// The whole report.
pub fn markdown(report: &Report) -> String {
    let mut out = String::new();
    line(&mut out, &report.heading());
    line(&mut out, "");
    let header = summary_header(&report.runs);
    table(&mut out, &header, 2..header.len(), summary_cells(&report.runs));
    for runs in by_scene(&report.runs) {
        for (index, run) in runs.iter().enumerate() {
            if index == 0 {
                line(&mut out, &format!("\n## {}\n\n{}", run.scene, rows::caption(run)));
            }
            line(&mut out, &format!("\n### {}\n", rows::contender(run)));
            let cells =
                rows::rows(run).into_iter().map(|row| [row.name.clone()].into_iter().chain(row.cells()).collect());
            table(&mut out, &HEADER, 1..5, cells);
            let errors = error_rows(run);
            if !errors.is_empty() {
                line(&mut out, "");
                table(&mut out, &ERROR_HEADER, 1..9, errors.iter().map(|row| row.cells().to_vec()));
                line(&mut out, &format!("\n{ERROR_NOTE}"));
            }
        }
    }
    if !report.failures.is_empty() {
        line(&mut out, "\n## Failures\n");
        for failure in &report.failures {
            line(&mut out, &format!("- {failure}"));
        }
    }
    out
}

/// A table whose columns in `numbers` are aligned to the right.
fn table(out: &mut String, header: &[&str], numbers: std::ops::Range<usize>, rows: impl Iterator<Item = Vec<String>>) {
    line(out, &format!("| {} |", header.join(" | ")));
    let rules: Vec<&str> =
        (0..header.len()).map(|index| if numbers.contains(&index) { "--:" } else { "---" }).collect();
    line(out, &format!("|{}|", rules.join("|")));
    for row in rows {
        let cells: Vec<String> = row.iter().map(|cell| cell.replace('|', "\\|").replace('\n', " ")).collect();
        line(out, &format!("| {} |", cells.join(" | ")));
    }
}

fn line(out: &mut String, text: &str) {
    // Writing to a string cannot fail.
    let _ = writeln!(out, "{text}");
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::error_rows::tests::compared_run;
    use crate::bench::report::Failure;
    use crate::bench::samples::tests::example_run;
    use crate::renderer::DeviceReport;

    #[test]
    fn every_table_is_sound() {
        let mut report = Report::new(&DeviceReport::default());
        report.runs = vec![example_run(), compared_run(), Run { scene: "a|b".to_owned(), ..example_run() }];
        report.failures.push(Failure {
            scene: "ring".to_owned(),
            error: "no such file".to_owned(),
            ..Failure::default()
        });
        let text = markdown(&report);
        let mut columns = None;
        for line in text.lines() {
            let bars = line.replace("\\|", "").matches('|').count();
            match columns {
                Some(expected) if bars > 0 => assert_eq!(bars, expected, "{line}"),
                _ => columns = (bars > 0).then_some(bars),
            }
        }
        for words in ["| sponza | rsm (default) | 18.50 |", "## a|b", "### rsm (default)", "- ring: no such file"] {
            assert!(text.contains(words), "{words} is not in\n{text}");
        }
        assert!(text.contains("| diffuse | 12.5 % | 50.0 % |"), "{text}");
        assert!(text.contains("| caustics/photons | skipped |  |  |  | no specular surface |"), "{text}");
    }
}
