//! Shards: parts of a reference that several machines make.

use std::ops::Range;

use super::blocks::SAMPLES_PER_CHUNK;

/// Part I of N of a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, 1 to `count`.
    pub index: u32,
    /// How many parts there are.
    pub count: u32,
}

impl Shard {
    /// Reads `I/N`.
    ///
    /// # Errors
    /// A sentence on what belongs there.
    pub fn parse(text: &str) -> Result<Shard, String> {
        let numbers = text.split_once('/').map(|(index, count)| (index.parse(), count.parse()));
        match numbers {
            Some((Ok(index), Ok(count))) if (1..=count).contains(&index) => Ok(Shard { index, count }),
            _ => Err("a shard is I/N, part I of N, such as 1/4".to_owned()),
        }
    }

    /// Its chunks of all that `spp` samples per pixel take. All shards together have each of them once; some have none if
    /// there are more shards than chunks.
    pub(crate) fn chunks(self, spp: u32) -> Range<u32> {
        let all = u64::from(chunks_of(spp));
        let end = |index: u32| (all * u64::from(index) / u64::from(self.count)) as u32;
        end(self.index - 1)..end(self.index)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

/// The chunks that at least `spp` samples per pixel take.
pub(crate) fn chunks_of(spp: u32) -> u32 {
    spp.div_ceil(SAMPLES_PER_CHUNK).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_have_every_chunk_once() {
        for (spp, count) in [(1, 1), (16, 3), (1000, 7), (4096, 4), (u32::MAX, 5)] {
            let mut next = 0;
            for index in 1..=count {
                let chunks = Shard { index, count }.chunks(spp);
                assert_eq!(chunks.start, next, "{index}/{count} of {spp}");
                next = chunks.end;
            }
            assert_eq!(next, chunks_of(spp));
        }
    }

    #[test]
    fn shards_are_written_as_parts() {
        assert_eq!(Shard::parse("2/3"), Ok(Shard { index: 2, count: 3 }));
        assert_eq!(Shard { index: 2, count: 3 }.to_string(), "2/3");
        for wrong in ["", "1", "0/3", "4/3", "1/0", "-1/3", "a/b", "1/2/3"] {
            assert!(Shard::parse(wrong).is_err_and(|error| error.contains("I/N")), "{wrong}");
        }
    }
}
