//! Sums of samples that many invocations add to, in a buffer: of discs, and of crowded tiles. A tile's take 8 KiB, more than a device has for all
//! tiles of a large frame: its tiles are done in ranges, one after the other in the same memory.

use super::splat_tiles::{RECORDS, Splat, TileList};
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::photon_splat::{Clear, ClearPush, Resolve, ResolvePush};

/// Words of the sums of a tile's samples.
const TILE_SUM_WORDS: usize = 8 * 256;
/// Tiles whose sums are kept at a time: 64 MiB, half of what every device lets a kernel see of one buffer.
pub(crate) const TILES_AT_ONCE: usize = 8192;

/// Tiles that are done together.
#[derive(Clone, Copy)]
pub(super) struct TileRange {
    number: usize,
    /// The first tile, and the one after the last.
    pub(super) ends: [i32; 2],
    pub(super) sums: BufferRef<u32>,
}

impl TileRange {
    /// The name of a pass over the tiles of the range that are in `list`.
    pub(super) fn pass_name(&self, list: TileList, pass: &str) -> String {
        let name = list.pass_name(pass);
        if self.number == 0 { name } else { format!("{name}.{}", self.number) }
    }
}

impl Splat<'_> {
    /// Ranges that hold all tiles.
    pub(super) fn ranges(&self, graph: &mut Graph<'_>) -> Vec<TileRange> {
        let (tiles, at_once) = (self.grid.tile_count(), self.tiles_at_once.max(1));
        let sums = graph.buffer("photons.sums", TILE_SUM_WORDS * tiles.min(at_once));
        let range = |number: usize| {
            let first = number * at_once;
            let ends = [first, tiles.min(first + at_once)].map(|tile| i32::try_from(tile).unwrap_or(i32::MAX));
            TileRange { number, ends, sums }
        };
        (0..tiles.div_ceil(at_once)).map(range).collect()
    }

    /// Clears the sums of those tiles of the range that are in `list`.
    pub(super) fn clear_sums(&self, graph: &mut Graph<'_>, list: TileList, range: TileRange) {
        let pass = Clear {
            splat: self.group(list),
            sums: range.sums.start(),
            push: ClearPush { list: list.word() as u32, range: range.ends },
        };
        graph.pass(&range.pass_name(list, "clear-sums"), pass).threads_indirect(self.state, list.word());
    }

    /// Writes the results of those tiles of the range that are in `list` from their sums.
    pub(super) fn resolve(&self, graph: &mut Graph<'_>, list: TileList, range: TileRange) {
        let pass = Resolve {
            splat: self.group(list),
            surface: self.buffer.group.clone(),
            sums: range.sums.texels(RECORDS),
            result: self.result.modify(),
            push: ResolvePush {
                image_size: self.image_size,
                downscale: self.downscale,
                list: list.word() as u32,
                range: range.ends,
            },
        };
        graph.pass(&range.pass_name(list, "resolve"), pass).threads_indirect(self.state, list.word());
    }
}
