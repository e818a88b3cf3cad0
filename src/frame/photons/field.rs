//! The light of landed photons at points that mirrors and glass show: density estimation in the world, by the same ellipses that pixels see, out of a grid over
//! space (glsl/photons/field.glsl). Neither the method that sends photons nor the one that follows reflections knows the other.

use ash::vk;

use super::bvh::shift;
use super::kept::KeptPhotons;
use crate::frame::inputs::FrameInputs;
use crate::frame::mirrored::{MirroredCaustics, MirroredPoints};
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::buckets::{Starts, StartsPush};
use crate::shaders::photons::{
    FieldList, FieldListPush, FieldMirrored, FieldMirroredPush, FieldPlace, FieldPlacePush, FieldWanted,
    FieldWantedPush,
};

const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const WORDS: vk::Format = vk::Format::R32_UINT;

/// As in glsl/photons/field.glsl.
const TEXELS: usize = 3;
const STATE_WORDS: usize = 3;
const STATE_PHOTONS: usize = 2;
/// Buckets of the table, as a power of two: about one a photon.
const LEAST_BUCKETS: u32 = 1 << 9;
const MOST_BUCKETS: u32 = 1 << 18;
/// In a bucket: what is left out beyond, the others stand for.
const MOST_LISTED: f32 = 2048.0;
/// Side of the coarsest cells over the scene's radius: ellipses are no wider than half of that.
const COARSEST: f64 = 0.75;
/// Words of the arguments that have the groups for each photon, and those for a single group.
const FOR_PHOTONS: usize = 0;
const FOR_ONE: usize = 3;

/// How wide photons' light is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Widths {
    /// Of all of them, m; 0: each has its own ellipse.
    pub(crate) radius: f32,
    /// Of those ellipses' radii.
    pub(crate) scale: f32,
    /// What a photon may be off its surface, m.
    pub(crate) tolerance: f32,
}

/// Photons in the grid.
struct Field {
    photons: BufferRef<[u32; 4]>,
    starts: BufferRef<u32>,
    lengths: BufferRef<u32>,
    order: BufferRef<u32>,
    state: BufferRef<u32>,
    bucket_mask: u32,
}

/// Says what light of caustics comes to the points that mirrors and glass show, if somebody lists them. `level`: of the passes' names.
pub(crate) fn light_mirrored(
    graph: &mut Graph<'_>,
    frame: &FrameInputs<'_>,
    level: &str,
    kept: KeptPhotons,
    widths: Widths,
) {
    let Some(points) = frame.offers.get::<MirroredPoints>() else { return };
    let field = place(graph, frame, level, (kept, widths), &points);
    let mut irradiance = Vec::new();
    for (number, list) in points.lists.iter().enumerate() {
        let received = graph.buffer::<[f32; 4]>(&format!("photons.mirrored.{number}"), list.points.count());
        let pass = FieldMirrored {
            mirrored: list.group(),
            photons: field.photons.texels(RECORDS),
            starts: field.starts.texels(WORDS),
            lengths: field.lengths.texels(WORDS),
            order: field.order.texels(WORDS),
            state: field.state.texels(WORDS),
            received: received.start(),
            push: FieldMirroredPush {
                inverse_coarsest: coarsest(frame.data.radius).recip(),
                tolerance: widths.tolerance,
                most_listed: MOST_LISTED,
                bucket_mask: field.bucket_mask,
            },
        };
        graph.pass(&format!("{level}/points.{number}"), pass).threads_indirect(list.arguments, 0);
        irradiance.push(received);
    }
    frame.offers.put(MirroredCaustics { irradiance });
}

fn coarsest(radius: f64) -> f32 {
    (COARSEST * radius) as f32
}

/// Declares the passes that put photons into the grid, where some point asks for them.
fn place(
    graph: &mut Graph<'_>,
    frame: &FrameInputs<'_>,
    level: &str,
    (kept, widths): (KeptPhotons, Widths),
    points: &MirroredPoints,
) -> Field {
    let shift = frame.traced.map_or([0.0; 3], |scene| shift(frame.data, scene));
    let count = kept.count as usize;
    let bucket_count = kept.count.next_power_of_two().clamp(LEAST_BUCKETS, MOST_BUCKETS);
    let arguments = graph.buffer::<u32>("photons.field_arguments", 6);
    let field = Field {
        photons: graph.buffer("photons.field", TEXELS * count),
        starts: graph.buffer("photons.field_starts", bucket_count as usize + 1),
        lengths: graph.buffer("photons.field_lengths", bucket_count as usize),
        order: graph.buffer("photons.field_order", count),
        state: graph.buffer("photons.field_state", STATE_WORDS),
        bucket_mask: bucket_count - 1,
    };
    let buckets = graph.buffer::<u32>("photons.field_buckets", count);
    let counts = graph.buffer::<u32>("photons.field_counts", bucket_count as usize);
    let mut clear = |what: &str, buffer: BufferRef<u32>| graph.fill_buffer(&format!("{level}/clear-{what}"), buffer, 0);
    clear("arguments", arguments);
    clear("counts", counts);
    clear("lengths", field.lengths);
    clear("state", field.state);
    for (number, list) in points.lists.iter().enumerate() {
        let push = FieldWantedPush { groups: kept.count.div_ceil(64) };
        let pass = FieldWanted { mirrored: list.group(), arguments: arguments.read_write(), push };
        graph.pass(&format!("{level}/wanted.{number}"), pass).groups([1, 1, 1]);
    }
    let pass = FieldPlace {
        kept: kept.photons.texels(RECORDS),
        photons: field.photons.start(),
        buckets: buckets.start(),
        counts: counts.read_write(),
        state: field.state.read_write(),
        push: FieldPlacePush {
            shift,
            count: kept.count,
            eye: points.seen.eye,
            pixel_angle: points.seen.angle,
            pixel_extent: points.seen.extent,
            radius: widths.radius,
            radius_scale: widths.scale,
            coarsest: coarsest(frame.data.radius),
            tolerance: widths.tolerance,
            bucket_mask: field.bucket_mask,
        },
    };
    let pass = graph.pass(&format!("{level}/place"), pass);
    pass.count("photons", field.state, STATE_PHOTONS).threads_indirect(arguments, FOR_PHOTONS);
    let pass = Starts { counts: counts.texels(WORDS), starts: field.starts.start(), push: StartsPush { bucket_count } };
    graph.pass(&format!("{level}/starts"), pass).threads_indirect(arguments, FOR_ONE);
    let pass = FieldList {
        photons: field.photons.texels(RECORDS),
        buckets: buckets.texels(WORDS),
        starts: field.starts.texels(WORDS),
        lengths: field.lengths.read_write(),
        order: field.order.start(),
        push: FieldListPush { count: kept.count, most_listed: MOST_LISTED },
    };
    graph.pass(&format!("{level}/list"), pass).unordered().threads_indirect(arguments, FOR_PHOTONS);
    field
}
