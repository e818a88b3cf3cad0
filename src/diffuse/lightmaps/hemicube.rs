//! Final gathering by hemicubes (Larsen & Christensen 2004, section 4): every texel's view of the scene is drawn into a tile of an atlas, many in one draw, and summed.
//!
//! A batch has as many views as the atlas has tiles. Passes list for each of them the runs of triangles that it may see; an instance of the draw is one view with one
//! run, clipped to the view's tile; what the fragments show is looked up in the AIM once the nearest triangles are known.

use std::f64::consts::PI;

use ash::vk;

use super::formats::{FLOATS4, WORD};
use super::options::LightmapsOptions;
use super::texels::{Chosen, LightTexels};
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{ClearColor, Graph};
use crate::shaders::buckets::{Starts, StartsPush};
use crate::shaders::hemicube::{
    Boxes, BoxesPush, Count, CountPush, Draw, DrawPush, List, ListPush, Shade, ShadePush, Sum, SumPush,
};
use crate::vulkan::{DepthState, RasterState};

/// Texels of the atlas along a side, at most.
const SIDE: u32 = 1024;
/// Triangles that are drawn or left out together, at least.
const RUN: u32 = 64;
/// Runs at most: an invocation goes through all of them.
const MOST_RUNS: u32 = 1 << 14;
/// Views with their runs in one draw, at most: 2²⁷ triangles, if runs are no longer than they have to be.
const MOST_PAIRS: u32 = 1 << 21;

/// How texels are shared out to draws, and views to the tiles of the atlas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Batches {
    /// Views in each.
    views: u32,
    /// Tiles along the atlas' sides.
    tiles: [u32; 2],
    /// Fragments along a tile's sides.
    side: u32,
    /// Triangles.
    run: u32,
    runs: u32,
}

impl Batches {
    fn new(texels: u32, side: u32, triangles: u32) -> Batches {
        let run = triangles.div_ceil(MOST_RUNS).max(RUN);
        let runs = triangles.div_ceil(run).max(1);
        let along = (SIDE / side).max(1);
        let views = (along * along).min(MOST_PAIRS / runs).min(texels).max(1);
        let columns = along.min(views);
        Batches { views, tiles: [columns, views.div_ceil(columns)], side, run, runs }
    }

    fn size(&self) -> [u32; 2] {
        self.tiles.map(|tiles| tiles * self.side)
    }
}

/// ΣF over the fragments of the front plane from −a to a: the share of the cosine-weighted hemisphere that it covers, by the middles of its fragments
/// (glsl/hemicube/weight.glsl).
fn covered(side: u32, plane: f64) -> f64 {
    let width = 2.0 * plane / f64::from(side);
    let at = |number: u32| plane * (f64::from(2 * number + 1) / f64::from(side) - 1.0);
    let row = |y: u32| -> f64 {
        (0..side).map(|x| width * width / (PI * (at(x).powi(2) + at(y).powi(2) + 1.0).powi(2))).sum()
    };
    (0..side).map(row).sum()
}

/// What all batches use, one after the other.
struct Drawing<'a> {
    texels: &'a LightTexels,
    aim: BufferRef<[f32; 4]>,
    gathered: BufferRef<[f32; 4]>,
    /// Of several lights, one behind the other in both.
    maps: u32,
    chosen: Chosen,
    batches: Batches,
    plane: f64,
    boxes: BufferRef<[f32; 4]>,
    counts: BufferRef<u32>,
    starts: BufferRef<u32>,
    pairs: BufferRef<u32>,
    arguments: BufferRef<u32>,
    seen: ImageRef,
    depth: ImageRef,
    light: BufferRef<[f32; 4]>,
}

/// Declares passes that gather those texels that are chosen; the others stand.
pub(super) fn gather(
    graph: &mut Graph<'_>,
    texels: &LightTexels,
    (aim, gathered, maps): (BufferRef<[f32; 4]>, BufferRef<[f32; 4]>, u32),
    chosen: Chosen,
    options: &LightmapsOptions,
) {
    let triangle_count = texels.leaf_triangle_count;
    let batches = Batches::new(chosen.most, options.fragments, triangle_count);
    let Batches { views, run, runs, side, .. } = batches;
    let boxes = graph.buffer("lightmaps.run_boxes", 2 * runs as usize);
    let pass = Boxes { scene_rays: texels.rays.clone(), boxes: boxes.write(), push: BoxesPush { triangle_count, run } };
    graph.pass("diffuse/lightmaps/iim/boxes", pass).note("runs", u64::from(runs)).threads([runs, 1, 1]);
    let drawing = Drawing {
        texels,
        aim,
        gathered,
        maps,
        chosen,
        batches,
        plane: options.plane,
        boxes,
        counts: graph.buffer("lightmaps.run_counts", views as usize),
        starts: graph.buffer("lightmaps.run_starts", views as usize + 1),
        pairs: graph.buffer("lightmaps.seen_runs", (views * runs) as usize),
        arguments: graph.buffer("lightmaps.draw_arguments", 4),
        seen: graph.image("lightmaps.seen_triangles", vk::Format::R32_UINT, batches.size()),
        depth: graph.image("lightmaps.view_depth", vk::Format::D32_SFLOAT, batches.size()),
        light: graph.buffer("lightmaps.view_light", (views * side * side) as usize),
    };
    for number in 0..chosen.most.div_ceil(views) {
        drawing.list(graph, number);
        drawing.draw(graph, number);
        for map in 0..maps {
            drawing.sum(graph, number, map);
        }
    }
}

impl Drawing<'_> {
    /// Where a batch begins in the list of texels.
    fn first(&self, number: u32) -> u32 {
        number * self.batches.views
    }

    /// Lists what the views of a batch may see.
    fn list(&self, graph: &mut Graph<'_>, number: u32) {
        let Batches { views, run, runs, .. } = self.batches;
        let (first, plane) = (self.first(number), self.plane as f32);
        let pass = Count {
            scene_rays: self.texels.rays.clone(),
            lightmap: self.texels.group.clone(),
            boxes: self.boxes.texels(FLOATS4),
            list: self.chosen.list.texels(WORD),
            head: self.chosen.head.texels(WORD),
            counts: self.counts.write(),
            push: CountPush { first, view_count: views, run_count: runs, run, plane },
        };
        graph.pass(&format!("diffuse/lightmaps/iim/count.{number}"), pass).threads([views, 1, 1]);
        let push = StartsPush { bucket_count: views };
        let pass = Starts { counts: self.counts.texels(WORD), starts: self.starts.write(), push };
        graph.pass(&format!("diffuse/lightmaps/iim/starts.{number}"), pass).groups([1, 1, 1]);
        let pass = List {
            scene_rays: self.texels.rays.clone(),
            lightmap: self.texels.group.clone(),
            boxes: self.boxes.texels(FLOATS4),
            list: self.chosen.list.texels(WORD),
            head: self.chosen.head.texels(WORD),
            starts: self.starts.texels(WORD),
            pairs: self.pairs.start(),
            arguments: self.arguments.write(),
            push: ListPush { first, view_count: views, run_count: runs, run, plane },
        };
        graph.pass(&format!("diffuse/lightmaps/iim/list.{number}"), pass).threads([views, 1, 1]);
    }

    /// Draws the views of a batch.
    fn draw(&self, graph: &mut Graph<'_>, number: u32) {
        let pass = Draw {
            scene_rays: self.texels.rays.clone(),
            lightmap: self.texels.group.clone(),
            list: self.chosen.list.texels(WORD),
            pairs: self.pairs.texels(WORD),
            push: DrawPush {
                first: self.first(number),
                run: self.batches.run,
                triangle_count: self.texels.leaf_triangle_count,
                tiles: self.batches.tiles,
                plane: self.plane as f32,
            },
        };
        let state = RasterState {
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            depth: Some(DepthState { compare: vk::CompareOp::GREATER, write: true }),
            ..RasterState::default()
        };
        let pass = graph.raster(&format!("diffuse/lightmaps/iim/draw.{number}"), pass, state);
        let pass = pass.depth(self.depth, Some(0.0)).color(self.seen, Some(ClearColor::Uint([u32::MAX; 4])));
        let pass = pass.note("triangles a run", u64::from(self.batches.run)).count("runs", self.arguments, 1);
        pass.draw_indirect(self.arguments, 0, 1);
    }

    /// Looks up what they show of one of the maps, and sums it.
    fn sum(&self, graph: &mut Graph<'_>, number: u32, map: u32) {
        let Batches { views, tiles, side, .. } = self.batches;
        let (first, plane) = (self.first(number), self.plane as f32);
        let first_of_map = map * self.texels.map.count;
        let number = if self.maps > 1 { format!("{number}.{map}") } else { number.to_string() };
        let pass = Shade {
            scene_rays: self.texels.rays.clone(),
            lightmap: self.texels.group.clone(),
            received: self.aim.texels(FLOATS4),
            list: self.chosen.list.texels(WORD),
            head: self.chosen.head.texels(WORD),
            seen: self.seen.sampled(),
            light: self.light.write(),
            push: ShadePush { first, view_count: views, columns: tiles[0], side, plane, first_of_map },
        };
        let pass = graph.pass(&format!("diffuse/lightmaps/iim/shade.{number}"), pass);
        pass.threads([views * side * side, 1, 1]);
        let pass = Sum {
            list: self.chosen.list.texels(WORD),
            head: self.chosen.head.texels(WORD),
            light: self.light.texels(FLOATS4),
            gathered: self.gathered.read_write(),
            push: SumPush {
                first,
                view_count: views,
                side,
                plane,
                covered: covered(side, self.plane) as f32,
                first_of_map,
            },
        };
        let pass = graph.pass(&format!("diffuse/lightmaps/iim/gather.{number}"), pass);
        pass.note("fragments a texel", u64::from(side * side))
            .count("texels", self.chosen.head, 3)
            .threads([views, 1, 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over |x|, |y| ≤ a the integral of F is 4/π·t·atan t with t = a/√(1 + a²).
    #[test]
    fn the_plane_covers_what_its_integral_says() {
        for (plane, whole, coarse) in [(1.0, 0.554, 0.556), (2.0, 0.831, 0.833)] {
            let t = plane / f64::hypot(1.0, plane);
            let integral = 4.0 / PI * t * t.atan();
            assert!((integral - whole).abs() < 5e-4, "{plane}: {integral}");
            assert!((covered(512, plane) - integral).abs() < 1e-5, "{plane}: {}", covered(512, plane));
            assert!((covered(8, plane) - coarse).abs() < 5e-4, "{plane}: {}", covered(8, plane));
        }
    }

    /// However many texels and triangles there are: the atlas stays within its bounds, lists within theirs, and every view has a tile.
    #[test]
    fn batches_keep_to_their_bounds() {
        for texels in [1, 20, 513, 24_000, 524_288] {
            for side in [4, 8, 16, 31, 64] {
                for triangles in [1, 34, 133_000, 1_000_000, 20_000_000] {
                    let batches = Batches::new(texels, side, triangles);
                    let Batches { views, tiles, run, runs, .. } = batches;
                    assert!(batches.size().iter().all(|&length| length <= SIDE), "{batches:?}");
                    assert!(tiles[0] * tiles[1] >= views && tiles[0] * (tiles[1] - 1) < views, "{batches:?}");
                    assert!(u64::from(views) * u64::from(runs) <= u64::from(MOST_PAIRS) && views <= 1 << 16);
                    assert!(runs <= MOST_RUNS && u64::from(run) * u64::from(runs) >= u64::from(triangles));
                    assert!(views <= texels);
                }
            }
        }
        assert_eq!(Batches::new(24_000, 16, 34).views, 4096);
        assert_eq!(Batches::new(20, 32, 13_000), Batches { views: 20, tiles: [20, 1], side: 32, run: 64, runs: 204 });
    }
}
