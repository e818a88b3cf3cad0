//! The graph, printed: as text and as Graphviz.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::declare::Graph;
use super::demand::{Verdict, Version};
use super::pass::Pass;
use super::piece::joined;

/// The passes of a frame, which of them are skipped and why, and what flows between them.
#[derive(Clone, Debug, Default)]
pub struct GraphDescription {
    passes: Vec<DescribedPass>,
}

#[derive(Clone, Debug)]
struct DescribedPass {
    piece: String,
    name: String,
    skipped: Option<String>,
    reads: Vec<String>,
    writes: Vec<String>,
}

impl Graph<'_> {
    /// Describes the frame without running it.
    pub(crate) fn describe(self) -> GraphDescription {
        let verdicts = self.verdicts();
        let describe = |(pass, verdict): (&Pass, &Verdict)| {
            let names = |versions: &[Version]| -> Vec<String> {
                let names: BTreeSet<&String> =
                    versions.iter().map(|version| &self.resources[version.place.0].name).collect();
                names.into_iter().cloned().collect()
            };
            DescribedPass {
                piece: pass.piece.clone(),
                name: pass.name.clone(),
                skipped: pass.skip_reason(*verdict),
                reads: names(&pass.needs.reads),
                writes: names(&pass.needs.writes),
            }
        };
        GraphDescription { passes: self.passes.iter().zip(&verdicts).map(describe).collect() }
    }
}

impl DescribedPass {
    fn full_name(&self) -> String {
        joined(&self.piece, &self.name)
    }

    /// What tells it from the others of its piece.
    fn label(&self) -> &str {
        if self.name.is_empty() { &self.piece } else { &self.name }
    }
}

impl GraphDescription {
    /// Adds the passes of another graph of the same frame, which run after these.
    pub(crate) fn append(&mut self, mut other: GraphDescription) {
        self.passes.append(&mut other.passes);
    }

    /// One line a pass, in the order of execution.
    pub fn text(&self) -> String {
        let mut out = String::new();
        for pass in &self.passes {
            writeln!(out, "{}", pass.full_name()).ok();
            match &pass.skipped {
                Some(reason) => writeln!(out, "    skipped: {reason}").ok(),
                None => {
                    writeln!(out, "    reads  {}\n    writes {}", pass.reads.join(", "), pass.writes.join(", ")).ok()
                }
            };
        }
        out
    }

    /// A Graphviz digraph: passes as boxes grouped by piece, images and buffers as ellipses, skipped passes dashed with
    /// their reason.
    pub fn dot(&self) -> String {
        let quoted = |text: &str| format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""));
        let mut out = String::from("digraph frame {\n  rankdir=LR;\n  node [fontname=\"sans-serif\", fontsize=10];\n");
        let mut pieces: BTreeMap<&str, Vec<&DescribedPass>> = BTreeMap::new();
        for pass in &self.passes {
            pieces.entry(&pass.piece).or_default().push(pass);
        }
        for (number, (piece, passes)) in pieces.iter().enumerate() {
            writeln!(out, "  subgraph cluster_{number} {{\n    label={};", quoted(piece)).ok();
            for pass in passes {
                let name = pass.full_name();
                match &pass.skipped {
                    Some(reason) => writeln!(
                        out,
                        "    {} [shape=box, style=dashed, label={}];",
                        quoted(&name),
                        quoted(&format!("{}\n{reason}", pass.label())).replace('\n', "\\n")
                    )
                    .ok(),
                    None => {
                        writeln!(out, "    {} [shape=box, style=bold, label={}];", quoted(&name), quoted(pass.label()))
                            .ok()
                    }
                };
            }
            out.push_str("  }\n");
        }
        let resources: BTreeSet<&String> =
            self.passes.iter().flat_map(|pass| pass.reads.iter().chain(&pass.writes)).collect();
        for resource in resources {
            writeln!(out, "  {} [shape=ellipse];", quoted(resource)).ok();
        }
        for pass in &self.passes {
            let name = quoted(&pass.full_name());
            for read in &pass.reads {
                writeln!(out, "  {} -> {name};", quoted(read)).ok();
            }
            for write in &pass.writes {
                writeln!(out, "  {name} -> {};", quoted(write)).ok();
            }
        }
        out.push_str("}\n");
        out
    }
}
