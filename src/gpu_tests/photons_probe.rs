//! Photons of the `photons` method with their way read back.

use glam::{DVec3, Vec3};

use super::scenes::view;
use super::session::Session;
use crate::caustics::photons::{Photons as Method, TracedPhotons, trace_all};
use crate::frame::light_set::LightSet;
use crate::frame::rays::TracedScene;
use crate::frame::scene_data::SceneData;
use crate::frame::twins::unpack_direction;
use crate::graph::{Graph, Store};
use crate::method::{FrameCx, Method as _};
use crate::renderer::declare::Shared;
use crate::renderer::{FrameRequest, PassTiming, Preset, Settings, Technique, Timing};
use crate::scene::Scene;

/// The hybrid technique with these changes; its photons are traced through the hierarchy.
pub(super) fn photon_settings(changes: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(Technique::Hybrid, Preset::Default);
    for (key, value) in changes {
        settings.set(key, value).expect("a setting and its value");
    }
    settings
}

/// A photon at a specular surface, or one that leaves it.
#[derive(Clone, Debug)]
pub(super) struct Ray {
    /// Render space.
    pub(super) origin: DVec3,
    pub(super) travelled: f64,
    pub(super) direction: DVec3,
    pub(super) flux: DVec3,
    pub(super) number: u32,
}

/// A photon that landed.
#[derive(Clone, Debug)]
pub(super) struct Landed {
    pub(super) position: DVec3,
    pub(super) normal: DVec3,
    pub(super) flux: DVec3,
    pub(super) radius: f64,
}

pub(super) struct Photons {
    /// Of the world, where render space starts.
    pub(super) origin: DVec3,
    /// Photons at the specular surfaces from which the last stage's rays left: those that lights see, if there is one bounce.
    pub(super) arrivals: Vec<Ray>,
    /// Of the last stage.
    pub(super) rays: Vec<Ray>,
    pub(super) landed: Vec<Landed>,
    pub(super) level: u32,
    pub(super) emitted: usize,
    /// Number of rays of each stage.
    pub(super) ray_counts: Vec<usize>,
    pub(super) passes: Vec<PassTiming>,
    pub(super) landed_words: Vec<[u32; 8]>,
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

fn vector(words: &[u32]) -> DVec3 {
    Vec3::new(f32::from_bits(words[0]), f32::from_bits(words[1]), f32::from_bits(words[2])).as_dvec3()
}

fn ray(words: &[u32]) -> Ray {
    Ray {
        origin: vector(words),
        travelled: f64::from(f32::from_bits(words[3])),
        direction: vector(&words[4..]),
        flux: vector(&words[8..]),
        number: words[11],
    }
}

fn landed(words: &[u32]) -> Landed {
    Landed {
        position: vector(words),
        normal: unpack_direction(words[3]).as_dvec3(),
        flux: vector(&words[4..]),
        radius: f64::from(f32::from_bits(words[7])),
    }
}

type Reads = [Vec<u32>; 6];

/// A scene on the device, and what frames left there.
struct OnDevice<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    store: Store,
    data: SceneData,
    set: LightSet,
    traced: TracedScene,
}

impl OnDevice<'_> {
    fn new<'a>(session: &Session, scene: &'a Scene, settings: &'a Settings) -> OnDevice<'a> {
        let store = session.store();
        let device = store.device().clone();
        let data = SceneData::update(&device, store.pipelines(), None, scene).expect("the scene fits the device");
        let set = LightSet::update(
            LightSet::default(),
            scene,
            &data,
            settings.lights.detail(settings.shadow_map.filter_radius),
            &device,
        );
        let traced = TracedScene::new(&device, scene).expect("the scene fits the device");
        OnDevice { scene, settings, store, data, set, traced }
    }

    fn frame(&mut self, timing: Timing) -> (Reads, Vec<PassTiming>, TracedPhotons) {
        let OnDevice { scene, settings, store, data, set, traced } = self;
        let mut graph = Graph::new(store);
        let request = FrameRequest::new([8, 8], view(DVec3::ONE, DVec3::ZERO));
        let shared = Shared::declare(&mut graph, scene, data, &request, settings);
        let inputs = Method::inputs(&settings.photons);
        let frame = shared.inputs(&mut graph, data, set, Some(traced), inputs, settings);
        let made = trace_all(&mut FrameCx::new(&mut graph, &frame, inputs), &settings.photons);
        let reads = [
            graph.read_back_buffer(made.landed.photons),
            graph.read_back_buffer(made.landed.counts),
            graph.read_back_buffer(made.choice),
            graph.read_back_buffer(made.arrivals),
            graph.read_back_buffer(made.rays.rays),
            graph.read_back_buffer(made.arrival_counts),
        ];
        let mut executed = graph.run(timing).expect("a frame");
        (reads.map(|read| words(&executed.take(read))), executed.passes, made)
    }
}

/// The passes of a second frame that is like the first.
pub(super) fn passes_of_second_frame(session: &Session, scene: &Scene, settings: &Settings) -> Vec<PassTiming> {
    let mut device = OnDevice::new(session, scene, settings);
    device.frame(Timing::Frame);
    device.frame(Timing::Frame).1
}

/// The photons of one frame. With passes timed, the least times of several frames.
pub(super) fn photons(session: &Session, scene: &Scene, settings: &Settings, timing: Timing) -> Photons {
    let mut device = OnDevice::new(session, scene, settings);
    let (read, mut passes, made) = device.frame(timing);
    if timing == Timing::Passes {
        // The first frame compiles the kernels.
        for _ in 0..6 {
            device.store.invalidate();
            for (pass, again) in passes.iter_mut().zip(device.frame(timing).1) {
                pass.ms = pass.ms.zip(again.ms).map(|(a, b)| a.min(b));
            }
        }
    }
    let [photons, counts, choice, arrivals, rays, arrival_counts] = read;
    let count = |counts: &[u32], stage: usize| {
        let (groups, count, drawn) = (counts[8 * stage], counts[8 * stage + 3], counts[8 * stage + 5]);
        assert_eq!(groups, count.div_ceil(64), "groups for {count}");
        assert_eq!(counts[8 * stage + 1..8 * stage + 3], [1, 1]);
        assert_eq!([counts[8 * stage + 4], drawn], [6, if drawn > 0 { count } else { 0 }]);
        count as usize
    };
    let stages = made.landed.stage;
    let landed_words: Vec<[u32; 8]> = photons
        .chunks_exact(8)
        .take(count(&counts, stages))
        .map(|words| std::array::from_fn(|index| words[index]))
        .collect();
    let arrived = count(&arrival_counts, stages - 1);
    let left = count(&counts, stages - 1);
    Photons {
        origin: device.data.origin,
        arrivals: arrivals.chunks_exact(12).take(arrived).map(ray).collect(),
        rays: rays.chunks_exact(12).take(left).map(ray).collect(),
        landed: landed_words.iter().map(|words| landed(words)).collect(),
        level: choice[3],
        emitted: choice[5] as usize,
        ray_counts: (0..stages).map(|stage| count(&counts, stage)).collect(),
        passes,
        landed_words,
    }
}

pub(super) fn total(fluxes: impl Iterator<Item = DVec3>) -> DVec3 {
    fluxes.sum()
}
