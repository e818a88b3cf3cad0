//! Rays through the hierarchy against all triangles one by one in f64; closed surfaces; what must not break it.

use ash::vk;
use glam::{DVec3, Vec3};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{Rng, SeedableRng};

use super::session::Session;
use crate::graph::{Dependence, Graph};
use crate::renderer::Timing;
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::shaders::selftest::{LeaveSurface, MaskedHit};
use crate::shaders::trace::{Closest, Occluded};
use crate::shaders::types;

const NODES: vk::Format = vk::Format::R32G32B32A32_UINT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const NO_TRIANGLE: u32 = u32::MAX;
/// How much nearer than the accuracy of a hit's weights a ray must pass an edge before the test takes no side.
const UNSURE: f64 = 1e-4;

/// Origin, end, direction, nothing.
type Ray = [[f32; 4]; 2];

fn ray(origin: Vec3, direction: Vec3, end: f32) -> Ray {
    [origin.extend(end).to_array(), direction.extend(0.0).to_array()]
}

struct Random(Pcg32);

impl Random {
    fn new(seed: u64) -> Random {
        Random(Pcg32::seed_from_u64(seed))
    }

    fn below(&mut self, count: usize) -> usize {
        self.0.next_u32() as usize % count
    }

    /// From -1 to 1.
    fn signed(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    fn point(&mut self) -> Vec3 {
        Vec3::from_array([0; 3].map(|_| self.signed()))
    }
}

/// The nearest hits, and whether the rays are blocked.
fn trace(session: &Session, bvh: &Bvh, rays: &[Ray]) -> (Vec<types::Hit>, Vec<bool>) {
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let nodes = graph.upload("bvh.nodes", &bvh.nodes, Dependence::NONE);
    let triangles = graph.upload("bvh.triangles", &bvh.triangles, Dependence::NONE);
    let list = graph.upload("rays", rays, Dependence::NONE);
    let hits = graph.buffer::<types::Hit>("hits", rays.len());
    let blocked = graph.buffer::<u32>("blocked", rays.len());
    let threads = [rays.len() as u32, 1, 1];
    let closest = Closest {
        bvh_nodes: nodes.texels(NODES),
        bvh_triangles: triangles.texels(FLOATS),
        rays: list.texels(FLOATS),
        hits: hits.write(),
    };
    graph.pass("test/closest", closest).threads(threads);
    let occluded = Occluded {
        bvh_nodes: nodes.texels(NODES),
        bvh_triangles: triangles.texels(FLOATS),
        rays: list.texels(FLOATS),
        blocked: blocked.write(),
    };
    graph.pass("test/occluded", occluded).threads(threads);
    let reads = (graph.read_back_buffer(hits), graph.read_back_buffer(blocked));
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    let hits = bytemuck::pod_collect_to_vec(&executed.take(reads.0));
    let blocked = bytemuck::pod_collect_to_vec::<u8, u32>(&executed.take(reads.1));
    (hits, blocked.into_iter().map(|word| word == 1).collect())
}

/// Distance and weights of the corners where the line of a ray meets the plane of a triangle (Möller & Trumbore).
fn plane_hit(triangle: &BvhTriangle, ray: &Ray) -> Option<(f64, DVec3)> {
    let [a, b, c] = triangle.corners.map(|corner| Vec3::from(corner).as_dvec3());
    let [origin, direction] = ray.map(|texel| Vec3::new(texel[0], texel[1], texel[2]).as_dvec3());
    let (ab, ac, from) = (b - a, c - a, origin - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    // Rays in the plane of a triangle may hit it or not.
    if determinant.abs() <= 1e-6 * ab.length() * ac.length() * direction.length() {
        return None;
    }
    let around = from.cross(ab);
    let (u, v) = (from.dot(across) / determinant, direction.dot(around) / determinant);
    Some((ac.dot(around) / determinant, DVec3::new(1.0 - u - v, u, v)))
}

/// Checks a hit against all triangles. Where a ray passes an edge, an end or another surface too closely, either answer is right.
fn check(triangles: &[BvhTriangle], extent: f64, ray: &Ray, hit: &types::Hit, blocked: bool) -> Result<(), String> {
    let length = DVec3::new(f64::from(ray[1][0]), f64::from(ray[1][1]), f64::from(ray[1][2])).length();
    let unsure = UNSURE * extent / length;
    let end = f64::from(ray[0][3]);
    if blocked != (hit.triangle != NO_TRIANGLE) {
        return Err(format!("blocked: {blocked}, nearest: {hit:?}"));
    }
    let mut reach = end;
    if hit.triangle != NO_TRIANGLE {
        reach = f64::from(hit.distance);
        let Some((distance, weights)) = plane_hit(&triangles[hit.triangle as usize], ray) else { return Ok(()) };
        let found = DVec3::new(weights.x, f64::from(hit.barycentric[0]), f64::from(hit.barycentric[1]));
        if (distance - reach).abs() > unsure
            || (found - weights).abs().max_element() > 1e-2
            || weights.min_element() < -1e-3
        {
            return Err(format!("{hit:?}, but that triangle is met at {distance}, weights {weights}"));
        }
    }
    for (number, triangle) in triangles.iter().enumerate() {
        if let Some((distance, weights)) = plane_hit(triangle, ray)
            && weights.min_element() > UNSURE
            && distance > unsure
            && distance < reach - unsure
        {
            return Err(format!("{hit:?}, but triangle {number} is met at {distance}, weights {weights}"));
        }
    }
    Ok(())
}

/// Small, large, long and thin triangles, some twice, some without area, some not finite.
fn soup(random: &mut Random, count: usize, scale: f32) -> Vec<BvhTriangle> {
    let mut triangles: Vec<BvhTriangle> = Vec::new();
    while triangles.len() < count {
        let size = [0.01, 0.1, 1.0][random.below(3)];
        let center = random.point();
        let mut corners = [0; 3].map(|_| (center + random.point() * size) * scale);
        match random.below(12) {
            0 => corners[2] = corners[0],
            1 => corners[2] = corners[0] + (corners[1] - corners[0]) * 0.5,
            2 => corners[1].y = f32::NAN,
            3 => corners[0].x = f32::INFINITY,
            4 => corners = corners.map(|corner| Vec3::new(corner.x, corners[0].y, corner.z)),
            5 => corners[2] = corners[1] + (corners[1] - corners[0]) * 0.01 + random.point() * 1e-3 * scale,
            6 if !triangles.is_empty() => {
                let twin = triangles[random.below(triangles.len())];
                triangles.push(twin);
                continue;
            }
            _ => {}
        }
        triangles.push(BvhTriangle { corners: corners.map(|corner| corner.to_array()), flags: 0 });
    }
    triangles
}

fn rays_about(random: &mut Random, count: usize, scale: f32) -> Vec<Ray> {
    let one = |_| {
        let origin = random.point() * [0.5, 1.5, 20.0][random.below(3)] * scale;
        let mut direction = random.point() * scale - origin;
        match random.below(6) {
            0 => direction[random.below(3)] = 0.0,
            1 => {
                let axis = random.below(3);
                let along = direction[axis];
                direction = Vec3::ZERO;
                direction[axis] = along;
            }
            2 => direction = direction.normalize(),
            _ => {}
        }
        let end = [f32::INFINITY, 1e30, 1.0, 0.5][random.below(4)];
        ray(origin, direction, end)
    };
    (0..count).map(one).collect()
}

#[test]
fn hits_are_those_of_all_triangles_one_by_one() {
    let session = Session::open();
    for (seed, count, scale) in
        [(1, 1, 1.0), (2, 5, 1.0), (3, 60, 1.0), (4, 700, 1.0), (5, 300, 1e-9), (6, 300, 1e-3), (7, 300, 1e9)]
    {
        let mut random = Random::new(seed);
        let triangles = soup(&mut random, count, scale);
        let rays = rays_about(&mut random, 3000, scale);
        // The second tree is what stands in for one that is too deep.
        for bvh in [Bvh::build(&triangles), Bvh::build_within(&triangles, 0)] {
            let (hits, blocked) = trace(&session, &bvh, &rays);
            let mut hit_count = 0;
            for ((ray, hit), &blocked) in rays.iter().zip(&hits).zip(&blocked) {
                if let Err(fault) = check(&triangles, f64::from(scale), ray, hit, blocked) {
                    panic!("seed {seed}, scale {scale:e}, ray {ray:?}: {fault}");
                }
                hit_count += usize::from(blocked);
            }
            println!("seed {seed}: {hit_count} of {} rays hit", rays.len());
            assert!(count < 60 || (100..2900).contains(&hit_count));
        }
    }
}

/// A sphere of `rings` times `2·rings` quads, the poles shared by thin triangles.
fn sphere(rings: usize, center: Vec3, radius: f32) -> Vec<BvhTriangle> {
    use std::f64::consts::PI;
    let corner = |ring: usize, segment: usize| {
        let (polar, around) = (PI * ring as f64 / rings as f64, PI * (segment % (2 * rings)) as f64 / rings as f64);
        let sine = if ring == rings { 0.0 } else { polar.sin() };
        (center + DVec3::new(sine * around.cos(), polar.cos(), sine * around.sin()).as_vec3() * radius).to_array()
    };
    let quad = |ring: usize, segment: usize| {
        let [a, b] = [corner(ring, segment), corner(ring, segment + 1)];
        let [c, d] = [corner(ring + 1, segment), corner(ring + 1, segment + 1)];
        [[a, b, d], [a, d, c]].map(|corners| BvhTriangle { corners, flags: 0 })
    };
    let all = (0..rings).flat_map(|ring| (0..2 * rings).flat_map(move |segment| quad(ring, segment)));
    all.filter(|triangle| triangle.corners[0] != triangle.corners[1] && triangle.corners[1] != triangle.corners[2])
        .collect()
}

#[test]
fn no_ray_leaves_a_closed_surface_through_an_edge_or_a_corner() {
    let session = Session::open();
    let mut random = Random::new(11);
    let mut leaks = 0;
    for (center, radius) in
        [(Vec3::ZERO, 1.0), (Vec3::new(300.0, -70.0, 1000.0), 1.0), (Vec3::ZERO, 1e-6), (Vec3::ONE, 1e6)]
    {
        let triangles = sphere(40, center, radius);
        let bvh = Bvh::build(&triangles);
        let one = |_| {
            let corners = triangles[random.below(triangles.len())].corners.map(Vec3::from);
            let along = [0.0, 0.5, 0.5 + 0.5 * random.signed()][random.below(3)];
            let target = corners[0] + (corners[1 + random.below(2)] - corners[0]) * along;
            let origin = center + random.point() * radius * 0.5;
            ray(origin, target - origin, 2.0)
        };
        let rays: Vec<Ray> = (0..250_000).map(one).collect();
        let (hits, blocked) = trace(&session, &bvh, &rays);
        for ((ray, hit), blocked) in rays.iter().zip(&hits).zip(blocked) {
            let near = (hit.distance - 1.0).abs() < 1e-2;
            if !(blocked && hit.triangle != NO_TRIANGLE && near) {
                leaks += 1;
                println!("{ray:?} leaves the sphere of radius {radius} at {center}: {hit:?}");
            }
        }
    }
    assert_eq!(leaks, 0);
}

#[test]
fn nothing_is_hit_where_nothing_is_and_odd_rays_end() {
    let session = Session::open();
    let mut random = Random::new(21);
    let odd = [0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE, -0.0, 1.0];
    let one = |_| [[0; 4], [0; 4]].map(|texel| texel.map(|_| odd[random.below(odd.len())]));
    let rays: Vec<Ray> = (0..4096).map(one).collect();
    let flat = BvhTriangle { corners: [[1.0; 3], [2.0; 3], [3.0; 3]], flags: 0 };
    for triangles in [vec![], vec![flat; 5]] {
        let (hits, blocked) = trace(&session, &Bvh::build(&triangles), &rays);
        assert!(hits.iter().all(|hit| hit.triangle == NO_TRIANGLE) && !blocked.contains(&true));
    }
    let triangles = soup(&mut random, 500, 1.0);
    let (hits, _) = trace(&session, &Bvh::build(&triangles), &rays);
    assert!(hits.iter().all(|hit| hit.triangle == NO_TRIANGLE || (hit.triangle as usize) < triangles.len()));
}

#[test]
fn a_flagged_triangle_is_met_only_where_the_shader_accepts_it() {
    let session = Session::open();
    let layer = |height: f32, flags| BvhTriangle {
        corners: [[0.0, height, 0.0], [1.0, height, 0.0], [0.0, height, 1.0]],
        flags,
    };
    // The shader cuts away what lies beyond half the height over corner 1.
    let triangles = [layer(2.0, 1), layer(1.0, 0), layer(3.0, 1)];
    let bvh = Bvh::build(&triangles);
    let down = |x: f32, end| ray(Vec3::new(x, 4.0, 0.1), Vec3::NEG_Y, end);
    let rays = [down(0.25, 10.0), down(0.75, 10.0), down(0.25, 2.5), down(0.75, 2.5)];
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let hits = graph.buffer::<types::MaskedHit>("hits", rays.len());
    let pass = MaskedHit {
        bvh_nodes: graph.upload("bvh.nodes", &bvh.nodes, Dependence::NONE).texels(NODES),
        bvh_triangles: graph.upload("bvh.triangles", &bvh.triangles, Dependence::NONE).texels(FLOATS),
        rays: graph.upload("rays", &rays, Dependence::NONE).texels(FLOATS),
        hits: hits.write(),
    };
    graph.pass("test/masked-hit", pass).threads([4, 1, 1]);
    let read_back = graph.read_back_buffer(hits);
    let bytes = graph.run(Timing::Frame).expect("a frame").take(read_back);
    let found: Vec<types::MaskedHit> = bytemuck::pod_collect_to_vec(&bytes);
    let found: Vec<(u32, u32)> = found.iter().map(|found| (found.hit.triangle, found.blocked)).collect();
    assert_eq!(found, [(2, 1), (1, 1), (2, 1), (NO_TRIANGLE, 0)]);
}

#[test]
fn rays_leave_a_surface_without_meeting_it_again() {
    let session = Session::open();
    for (seed, scale) in [(31, 1.0), (32, 1e-6), (33, 1e6)] {
        let mut random = Random::new(seed);
        for center in [Vec3::ZERO, Vec3::new(0.7, -0.1, 0.4)] {
            let triangles = sphere(24, center * scale, 0.3 * scale);
            // A far speck gives the scene its extent.
            let speck = Vec3::ONE * scale;
            let speck = [speck, speck * 1.001, speck * Vec3::new(1.0, 1.001, 1.0)].map(|corner| corner.to_array());
            let triangles = [triangles, vec![BvhTriangle { corners: speck, flags: 0 }]].concat();
            let bvh = Bvh::build(&triangles);
            let one = |_| {
                let target = (center + random.point() * 0.2) * scale;
                let origin = (center + random.point().normalize()) * scale;
                ray(origin, (target - origin).normalize(), 10.0 * scale)
            };
            let rays: Vec<Ray> = (0..20_000).map(one).collect();
            let corners: Vec<[f32; 4]> =
                triangles.iter().flat_map(|triangle| triangle.corners.map(|[x, y, z]| [x, y, z, 0.0])).collect();
            let mut store = session.store();
            let mut graph = Graph::new(&mut store);
            let leavings = graph.buffer::<types::Leaving>("leavings", rays.len());
            let pass = LeaveSurface {
                bvh_nodes: graph.upload("bvh.nodes", &bvh.nodes, Dependence::NONE).texels(NODES),
                bvh_triangles: graph.upload("bvh.triangles", &bvh.triangles, Dependence::NONE).texels(FLOATS),
                rays: graph.upload("rays", &rays, Dependence::NONE).texels(FLOATS),
                corners: graph.upload("corners", &corners, Dependence::NONE).texels(FLOATS),
                leavings: leavings.write(),
            };
            graph.pass("test/leave-surface", pass).threads([rays.len() as u32, 1, 1]);
            let read_back = graph.read_back_buffer(leavings);
            let bytes = graph.run(Timing::Frame).expect("a frame").take(read_back);
            let found: Vec<types::Leaving> = bytemuck::pod_collect_to_vec(&bytes);
            let blocked = found.iter().filter(|leaving| leaving.blocked != 0).count();
            let farthest = found.iter().map(|leaving| leaving.offset).fold(0.0, f32::max) / scale;
            println!(
                "scale {scale:e}, centre {center}: {blocked} blocked, moved by at most {farthest:.1e} of the scene"
            );
            assert!(found.iter().filter(|leaving| leaving.hit != 0).count() > 19_000);
            assert_eq!(blocked, 0);
            assert!(farthest < 3e-5);
        }
    }
}
