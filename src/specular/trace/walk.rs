//! The preliminary rays: which points mirrors and glass show, and what shines on the way to them.

use ash::vk;

use super::options::TraceOptions;
use crate::frame::mirrored::MirroredList;
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef, SampledImage};
use crate::method::FrameCx;
use crate::shaders::groups::Lobes;
use crate::shaders::trace::{Arguments, ArgumentsPush, Glass, GlassPush, Walk, WalkPush};
use crate::shaders::types::{MirroredPoint, Walking};

/// Pixels whose points fit a list even if each has two for every ray.
const PIXEL_RAYS: u32 = 1 << 20;
/// Pixels that a list has room for at first, each with one point: an eighth.
const SHARE: u32 = 8;

/// What the rays left.
pub(super) struct Walked {
    /// The number of each pixel's last point, plus 1.
    pub(super) heads: ImageRef,
    /// What shines by itself on the way, W/(m² sr).
    pub(super) shining: ImageRef,
    pub(super) bands: Vec<Band>,
}

/// Some rows of the picture.
#[derive(Clone, Copy)]
pub(super) struct Band {
    pub(super) first_row: u32,
    pub(super) row_count: u32,
    pub(super) list: MirroredList,
}

/// Rows of a band, whole blocks of eight.
pub(super) fn band_rows([width, height]: [u32; 2], samples: u32) -> u32 {
    let pixels = PIXEL_RAYS / samples.max(1);
    (pixels / width.max(1) / 8 * 8).clamp(8, height.next_multiple_of(8))
}

/// Declares the passes.
pub(super) fn walk(cx: &mut FrameCx<'_, '_>, scene: &TracedScene, options: &TraceOptions) -> Walked {
    let (surface, frame) = (cx.frame.surface, cx.frame);
    let shift = (frame.data.origin - scene.origin).as_vec3().to_array();
    let size = surface.size;
    let graph = &mut *cx.graph;
    let rays = scene.rays(graph);
    let glass = frame.facts.transmissive.then(|| {
        let glass = graph.image("trace.glass", vk::Format::R32G32B32A32_SFLOAT, size);
        let pass = Glass {
            scene_rays: rays.clone(),
            surface: surface.group.clone(),
            glass: glass.write(),
            push: GlassPush { shift },
        };
        graph.pass("specular/trace/walk/glass", pass).pixels(size);
        glass
    });
    if glass.is_none() {
        graph.skip("specular/trace/walk/glass", "nothing transmits light");
    }
    let heads = graph.image("trace.heads", vk::Format::R32_UINT, size);
    let shining = graph.image("trace.shining", vk::Format::R32G32B32A32_SFLOAT, size);
    let rows = band_rows(size, options.samples);
    let mut bands = Vec::new();
    for (number, first_row) in (0..size[1]).step_by(rows as usize).enumerate() {
        let row_count = rows.min(size[1] - first_row);
        let least = (size[0] * row_count / SHARE).max(1024) as usize;
        let points = graph.growing_buffer::<MirroredPoint>(&format!("trace.points.{number}"), least);
        let counts = graph.buffer::<u32>(&format!("trace.counts.{number}"), 2);
        graph.fill_buffer(&format!("specular/trace/walk/clear.{number}"), counts, 0);
        let capacity = points.count() as u32;
        let pass = Walk {
            scene_rays: rays.clone(),
            surface: surface.group.clone(),
            lobes: Lobes { specular_lobes: 1, transmissive: u32::from(glass.is_some()) },
            glass: SampledImage::of(glass),
            points: points.start(),
            counts: counts.read_write(),
            heads: if number == 0 { heads.start() } else { heads.modify() },
            shining: if number == 0 { shining.start() } else { shining.modify() },
            push: WalkPush {
                shift,
                first_row,
                walking: walking(scene, options, options.samples, capacity),
                lamps: u32::from(!frame.mirrored_lamps),
            },
        };
        let pass = graph.pass(&format!("specular/trace/walk/rays.{number}"), pass);
        let pass = pass.count("points", counts, 0).count("rays", counts, 1).unordered();
        pass.pixels([size[0], row_count]);
        graph.grows(points, counts, 0);
        let arguments = graph.buffer::<u32>(&format!("trace.arguments.{number}"), 4);
        count(graph, &format!("specular/trace/walk/arguments.{number}"), counts, capacity, arguments);
        bands.push(Band { first_row, row_count, list: MirroredList { points, arguments } });
    }
    Walked { heads, shining, bands }
}

/// How ways are followed that may list so many points.
pub(super) fn walking(scene: &TracedScene, options: &TraceOptions, sample_count: u32, capacity: u32) -> Walking {
    let (sky, depth, point_lights) = (scene.sky, options.depth, u32::from(scene.punctual_count > 0));
    Walking { sky, sample_count, depth, capacity, point_lights }
}

/// Declares the pass that says how many groups take what a list holds of what `counts` counts.
pub(super) fn count(
    graph: &mut Graph<'_>,
    name: &str,
    counts: BufferRef<u32>,
    capacity: u32,
    arguments: BufferRef<u32>,
) {
    let push = ArgumentsPush { capacity };
    let pass = Arguments { counts: counts.texels(vk::Format::R32_UINT), arguments: arguments.write(), push };
    graph.pass(name, pass).groups([1, 1, 1]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_hold_whole_blocks_and_no_more_points_than_a_buffer() {
        assert_eq!(band_rows([512, 512], 4), 512);
        assert_eq!(band_rows([1024, 1024], 4), 256);
        assert_eq!(band_rows([100, 10], 1), 16);
        assert_eq!(band_rows([16384, 100], 256), 8);
    }
}
