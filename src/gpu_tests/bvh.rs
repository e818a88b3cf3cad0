//! Rays through the hierarchy against all triangles one by one in f64, and what must not break it.

use glam::{DVec3, Vec3};

use super::rays::{FLOATS, NO_TRIANGLE, Random, Ray, Traced, ray, scene_rays, trace};
use super::session::Session;
use crate::graph::{Dependence, Graph};
use crate::renderer::Timing;
use crate::scene::bvh::{Bvh, BvhTriangle, can_be_hit};
use crate::shaders::selftest::MaskedHit;
use crate::shaders::types;

/// Where a ray passes an edge, an end or another surface nearer than this share, either answer is right.
const UNSURE: f64 = 1e-4;

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

/// Checks a hit against all triangles.
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
        [(1, 1, 1.0), (2, 5, 1.0), (3, 60, 1.0), (4, 500, 1.0), (5, 300, 1e-9), (6, 300, 1e-3), (7, 300, 1e9)]
    {
        let mut random = Random::new(seed);
        let triangles = soup(&mut random, count, scale);
        let rays = rays_about(&mut random, 800, scale);
        // The second tree is what stands in for one that is too deep.
        for bvh in [Bvh::build(&triangles), Bvh::build_within(&triangles, 0)] {
            let Traced { hits, blocked, .. } = trace(&session, &bvh, &rays);
            let mut hit_count = 0;
            for ((ray, hit), &blocked) in rays.iter().zip(&hits).zip(&blocked) {
                if let Err(fault) = check(&triangles, f64::from(scale), ray, hit, blocked) {
                    panic!("seed {seed}, scale {scale:e}, ray {ray:?}: {fault}");
                }
                hit_count += usize::from(blocked);
            }
            println!("seed {seed}: {hit_count} of {} rays hit", rays.len());
            assert!(count < 60 || (40..760).contains(&hit_count));
        }
    }
}

/// What a ray meets does not depend on the tree: not on whether one was built around the triangles as they are or before some moved, nor on which of two that lie in one place comes first in it.
#[test]
fn trees_that_were_built_before_something_moved_give_the_same_bits() {
    let session = Session::open();
    for (seed, scale) in [(31, 1.0), (32, 1e-6), (33, 1e9)] {
        let mut random = Random::new(seed);
        let then = soup(&mut random, 900, scale);
        let built = Bvh::build(&then);
        let rays = rays_about(&mut random, 1500, scale);
        let mut now = then.clone();
        for triangle in now.iter_mut().step_by(9) {
            let way = random.point() * 0.05 * scale;
            let moved = triangle.corners.map(|corner| (Vec3::from(corner) + way).to_array());
            let moved = BvhTriangle { corners: moved, ..*triangle };
            // Rounding may give a line an area.
            if can_be_hit(&moved) == can_be_hit(triangle) {
                *triangle = moved;
            }
        }
        let refitted = built.refitted(&now).expect("it is a tree for what moved");
        let same = |bvh: &Bvh| {
            let Traced { hits, blocked, .. } = trace(&session, bvh, &rays);
            (bytemuck::cast_slice::<_, u32>(&hits).to_vec(), blocked)
        };
        let fresh = same(&Bvh::build(&now));
        assert!(same(&refitted) == fresh, "seed {seed}: the tree that was there before");
        assert!(same(&Bvh::build_within(&now, 0)) == fresh, "seed {seed}: the tree of medians");
        assert!(same(&built) != fresh, "seed {seed}: nothing that rays meet moved");
        // Back again: nothing is left of the way.
        let back = built.refitted(&then).expect("nothing moved");
        assert!(
            back.nodes == built.nodes
                && bytemuck::cast_slice::<_, u32>(&back.triangles)
                    == bytemuck::cast_slice::<[f32; 4], u32>(&built.triangles)
        );
    }
}

#[test]
fn a_tree_is_built_anew_where_the_old_one_is_none_for_what_moved() {
    let mut random = Random::new(34);
    let then: Vec<BvhTriangle> = soup(&mut random, 900, 1.0).into_iter().filter(can_be_hit).collect();
    let built = Bvh::build(&then);
    let mut line = then.clone();
    line[7].corners[2] = line[7].corners[0];
    assert!(built.refitted(&line).is_none(), "a triangle has no area any more");
    let grown = Bvh::build(&line).refitted(&then);
    assert!(grown.is_none(), "the tree does not hold a triangle that can be hit now");
    let mut scattered = then.clone();
    for triangle in &mut scattered {
        let way = random.point() * 3.0;
        let moved = triangle.corners.map(|corner| (Vec3::from(corner) + way).to_array());
        let moved = BvhTriangle { corners: moved, ..*triangle };
        if can_be_hit(&moved) {
            *triangle = moved;
        }
    }
    assert!(built.refitted(&scattered).is_none(), "boxes hold everything");
    assert!(built.refitted(&then[1..]).is_none(), "there are fewer triangles");
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
        let Traced { hits, blocked, .. } = trace(&session, &Bvh::build(&triangles), &rays);
        assert!(hits.iter().all(|hit| hit.triangle == NO_TRIANGLE) && !blocked.contains(&true));
    }
    let triangles = soup(&mut random, 500, 1.0);
    let Traced { hits, .. } = trace(&session, &Bvh::build(&triangles), &rays);
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
        scene_rays: scene_rays(&mut graph, &bvh),
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
