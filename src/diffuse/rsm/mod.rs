//! `rsm`: one-bounce diffuse light from reflective shadow maps (Dachsbacher & Stamminger 2005), the baseline of two of
//! the papers. Every pixel gathers N virtual point lights, without visibility:
//!
//!   L(x) = ρ/π · Σ_k Φ_k/π · (n_k·−ω)⁺ (n_x·ω)⁺ / (d² + A_k/π)      W/(m² sr)
//!
//! Where the paper samples a fixed pattern around each pixel's projection into the map, the VPLs here are strata of the
//! flux that all light views reflect together: each carries the flux of what it stands for, so that ΣΦ_k is all of it, and
//! lights share N by flux. The disc form d² + A/π in place of the paper's d⁴ removes the singularity without a tuned
//! constant (glsl/lib/vpl.glsl). Light that is blocked on its way from y to x is counted all the same: that is the
//! method's error, besides everything beyond one bounce.

pub(crate) mod options;

use ash::vk;

use self::options::RsmOptions;
use crate::frame::light_views::Views;
use crate::graph::Dependence;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::method::{Error, FrameCx, Inputs, Method};
use crate::scene::Facts;
use crate::shaders::rsm::{Gather, GatherPush, Scan, ScanPush, TileFlux, TileFluxPush, Vpls, VplsPush};
use crate::slot::{LightPaths, Slot};

/// Most work groups of the tile pass; each then takes several tiles.
const MOST_TILE_GROUPS: u32 = 32768;

/// Reflective shadow maps: VPLs gathered at every pixel, without visibility.
pub(crate) struct Rsm;

impl Method for Rsm {
    const NAME: &'static str = "rsm";
    const SLOT: Slot = Slot::Diffuse;
    type Options = RsmOptions;

    fn light_paths(_: &RsmOptions) -> LightPaths {
        LightPaths::up_to(1)
    }

    fn inputs(_: &RsmOptions) -> Inputs {
        Inputs { light_depth: Views::All, light_flux: Views::All, ..Inputs::default() }
    }

    fn shaders(_: &RsmOptions, _: bool) -> Vec<&'static str> {
        vec!["rsm/*"]
    }

    fn skip(options: &RsmOptions, facts: &Facts) -> Option<&'static str> {
        match (facts.diffuse, options.vpls) {
            (false, _) => Some("no diffuse surface"),
            (_, 0) => Some("no VPLs asked for"),
            _ => None,
        }
    }

    fn declare(cx: &mut FrameCx<'_, '_>, options: &RsmOptions) -> Result<Option<ImageRef>, Error> {
        Ok(Some(rsm(cx, options).diffuse))
    }
}

/// The slot, and the VPLs behind it: two texels each (glsl/lib/vpl.glsl).
pub(crate) struct Made {
    pub(crate) diffuse: ImageRef,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) vpls: BufferRef<[f32; 4]>,
}

/// Declares the method's passes in the order in which they run.
pub(crate) fn rsm(cx: &mut FrameCx<'_, '_>, options: &RsmOptions) -> Made {
    let (buffer, set, lights) = (cx.frame.surface, cx.frame.set, cx.lights());
    let graph = &mut *cx.graph;
    let tile_count = set.atlas.tiles.len() as u32;
    let vpl_count = options.vpls;
    let tiles = graph.upload("rsm.tiles", &set.atlas.tiles, Dependence::LIGHTS);
    let tile_fluxes = graph.buffer::<[f32; 4]>("rsm.tile_fluxes", tile_count as usize);
    let flux_prefix = graph.buffer::<[f32; 4]>("rsm.flux_prefix", tile_count as usize + 1);
    let vpls = graph.buffer::<[f32; 4]>("rsm.vpls", 2 * vpl_count as usize);
    let diffuse = graph.image("diffuse", vk::Format::R32G32B32A32_SFLOAT, buffer.size);

    let dropped = graph.buffer::<u32>("rsm.dropped", 1);
    graph.fill_buffer("diffuse/rsm/clear-dropped", dropped, 0);
    let pass = TileFlux {
        tiles: tiles.read(),
        light_views: lights.group.clone(),
        tile_fluxes: tile_fluxes.write(),
        dropped_texels: dropped.read_write(),
        push: TileFluxPush { tile_count },
    };
    graph
        .pass("diffuse/rsm/tile-flux", pass)
        .note("tiles", u64::from(tile_count))
        .count("dropped", dropped, 0)
        .groups([tile_count.min(MOST_TILE_GROUPS), 1, 1]);

    let pass =
        Scan { tile_fluxes: tile_fluxes.read(), flux_prefix: flux_prefix.write(), push: ScanPush { tile_count } };
    graph.pass("diffuse/rsm/scan", pass).groups([1, 1, 1]);

    let pass = Vpls {
        tiles: tiles.read(),
        light_views: lights.group.clone(),
        flux_prefix: flux_prefix.read(),
        vpls: vpls.write(),
        push: VplsPush { tile_count, vpl_count },
    };
    graph.pass("diffuse/rsm/vpls", pass).note("VPLs", u64::from(vpl_count)).threads([vpl_count, 1, 1]);

    let pass = Gather {
        surface: buffer.group.clone(),
        vpls: vpls.texels(vk::Format::R32G32B32A32_SFLOAT),
        diffuse: diffuse.write(),
        push: GatherPush { vpl_count },
    };
    let [width, height] = buffer.size;
    let terms = u64::from(width) * u64::from(height) * u64::from(vpl_count);
    graph.pass("diffuse/rsm/gather", pass).note("VPL terms", terms).groups([width.div_ceil(16), height.div_ceil(8), 1]);
    Made { diffuse, vpls }
}
