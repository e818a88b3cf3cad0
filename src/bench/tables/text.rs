//! Tables for a terminal: UTF-8 rules, no colours, never wider than [`TEXT_WIDTH`].

use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};

use super::summary::{summary_cells, summary_header};
use crate::bench::error_rows::{ERROR_HEADER, ERROR_NOTE, error_rows};
use crate::bench::report::Run;
use crate::bench::rows::{self, HEADER, Row};

/// The most columns that a table takes.
pub const TEXT_WIDTH: u16 = 110;

/// All techniques on one scene, pass by pass, then their errors if they have any; empty if there are none.
pub fn scene_text(runs: &[&Run]) -> String {
    let Some(first) = runs.first() else { return String::new() };
    let mut table = table(&HEADER, &[1, 2, 3, 4]);
    for (index, run) in runs.iter().enumerate() {
        if index > 0 {
            table.add_row([""]);
        }
        table.add_row([rows::contender(run).to_uppercase()]);
        for row in rows::rows(run) {
            table.add_row(text_cells(&row));
        }
    }
    format!("{}: {}\n{}\n{}", first.scene, rows::caption(first), table.trim_fmt(), errors_text(runs))
}

/// The errors of all techniques on one scene; empty if there are none.
fn errors_text(runs: &[&Run]) -> String {
    let mut table = table(&ERROR_HEADER, &[1, 2, 3, 4, 5, 6, 7, 8]);
    let mut empty = true;
    for run in runs {
        let rows = error_rows(run);
        if rows.is_empty() {
            continue;
        }
        if !empty {
            table.add_row([""]);
        }
        table.add_row([rows::contender(run).to_uppercase()]);
        table.add_rows(rows.iter().map(|row| row.cells()));
        empty = false;
    }
    if empty { String::new() } else { format!("{}\n{ERROR_NOTE}\n", table.trim_fmt()) }
}

/// All scenes and techniques, a row each.
pub fn summary_text(runs: &[Run]) -> String {
    let header = summary_header(runs);
    let mut table = table(&header, &(2..header.len()).collect::<Vec<_>>());
    table.add_rows(summary_cells(runs));
    format!("{}\n", table.trim_fmt())
}

fn text_cells(row: &Row) -> Vec<Cell> {
    [row.label()].into_iter().chain(row.cells()).map(Cell::new_owned).collect()
}

/// A table without vertical rules, the columns of `numbers` aligned to the right.
pub(crate) fn table(header: &[&str], numbers: &[usize]) -> Table {
    let rule = LineStyle::none().fill('─').junction('─');
    let mut table = Table::new();
    table.load_style(TableStyle::new().top_border(rule).header_separator(rule).bottom_border(rule));
    table.set_content_arrangement(ContentArrangement::Dynamic).set_width(TEXT_WIDTH);
    table.set_header(header);
    for index in numbers {
        if let Some(column) = table.column_mut(*index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::error_rows::tests::compared_run;
    use crate::bench::samples::tests::example_run;

    fn wide_run() -> Run {
        let mut run = example_run();
        run.passes[0]
            .work
            .insert("a counter with a name that takes more room than there is in one line of a table".to_owned(), 7);
        run
    }

    #[test]
    fn a_scene_is_one_table_that_fits() {
        let (first, second) = (example_run(), Run { technique: "direct".to_owned(), ..wide_run() });
        let text = scene_text(&[&first, &second]);
        assert!(text.lines().all(|line| line.chars().count() <= usize::from(TEXT_WIDTH)), "{text}");
        assert!(text.lines().all(|line| line.trim_end() == line), "{text}");
        let shown = ["sponza: 1024x768, camera main, 3 rounds after 3 frames", "RSM (DEFAULT)", "DIRECT (DEFAULT)"];
        let rows = ["   gather", "  reduce", "no specular surface", "unexplained", "unchanged frame", "100 MiB"];
        for words in shown.into_iter().chain(rows.map(str::trim_start)) {
            assert!(text.contains(words), "{words} is not in\n{text}");
        }
        assert_eq!(scene_text(&[]), "");
    }

    #[test]
    fn errors_stand_below_the_times() {
        let (compared, timed) = (compared_run(), example_run());
        let text = scene_text(&[&compared, &timed]);
        assert!(text.lines().all(|line| line.chars().count() <= usize::from(TEXT_WIDTH)), "{text}");
        assert!(text.contains("12.5 %") && text.contains("< 0.800 %") && text.contains("reference's noise"), "{text}");
        assert!(!scene_text(&[&timed]).contains("noise"));
        let summary = summary_text(&[compared, timed]);
        assert!(summary.contains("40.0 %") && summary.contains("full image"), "{summary}");
        assert!(!summary_text(&[example_run()]).contains("full image"));
    }

    #[test]
    fn the_summary_has_a_row_for_every_run() {
        let text = summary_text(&[example_run(), Run { scene: "ring".to_owned(), ..example_run() }]);
        let rows: Vec<&str> = text.lines().filter(|line| line.contains("rsm (default)")).collect();
        assert_eq!(rows.len(), 2, "{text}");
        for words in ["sponza", "18.50", "20.50", "0.250", "100 MiB", "480.5"] {
            assert!(rows[0].contains(words), "{words} is not in {}", rows[0]);
        }
    }
}
