//! What both ways of splatting start with: photons become discs, are counted in a grid of cells, and the tiles that they may reach are listed.

use ash::vk;

use super::grid::Grid;
use crate::frame::gbuffer::GBuffer;
use crate::frame::photons::records::{COUNT_WORD, DISPATCH_WORD, LandedPhotons, STAGE_WORDS};
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::shaders::groups;
use crate::shaders::photon_splat::{Project, ProjectPush, Start, StartPush, Touch, TouchPush};

/// Words of `photons.splat_state` (glsl/photon_splat/state.glsl).
pub(super) const STATE_WORDS: usize = 19;
const STATE_DROPPED: usize = 18;
pub(super) const ROWS_WORD: usize = 0;
const BLOCKS_WORD: usize = 3;
pub(super) const PARTS_WORD: usize = 14;

/// A list of tiles that photons may reach, by where its four words are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum TileList {
    Ordinary = 6,
    Crowded = 10,
}

impl TileList {
    pub(super) fn word(self) -> usize {
        self as usize
    }

    /// The name of a pass over the list.
    pub(super) fn pass_name(self, pass: &str) -> String {
        let suffix = if self == TileList::Crowded { "-crowded" } else { "" };
        format!("caustics/photons/splat/{pass}{suffix}")
    }
}

/// Photons that a group of `tiles` takes at most: what more would keep one group busy while others have none left. It is no more than any device's
/// loops may do ([`crate::vulkan::DeviceTraits::loop_steps`]), of whose steps a photon takes up to two.
pub(super) const PART_PHOTONS: u32 = 32000;

pub(super) const WORDS: vk::Format = vk::Format::R32_UINT;
pub(super) const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// What the passes share.
pub(super) struct Splat<'a> {
    pub(super) buffer: &'a GBuffer,
    pub(super) landed: LandedPhotons,
    pub(super) gaussian: u32,
    pub(super) elliptic: u32,
    pub(super) tolerance: f32,
    pub(super) image_size: [i32; 2],
    pub(super) downscale: i32,
    pub(super) grid: Grid,
    /// Three texels a photon (glsl/photon_splat/disc.glsl).
    pub(super) discs: BufferRef<[u32; 4]>,
    /// A photon's cell, and its place there.
    pub(super) places: BufferRef<[u32; 2]>,
    pub(super) cell_counts: BufferRef<u32>,
    pub(super) cell_peaks: BufferRef<u32>,
    pub(super) tile_list: BufferRef<u32>,
    pub(super) crowded: BufferRef<u32>,
    pub(super) tile_peaks: BufferRef<u32>,
    pub(super) state: BufferRef<u32>,
    /// Whether a tile may have more photons than a group takes.
    pub(super) may_crowd: bool,
    /// Tiles whose sums are kept at a time.
    pub(super) tiles_at_once: usize,
    /// What the samples' results are written to: the slot, or irradiance.
    pub(super) result: ImageRef,
}

impl Splat<'_> {
    /// What both ways start with: `start`, `project`, `touch`.
    pub(super) fn declare_start(&self, graph: &mut Graph<'_>) {
        graph.fill_buffer("caustics/photons/splat/clear-counts", self.cell_counts, 0);
        graph.fill_buffer("caustics/photons/splat/clear-peaks", self.cell_peaks, 0);
        let (grid, stage) = (&self.grid, self.landed.stage as u32);
        let blocks = grid.tiles().map(|tiles| tiles.div_ceil(8));
        let pass = Start {
            counts: self.landed.counts.texels(WORDS),
            state: self.state.write(),
            push: StartPush { stage, row_count: grid.row_count, blocks },
        };
        graph.pass("caustics/photons/splat/start", pass).groups([1, 1, 1]);

        let pass = Project {
            splat: self.group(TileList::Ordinary),
            surface: self.buffer.group.clone(),
            photons: self.landed.photons.texels(RECORDS),
            ellipses: self.landed.ellipses.texels(vk::Format::R32G32B32A32_SFLOAT),
            counts: self.landed.counts.texels(WORDS),
            discs: self.discs.start(),
            places: self.places.start(),
            cell_counts: self.cell_counts.read_write(),
            cell_peaks: self.cell_peaks.read_write(),
            state: self.state.read_write(),
            push: ProjectPush {
                image_size: self.image_size,
                stage,
                downscale: self.downscale,
                level_count: grid.level_count,
                tolerance: self.tolerance,
            },
        };
        let first = STAGE_WORDS * self.landed.stage;
        graph
            .pass("caustics/photons/splat/project", pass)
            .unordered()
            .count("photons", self.landed.counts, first + COUNT_WORD)
            .count("dropped", self.state, STATE_DROPPED)
            .threads_indirect(self.landed.counts, first + DISPATCH_WORD);

        let pass = Touch {
            splat: self.group(TileList::Ordinary),
            cell_peaks: self.cell_peaks.texels(WORDS),
            cell_counts: self.cell_counts.texels(WORDS),
            tile_peaks: self.tile_peaks.start(),
            tiles: self.tile_list.start(),
            crowded: self.crowded.start(),
            state: self.state.read_write(),
            push: TouchPush {
                tile_count: grid.tiles().map(u32::cast_signed),
                level_count: grid.level_count,
                ordinary: if self.may_crowd { PART_PHOTONS } else { u32::MAX },
            },
        };
        graph
            .pass("caustics/photons/splat/touch", pass)
            .unordered()
            .count("tiles", self.state, TileList::Ordinary.word() + 3)
            .count("crowded tiles", self.state, TileList::Crowded.word() + 3)
            .threads_indirect(self.state, BLOCKS_WORD);
    }

    /// What later passes read of the first ones, over the tiles of `list`.
    pub(super) fn group(&self, list: TileList) -> groups::Splat {
        let tiles = if list == TileList::Ordinary { self.tile_list } else { self.crowded };
        groups::Splat {
            splat_state: self.state.texels(WORDS),
            splat_tiles: tiles.texels(WORDS),
            splat_peaks: self.tile_peaks.texels(WORDS),
            splat_levels: self.grid.levels.texels(RECORDS),
            gaussian: self.gaussian,
            elliptic: self.elliptic,
        }
    }

    /// The lists of tiles that the chosen way makes.
    pub(super) fn lists(&self) -> &'static [TileList] {
        if self.may_crowd { &[TileList::Ordinary, TileList::Crowded] } else { &[TileList::Ordinary] }
    }
}
