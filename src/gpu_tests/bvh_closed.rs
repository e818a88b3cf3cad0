//! Closed surfaces: no ray slips through, and rays leave them.

use glam::{DVec3, Vec3};

use super::rays::{FLOATS, NO_TRIANGLE, Random, Ray, Traced, ray, scene_rays, trace};
use super::session::Session;
use crate::graph::{Dependence, Graph};
use crate::renderer::Timing;
use crate::scene::bvh::{Bvh, BvhTriangle};
use crate::shaders::selftest::LeaveSurface;
use crate::shaders::types;

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
        let Traced { hits, blocked, .. } = trace(&session, &bvh, &rays);
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
                scene_rays: scene_rays(&mut graph, &bvh),
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
