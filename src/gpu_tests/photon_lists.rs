//! Per-pixel lists of scenes, and rays through them against rays through the hierarchy of triangles.

use std::path::Path;

use glam::{DAffine3, Mat4, Vec3};

use super::rays::{NO_TRIANGLE, Random, Ray, ray, trace_in};
use super::scenes::{builtin, closed_box, lambert, place, quad};
use super::session::Session;
use crate::caustics::photons::lists::{ListInputs, build, build_from};
use crate::caustics::photons::records::PhotonRays;
use crate::caustics::photons::{lines, march};
use crate::frame::camera::camera;
use crate::frame::geometry::Geometry;
use crate::frame::scene_data::SceneData;
use crate::frame::twins::unpack_direction;
use crate::graph::{Dependence, Graph, Store};
use crate::renderer::{PassTiming, PhotonSettings, PhotonTracing, Preset, Settings, Technique, Timing};
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::scene::{Alpha, CameraView, Material, Primitive, Scene, Texture, TextureRef, Wrap};
use crate::shaders::types;

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
        let leave = |(from, hit): (&Ray, &types::Hit)| {
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

    fn lists(&mut self, settings: &PhotonSettings, pool: Option<usize>) -> Lists {
        let camera = camera(&self.view(), [64, 64], self.data.origin);
        let mut graph = Graph::new(&mut self.store);
        let geometry = Geometry::import(&mut graph, &self.data);
        let inputs = ListInputs { data: &self.data, geometry: &geometry, camera: Some(&camera), settings };
        let lists = match pool {
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
        Lists { pixels, nodes, count: count[0], outgrown: executed.outgrown, passes: executed.passes }
    }

    fn trace(&mut self, settings: &PhotonSettings, rays: &[Ray]) -> Found {
        self.store.invalidate();
        self.trace_again(settings, rays, 0)
    }

    /// Lists that are made already stand; another `salt` traces the rays again.
    fn trace_again(&mut self, settings: &PhotonSettings, rays: &[Ray], salt: u32) -> Found {
        self.trace_in(settings, rays, salt, None)
    }

    /// Through these lists, if there are any, in place of those that the frame makes.
    fn trace_in(&mut self, settings: &PhotonSettings, rays: &[Ray], salt: u32, held: Option<&Lists>) -> Found {
        let camera = camera(&self.view(), [64, 64], self.data.origin);
        let bits = |vector: &[f32; 4]| [vector[0].to_bits(), vector[1].to_bits(), vector[2].to_bits(), 0];
        let records: Vec<[u32; 4]> =
            rays.iter().flat_map(|[start, way]| [bits(start), bits(way), [0, 0, 0, 0]]).collect();
        let count = rays.len() as u32;
        loop {
            let mut graph = Graph::new(&mut self.store);
            let geometry = Geometry::import(&mut graph, &self.data);
            let inputs = ListInputs { data: &self.data, geometry: &geometry, camera: Some(&camera), settings };
            let mut lists = build(&mut graph, &inputs);
            if let Some(held) = held {
                let (pixels, nodes) = held.reversed();
                lists.pixels = graph.upload("reversed.pixels", &pixels, Dependence::NONE);
                lists.nodes = graph.upload("reversed.nodes", &nodes, Dependence::NONE);
            }
            let counts = [count.div_ceil(64), 1, 1, count, 6, count, 0, salt];
            let counts = graph.upload("counts", &counts, Dependence::NONE);
            // A record more than there are rays: there may be none.
            let padded: Vec<[u32; 4]> = records.iter().copied().chain([[0; 4]; 3]).collect();
            let capacity = count + 1;
            let hits = graph.buffer("hits", 4 * capacity as usize);
            let traced = PhotonRays { rays: graph.upload("rays", &padded, Dependence::NONE), hits, stage: 0, capacity };
            match settings.trace {
                PhotonTracing::Lines => lines::trace(&mut graph, &lists, &traced, counts),
                _ => march::trace(&mut graph, &lists, &traced, counts),
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
        let mut compared = Comparison { rays: rays.len(), ..Comparison::default() };
        for (hit, real) in found.hits.iter().zip(&truth.hits) {
            let distance = f32::from_bits(hit[0]);
            match (hit[0] != HIT_NONE, real.triangle != NO_TRIANGLE) {
                (false, false) => compared.right += 1,
                (false, true) => compared.missed += 1,
                (true, false) => compared.wrong += 1,
                (true, true) => {
                    let off = (distance - real.distance).abs() / texel;
                    let normal = unpack_direction(hit[1]);
                    let same = normal.dot(self.normal(real.triangle)) > 0.9;
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
    pixels: Vec<u32>,
    nodes: Vec<u32>,
    count: u32,
    outgrown: Vec<(String, [usize; 2])>,
    passes: Vec<PassTiming>,
}

const NO_NODE: u32 = u32::MAX;

impl Lists {
    /// The nodes of a texel: depth, normal, next, material.
    fn of_texel(&self, texel: usize) -> Vec<[u32; 4]> {
        let node = |index: u32| -> Option<[u32; 4]> {
            let first = 4 * index as usize;
            (index != NO_NODE).then(|| self.nodes[first..first + 4].try_into().expect("four words"))
        };
        std::iter::successors(node(self.pixels[4 * texel]), |found| node(found[2])).collect()
    }

    /// The same lists, from their ends.
    fn reversed(&self) -> (Vec<u32>, Vec<[u32; 4]>) {
        let mut pixels = self.pixels.clone();
        let mut nodes: Vec<[u32; 4]> = self.nodes.chunks_exact(4).map(|node| node.try_into().expect("four")).collect();
        for head in pixels.iter_mut().step_by(4) {
            let (mut index, mut before) = (*head, NO_NODE);
            while index != NO_NODE {
                let next = std::mem::replace(&mut nodes[index as usize][2], before);
                (before, index) = (index, next);
            }
            *head = before;
        }
        (pixels, nodes)
    }
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

#[test]
fn every_surface_behind_a_texel_is_in_its_list_once() {
    let session = Session::open();
    let mut room = Stage::new(&session, closed_box(1.0, lambert([0.5; 3])));
    let lists = room.lists(&photon_settings(&[("resolution", "32")]), None);
    // A texel around the room stays empty; every other one has a wall in front and one behind.
    assert_eq!(lists.count, 3 * 30 * 30 * 2);
    for texel in 0..3 * 32 * 32 {
        let (x, y) = (texel % 32, texel / 32 % 32);
        let inside = (1..31).contains(&x) && (1..31).contains(&y);
        let mut depths: Vec<f32> = lists.of_texel(texel).iter().map(|node| f32::from_bits(node[0])).collect();
        depths.sort_by(f32::total_cmp);
        assert_eq!(depths.len(), if inside { 2 } else { 0 }, "texel {x}, {y}");
        if let [near, far] = depths[..] {
            assert!((near - 0.02).abs() < 1e-5 && (far - 2.02).abs() < 1e-5, "{near} {far}");
        }
    }
    let mut ring = Stage::new(&session, builtin("ring"));
    let materials = ring.scene.materials().len() as u32;
    for geometry in ["lists", "layers:3"] {
        let lists = ring.lists(&photon_settings(&[("resolution", "64"), ("geometry", geometry)]), None);
        let mut nodes = 0;
        for texel in 0..3 * 64 * 64 {
            let list = lists.of_texel(texel);
            nodes += list.len();
            let depths = || list.iter().map(|node| node[0]);
            let bounds = [depths().min().unwrap_or(u32::MAX), !depths().max().unwrap_or(0)];
            assert_eq!(lists.pixels[4 * texel + 1..4 * texel + 3], bounds, "texel {texel}");
            assert!(
                list.iter().all(|node| node[3] < materials && (unpack_direction(node[1]).length() - 1.0).abs() < 1e-5)
            );
            assert!(geometry == "lists" || list.len() <= 3);
        }
        // Each list's walk ends, and together they reach as many nodes as there are: none is in two.
        assert_eq!(nodes, lists.count as usize, "{geometry}");
    }
}

#[test]
fn a_pool_that_is_too_small_grows() {
    let session = Session::open();
    let settings = photon_settings(&[("resolution", "32")]);
    let mut stage = Stage::new(&session, builtin("ring"));
    let cut = stage.lists(&settings, Some(16));
    let [(name, [held, needed])] = &cut.outgrown[..] else { panic!("{:?}", cut.outgrown) };
    assert_eq!((name.as_str(), *held, *needed), ("photons.lists.nodes", 16, cut.count as usize));
    assert_eq!(cut.nodes.len(), 4 * 16);
    let texels = 3 * 32 * 32;
    assert_eq!((0..texels).map(|texel| cut.of_texel(texel).len()).sum::<usize>(), 16);
    let whole = stage.lists(&settings, Some(16));
    assert!(whole.outgrown.is_empty() && whole.count == cut.count, "{:?}", whole.outgrown);
    assert_eq!((0..texels).map(|texel| whole.of_texel(texel).len()).sum::<usize>(), whole.count as usize);
    let again = stage.lists(&settings, Some(16));
    assert!(again.passes.iter().all(|pass| pass.skipped.is_some()), "{:?}", again.passes);
}

#[test]
fn lists_stand_while_the_geometry_does() {
    let session = Session::open();
    let mut stage = Stage::new(&session, builtin("ring"));
    for geometry in ["lists", "layers:2"] {
        for projection in ["scene", "camera"] {
            let changes = [("resolution", "32"), ("geometry", geometry), ("projection", projection)];
            let first = stage.lists(&photon_settings(&changes), None);
            let again = stage.lists(&photon_settings(&changes), None);
            assert_eq!(first.count, again.count);
            assert!(again.passes.iter().all(|pass| pass.skipped.is_some()), "{changes:?}: {:?}", again.passes);
        }
    }
}

#[test]
fn a_hole_in_a_masked_surface_leaves_no_node() {
    let session = Session::open();
    let mut stage = Stage::new(&session, lattice());
    for geometry in ["lists", "layers:2"] {
        // Squares of eight texels; of three views one sees the floor, the others its edge.
        let settings = photon_settings(&[("resolution", "34"), ("geometry", geometry)]);
        assert_eq!(stage.lists(&settings, None).count, 32 * 32 / 2, "{geometry}");
    }
}

#[test]
fn rays_hit_what_they_hit_in_the_hierarchy() {
    let session = Session::open();
    // Shares in per mille: right at least, missed at most; the mean error of a distance in texels.
    let cases = [("ring", "128", [990, 5]), ("ring", "256", [994, 3]), ("cornell-point", "128", [980, 10])];
    for (name, resolution, [right, missed]) in cases {
        let mut stage = Stage::new(&session, builtin(name));
        let rays = stage.surface_rays(3000, 2);
        for trace in ["march", "lines"] {
            let found = stage.compare(&photon_settings(&[("resolution", resolution), ("trace", trace)]), &rays);
            let share = |count: usize| 1000 * count / found.rays;
            assert!(share(found.right) >= right, "{name} {resolution} {trace}: {found}");
            assert!(share(found.missed) <= missed, "{name} {resolution} {trace}: {found}");
            assert!(found.error < 0.01, "{name} {resolution} {trace}: {found}");
        }
    }
}

#[test]
fn hits_do_not_depend_on_the_order_of_nodes() {
    let session = Session::open();
    let mut stage = Stage::new(&session, builtin("ring-occluded"));
    let rays = stage.surface_rays(2000, 5);
    for trace in ["march", "lines"] {
        let settings = photon_settings(&[("resolution", "64"), ("trace", trace)]);
        let first = stage.trace(&settings, &rays).hits;
        assert_eq!(first, stage.trace(&settings, &rays).hits, "{trace}: a second run");
        let lists = stage.lists(&settings, None);
        assert_eq!(first, stage.trace_in(&settings, &rays, 1, Some(&lists)).hits, "{trace}: lists from their ends");
    }
}

#[test]
fn rays_that_meet_nothing_and_no_rays_at_all() {
    let session = Session::open();
    let mut stage = Stage::new(&session, builtin("ring"));
    let radius = stage.data.radius as f32;
    let mut random = Random::new(7);
    let away = |_| {
        let way = direction(&mut random);
        ray(way * 3.0 * radius, way, f32::MAX)
    };
    let mut rays: Vec<Ray> = (0..200).map(away).collect();
    // Along the axes, and along a wall.
    rays.extend([Vec3::X, Vec3::Y, Vec3::Z].map(|way| ray(way * 3.0 * radius, way, f32::MAX)));
    rays.push(ray(Vec3::new(0.0, 3.0 * radius, 0.0), Vec3::X, f32::MAX));
    for trace in ["march", "lines"] {
        for changes in [[("projection", "scene")], [("projection", "camera")]] {
            let changes = [&changes[..], &[("resolution", "32"), ("trace", trace)]].concat();
            let settings = photon_settings(&changes);
            let found = stage.trace(&settings, &rays);
            assert!(found.hits.iter().all(|hit| hit[0] == HIT_NONE && hit[3] == NO_TRIANGLE), "{changes:?}");
            assert!(stage.trace(&settings, &[]).hits.is_empty());
        }
    }
}

/// In `ring-occluded` four walls hide the ring from the camera (Quyen 2014, section 4.1.2): the platform that its light falls on is not among
/// the camera's nearest four layers, and photons fall through it.
#[test]
fn four_layers_leak_where_lists_do_not() {
    let session = Session::open();
    let mut stage = Stage::new(&session, builtin("ring-occluded"));
    let rays = stage.surface_rays(20_000, 11);
    let truth = trace_in(&mut stage.store, &stage.bvh, &rays);
    let camera = camera(&stage.view(), [64, 64], stage.data.origin);
    let matrix = Mat4::from_cols_array_2d(&camera.view_projection);
    let seen = |point: Vec3| {
        let clip = matrix * point.extend(1.0);
        clip.w > 0.1 && clip.x.abs().max(clip.y.abs()) < 0.98 * clip.w
    };
    // The camera's view covers all of these rays.
    let inside = |(ray, hit): &(&Ray, &types::Hit)| {
        let [start, way] = ray.map(|texel| Vec3::from_slice(&texel[..3]));
        hit.triangle != NO_TRIANGLE && seen(start) && seen(start + way * hit.distance)
    };
    let rays: Vec<Ray> = rays.iter().zip(&truth.hits).filter(inside).map(|(ray, _)| *ray).collect();
    let mut found = |geometry: &str| {
        let settings = photon_settings(&[("projection", "camera"), ("geometry", geometry)]);
        stage.compare(&settings, &rays)
    };
    let [lists, four, sixteen] = ["lists", "layers:4", "layers:16"].map(&mut found);

    let share = |found: &Comparison| found.right as f64 / found.rays as f64;
    let [lists, four, sixteen] = [lists, four, sixteen].map(|found| share(&found));
    assert!(four < lists - 0.1, "lists {lists}, four layers {four}");
    assert!((sixteen - lists).abs() < 0.005, "lists {lists}, sixteen layers {sixteen}");
}

#[test]
fn steps_grow_more_slowly_than_the_resolution() {
    let session = Session::open();
    let mut stage = Stage::new(&session, builtin("ring"));
    let rays = coherent_rays(40);
    let mut steps = |resolution: &str| {
        let found = stage.trace(&photon_settings(&[("resolution", resolution)]), &rays);
        found.work("march.0", "steps") as f64
    };
    let slope = (steps("512") / steps("64")).log2() / 3.0;
    assert!(slope < 0.6, "steps grow as the resolution to the power of {slope}");
}

/// A floor of 4×4 squares, every other one of which is a hole.
fn lattice() -> Scene {
    let mut scene = Scene::empty("lattice");
    let alpha = |texel: u32| if (texel % 4 + texel / 4).is_multiple_of(2) { 255 } else { 0 };
    let texture = Texture {
        name: String::new(),
        width: 4,
        height: 4,
        rgba8: (0..16).flat_map(|texel| [255, 255, 255, alpha(texel)]).collect(),
        wrap: [Wrap::Repeat; 2],
        nearest: true,
        srgb: true,
    };
    let texture = TextureRef::new(scene.add_texture(texture).expect("sound"));
    let material =
        Material { alpha: Alpha::Mask { cutoff: 0.5 }, base_color_texture: Some(texture), ..lambert([0.5; 3]) };
    let id = scene.add_material(material).expect("sound");
    let corners = [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]];
    let texcoords = vec![[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    let floor = Primitive { texcoords: [Some(texcoords), None], ..quad(corners, id) };
    place(&mut scene, vec![floor], DAffine3::IDENTITY);
    scene
}

/// Milliseconds that all threads of this process have run, over two cores.
fn cpu_ms() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |field: usize| fields.get(field).and_then(|ticks| ticks.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(11) + ticks(12)) * 10.0 / 2.0
}

/// The values that an environment variable names, by commas.
fn named(variable: &str, default: &str) -> Vec<String> {
    std::env::var(variable).unwrap_or(default.to_owned()).split(',').map(str::to_owned).collect()
}

#[test]
#[ignore = "a measurement"]
fn rays_against_the_hierarchy() {
    const RUNS: u32 = 20;
    let session = Session::open();
    let views = named("IRRADIA_LIST_VIEWS", "1,2,3");
    for name in named("IRRADIA_LIST_SCENES", "ring,ring-occluded,cornell-point,water,two-rooms") {
        let scene = match Path::new(&name) {
            file if file.exists() => Scene::load(file).expect("a sound file"),
            _ => builtin(&name),
        };
        let mut stage = Stage::new(&session, scene);
        let rays = stage.surface_rays(38_000, 3);
        let timed = [("surface", rays.clone()), ("coherent", coherent_rays(195))];
        for resolution in named("IRRADIA_LIST_SIZES", "128,256") {
            for trace in named("IRRADIA_LIST_TRACES", "march,lines") {
                let place = format!("{name} {resolution} {trace}");
                let given = [("resolution", &*resolution), ("trace", &*trace)];
                for views in &views {
                    let settings = photon_settings(&[&given[..], &[("views", views)]].concat());
                    println!("{place} {views} views: {}", stage.compare(&settings, &rays));
                }
                let settings = photon_settings(&given);
                for (what, rays) in &timed {
                    let first = stage.trace(&settings, rays);
                    let before = cpu_ms();
                    let runs: Vec<Found> = (1..=RUNS).map(|salt| stage.trace_again(&settings, rays, salt)).collect();
                    let cpu = (cpu_ms() - before) / f64::from(RUNS);
                    let least = runs.iter().map(|run| run.ms(&trace)).fold(f64::MAX, f64::min);
                    let steps = first.work("march.0", "steps") as f64 / rays.len() as f64;
                    println!("{place} {} {what} rays: {least:.2} ms, cpu {cpu:.2} ms, {steps:.1} steps", rays.len());
                }
                let settings = &settings;
                let before = cpu_ms();
                let built: Vec<Found> = (0..RUNS).map(|_| stage.trace(settings, &[])).collect();
                let cpu = (cpu_ms() - before) / f64::from(RUNS);
                let least = |pass: &str| built.iter().map(|run| run.ms(pass)).fold(f64::MAX, f64::min);
                let nodes = built[0].work("lists", "nodes");
                println!(
                    "{place} lists: {:.2} ms, of that blocks {:.2}, cpu {cpu:.2} ms, {nodes} nodes",
                    least("lists"),
                    least("lists-blocks")
                );
            }
        }
    }
}
