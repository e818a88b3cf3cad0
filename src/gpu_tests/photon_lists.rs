//! Per-pixel lists of scenes, and rays through them against rays through the hierarchy of triangles.

use ash::vk;
use glam::{DVec3, Vec3};

use super::rays::{NO_TRIANGLE, Random, Ray, ray, trace_in};
use super::scenes::builtin;
use super::session::Session;
use crate::caustics::photons::lists::{ListInputs, SceneLists, build, build_from};
use crate::caustics::photons::records::PhotonRays;
use crate::caustics::photons::{lines, march};
use crate::frame::camera::camera;
use crate::frame::geometry::Geometry;
use crate::frame::scene_data::SceneData;
use crate::frame::twins::unpack_direction;
use crate::graph::{Dependence, Graph, Store};
use crate::renderer::{PassTiming, PhotonSettings, PhotonTracing, Preset, Settings, Technique, Timing};
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::scene::{CameraView, Scene};

const HIT_NONE: u32 = u32::MAX;

fn photon_settings(changes: &[(&str, &str)]) -> PhotonSettings {
    let mut settings = Settings::new(Technique::Hybrid, Preset::Default);
    for (key, value) in changes {
        settings.set(&format!("photons.{key}"), value).expect("a setting and its value");
    }
    settings.photons
}

/// A scene ready for lists and for the hierarchy.
struct Stage {
    scene: Scene,
    data: SceneData,
    store: Store,
    triangles: Vec<BvhTriangle>,
    bvh: Bvh,
}

impl Stage {
    fn new(session: &Session, scene: Scene) -> Stage {
        let store = session.store();
        let device = store.device().clone();
        let data = SceneData::update(&device, store.pipelines(), None, &scene).expect("the scene fits the device");
        let triangles = Bvh::triangles_of(&scene, data.origin, |_| 0);
        let bvh = Bvh::build(&triangles);
        Stage { scene, data, store, triangles, bvh }
    }

    fn view(&self) -> CameraView {
        self.scene.camera_view(None).expect("a view")
    }

    /// Rays from free points of the scene's box.
    fn free_rays(&self, count: usize, seed: u64) -> Vec<Ray> {
        let mut random = Random::new(seed);
        let bounds = self.scene.bounds().expect("triangles");
        let half = ((bounds.max - bounds.min) * 0.5).as_vec3();
        (0..count).map(|_| ray(random.point() * half * 0.999, direction(&mut random), f32::MAX)).collect()
    }

    /// Rays from points of surfaces into the side that other rays saw them from.
    fn surface_rays(&mut self, count: usize, seed: u64) -> Vec<Ray> {
        let from = self.free_rays(count, seed);
        let found = trace_in(&mut self.store, &self.bvh, &from);
        let mut random = Random::new(seed + 1);
        let lift = 1e-5 * self.data.radius as f32;
        let leave = |(from, hit): (&Ray, &crate::shaders::types::Hit)| {
            let [start, along] = from.map(|texel| Vec3::from_slice(&texel[..3]));
            let normal = self.normal(hit.triangle);
            let side = if normal.dot(along) < 0.0 { normal } else { -normal };
            let way = direction(&mut random);
            let way = if way.dot(side) < 0.0 { -way } else { way };
            ray(start + along * hit.distance + side * lift, way, f32::MAX)
        };
        from.iter().zip(&found.hits).filter(|(_, hit)| hit.triangle != NO_TRIANGLE).map(leave).collect()
    }

    fn normal(&self, triangle: u32) -> Vec3 {
        let [a, b, c] = self.triangles[triangle as usize].corners.map(Vec3::from);
        (b - a).cross(c - a).normalize_or_zero()
    }

    fn lists(&mut self, settings: &PhotonSettings, nodes_per_texel: Option<usize>) -> Lists {
        let camera = camera(&self.view(), [64, 64], self.data.origin);
        let mut graph = Graph::new(&mut self.store);
        let geometry = Geometry::import(&mut graph, &self.data);
        let inputs = ListInputs { data: &self.data, geometry: &geometry, camera: Some(&camera), settings };
        let lists = match nodes_per_texel {
            None => build(&mut graph, &inputs),
            Some(nodes) => build_from(&mut graph, &inputs, nodes),
        };
        let reads = [
            graph.read_back_buffer(lists.pixels),
            graph.read_back_buffer(lists.nodes),
            graph.read_back_buffer(lists.node_count),
        ];
        let mut executed = graph.run(Timing::Passes).expect("a frame");
        let [pixels, nodes, count] = reads.map(|read| bytemuck::pod_collect_to_vec::<u8, u32>(&executed.take(read)));
        Lists { lists, pixels, nodes, count: count[0], outgrown: executed.outgrown, passes: executed.passes }
    }

    fn trace(&mut self, settings: &PhotonSettings, rays: &[Ray]) -> Found {
        self.store.invalidate();
        self.trace_again(settings, rays, 0)
    }

    /// Lists that are made already stand; another `salt` traces the rays again.
    fn trace_again(&mut self, settings: &PhotonSettings, rays: &[Ray], salt: u32) -> Found {
        let camera = camera(&self.view(), [64, 64], self.data.origin);
        let bits = |vector: &[f32; 4]| [vector[0].to_bits(), vector[1].to_bits(), vector[2].to_bits(), 0];
        let records: Vec<[u32; 4]> =
            rays.iter().flat_map(|[start, way]| [bits(start), bits(way), [0, 0, 0, 0]]).collect();
        let count = rays.len() as u32;
        loop {
            let mut graph = Graph::new(&mut self.store);
            let geometry = Geometry::import(&mut graph, &self.data);
            let inputs = ListInputs { data: &self.data, geometry: &geometry, camera: Some(&camera), settings };
            let lists = build(&mut graph, &inputs);
            let counts = [count.div_ceil(64), 1, 1, count, 6, count, 0, salt];
            let counts = graph.upload("counts", &counts, Dependence::NONE);
            // A record more than there are rays: there may be none.
            let padded: Vec<[u32; 4]> = records.iter().copied().chain([[0; 4]; 3]).collect();
            let capacity = count + 1;
            let hits = graph.buffer("hits", 4 * capacity as usize);
            let traced = PhotonRays { rays: graph.upload("rays", &padded, Dependence::NONE), hits, stage: 0, capacity };
            match settings.trace {
                PhotonTracing::Lines => lines::trace(&mut graph, &lists, &traced, counts),
                _ => drop(march::trace(&mut graph, &lists, &traced, counts)),
            }
            let read = graph.read_back_buffer(hits);
            let mut executed = graph.run(Timing::Passes).expect("a frame");
            if executed.outgrown.is_empty() {
                let words: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(&executed.take(read));
                return Found { hits: words[..rays.len()].to_vec(), passes: executed.passes };
            }
        }
    }

    fn compare(&mut self, settings: &PhotonSettings, rays: &[Ray]) -> Comparison {
        let found = self.trace(settings, rays);
        let truth = trace_in(&mut self.store, &self.bvh, rays);
        let bounds = self.scene.bounds().expect("triangles");
        let texel = (bounds.max - bounds.min).max_element() as f32 / settings.resolution as f32;
        let mut compared = Comparison { texel, rays: rays.len(), ..Comparison::default() };
        for ((hit, real), ray) in found.hits.iter().zip(&truth.hits).zip(rays) {
            let distance = f32::from_bits(hit[0]);
            match (hit[0] != HIT_NONE, real.triangle != NO_TRIANGLE) {
                (false, false) => compared.right += 1,
                (false, true) => compared.missed += 1,
                (true, false) => compared.wrong += 1,
                (true, true) => {
                    let off = (distance - real.distance).abs() / texel;
                    let normal = unpack_direction(hit[1]);
                    let same = normal.dot(self.normal(real.triangle)) > 0.9;
                    let _ = ray;
                    if off < 1.0 && same {
                        compared.right += 1;
                        compared.error += f64::from(off);
                    } else if off < 3.0 {
                        compared.near += 1;
                    } else {
                        compared.wrong += 1;
                    }
                }
            }
        }
        compared.error /= compared.right.max(1) as f64;
        compared
    }
}

/// All directions from the middle of the scene, neighbours side by side.
fn coherent_rays(side: u16) -> Vec<Ray> {
    let at = |index: u16| (2.0 * f32::from(index) + 1.0) / f32::from(side) - 1.0;
    let places = (0..side).flat_map(|y| (0..side).map(move |x| (at(x), at(y))));
    let way = |(x, y): (f32, f32)| {
        let z = 1.0 - x.abs() - y.abs();
        let fold = (-z).max(0.0);
        Vec3::new(x - fold * x.signum(), y - fold * y.signum(), z).normalize()
    };
    places.map(|place| ray(Vec3::new(0.013, 0.017, 0.019), way(place), f32::MAX)).collect()
}

fn direction(random: &mut Random) -> Vec3 {
    loop {
        let point = random.point();
        if (1e-3..1.0).contains(&point.length_squared()) {
            return point.normalize();
        }
    }
}

#[derive(Debug, Default)]
struct Comparison {
    rays: usize,
    texel: f32,
    /// The same surface within a texel of the distance; nothing where there is nothing.
    right: usize,
    /// Another surface within three texels.
    near: usize,
    missed: usize,
    wrong: usize,
    /// Mean error of the distance of the right ones, texels.
    error: f64,
}

impl std::fmt::Display for Comparison {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let share = |count: usize| 100.0 * count as f64 / self.rays as f64;
        write!(
            f,
            "right {:.3}% (off by {:.5} texels), near {:.3}%, missed {:.3}%, wrong {:.3}%",
            share(self.right),
            self.error,
            share(self.near),
            share(self.missed),
            share(self.wrong)
        )
    }
}

struct Lists {
    lists: SceneLists,
    pixels: Vec<u32>,
    nodes: Vec<u32>,
    count: u32,
    outgrown: Vec<(String, [usize; 2])>,
    passes: Vec<PassTiming>,
}

struct Found {
    hits: Vec<[u32; 4]>,
    passes: Vec<PassTiming>,
}

impl Found {
    fn ms(&self, pass: &str) -> f64 {
        let of = self.passes.iter().filter(|timing| timing.pass.starts_with(pass));
        of.filter_map(|timing| timing.ms).sum()
    }

    fn work(&self, pass: &str, name: &str) -> u64 {
        let of = self.passes.iter().find(|timing| timing.pass.starts_with(pass) && timing.work.contains_key(name));
        of.map_or(0, |timing| timing.work[name])
    }
}

/// Milliseconds that all threads of this process have run, over two cores.
fn cpu_ms() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |field: usize| fields.get(field).and_then(|ticks| ticks.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(11) + ticks(12)) * 10.0 / 2.0
}

#[test]
#[ignore = "a measurement"]
fn rays_against_the_hierarchy() {
    let session = Session::open();
    let list = |name: &str, default: &str| -> Vec<String> {
        std::env::var(name).unwrap_or(default.to_owned()).split(',').map(str::to_owned).collect()
    };
    for name in list("SCENES", "ring,ring-occluded,cornell-point,water,two-rooms") {
        let mut stage = Stage::new(&session, builtin(&name));
        let rays = [stage.free_rays(20_000, 1), stage.surface_rays(20_000, 2)];
        for resolution in list("SIZES", "128,256") {
            for trace in list("TRACES", "march,lines") {
                for views in list("VIEWS", "1,2,3") {
                    let settings =
                        photon_settings(&[("resolution", &resolution), ("trace", &trace), ("views", &views)]);
                    for (what, rays) in ["free", "surface"].iter().zip(&rays) {
                        let compared = stage.compare(&settings, rays);
                        println!("{name:14} {resolution} {trace} {views} views, {what:8}: {compared}");
                    }
                }
                let settings = photon_settings(&[("resolution", &resolution), ("trace", &trace)]);
                for rays in [stage.surface_rays(38_000, 3), coherent_rays(195)] {
                    let first = stage.trace(&settings, &rays);
                    let before = cpu_ms();
                    let runs: Vec<Found> = (1..21).map(|salt| stage.trace_again(&settings, &rays, salt)).collect();
                    let cpu = (cpu_ms() - before) / 20.0;
                    let least = runs.iter().map(|run| run.ms(&trace)).fold(f64::MAX, f64::min);
                    println!(
                        "{name:14} {resolution} {trace} lists {:.2} ms (blocks {:.2}), trace {least:.2} ms, cpu {cpu:.2} ms, steps {:.1}, nodes {}",
                        first.ms("lists"),
                        first.ms("lists-blocks"),
                        first.work("march.0", "steps") as f64 / rays.len() as f64,
                        first.work("lists", "nodes"),
                    );
                }
            }
        }
    }
}
