//! From photons where they landed to the slot (Quyen 2014, sections 3.3.2.3 and 3.3.2.4): each spreads its flux over a disc of its surface.
//!
//!   L(x) = ρ/π · E(x)       E(x) = Σ_p Φ_p·K(d_p/h_p)/h_p²·(n_x·n_p)⁺      W/(m² sr)
//!
//! The paper's ΔE = Φκ(d)/(πh²) does not conserve energy; K here has unit integral (glsl/photon_splat/kernel.glsl), and the cosine makes up
//! for surfaces that bend away from the disc, so that a photon's whole flux arrives wherever its surface goes on for h. Of a disc that
//! sticks out over its surface's edge, the part outside is lost: how large it is, nobody knows here.
//!
//! Two ways, [`super::discs`] and [`super::tiles`], share the first steps: photons become discs and are counted in a grid of cells
//! (`project`), and the tiles of 16×16 samples that they may reach are listed (`touch`). Later passes run for those tiles alone; elsewhere the
//! slot is cleared. Sums are in fixed point, so that the order of photons, which differs from run to run, changes no bit.
//!
//! `auto` takes tiles: on the software driver discs cost four to six times as much (three atomic additions for each of a disc's pixels). No other
//! device was measured.
//!
//! With `downscale` beyond 1 irradiance is splatted to every second or fourth pixel's surface and then interpolated ([`super::upsample`]).

use ash::vk;

use super::discs::discs;
use super::grid::Grid;
use super::options::{PhotonFootprint, PhotonKernel, PhotonSettings, PhotonSplatting};
use super::records::{COUNT_WORD, DISPATCH_WORD, LandedPhotons, STAGE_WORDS};
use super::tiles::tiles;
use super::upsample::upsample;
use crate::frame::gbuffer::GBuffer;
use crate::graph::bindings::{BufferRef, ImageRef, TexelBuffer};
use crate::graph::{ClearColor, Graph};
use crate::shaders::photon_splat::{Project, ProjectPush, Start, StartPush, Touch, TouchPush};

/// Words of `photons.splat_state` (glsl/photon_splat/state.glsl).
const STATE_WORDS: usize = 18;
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
        format!("caustics/photons/{pass}{suffix}")
    }
}

/// What a photon may be off its surface, over the scene's length: its hit may come from lists of limited resolution.
const TOLERANCE: f64 = 1e-3;

/// Photons that a group of `tiles` takes at most: a driver may end loops after 65535 rounds, of which a photon takes up to 1⅛.
const PART_PHOTONS: u32 = 32768;

pub(super) const WORDS: vk::Format = vk::Format::R32_UINT;
pub(super) const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// What splatting takes.
pub(crate) struct SplatInputs<'a> {
    pub(crate) buffer: &'a GBuffer,
    pub(crate) settings: &'a PhotonSettings,
    /// Radius of the scene, metres.
    pub(crate) length: f64,
    /// Tiles whose sums are kept at a time, [`super::sums::TILES_AT_ONCE`].
    pub(crate) tiles_at_once: usize,
}

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
    cell_peaks: BufferRef<u32>,
    tile_list: BufferRef<u32>,
    crowded: BufferRef<u32>,
    tile_peaks: BufferRef<u32>,
    pub(super) state: BufferRef<u32>,
    /// Whether a tile may have more photons than a group takes.
    pub(super) may_crowd: bool,
    /// Tiles whose sums are kept at a time.
    pub(super) tiles_at_once: usize,
    /// What the samples' results are written to: the slot, or irradiance.
    pub(super) result: ImageRef,
}

/// Declares the passes; returns the slot.
pub(crate) fn splat(graph: &mut Graph<'_>, inputs: &SplatInputs<'_>, landed: &LandedPhotons) -> ImageRef {
    let (buffer, settings) = (inputs.buffer, inputs.settings);
    let downscale = settings.downscale.max(1);
    let slot = graph.image("caustics", vk::Format::R32G32B32A32_SFLOAT, buffer.size);
    graph.clear_image("caustics/photons/clear", slot, ClearColor::Float([0.0, 0.0, 0.0, 1.0]));
    let grid = Grid::upload(graph, buffer.size.map(|side| side.div_ceil(downscale)));
    let result = if downscale == 1 {
        slot
    } else {
        let irradiance = graph.image("photons.irradiance", vk::Format::R32G32B32A32_SFLOAT, grid.size);
        graph.clear_image("caustics/photons/clear-irradiance", irradiance, ClearColor::Float([0.0; 4]));
        irradiance
    };
    let (cells, tile_count, capacity) = (grid.cell_count as usize, grid.tile_count(), landed.capacity.max(1) as usize);
    let shared = Splat {
        buffer,
        landed: *landed,
        gaussian: u32::from(settings.kernel == PhotonKernel::Gaussian),
        elliptic: u32::from(settings.footprint == PhotonFootprint::Beam),
        tolerance: (inputs.length * TOLERANCE) as f32,
        image_size: buffer.size.map(u32::cast_signed),
        downscale: downscale.cast_signed(),
        grid,
        discs: graph.buffer("photons.discs", 3 * capacity),
        places: graph.buffer("photons.places", capacity),
        cell_counts: graph.buffer("photons.cell_counts", cells),
        cell_peaks: graph.buffer("photons.cell_peaks", cells),
        tile_list: graph.buffer("photons.splat_tiles", tile_count),
        crowded: graph.buffer("photons.crowded", tile_count),
        tile_peaks: graph.buffer("photons.tile_peaks", tile_count),
        state: graph.buffer("photons.splat_state", STATE_WORDS),
        may_crowd: settings.splat != PhotonSplatting::Discs && landed.capacity > PART_PHOTONS,
        tiles_at_once: inputs.tiles_at_once,
        result,
    };
    shared.declare_start(graph);
    match settings.splat {
        PhotonSplatting::Discs => discs(graph, &shared),
        PhotonSplatting::Tiles | PhotonSplatting::Auto => tiles(graph, &shared),
    }
    if downscale > 1 {
        upsample(graph, &shared, slot);
    }
    slot
}

impl Splat<'_> {
    /// What both ways start with: `start`, `project`, `touch`.
    fn declare_start(&self, graph: &mut Graph<'_>) {
        graph.fill_buffer("caustics/photons/clear-counts", self.cell_counts, 0);
        graph.fill_buffer("caustics/photons/clear-peaks", self.cell_peaks, 0);
        let (grid, stage) = (&self.grid, self.landed.stage as u32);
        let blocks = grid.tiles().map(|tiles| tiles.div_ceil(8));
        let pass = Start {
            counts: self.landed.counts.texels(WORDS),
            state: self.state.write(),
            push: StartPush { stage, row_count: grid.row_count, blocks },
        };
        graph.pass("caustics/photons/splat-start", pass).groups([1, 1, 1]);

        let pass = Project {
            camera: self.buffer.camera.clone(),
            photons: self.landed.photons.texels(RECORDS),
            ellipses: self.landed.ellipses.texels(vk::Format::R32G32B32A32_SFLOAT),
            counts: self.landed.counts.texels(WORDS),
            levels: grid.levels.texels(RECORDS),
            discs: self.discs.write(),
            places: self.places.write(),
            cell_counts: self.cell_counts.read_write(),
            cell_peaks: self.cell_peaks.read_write(),
            state: self.state.read_write(),
            gaussian: self.gaussian,
            elliptic: self.elliptic,
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
            .pass("caustics/photons/project", pass)
            .count("photons", self.landed.counts, first + COUNT_WORD)
            .threads_indirect(self.landed.counts, first + DISPATCH_WORD);

        let pass = Touch {
            levels: grid.levels.texels(RECORDS),
            cell_peaks: self.cell_peaks.texels(WORDS),
            cell_counts: self.cell_counts.texels(WORDS),
            tile_peaks: self.tile_peaks.write(),
            tiles: self.tile_list.write(),
            crowded: self.crowded.write(),
            state: self.state.read_write(),
            push: TouchPush {
                tile_count: grid.tiles().map(u32::cast_signed),
                level_count: grid.level_count,
                ordinary: if self.may_crowd { PART_PHOTONS } else { u32::MAX },
            },
        };
        graph
            .pass("caustics/photons/touch", pass)
            .count("tiles", self.state, TileList::Ordinary.word() + 3)
            .count("crowded tiles", self.state, TileList::Crowded.word() + 3)
            .threads_indirect(self.state, BLOCKS_WORD);
    }

    pub(super) fn state_texels(&self) -> TexelBuffer {
        self.state.texels(WORDS)
    }

    /// The lists of tiles that the chosen way makes.
    pub(super) fn lists(&self) -> &'static [TileList] {
        if self.may_crowd { &[TileList::Ordinary, TileList::Crowded] } else { &[TileList::Ordinary] }
    }

    pub(super) fn tile_texels(&self, list: TileList) -> TexelBuffer {
        match list {
            TileList::Ordinary => self.tile_list.texels(WORDS),
            TileList::Crowded => self.crowded.texels(WORDS),
        }
    }

    pub(super) fn tile_peak_texels(&self) -> TexelBuffer {
        self.tile_peaks.texels(WORDS)
    }
}
