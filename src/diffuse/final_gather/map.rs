//! The photon map, and points of it at which irradiance is known. It stands while lights, geometry and materials do.

use super::grid::{Counted, Listed, WORD, WORDS4};
use super::options::FinalGatherOptions;
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::shaders::final_gather::{Choose, ChoosePush, Emit, EmitPush, Points, PointsPush};
use crate::shaders::groups::{self, Lobes};
use crate::shaders::types::MapRecord;

/// Photons that memory is held for at first, to each that lights send out.
const PHOTONS_PER_PATH: usize = 2;
/// In a bucket: what is left out beyond, the others carry.
const MOST_PHOTONS: u32 = 2048;
/// Points in as much surface as a bucket of photons has, four squares of the disc's radius: as in every fourth photon, where they lie as densely as the
/// options say.
const POINTS: u32 = 16;
/// Share of the photons that the sky sends out where other lights shine too.
const SKY_SHARE: f32 = 0.5;
/// Steps of a sum that the mean photon has.
const STEPS: f64 = 1_048_576.0;

/// What gather rays look up.
pub(super) struct PhotonMap {
    points: Listed,
    /// m
    pub(super) radius: f32,
}

impl PhotonMap {
    /// Declares its passes.
    pub(super) fn declare(graph: &mut Graph<'_>, scene: &TracedScene, options: &FinalGatherOptions) -> PhotonMap {
        let rays = scene.rays(graph);
        let share = f64::from(options.nearest) / f64::from(options.photons);
        let radius = (share * scene.area / std::f64::consts::PI).sqrt().clamp(1e-5 * scene.radius, scene.radius);
        let radius = radius as f32;
        let sky_power = std::f64::consts::PI.powi(2) * 4.0 * scene.radius.powi(2);
        let sky_power = sky_power * scene.sky.iter().map(|&channel| f64::from(channel)).fold(0.0, f64::max);
        let sky_share = match (scene.emitter_count, sky_power > 0.0) {
            (0, _) => 1.0,
            (_, false) => 0.0,
            _ => SKY_SHARE,
        };

        let least = PHOTONS_PER_PATH * options.photons as usize;
        let photons = graph.growing_buffer::<MapRecord>("final-gather.photons", least);
        let capacity = photons.count() as u32;
        let counted = Counted::declare(graph, "photons", photons);
        let head = graph.buffer::<u32>("final-gather.head", 2);
        graph.fill_buffer("diffuse/final-gather/map/clear", head, 0);
        let facts = &scene.facts;
        let pass = Emit {
            scene_rays: rays.clone(),
            scene_lights: scene.lights(graph),
            lobes: Lobes { specular_lobes: u32::from(facts.specular), transmissive: u32::from(facts.transmissive) },
            far_surfaces: u32::from(scene.far_surfaces),
            photons: photons.start(),
            buckets: counted.buckets.start(),
            counts: counted.counts.read_write(),
            head: head.read_write(),
            push: EmitPush {
                photon_count: options.photons,
                emitter_count: scene.emitter_count,
                sky_share,
                bounces: options.bounces.unwrap_or(u32::MAX),
                sky: scene.sky,
                radius: scene.radius as f32,
                middle: scene.middle_rs.as_vec3().to_array(),
                capacity,
                bits: counted.bits,
                inverse_cell: 0.5 / radius,
            },
        };
        let pass = graph.pass("diffuse/final-gather/map/emit", pass).unordered();
        let pass = pass.note("photons", u64::from(options.photons)).count("stored", head, 0).count("rays", head, 1);
        pass.threads([options.photons, 1, 1]);
        graph.grows(photons, head, 0);
        let listed = counted.list(graph, (head, 0), MOST_PHOTONS);

        let points = graph.growing_buffer::<MapRecord>("final-gather.points", options.photons as usize / 4);
        let room = points.count() as u32;
        let chosen = graph.buffer::<u32>("final-gather.chosen", points.count());
        let arguments = graph.buffer::<u32>("final-gather.arguments", 4);
        graph.fill_buffer("diffuse/final-gather/map/clear-chosen", arguments, 0);
        let pass = Choose {
            photons: listed.records.texels(WORDS4),
            starts: listed.starts.texels(WORD),
            lengths: listed.lengths.texels(WORD),
            head: head.texels(WORD),
            chosen: chosen.start(),
            arguments: arguments.read_write(),
            push: ChoosePush { capacity, room, bits: listed.bits, inverse_cell: 0.5 / radius, wanted: POINTS as f32 },
        };
        let pass = graph.pass("diffuse/final-gather/map/choose", pass).unordered();
        pass.count("points", arguments, 3).threads([capacity, 1, 1]);
        graph.grows(points, arguments, 3);

        let counted = Counted::declare(graph, "points", points);
        let tallies = graph.buffer::<u32>("final-gather.tallies", 2);
        graph.fill_buffer("diffuse/final-gather/map/clear-tallies", tallies, 0);
        let power = (scene.power + sky_power).max(1e-30);
        let pass = Points {
            scene_rays: rays,
            photons: listed.records.texels(WORDS4),
            starts: listed.starts.texels(WORD),
            lengths: listed.lengths.texels(WORD),
            chosen: chosen.texels(WORD),
            arguments: arguments.texels(WORD),
            points: points.start(),
            buckets: counted.buckets.start(),
            counts: counted.counts.read_write(),
            tallies: tallies.read_write(),
            push: PointsPush {
                room,
                radius,
                steps_a_watt: (STEPS * f64::from(options.photons) / power) as f32,
                bits: listed.bits,
                bits_of_points: counted.bits,
            },
        };
        let pass = graph.pass("diffuse/final-gather/map/irradiance", pass).unordered();
        let pass = pass.count("photons", tallies, 0).count("rays", tallies, 1);
        pass.threads_indirect(arguments, 0);
        PhotonMap { points: counted.list(graph, (arguments, 3), u32::MAX), radius }
    }

    /// As kernels read it.
    pub(super) fn group(&self) -> groups::PhotonMap {
        groups::PhotonMap {
            map_points: self.points.records.texels(WORDS4),
            map_starts: self.points.starts.texels(WORD),
            map_lengths: self.points.lengths.texels(WORD),
        }
    }

    pub(super) fn bits(&self) -> u32 {
        self.points.bits
    }
}
