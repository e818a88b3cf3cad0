//! Bits that passes set, and their numbers as a list, in their order.

use super::super::formats::WORD;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::particles::{MeshBits, MeshBitsPush, MeshNumbers, MeshNumbersPush};

/// What is marked.
pub(super) struct Found {
    pub(super) marks: BufferRef<u32>,
    /// Bits before each word.
    pub(super) starts: BufferRef<u32>,
    /// Groups of 64 that take one each, in three words, and how many there are.
    pub(super) head: BufferRef<u32>,
    pub(super) numbers: BufferRef<u32>,
}

impl Found {
    /// `count` bits, none of them set.
    pub(super) fn marks(graph: &mut Graph<'_>, what: &str, count: u32) -> BufferRef<u32> {
        let marks = graph.buffer::<u32>(&format!("particles.{what}_marks"), (count.div_ceil(32) as usize).max(1));
        graph.fill_buffer(&format!("diffuse/particles/find/clear-{}", what.replace('_', "-")), marks, 0);
        marks
    }

    /// Lists the bits that are set, `most` at most.
    pub(super) fn declare(graph: &mut Graph<'_>, what: &str, marks: BufferRef<u32>, most: usize) -> Found {
        let word_count = marks.count() as u32;
        let starts = graph.buffer::<u32>(&format!("particles.{what}_before"), marks.count() + 1);
        let head = graph.buffer::<u32>(&format!("particles.{what}_head"), 4);
        let pass = MeshBits {
            marks: marks.texels(WORD),
            starts: starts.write(),
            found: head.write(),
            push: MeshBitsPush { word_count },
        };
        let name = what.replace('_', "-");
        graph.pass(&format!("diffuse/particles/find/{name}-count"), pass).groups([1, 1, 1]);
        let numbers = graph.buffer::<u32>(&format!("particles.{what}"), most.max(1));
        let pass = MeshNumbers {
            marks: marks.texels(WORD),
            starts: starts.texels(WORD),
            numbers: numbers.start(),
            push: MeshNumbersPush { word_count },
        };
        graph.pass(&format!("diffuse/particles/find/{name}"), pass).threads([word_count, 1, 1]);
        Found { marks, starts, head, numbers }
    }
}
