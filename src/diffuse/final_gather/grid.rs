//! Records in the buckets of a grid over space, listed by counting (glsl/final_gather/list.comp). Within a bucket their order is any.

use ash::vk;

use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::buckets::{Starts, StartsPush};
use crate::shaders::final_gather::{List, ListPush};
use crate::shaders::types::MapRecord;

pub(super) const WORD: vk::Format = vk::Format::R32_UINT;
pub(super) const WORDS4: vk::Format = vk::Format::R32G32B32A32_UINT;

/// Buckets that are being counted.
pub(super) struct Counted {
    name: &'static str,
    pub(super) records: BufferRef<MapRecord>,
    pub(super) buckets: BufferRef<u32>,
    pub(super) counts: BufferRef<u32>,
    pub(super) bits: u32,
}

/// Records, bucket by bucket.
#[derive(Clone, Copy)]
pub(super) struct Listed {
    pub(super) records: BufferRef<MapRecord>,
    pub(super) starts: BufferRef<u32>,
    pub(super) lengths: BufferRef<u32>,
    pub(super) bits: u32,
}

impl Counted {
    /// None so far.
    pub(super) fn declare(graph: &mut Graph<'_>, name: &'static str, records: BufferRef<MapRecord>) -> Counted {
        let capacity = records.count();
        let bits = (capacity.max(2).ilog2() / 3).clamp(3, 6);
        let buckets = graph.buffer(&format!("final-gather.{name}.buckets"), capacity);
        let counts = graph.buffer(&format!("final-gather.{name}.counts"), 1 << (3 * bits));
        graph.fill_buffer(&format!("diffuse/final-gather/map/clear-{name}"), counts, 0);
        Counted { name, records, buckets, counts, bits }
    }

    /// Lists as many as word `word` of `head` says, in one bucket `most` on the average at most.
    pub(super) fn list(self, graph: &mut Graph<'_>, (head, word): (BufferRef<u32>, u32), most: u32) -> Listed {
        let Counted { name, records, buckets, counts, bits } = self;
        let capacity = records.count();
        let bucket_count = 1_u32 << (3 * bits);
        let starts = graph.buffer::<u32>(&format!("final-gather.{name}.starts"), bucket_count as usize + 1);
        let pass = Starts { counts: counts.texels(WORD), starts: starts.write(), push: StartsPush { bucket_count } };
        graph.pass(&format!("diffuse/final-gather/map/{name}-starts"), pass).groups([1, 1, 1]);
        let lengths = graph.buffer::<u32>(&format!("final-gather.{name}.lengths"), bucket_count as usize);
        graph.fill_buffer(&format!("diffuse/final-gather/map/clear-{name}-lists"), lengths, 0);
        let listed = graph.buffer::<MapRecord>(&format!("final-gather.{name}.listed"), capacity);
        let pass = List {
            records: records.texels(WORDS4),
            buckets: buckets.texels(WORD),
            starts: starts.texels(WORD),
            head: head.texels(WORD),
            lengths: lengths.read_write(),
            listed: listed.start(),
            push: ListPush { capacity: capacity as u32, word, most },
        };
        let pass = graph.pass(&format!("diffuse/final-gather/map/{name}-list"), pass).unordered();
        pass.threads([capacity as u32, 1, 1]);
        Listed { records: listed, starts, lengths, bits }
    }
}
