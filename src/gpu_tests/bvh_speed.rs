//! How many rays a second the hierarchy answers. Not a test; run it with
//!
//! `MESA_SHADER_CACHE_DISABLE=true IRRADIA_TEST_VALIDATION=off IRRADIA_BVH_SCENE=FILE cargo test --release --lib bvh_speed -- --ignored --nocapture`

use std::path::Path;
use std::time::Instant;

use glam::Vec3;

use super::rays::{NO_TRIANGLE, Random, Ray, Traced, ray, trace_in};
use super::scenes::builtin;
use super::session::Session;
use crate::frame::camera::camera;
use crate::graph::Store;
use crate::scene::Scene;
use crate::scene::bvh::{Bvh, BvhTriangle};

const SIDE: u32 = 512;
const RUNS: usize = 7;

/// Through the pixels of a square picture, in blocks of 4×2 and tiles of 8×8.
fn camera_rays(scene: &Scene, origin: glam::DVec3, random: &mut Random) -> Vec<Ray> {
    let view = scene.camera_view(None).expect("a view");
    let camera = camera(&view, [SIDE, SIDE], origin);
    let [right, down, forward] = [camera.right_scaled, camera.down_scaled, camera.forward].map(Vec3::from);
    let one = |index: u32| {
        let (tile, block, lane) = (index / 64, index / 8 % 8, index % 8);
        let x = tile % (SIDE / 8) * 8 + block % 2 * 4 + lane % 4;
        let y = tile / (SIDE / 8) * 8 + block / 2 * 2 + lane / 4;
        let mut ndc = |place: u32| (2 * place + 1) as f32 / SIDE as f32 - 1.0 + random.signed() / SIDE as f32;
        ray(camera.position_rs.into(), (forward + right * ndc(x) + down * ndc(y)).normalize(), f32::INFINITY)
    };
    (0..SIDE * SIDE).map(one).collect()
}

/// From where rays hit: diffusely reflected ones, and ones to points in the middle of the scene. Rays that hit nothing return.
fn rays_from(
    hits: &Traced,
    rays: &[Ray],
    triangles: &[BvhTriangle],
    radius: f32,
    random: &mut Random,
) -> [Vec<Ray>; 2] {
    let one = |(hit, old): (&crate::shaders::types::Hit, &Ray)| {
        let [origin, direction] = old.map(|texel| Vec3::new(texel[0], texel[1], texel[2]));
        if hit.triangle == NO_TRIANGLE {
            return [ray(origin, -direction, f32::INFINITY); 2];
        }
        let [a, b, c] = triangles[hit.triangle as usize].corners.map(Vec3::from);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
        let start = origin + direction * hit.distance + normal * (1e-5 * radius);
        let mut on_sphere = random.point();
        while !(0.01..1.0).contains(&on_sphere.length_squared()) {
            on_sphere = random.point();
        }
        let to_light = random.point() * (0.2 * radius) - start;
        [ray(start, normal + on_sphere.normalize(), f32::INFINITY), ray(start, to_light, 1.0)]
    };
    hits.hits.iter().zip(rays).map(one).fold([Vec::new(), Vec::new()], |mut lists, pair| {
        lists.iter_mut().zip(pair).for_each(|(list, ray)| list.push(ray));
        lists
    })
}

/// Millions of rays a second, closest and any hit.
fn measure(store: &mut Store, what: &str, bvh: &Bvh, rays: &[Ray]) -> (Traced, [f64; 2]) {
    let mut runs: Vec<Traced> = (0..RUNS).map(|_| trace_in(store, bvh, rays)).collect();
    let speed = [0, 1].map(|kernel| {
        let best = runs.iter().map(|run| run.ms[kernel]).fold(f64::INFINITY, f64::min);
        rays.len() as f64 / best / 1e3
    });
    let first = runs.swap_remove(0);
    println!(
        "{what:18} closest {:7.2}, any {:7.2} Mray/s; first run {:.0}, {:.0} ms",
        speed[0], speed[1], first.ms[0], first.ms[1]
    );
    (first, speed)
}

#[test]
#[ignore = "a measurement"]
fn rays_a_second() {
    let session = Session::open();
    let scene = match std::env::var_os("IRRADIA_BVH_SCENE") {
        Some(path) => Scene::load(Path::new(&path)).expect("a sound file"),
        None => builtin("cornell-empty"),
    };
    let bounds = scene.bounds().expect("triangles");
    let triangles = Bvh::triangles_of(&scene, bounds.center(), |_| 0);
    let start = Instant::now();
    let bvh = Bvh::build(&triangles);
    let build_ms = start.elapsed().as_secs_f64() * 1e3;
    let bytes = 16 * (bvh.nodes.len() + bvh.triangles.len());
    let count = triangles.len();
    println!("{}: {count} triangles, built in {build_ms:.0} ms, {} bytes a triangle", scene.name, bytes / count);

    let mut random = Random::new(41);
    let mut store = session.store();
    let radius = bounds.radius() as f32;
    let camera = camera_rays(&scene, bounds.center(), &mut random);
    let (seen, camera_speed) = measure(&mut store, "camera", &bvh, &camera);
    let [diffuse, shadow] = rays_from(&seen, &camera, &triangles, radius, &mut random);
    let (met, first) = measure(&mut store, "diffuse bounce", &bvh, &diffuse);
    let (_, shadow_first) = measure(&mut store, "shadow", &bvh, &shadow);
    let [second, shadow] = rays_from(&met, &diffuse, &triangles, radius, &mut random);
    let (_, second) = measure(&mut store, "second bounce", &bvh, &second);
    let (_, shadow_second) = measure(&mut store, "its shadow", &bvh, &shadow);
    let seconds =
        1.0 / camera_speed[0] + 1.5 / first[0] + 1.5 / second[0] + 2.0 / shadow_first[1] + 2.0 / shadow_second[1];
    println!("1 camera, 3 diffuse and 4 shadow rays: {:.2} Mray/s", 8.0 / seconds);
}
