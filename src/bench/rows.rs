//! What a table says of a run, row by row; text, Markdown and CSV differ only in how they write it down.

use std::collections::BTreeMap;

use serde_json::Value;

use super::over_time::OverTime;
use super::report::{Leaks, Pass, Piece, PieceAlone, Run};
use super::statistics::Spread;
use super::units;
use crate::renderer::Slot;

/// What a row is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RowKind {
    /// Several passes together.
    Piece,
    /// Some passes of a piece together; part of the piece's own row.
    Level,
    /// One pass.
    Pass,
    /// A piece timed on its own.
    Alone,
    /// The frame as a whole, or what belongs to no pass.
    Frame,
}

impl RowKind {
    /// The word for it in CSV.
    pub fn name(self) -> &'static str {
        match self {
            RowKind::Piece => "piece",
            RowKind::Level => "level",
            RowKind::Pass => "pass",
            RowKind::Alone => "alone",
            RowKind::Frame => "frame",
        }
    }
}

/// One row of a run's table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What it is about.
    pub kind: RowKind,
    /// Its full name: `piece`, `piece/pass`, or words such as `unchanged frame`.
    pub name: String,
    /// The rows above that it is part of: names of a piece and of levels, from the outermost.
    pub within: Vec<String>,
    /// The median, milliseconds, or the only measurement.
    pub ms: Option<f64>,
    /// The least and the 95th percentile, milliseconds.
    pub range_ms: Option<(f64, f64)>,
    /// Part of the serialised frame, of one.
    pub share: Option<f64>,
    /// Whether the pass did not run; `text` says why.
    pub skipped: bool,
    /// What it did, why it did not, or what there is to say.
    pub text: String,
}

impl Row {
    fn new(kind: RowKind, name: impl Into<String>) -> Row {
        let (within, text) = Default::default();
        Row { kind, name: name.into(), within, ms: None, range_ms: None, share: None, skipped: false, text }
    }

    fn frame(name: &str) -> Row {
        Row::new(RowKind::Frame, name)
    }

    fn spread(self, spread: Spread) -> Row {
        Row { ms: Some(spread.median), range_ms: Some((spread.min, spread.p95)), ..self }
    }

    fn share(self, share: f64) -> Row {
        Row { share: Some(share), ..self }
    }

    fn text(self, text: impl Into<String>) -> Row {
        Row { text: text.into(), ..self }
    }

    fn within(self, within: &[String]) -> Row {
        Row { within: within.to_vec(), ..self }
    }

    /// The name for people: indented below what it is part of, without repeating it.
    pub fn label(&self) -> String {
        let own = self.within.last().and_then(|outer| self.name.strip_prefix(outer)).unwrap_or(&self.name);
        "  ".repeat(self.within.len()) + own.trim_start_matches('/')
    }

    /// The cells after the label: median, least and 95th percentile in milliseconds, share, text.
    pub fn cells(&self) -> [String; 5] {
        let ms = if self.skipped { Some("skipped".to_owned()) } else { self.ms.map(units::milliseconds) };
        let (min, p95) = self.range_ms.map(|(min, p95)| (units::milliseconds(min), units::milliseconds(p95))).unzip();
        let share = self.share.map(units::percent);
        [ms, min, p95, share, Some(self.text.clone())].map(Option::unwrap_or_default)
    }
}

/// The header of the rows of [`rows`].
pub const HEADER: [&str; 6] = ["pass", "ms", "min", "p95", "share", "work"];

/// All rows of a run: its passes by piece and level, then the frame as a whole.
pub fn rows(run: &Run) -> Vec<Row> {
    let mut rows = Vec::new();
    for piece in run.pieces.iter().filter(|piece| piece.within.is_none()) {
        add_piece(run, piece, &mut Vec::new(), &mut rows);
    }
    let unexplained_share = run.unexplained_ms / run.serialised_ms.median;
    let unexplained = Row { ms: Some(run.unexplained_ms), ..Row::frame("unexplained") };
    rows.push(if unexplained_share.is_finite() { unexplained.share(unexplained_share) } else { unexplained });
    rows.push(Row::frame("serialised frame").spread(run.serialised_ms).text("barriers between all passes"));
    rows.push(Row::frame("frame").spread(run.frame_ms).text(format!(
        "passes overlap as the driver likes; {} ms on the host",
        units::milliseconds(run.host_ms.median)
    )));
    if let Some(cold) = run.cold_ms {
        let text = format!("all made anew without a past; the others came after {} frames", run.lead_in);
        rows.push(Row::frame("cold frame").spread(cold).text(text));
    }
    rows.push(Row::frame("unchanged frame").spread(run.unchanged_ms).text(format!(
        "nothing changed since the last; {} ms on the host",
        units::milliseconds(run.unchanged_host_ms.median)
    )));
    rows.extend(run.piece_alone.iter().map(alone_row));
    let first = units::milliseconds(run.first_frame_ms);
    let (upload, pipelines) = (units::milliseconds(run.upload_ms), units::milliseconds(run.pipeline_ms));
    let compile = format!("first frame {first} ms on the host, of it upload {upload} ms, pipelines {pipelines} ms");
    rows.push(Row { ms: Some(run.compile_ms), ..Row::frame("compile").text(compile) });
    rows.push(Row::frame("memory").text(memory(run)));
    rows.extend(memory_rows(run));
    rows.extend(run.leaks.as_ref().map(|leaks| Row::frame("leaks").text(leaked(leaks))));
    rows.push(Row::frame("settings").text(settings(run)));
    rows
}

/// What arrives in dark rooms over what is emitted, of slots that let any through.
fn leaked(leaks: &Leaks) -> String {
    let room = |(camera, slots): (&String, &BTreeMap<Slot, f64>)| {
        let slots = slots.iter().filter(|(_, share)| **share != 0.0);
        let slots: Vec<String> = slots.map(|(slot, share)| format!("{slot} {share:.1e}")).collect();
        format!("{camera}: {}", if slots.is_empty() { "none".to_owned() } else { slots.join(", ") })
    };
    let rooms: Vec<String> = leaks.rooms.iter().map(room).collect();
    format!("of all light in dark rooms: {}", rooms.join("; "))
}

/// A piece or level, then what it holds in the order of the passes; of one that holds a single pass that pass alone. `within` are the rows above.
fn add_piece(run: &Run, piece: &Piece, within: &mut Vec<String>, rows: &mut Vec<Row>) {
    let passes: Vec<&Pass> = run.passes.iter().filter(|pass| pass.lies_in(&piece.piece)).collect();
    let has_row = passes.len() > 1;
    if has_row {
        let kind = if piece.within.is_none() { RowKind::Piece } else { RowKind::Level };
        rows.push(Row::new(kind, &piece.piece).within(within).spread(piece.ms).share(piece.share));
        within.push(piece.piece.clone());
    }
    let levels: Vec<&Piece> = run.pieces.iter().filter(|level| level.within.as_ref() == Some(&piece.piece)).collect();
    let mut shown: Vec<&str> = Vec::new();
    for pass in passes {
        match levels.iter().find(|level| pass.lies_in(&level.piece)) {
            Some(level) if shown.contains(&&*level.piece) => {}
            Some(level) => {
                shown.push(&level.piece);
                add_piece(run, level, within, rows);
            }
            None => rows.push(pass_row(pass).within(within)),
        }
    }
    if has_row {
        within.pop();
    }
}

/// The technique and its preset: `rsm (default)`.
pub fn contender(run: &Run) -> String {
    format!("{} ({})", run.technique, run.preset)
}

/// What all runs of a scene share: camera, size, rounds.
pub fn caption(run: &Run) -> String {
    let [width, height] = run.size;
    let (rounds, camera, load) = (run.frames, &run.camera, units::milliseconds(run.load_ms));
    let warmup = run.warmup + 1;
    if let Some(OverTime { fps, .. }) = &run.over_time {
        return format!(
            "{width}x{height}, {camera}, {rounds} frames played at {fps} a second, scene loaded in {load} ms"
        );
    }
    format!(
        "{width}x{height}, camera {camera}, {rounds} rounds after {warmup} frames of warm-up, scene loaded in {load} ms"
    )
}

fn pass_row(pass: &Pass) -> Row {
    let row = Row::new(RowKind::Pass, pass.full_name());
    match &pass.skipped {
        Some(reason) => Row { skipped: true, ..row.text(reason) },
        None => row.spread(pass.ms).share(pass.share).text(work(pass)),
    }
}

fn alone_row(alone: &PieceAlone) -> Row {
    let row = Row::new(RowKind::Alone, format!("{} alone", alone.piece));
    if let Some(reason) = &alone.skipped {
        return Row { skipped: true, ..row.text(reason) };
    }
    let [in_frame, whole] = [alone.in_frame_ms, alone.whole_ms].map(|ms| units::milliseconds(ms.median));
    let mut text = format!("{in_frame} ms within the serialised frame; {whole} ms if passes overlap");
    if !alone.also.is_empty() {
        let names: Vec<&str> = alone.also.iter().map(|row| row.pass.as_str()).collect();
        let ms = units::milliseconds(alone.also.iter().map(|row| row.ms.median).sum());
        text += &format!("; interleaves with {}, which are repeated with it, {ms} ms more", names.join(", "));
    }
    row.spread(alone.ms).text(text)
}

fn work(pass: &Pass) -> String {
    let counts: Vec<String> =
        pass.work.iter().map(|(name, count)| format!("{} {name}", units::count(*count))).collect();
    counts.join(", ")
}

/// The whole, then its parts from the largest.
fn memory(run: &Run) -> String {
    parts_of(run.memory_bytes, run.memory.iter().map(|(piece, bytes)| (piece.as_str(), *bytes)), 0)
}

/// A piece has a row of its own from this share of all memory on, and a part of it a name there from a hundredth of the piece on.
const SHARE_WITH_A_ROW: f64 = 0.1;

/// What the pieces that hold much hold.
fn memory_rows(run: &Run) -> Vec<Row> {
    let large = run.memory_parts.iter().filter(|(_, parts)| parts.len() > 1);
    let rows = large.filter_map(|(piece, parts)| {
        let total: u64 = parts.values().sum();
        // Its own name, which most of them begin with, says nothing.
        let own = format!("{}.", piece.rsplit('/').next().unwrap_or(piece));
        let named = parts.iter().map(|(name, bytes)| (name.strip_prefix(&own).unwrap_or(name), *bytes));
        let is_large = total as f64 >= SHARE_WITH_A_ROW * run.memory_bytes as f64;
        is_large.then(|| Row::frame(&format!("memory of {piece}")).text(parts_of(total, named, total / 100)))
    });
    rows.collect()
}

/// A total, then its parts from the largest; those of at most `small` bytes together.
fn parts_of<'a>(total: u64, parts: impl Iterator<Item = (&'a str, u64)>, small: u64) -> String {
    let (mut named, others): (Vec<_>, Vec<_>) = parts.partition(|(_, bytes)| *bytes > small);
    named.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    let others: u64 = others.iter().map(|(_, bytes)| bytes).sum();
    named.extend((others > 0).then_some(("others", others)));
    let parts: Vec<String> = named.iter().map(|(name, bytes)| format!("{name} {}", units::bytes(*bytes))).collect();
    let total = units::bytes(total);
    if parts.is_empty() { total } else { format!("{total}: {}", parts.join(", ")) }
}

fn settings(run: &Run) -> String {
    let settings = run.settings.iter().flat_map(|(piece, options)| {
        let options = options.as_object().into_iter().flatten();
        options.map(move |(key, value)| format!("{piece}.{key}={}", plain(value)))
    });
    settings.collect::<Vec<_>>().join(" ")
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::report::PassAlone;
    use crate::bench::samples::tests::example_run;

    #[test]
    fn passes_come_by_piece_and_the_frame_last() {
        let rows = rows(&example_run());
        let labels: Vec<String> = rows.iter().map(Row::label).collect();
        let passes = ["gbuffer/draw", "light-views", "  draw", "  reduce", "rsm/gather", "caustics/photons"];
        let frame = [
            "unexplained",
            "serialised frame",
            "frame",
            "cold frame",
            "unchanged frame",
            "compile",
            "memory",
            "memory of gbuffer",
            "settings",
        ];
        assert_eq!(labels, [&passes[..], &frame[..]].concat());
        assert_eq!(rows[0].cells(), ["4.500", "4.000", "5.000", "22.0 %", "262 k triangles"]);
        assert_eq!(rows[4].text, "786 k invocations, 1.2 G vpls");
        assert_eq!(rows[5].cells(), ["skipped", "", "", "", "no specular surface"]);
        assert_eq!(rows[6].cells(), ["0.500", "", "", "2.4 %", ""]);
        assert_eq!(rows[12].text, "100 MiB: scene 80.0 MiB, gbuffer 20.0 MiB");
        assert_eq!(rows[13].text, "20.0 MiB: depth 12.0 MiB, normal 8.0 MiB, others 64 B");
        assert!(rows[14].text.contains("rsm.vpls=256"), "{}", rows[14].text);
    }

    #[test]
    fn levels_stand_below_their_piece_and_passes_below_their_level() {
        let pass = |pass: &str| Pass { piece: "caustics/photons".to_owned(), pass: pass.to_owned(), ..Pass::default() };
        let piece = |name: &str, within: Option<&str>| Piece {
            piece: name.to_owned(),
            within: within.map(str::to_owned),
            ..Piece::default()
        };
        let photons = Some("caustics/photons");
        let run = Run {
            passes: ["lists/clear", "trace/emit", "lists/draw", "clear", "splat/sort"].map(pass).to_vec(),
            pieces: vec![
                piece("caustics/photons", None),
                piece("caustics/photons/lists", photons),
                piece("caustics/photons/trace", photons),
                piece("caustics/photons/splat", photons),
            ],
            ..Run::default()
        };
        let rows = rows(&run);
        let labels: Vec<(&str, String)> = rows.iter().map(|row| (row.kind.name(), row.label())).collect();
        let expected = [
            ("piece", "caustics/photons"),
            ("level", "  lists"),
            ("pass", "    clear"),
            ("pass", "    draw"),
            ("pass", "  trace/emit"),
            ("pass", "  clear"),
            ("pass", "  splat/sort"),
        ];
        assert_eq!(labels[..7], expected.map(|(kind, label)| (kind, label.to_owned())));
        assert_eq!(rows[2].name, "caustics/photons/lists/clear");
    }

    #[test]
    fn a_piece_alone_names_what_had_to_be_repeated_with_it() {
        let ms = |ms: f64| Spread { min: ms, median: ms, p95: ms };
        let piece = "caustics/photons/trace".to_owned();
        let (ms_alone, in_frame_ms, whole_ms) = (ms(4.0), ms(5.0), ms(3.5));
        let also = vec![PassAlone { pass: "caustics/photons/choose/list".to_owned(), ms: ms(0.25) }];
        let alone = PieceAlone { piece, ms: ms_alone, in_frame_ms, whole_ms, also, ..PieceAlone::default() };
        let skipped = PieceAlone { skipped: Some("no light".to_owned()), ..alone.clone() };
        let rows = rows(&Run { piece_alone: vec![alone, skipped], ..Run::default() });
        let rows: Vec<&Row> = rows.iter().filter(|row| row.kind == RowKind::Alone).collect();
        let [alone, skipped] = rows[..] else { panic!("{} rows", rows.len()) };
        assert_eq!((alone.label(), alone.ms), ("caustics/photons/trace alone".to_owned(), Some(4.0)));
        for words in
            ["5.000 ms within", "3.500 ms if", "interleaves with caustics/photons/choose/list", "0.250 ms more"]
        {
            assert!(alone.text.contains(words), "{words} is not in {}", alone.text);
        }
        assert_eq!((skipped.skipped, &*skipped.text, skipped.ms), (true, "no light", None));
    }

    #[test]
    fn leaks_stand_room_by_room_and_slot_by_slot() {
        let slots = |direct: f64, diffuse: f64| BTreeMap::from([(Slot::Direct, direct), (Slot::Diffuse, diffuse)]);
        let room = |name: &str, direct, diffuse| (name.to_owned(), slots(direct, diffuse));
        let rooms = BTreeMap::from([room("sealed", 0.0, 0.0), room("thin", 0.0, 0.00125)]);
        let rows = rows(&Run { leaks: Some(Leaks { emitted_w: 2.0, rooms }), ..Run::default() });
        let row = rows.iter().find(|row| row.name == "leaks").expect("a row");
        assert_eq!(row.text, "of all light in dark rooms: sealed: none; thin: diffuse 1.3e-3");
    }

    #[test]
    fn an_empty_run_has_no_undefined_shares() {
        for row in rows(&Run::default()) {
            assert!(!row.cells().concat().contains("NaN"), "{row:?}");
        }
    }
}
