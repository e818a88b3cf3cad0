//! Splatting by gathering: photons are sorted into cells of a grid by size and place (glsl/photon_splat/levels.glsl), and each sample looks through
//! the cells around it. The sorted list is as long as there are photons, whatever their sizes.

use ash::vk;

use super::splat_tiles::{PARTS_WORD, RECORDS, ROWS_WORD, Splat, TileList};
use crate::frame::photons::records::{DISPATCH_WORD, STAGE_WORDS};
use crate::graph::Graph;
use crate::graph::bindings::ReadWriteBuffer;
use crate::shaders::photon_splat::{Gather, GatherPush, Scan, ScanPush, Scatter, ScatterPush};

const WORDS: vk::Format = vk::Format::R32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Declares the passes that fill `splat.result`.
pub(super) fn tiles(graph: &mut Graph<'_>, splat: &Splat<'_>) {
    let (grid, landed) = (&splat.grid, &splat.landed);
    let cell_starts = graph.buffer::<u32>("photons.cell_starts", grid.cell_count as usize);
    let sorted_count = graph.buffer::<u32>("photons.sorted_count", 1);
    let mut sorted =
        |what: &str| graph.buffer::<[f32; 4]>(&format!("photons.sorted_{what}"), landed.capacity.max(1) as usize);
    let (centers, normals, irradiances) = (sorted("centers"), sorted("normals"), sorted("irradiances"));
    let squeezes = sorted("squeezes");

    graph.fill_buffer("caustics/photons/splat/clear-sorted", sorted_count, 0);
    let pass = Scan {
        splat: splat.group(TileList::Ordinary),
        cell_counts: splat.cell_counts.texels(WORDS),
        cell_starts: cell_starts.write(),
        sorted_count: sorted_count.read_write(),
        push: ScanPush { row_count: grid.row_count },
    };
    graph
        .pass("caustics/photons/splat/scan", pass)
        .unordered()
        .count("photons in view", sorted_count, 0)
        .threads_indirect(splat.state, ROWS_WORD);

    let pass = Scatter {
        counts: landed.counts.texels(WORDS),
        discs: splat.discs.texels(RECORDS),
        places: splat.places.texels(vk::Format::R32G32_UINT),
        cell_starts: cell_starts.texels(WORDS),
        sorted_centers: centers.start(),
        sorted_normals: normals.start(),
        sorted_irradiances: irradiances.start(),
        sorted_squeezes: squeezes.start(),
        push: ScatterPush { stage: landed.stage as u32, tolerance: splat.tolerance },
    };
    let word = STAGE_WORDS * landed.stage + DISPATCH_WORD;
    graph.pass("caustics/photons/splat/sort", pass).threads_indirect(landed.counts, word);

    let in_step = u32::from(graph.traits().lanes_in_step);
    let gather = |sums: ReadWriteBuffer<u32>, list: TileList, range: [i32; 2]| Gather {
        splat: splat.group(list),
        surface: splat.buffer.group.clone(),
        cell_starts: cell_starts.texels(WORDS),
        sorted_centers: centers.texels(FLOATS),
        sorted_normals: normals.texels(FLOATS),
        sorted_irradiances: irradiances.texels(FLOATS),
        sorted_squeezes: squeezes.texels(FLOATS),
        result: splat.result.modify(),
        sums,
        crowded: u32::from(list == TileList::Crowded),
        in_step,
        push: GatherPush {
            image_size: splat.image_size,
            downscale: splat.downscale,
            level_count: grid.level_count,
            range,
        },
    };
    let list = TileList::Ordinary;
    let pass = gather(ReadWriteBuffer::absent(), list, [0, i32::MAX]);
    graph.pass(&list.pass_name("gather"), pass).threads_indirect(splat.state, list.word());
    if splat.may_crowd {
        let list = TileList::Crowded;
        for range in splat.ranges(graph) {
            splat.clear_sums(graph, list, range);
            let pass = gather(range.sums.read_write(), list, range.ends);
            graph.pass(&range.pass_name(list, "gather"), pass).threads_indirect(splat.state, PARTS_WORD);
            splat.resolve(graph, list, range);
        }
    }
}
