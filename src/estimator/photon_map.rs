//! The photon map of one pass, pass by pass (glsl/sppm/): measure and store while paths are walked, then scan, sort, gather.
//!
//! Photons are sorted into buckets of a grid by counting; within a bucket their order is any, and sums in fixed point make that
//! no matter.

use super::paths::{Paths, WORD, WORDS, Walk};
use super::view::View;
use crate::graph::bindings::BufferRef;
use crate::graph::{Graph, ReadBack};
use crate::shaders::buckets::{Starts, StartsPush};
use crate::shaders::sppm as shaders;

/// Texels of a photon and of a measurement point (glsl/sppm/photon.glsl).
const TEXELS: usize = 3;
/// Words before the numbers in a queue (glsl/path/queue.glsl).
const QUEUE_HEADER: usize = 4;

/// What is gathered with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    /// m
    pub(super) radius: f32,
    /// Units of a sum in 1 W/(m² sr).
    pub(super) scale: f32,
}

impl Disc {
    fn inverse_cell(&self) -> f32 {
        0.5 / self.radius
    }
}

/// Measurement points, photons, and the grid over these.
pub(super) struct PhotonMap {
    points: BufferRef<[u32; 4]>,
    point_queue: BufferRef<u32>,
    photons: BufferRef<[u32; 4]>,
    photon_queue: BufferRef<u32>,
    bucket_counts: BufferRef<u32>,
    bucket_starts: BufferRef<u32>,
    photon_order: BufferRef<u32>,
    bits: u32,
}

impl PhotonMap {
    /// Buffers for a measurement point a path, and `photon_capacity` photons.
    pub(super) fn declare(graph: &mut Graph<'_>, paths: &Paths, photon_capacity: u32) -> PhotonMap {
        let photons = photon_capacity as usize;
        let bits = (photon_capacity.max(2).ilog2() / 3).clamp(3, 6);
        let buckets = 1_usize << (3 * bits);
        let map = PhotonMap {
            points: graph.buffer("sppm.points", TEXELS * paths.capacity as usize),
            point_queue: graph.buffer("sppm.point_queue", QUEUE_HEADER + paths.capacity as usize),
            photons: graph.buffer("sppm.photons", TEXELS * photons),
            photon_queue: graph.buffer("sppm.photon_queue", QUEUE_HEADER),
            bucket_counts: graph.buffer("sppm.bucket_counts", buckets),
            bucket_starts: graph.buffer("sppm.bucket_starts", buckets + 1),
            photon_order: graph.buffer("sppm.photon_order", photons),
            bits,
        };
        for records in [map.points, map.photons] {
            graph.start_undefined(records);
            graph.keep_for_passes(records);
        }
        for words in [map.point_queue, map.photon_queue, map.bucket_counts] {
            graph.keep_for_passes(words);
        }
        map
    }

    /// Starts without points and photons.
    pub(super) fn clear(&self, graph: &mut Graph<'_>) {
        graph.fill_buffer("sppm/clear-counts", self.bucket_counts, 0);
        self.clear_queue(graph, "sppm/clear-points", self.point_queue);
        self.clear_queue(graph, "sppm/clear-photons", self.photon_queue);
    }

    fn clear_queue(&self, graph: &mut Graph<'_>, name: &str, queue: BufferRef<u32>) {
        graph.pass(name, shaders::Clear { queue: queue.start_then_read() }).groups([1, 1, 1]);
    }

    /// Leaves the measurement points among the camera's vertices number `depth`.
    pub(super) fn measure(&self, graph: &mut Graph<'_>, paths: &Paths, depth: u32) {
        let measure = shaders::Measure {
            scene_rays: paths.rays.clone(),
            paths: paths.group(Walk::FromCamera, depth),
            points: self.points.read_write(),
            point_queue: self.point_queue.read_write(),
            lobes: paths.lobes.clone(),
            push: shaders::MeasurePush { depth, reserved: 0 },
        };
        graph.pass("sppm/measure", measure).threads_indirect(paths.alive, 0);
    }

    /// Finds how much of each measurement point's disc is surface.
    pub(super) fn probe(&self, graph: &mut Graph<'_>, paths: &Paths, disc: Disc) {
        let probe = shaders::Probe {
            scene_rays: paths.rays.clone(),
            paths: paths.group(Walk::FromCamera, 0),
            point_queue: self.point_queue.texels(WORD),
            points: self.points.read_write(),
            push: shaders::ProbePush { radius: disc.radius, reserved: 0 },
        };
        graph.pass("sppm/probe", probe).threads_indirect(self.point_queue, 0);
    }

    /// Leaves photons at the vertices number `depth` of light paths.
    pub(super) fn store(&self, graph: &mut Graph<'_>, paths: &Paths, disc: Disc, depth: u32) {
        let store = shaders::Store {
            paths: paths.group(Walk::FromLight, depth),
            photons: self.photons.read_write(),
            photon_queue: self.photon_queue.read_write(),
            bucket_counts: self.bucket_counts.read_write(),
            lobes: paths.lobes.clone(),
            push: shaders::StorePush { depth, bits: self.bits, inverse_cell: disc.inverse_cell(), reserved: 0 },
        };
        graph.pass("sppm/store", store).threads_indirect(paths.alive, 0);
    }

    /// Adds the photons to what the measurement points' paths found, and takes them away.
    pub(super) fn gather(&self, graph: &mut Graph<'_>, paths: &Paths, view: &View, disc: Disc) {
        let scan = Starts {
            counts: self.bucket_counts.texels(WORD),
            starts: self.bucket_starts.write(),
            push: StartsPush { bucket_count: 1 << (3 * self.bits) },
        };
        graph.pass("sppm/scan", scan).groups([1, 1, 1]);
        let sort = shaders::Sort {
            photon_queue: self.photon_queue.texels(WORD),
            photons: self.photons.texels(WORDS),
            bucket_starts: self.bucket_starts.texels(WORD),
            bucket_counts: self.bucket_counts.read_write(),
            photon_order: self.photon_order.write(),
        };
        graph.pass("sppm/sort", sort).threads_indirect(self.photon_queue, 0);
        let area = std::f64::consts::PI * f64::from(disc.radius).powi(2);
        let gather = shaders::Gather {
            point_queue: self.point_queue.texels(WORD),
            points: self.points.texels(WORDS),
            photons: self.photons.texels(WORDS),
            bucket_starts: self.bucket_starts.texels(WORD),
            photon_order: self.photon_order.texels(WORD),
            path_radiance: paths.radiance.read_write(),
            lobes: paths.lobes.clone(),
            push: shaders::GatherPush {
                radius: disc.radius,
                inverse_cell: disc.inverse_cell(),
                density: (1.0 / (area * f64::from(view.pixel_count()))) as f32,
                scale: disc.scale,
                bits: self.bits,
                bounces: view.bounces.unwrap_or(u32::MAX),
                path_count: paths.capacity,
                reserved: 0,
            },
        };
        graph.pass("sppm/gather", gather).threads_indirect(self.point_queue, 0);
        self.clear_queue(graph, "sppm/clear-photons", self.photon_queue);
        graph.want_buffer(paths.radiance);
    }

    /// Asks for all that the next submission goes on from, and for the queue of photons, whose last word is their number.
    pub(super) fn want(&self, graph: &mut Graph<'_>) -> ReadBack {
        graph.want_buffer(self.points);
        graph.want_buffer(self.point_queue);
        graph.want_buffer(self.photons);
        graph.want_buffer(self.bucket_counts);
        graph.read_back_buffer(self.photon_queue)
    }
}
