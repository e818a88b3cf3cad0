//! Sums of samples in a tree whose shape depends on nothing but which samples there are.
//!
//! Samples come in chunks of [`CHUNK_SAMPLES`] of each half. Chunk k is block (0, k); block (level, index) is block
//! (level − 1, 2·index) + block (level − 1, 2·index + 1) in f32, left + right. So the set of finished chunks alone decides
//! every bit of the sums, whichever machines made them, in whichever order; and rounding errors grow with the logarithm of the
//! number of samples.

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;

use super::SlotSums;
use crate::slot::Slot;

/// Samples of every pixel in a chunk of one half; a power of two.
pub const CHUNK_SAMPLES: u32 = 8;

/// Samples of every pixel that a chunk of both halves adds.
pub(crate) const SAMPLES_PER_CHUNK: u32 = 2 * CHUNK_SAMPLES;

/// The largest level, so that no index of a chunk overflows.
pub(crate) const MAX_LEVEL: u32 = 26;

/// The most samples per pixel of a reference.
pub const MAX_SPP: u32 = SAMPLES_PER_CHUNK << MAX_LEVEL;

/// The two halves.
pub(crate) const HALVES: [usize; 2] = [0, 1];

/// One row-major image for each of [`Slot::ALL`].
pub(crate) type SlotPixels = [Vec<[f32; 3]>; 5];

/// Sums over 2^level chunks, of both halves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    pub(crate) level: u32,
    pub(crate) index: u32,
    pub(crate) halves: [SlotPixels; 2],
}

impl Block {
    /// A chunk as its source made it.
    pub(crate) fn chunk(index: u32, [a, b]: [SlotSums; 2]) -> Block {
        Block { level: 0, index, halves: [a.slots, b.slots] }
    }

    /// The chunks in it.
    pub(crate) fn chunks(&self) -> Range<u32> {
        self.index << self.level..(self.index + 1) << self.level
    }

    /// The block that two neighbours make: the left one has an even index.
    fn joined(mut left: Block, right: &Block) -> Block {
        for (left, right) in left.halves.iter_mut().flatten().zip(right.halves.iter().flatten()) {
            left.par_iter_mut().zip(right).for_each(|(left, right)| {
                *left = std::array::from_fn(|channel| left[channel] + right[channel]);
            });
        }
        Block { level: left.level + 1, index: left.index / 2, halves: left.halves }
    }
}

/// Chunks that were to be added although they, or some of them, are there.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Overlap(pub(crate) Range<u32>);

/// The largest blocks that the finished chunks make, by their first chunk.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct State {
    blocks: BTreeMap<u32, Block>,
}

impl State {
    /// The largest finished blocks, in the order of their chunks.
    pub(crate) fn blocks(&self) -> impl DoubleEndedIterator<Item = &Block> {
        self.blocks.values()
    }

    /// The same, given away.
    pub(crate) fn into_blocks(self) -> impl Iterator<Item = Block> {
        self.blocks.into_values()
    }

    /// Adds a block and joins what can be joined.
    ///
    /// # Errors
    /// Chunks that are there already; then nothing changes.
    pub(crate) fn insert(&mut self, mut block: Block) -> Result<(), Overlap> {
        let chunks = block.chunks();
        let before = self.blocks.range(..chunks.end).next_back().map(|(_, block)| block.chunks());
        if let Some(before) = before.filter(|before| before.end > chunks.start) {
            return Err(Overlap(before.start.max(chunks.start)..before.end.min(chunks.end)));
        }
        while block.level < MAX_LEVEL {
            let sibling = (block.index ^ 1) << block.level;
            if self.blocks.get(&sibling).is_none_or(|sibling| sibling.level != block.level) {
                break;
            }
            let Some(sibling) = self.blocks.remove(&sibling) else { break };
            let (left, right) = if block.index.is_multiple_of(2) { (block, sibling) } else { (sibling, block) };
            block = Block::joined(left, &right);
        }
        self.blocks.insert(block.chunks().start, block);
        Ok(())
    }

    /// How many chunks are finished.
    pub(crate) fn chunk_count(&self) -> u32 {
        self.blocks.values().map(|block| 1 << block.level).sum()
    }

    /// Samples of every pixel, of both halves together.
    pub(crate) fn samples(&self) -> u32 {
        self.chunk_count() * SAMPLES_PER_CHUNK
    }

    /// The chunks of `wanted` that are not finished, as ranges in ascending order.
    pub(crate) fn missing(&self, wanted: Range<u32>) -> Vec<Range<u32>> {
        let mut missing = Vec::new();
        let mut next = wanted.start;
        for chunks in self.blocks.values().map(Block::chunks).filter(|chunks| chunks.end > wanted.start) {
            if chunks.start >= wanted.end {
                break;
            }
            if chunks.start > next {
                missing.push(next..chunks.start);
            }
            next = next.max(chunks.end);
        }
        if next < wanted.end {
            missing.push(next..wanted.end);
        }
        missing
    }

    /// One past the last finished chunk.
    pub(crate) fn end(&self) -> u32 {
        self.blocks.values().next_back().map_or(0, |block| block.chunks().end)
    }

    /// What the samples come to.
    pub(crate) fn means(&self) -> Means {
        let pixel_count = self.blocks.values().next().map_or(0, |block| block.halves[0][0].len());
        let weight = 1.0 / f64::from(self.samples().max(1));
        let (mut means, mut noise) = (Vec::new(), Vec::new());
        for slot in 0..Slot::ALL.len() {
            let pixels = (0..pixel_count).into_par_iter().map(|pixel| {
                let [a, b] = HALVES.map(|half| self.sum(half, slot, pixel));
                // Each half has half of the samples, so its mean is its sum times 2·weight.
                let mean: [f64; 3] = std::array::from_fn(|channel| (a[channel] + b[channel]) * weight);
                let noise: [f64; 3] = std::array::from_fn(|channel| (a[channel] - b[channel]) * weight);
                (mean, noise.map(|value| value as f32))
            });
            let (mean, half_difference): (Vec<_>, Vec<_>) = pixels.unzip();
            means.push(mean);
            noise.push(half_difference);
        }
        let image = (0..pixel_count).into_par_iter().map(|pixel| {
            std::array::from_fn(|channel| {
                means.iter().map(|slot: &Vec<[f64; 3]>| slot[pixel][channel]).sum::<f64>() as f32
            })
        });
        let image = image.collect();
        let rounded = |pixels: Vec<[f64; 3]>| pixels.into_iter().map(|pixel| pixel.map(|value| value as f32)).collect();
        Means { image, slots: means.into_iter().map(rounded).collect(), noise }
    }

    fn sum(&self, half: usize, slot: usize, pixel: usize) -> [f64; 3] {
        self.blocks.values().fold([0.0; 3], |sum, block| {
            let value = block.halves[half][slot][pixel];
            std::array::from_fn(|channel| sum[channel] + f64::from(value[channel]))
        })
    }
}

/// Means over all samples.
#[derive(Clone, Debug)]
pub(crate) struct Means {
    /// The sum of all slots.
    pub(crate) image: Vec<[f32; 3]>,
    /// One for each of [`Slot::ALL`].
    pub(crate) slots: Vec<Vec<[f32; 3]>>,
    /// Half the difference of the means of the two halves, one for each of [`Slot::ALL`].
    pub(crate) noise: Vec<Vec<[f32; 3]>>,
}
