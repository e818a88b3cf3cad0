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
use super::options::{PhotonFootprint, PhotonKernel, PhotonOptions, PhotonSplatting};
use super::splat_tiles::{PART_PHOTONS, STATE_WORDS, Splat};
use super::tiles::tiles;
use super::upsample::upsample;
use crate::frame::gbuffer::GBuffer;
use crate::frame::photons::records::LandedPhotons;
use crate::graph::bindings::ImageRef;
use crate::graph::{ClearColor, Graph};

/// What a photon may be off its surface, over the scene's length: its hit may come from lists of limited resolution.
pub(super) const TOLERANCE: f64 = 1e-3;

/// What splatting takes.
pub(crate) struct SplatInputs<'a> {
    pub(crate) buffer: &'a GBuffer,
    pub(crate) options: &'a PhotonOptions,
    /// Radius of the scene, metres.
    pub(crate) length: f64,
    /// Tiles whose sums are kept at a time, [`super::sums::TILES_AT_ONCE`].
    pub(crate) tiles_at_once: usize,
}

/// Declares the passes; returns the slot.
pub(crate) fn splat(graph: &mut Graph<'_>, inputs: &SplatInputs<'_>, landed: &LandedPhotons) -> ImageRef {
    let (buffer, options) = (inputs.buffer, inputs.options);
    let downscale = options.downscale.max(1);
    let slot = graph.image("caustics", vk::Format::R32G32B32A32_SFLOAT, buffer.size);
    graph.clear_image("caustics/photons/splat/clear", slot, ClearColor::Float([0.0, 0.0, 0.0, 1.0]));
    let grid = Grid::upload(graph, buffer.size.map(|side| side.div_ceil(downscale)));
    let result = if downscale == 1 {
        slot
    } else {
        let irradiance = graph.image("photons.irradiance", vk::Format::R32G32B32A32_SFLOAT, grid.size);
        graph.clear_image("caustics/photons/splat/clear-irradiance", irradiance, ClearColor::Float([0.0; 4]));
        irradiance
    };
    let (cells, tile_count, capacity) = (grid.cell_count as usize, grid.tile_count(), landed.capacity.max(1) as usize);
    let shared = Splat {
        buffer,
        landed: *landed,
        gaussian: u32::from(options.kernel == PhotonKernel::Gaussian),
        elliptic: u32::from(options.footprint == PhotonFootprint::Beam),
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
        may_crowd: options.splat != PhotonSplatting::Discs && landed.capacity > PART_PHOTONS,
        tiles_at_once: inputs.tiles_at_once,
        result,
    };
    shared.declare_start(graph);
    match options.splat {
        PhotonSplatting::Discs => discs(graph, &shared),
        PhotonSplatting::Tiles | PhotonSplatting::Auto => tiles(graph, &shared),
    }
    if downscale > 1 {
        upsample(graph, &shared, slot);
    }
    slot
}
