//! Where photons start, chosen on the device: a pyramid over the mask, and the level of it that gives as many photons as there may be.

use ash::vk;

use super::records::{COUNT_WORD, STAGE_WORDS};
use super::turn::Sending;
use super::views::SpecularViews;
use crate::frame::light_set::LightSet;
use crate::frame::view_layout::TILE;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::graph::{Dependence, Graph};
use crate::shaders::photons::{
    Choose, ChoosePush, List, ListPush, Mark, MarkPush, Number, Pyramid, PyramidPush, Start, StartPush,
};
use crate::shaders::types;

/// Words of the pyramid before its sums (glsl/photons/pyramid.glsl).
const PYRAMID_COUNTS: u32 = 32;
/// The word of them that counts the mask's texels that are no numbers.
const PYRAMID_DROPPED: usize = 31;
/// Side of a square of blocks that one group marks, and the words of its marks (glsl/photons/squares.glsl).
const SQUARE_SIDE: u32 = 32;
const SQUARE_WORDS: usize = 32;
/// Levels that one pass adds.
const LEVELS_OF_PASS: usize = 2;

/// Words of the choice (glsl/photons/choice.glsl).
const CHOICE_LEVEL: usize = 3;
const CHOICE_PHOTONS: usize = 5;
const CHOICE_BLOCKS: usize = 6;
const CHOICE_WORDS: usize = 7;

const WORDS: vk::Format = vk::Format::R32_UINT;

/// What was chosen.
#[derive(Clone)]
pub(crate) struct Choice {
    /// The view of each square of 16x16 texels of the atlas, and how many squares a row has.
    pub(super) tile_views: TexelBuffer,
    pub(super) tiles_per_row: u32,
    pub(crate) levels: TexelBuffer,
    pub(crate) pyramid: BufferRef<u32>,
    pub(crate) choice: BufferRef<u32>,
    /// The blocks that get photons.
    pub(crate) blocks: BufferRef<u32>,
    /// Rays of each stage and, at the end, landed photons (super::records).
    pub(crate) counts: BufferRef<u32>,
    /// Likewise of photons that wait to be sent on, a stage for each bounce.
    pub(crate) arrival_counts: BufferRef<u32>,
}

/// Width, height and first word of each level; the first level lies in the mask. The list goes on with empty levels as far as a pass asks.
fn level_table(size: [u32; 2]) -> (Vec<[u32; 4]>, usize, usize) {
    let mut levels = Vec::new();
    let (mut level_size, mut words) = (size, PYRAMID_COUNTS);
    loop {
        let [width, height] = level_size;
        let first = if levels.is_empty() { 0 } else { words };
        words += if levels.is_empty() { 0 } else { width * height };
        levels.push([width, height, first, 0]);
        if level_size == [1, 1] {
            break;
        }
        level_size = level_size.map(|side| side.div_ceil(2));
    }
    let count = levels.len();
    levels.resize(PYRAMID_COUNTS as usize, [0; 4]);
    (levels, count, words as usize)
}

/// Column and row of every square of 16x16 texels that belongs to a view.
fn tiles_of(set: &LightSet) -> Vec<u32> {
    let place = |tile: &types::LightTile| {
        let [column, row] = tile.origin.map(|at| at.cast_unsigned() / TILE);
        row << 16 | column
    };
    let mut places: Vec<u32> = set.atlas.tiles.iter().map(place).collect();
    // A buffer holds something; nothing of an atlas without tiles is read.
    places.resize(places.len().max(1), 0);
    places
}

/// The view of each square of 16x16 texels of the atlas; 0 where there is none, and no flux either.
fn views_of_tiles(set: &LightSet) -> (Vec<u32>, u32) {
    let [columns, rows] = set.atlas.size.map(|side| side.div_ceil(TILE).max(1));
    let mut views = vec![0; (columns * rows) as usize];
    for tile in &set.atlas.tiles {
        let [column, row] = tile.origin.map(|at| at.cast_unsigned() / TILE);
        views[(row * columns + column) as usize] = tile.view;
    }
    (views, columns)
}

/// Declares the passes; at most `most` photons of all turns.
pub(crate) fn choose(
    graph: &mut Graph<'_>,
    set: &LightSet,
    sending: &Sending,
    views: &SpecularViews,
    most: u32,
) -> Choice {
    let size = set.atlas.size.map(|side| side.max(1));
    let (table, level_count, words) = level_table(size);
    let levels = graph.upload("photons.levels", &table, Dependence::LIGHTS).texels(vk::Format::R32G32B32A32_UINT);
    let (tile_views, tiles_per_row) = views_of_tiles(set);
    let tile_views = graph.upload("photons.tile_views", &tile_views, Dependence::LIGHTS).texels(WORDS);
    let made = Choice {
        tile_views,
        tiles_per_row,
        levels,
        pyramid: graph.buffer("photons.pyramid", words),
        choice: graph.buffer("photons.choice", CHOICE_WORDS),
        blocks: graph.buffer("photons.blocks", most as usize),
        counts: graph.buffer("photons.counts", STAGE_WORDS * (sending.stages + 1)),
        arrival_counts: graph.buffer("photons.arrival_counts", STAGE_WORDS * (sending.stages + 1)),
    };

    let piece = sending.piece;
    graph.fill_buffer(&format!("{piece}/choose/mask-clear"), made.pyramid, 0);
    let tiles = tiles_of(set);
    let tile_list = graph.upload("photons.tiles", &tiles, Dependence::LIGHTS).texels(WORDS);
    for level in (0..level_count.saturating_sub(1).max(1)).step_by(LEVELS_OF_PASS) {
        let [columns, rows] = [0, 1].map(|axis| table[level][axis].div_ceil(4));
        let count = if level == 0 { 16 * set.atlas.tiles.len() as u32 } else { columns * rows };
        let pass = Pyramid {
            mask: views.mask.read(),
            levels: made.levels.clone(),
            tiles: tile_list.clone(),
            pyramid: made.pyramid.read_write(),
            push: PyramidPush { level: level as u32, columns, count },
        };
        let name = format!("{piece}/choose/mask.{level}");
        let pass = graph.pass(&name, pass);
        let pass = if level == 0 { pass.count("dropped", made.pyramid, PYRAMID_DROPPED) } else { pass };
        pass.threads([count, 1, 1]);
    }

    let pass = Choose {
        levels: made.levels.clone(),
        pyramid: made.pyramid.read(),
        choice: made.choice.write(),
        push: ChoosePush { level_count: level_count as u32, most },
    };
    graph
        .pass(&format!("{piece}/choose/choose"), pass)
        .count("specular texels", made.pyramid, 0)
        .count("level", made.choice, CHOICE_LEVEL)
        .count("photons", made.choice, CHOICE_PHOTONS)
        .groups([1, 1, 1]);

    list(graph, piece, views, &made, (level_count as u32, most));
    made
}

/// Numbers the blocks of the chosen level that get photons, in the order of the atlas.
fn list(graph: &mut Graph<'_>, piece: &str, views: &SpecularViews, made: &Choice, (level_count, most): (u32, u32)) {
    let squares: usize = views.mask.info().extent[..2].iter().map(|side| side.div_ceil(SQUARE_SIDE) as usize).product();
    let marks = graph.buffer::<u32>("photons.marks", SQUARE_WORDS * squares);
    let square_counts = graph.buffer::<u32>("photons.square_counts", squares);
    let square_firsts = graph.buffer::<u32>("photons.square_firsts", squares + 1);
    let pass = Mark {
        mask: views.mask.sampled(),
        levels: made.levels.clone(),
        pyramid: made.pyramid.texels(WORDS),
        choice: made.choice.texels(WORDS),
        marks: marks.start(),
        square_counts: square_counts.start(),
        push: MarkPush { level_count },
    };
    graph.pass(&format!("{piece}/choose/mark"), pass).threads_indirect(made.choice, 0);

    let pass = Number {
        choice: made.choice.texels(WORDS),
        square_counts: square_counts.read(),
        square_firsts: square_firsts.start(),
    };
    graph.pass(&format!("{piece}/choose/number"), pass).groups([1, 1, 1]);

    let pass = List {
        marks: marks.read(),
        square_firsts: square_firsts.read(),
        blocks: made.blocks.start(),
        push: ListPush { capacity: most },
    };
    graph
        .pass(&format!("{piece}/choose/list"), pass)
        .count("blocks", made.choice, CHOICE_BLOCKS)
        .threads_indirect(made.choice, 0);
}

/// Empties the counts of all stages, and has the photons of the turn arrive at the first surfaces.
pub(super) fn start(graph: &mut Graph<'_>, sending: &Sending, made: &Choice) {
    let turn = sending.turn;
    let pass = Start {
        choice: made.choice.texels(WORDS),
        counts: made.counts.write(),
        arrival_counts: made.arrival_counts.write(),
        push: StartPush { first: turn.first, stride: turn.stride, stage_count: sending.stages as u32 + 1 },
    };
    graph.pass(&sending.pass("trace/start"), pass).count("photons", made.arrival_counts, COUNT_WORD).groups([1, 1, 1]);
}

impl Choice {
    /// The word that holds how many rays of a stage, or how many landed photons, there are.
    pub(crate) fn count_word(stage: usize) -> usize {
        STAGE_WORDS * stage + COUNT_WORD
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_at_one_block_and_do_not_overlap() {
        for size in [[1, 1], [16, 16], [48, 1024], [512, 512], [2064, 528]] {
            let (table, count, words) = level_table(size);
            assert_eq!(table[0], [size[0], size[1], 0, 0]);
            assert_eq!(table[count - 1][..2], [1, 1]);
            let mut next = PYRAMID_COUNTS;
            for level in &table[1..count] {
                assert_eq!(level[2], next);
                next += level[0] * level[1];
            }
            assert_eq!(words, next as usize);
        }
    }
}
