//! From photons where they landed to the slot (Larsen & Christensen 2004, section 5): drawn as points, then filtered where they lie.
//!
//! A pixel's flux is the sum of its photons' (glsl/points/draw.comp), in whole numbers: the same bits in whatever order photons stand in their list. Spread over the
//! surface that the filter reaches (glsl/points/spread.comp) it is irradiance, and L = ρ/π·E (glsl/points/filter.comp).

use ash::vk;

use super::kept::PIECE;
use super::options::{PointFilter, PointOptions, PointTiles};
use crate::frame::gbuffer::GBuffer;
use crate::frame::photons::kept::KeptPhotons;
use crate::graph::bindings::{BufferRef, ImageRef, SampledImage, TexelBuffer};
use crate::graph::{ClearColor, Graph};
use crate::shaders::points::{
    Draw, DrawPush, Filter, FilterPush, Peak, PeakPush, Shifts, ShiftsPush, Spread, SpreadPush, Total, TotalPush,
    Widths, WidthsPush,
};

const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const WORDS: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// As in glsl/points/tiles.glsl.
const TILE_SIDE: u32 = 8;
const LISTED_A_ROW: u32 = 32_768;
const HEAD_WORDS: usize = 4;
const HEAD_COUNT: usize = 3;
/// As in glsl/points/source.glsl.
const SOURCE_TEXELS: usize = 4;

/// The radii of a photon's light over those of the ellipse that it stands for.
pub(super) const RADIUS_SCALE: f32 = 1.4;

/// Sums of what photons leave at pixels.
struct Sums {
    /// The largest flux of a photon, and the total of all (glsl/points/fixed_point.glsl).
    fluxes: BufferRef<u32>,
    /// Red, green, blue.
    flux: [ImageRef; 3],
    /// xx, yy, xy of their ellipses, and x and y of their places in the pixel, for the filter in the world.
    shapes: Option<[ImageRef; 5]>,
}

/// The tiles that photons reach.
struct Tiles {
    reaches: BufferRef<u32>,
    list: BufferRef<u32>,
    head: BufferRef<u32>,
    /// The pixels of each on which photons fall, a bit each.
    lit: BufferRef<u32>,
    /// In one row and the next.
    all: [u32; 3],
}

/// Declares the passes; returns the slot.
pub(crate) fn draw(graph: &mut Graph<'_>, buffer: &GBuffer, options: &PointOptions, photons: KeptPhotons) -> ImageRef {
    let size = buffer.size.map(u32::cast_signed);
    let world = options.filter == PointFilter::World;
    let count_log2 = photons.count.max(1).next_power_of_two().ilog2();
    let radius = options.radius as f32;
    let (sums, tiles) = points(graph, buffer, (world, radius, count_log2), photons);

    let slot = graph.image("caustics", FLOATS, buffer.size);
    let slots = graph.image("points.slots", WORDS, buffer.size);
    // Of each pixel that has a photon at least.
    let most_sources = photons.count.max(1).min(buffer.size[0].saturating_mul(buffer.size[1]));
    let sources = graph.buffer::<[u32; 4]>("points.sources", SOURCE_TEXELS * most_sources as usize);
    let source_count = graph.buffer::<u32>("points.source_count", 1);
    graph.clear_image(&name("filter/clear"), slot, ClearColor::Float([0.0, 0.0, 0.0, 1.0]));
    graph.clear_image(&name("filter/clear-slots"), slots, ClearColor::Uint([0; 4]));
    graph.fill_buffer(&name("filter/clear-count"), source_count, 0);
    let all_tiles = options.tiles == PointTiles::All;
    let listed = |buffer: BufferRef<u32>| if all_tiles { TexelBuffer::absent() } else { buffer.texels(WORDS) };
    let [red, green, blue] = sums.flux.map(ImageRef::sampled);
    let [width_xx, width_yy, width_xy, shift_x, shift_y] =
        [0, 1, 2, 3, 4].map(|part| SampledImage::of(sums.shapes.map(|shapes| shapes[part])));
    let pass = Spread {
        surface: buffer.group.clone(),
        world: u32::from(world),
        all_tiles: u32::from(all_tiles),
        tile_head: listed(tiles.head),
        tile_list: listed(tiles.list),
        fluxes: sums.fluxes.texels(WORDS),
        red,
        green,
        blue,
        width_xx,
        width_yy,
        width_xy,
        shift_x,
        shift_y,
        slots: slots.modify(),
        sources: sources.start(),
        source_count: source_count.read_write(),
        push: SpreadPush { size, count_log2 },
    };
    let pass = graph.pass(&name("filter/spread"), pass).unordered().count("pixels", source_count, 0);
    match all_tiles {
        true => pass.groups(tiles.all),
        false => pass.threads_indirect(tiles.head, 0),
    }
    let pass = Filter {
        surface: buffer.group.clone(),
        world: u32::from(world),
        all_tiles: u32::from(all_tiles),
        tile_head: listed(tiles.head),
        tile_list: listed(tiles.list),
        tile_reaches: tiles.reaches.texels(WORDS),
        tile_lit: if all_tiles { TexelBuffer::absent() } else { tiles.lit.texels(WORDS) },
        slots: slots.sampled(),
        sources: sources.texels(RECORDS),
        caustics: slot.modify(),
        push: FilterPush { size },
    };
    let pass = graph.pass(&name("filter/filter"), pass);
    match all_tiles {
        true => pass.groups(tiles.all),
        false => pass.threads_indirect(tiles.head, 0),
    }
    slot
}

fn name(pass: &str) -> String {
    format!("{PIECE}/{pass}")
}

/// Declares the passes that draw photons as points.
fn points(
    graph: &mut Graph<'_>,
    buffer: &GBuffer,
    (world, radius, count_log2): (bool, f32, u32),
    photons: KeptPhotons,
) -> (Sums, Tiles) {
    let size = buffer.size.map(u32::cast_signed);
    let fluxes = graph.buffer::<u32>("points.fluxes", 2);
    graph.fill_buffer(&name("draw/clear-fluxes"), fluxes, 0);
    let pass = Peak {
        photons: photons.photons.texels(RECORDS),
        fluxes: fluxes.read_write(),
        push: PeakPush { count: photons.count },
    };
    graph.pass(&name("draw/peak"), pass).threads([photons.count, 1, 1]);
    let pass = Total {
        photons: photons.photons.texels(RECORDS),
        fluxes: fluxes.read_write(),
        push: TotalPush { count: photons.count, count_log2 },
    };
    graph.pass(&name("draw/total"), pass).threads([photons.count, 1, 1]);

    let mut cleared = |what: &str| {
        let image = graph.image(&format!("points.{what}"), WORDS, buffer.size);
        graph.clear_image(&name(&format!("draw/clear-{what}")), image, ClearColor::Uint([0; 4]));
        image
    };
    let flux = ["red", "green", "blue"].map(&mut cleared);
    let shapes = world.then(|| ["width_xx", "width_yy", "width_xy", "shift_x", "shift_y"].map(&mut cleared));
    let [columns, rows] = buffer.size.map(|side| side.div_ceil(TILE_SIDE));
    let count = columns * rows;
    let tiles = Tiles {
        reaches: graph.buffer("points.tile_reaches", count as usize),
        list: graph.buffer("points.tile_list", count as usize),
        head: graph.buffer("points.tile_head", HEAD_WORDS),
        lit: graph.buffer("points.tile_lit", 2 * count as usize),
        all: [count.min(LISTED_A_ROW), count.div_ceil(LISTED_A_ROW), 1],
    };
    graph.fill_buffer(&name("draw/clear-tiles"), tiles.reaches, 0);
    graph.fill_buffer(&name("draw/clear-head"), tiles.head, 0);
    graph.fill_buffer(&name("draw/clear-lit"), tiles.lit, 0);
    let pass = Draw {
        surface: buffer.group.clone(),
        world: u32::from(world),
        photons: photons.photons.texels(RECORDS),
        fluxes: fluxes.texels(WORDS),
        red: flux[0].read_write(),
        green: flux[1].read_write(),
        blue: flux[2].read_write(),
        tile_reaches: tiles.reaches.read_write(),
        tile_list: tiles.list.start(),
        tile_head: tiles.head.read_write(),
        tile_lit: tiles.lit.read_write(),
        push: DrawPush { size, count: photons.count, count_log2, radius, radius_scale: RADIUS_SCALE },
    };
    let pass = graph.pass(&name("draw/points"), pass).unordered();
    pass.count("tiles", tiles.head, HEAD_COUNT).note("of", u64::from(count)).threads([photons.count, 1, 1]);
    if let Some([width_xx, width_yy, width_xy, shift_x, shift_y]) = shapes {
        let pass = Widths {
            surface: buffer.group.clone(),
            photons: photons.photons.texels(RECORDS),
            fluxes: fluxes.texels(WORDS),
            width_xx: width_xx.read_write(),
            width_yy: width_yy.read_write(),
            width_xy: width_xy.read_write(),
            push: WidthsPush { size, count: photons.count, count_log2, radius, radius_scale: RADIUS_SCALE },
        };
        graph.pass(&name("draw/widths"), pass).threads([photons.count, 1, 1]);
        let pass = Shifts {
            surface: buffer.group.clone(),
            photons: photons.photons.texels(RECORDS),
            fluxes: fluxes.texels(WORDS),
            shift_x: shift_x.read_write(),
            shift_y: shift_y.read_write(),
            push: ShiftsPush { size, count: photons.count, count_log2 },
        };
        graph.pass(&name("draw/shifts"), pass).threads([photons.count, 1, 1]);
    }
    (Sums { fluxes, flux, shapes }, tiles)
}
