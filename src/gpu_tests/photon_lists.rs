//! Per-pixel lists of scenes, and rays through them against rays through the hierarchy of triangles.

use glam::{DAffine3, Mat4, Vec3};

use super::photon_stage::{Comparison, HIT_NONE, Stage, coherent_rays, direction, photon_options};
use super::rays::{NO_TRIANGLE, Random, Ray, ray, trace_in};
use super::scenes::{builtin, closed_box, lambert, lattice, place};
use super::session::Session;
use crate::frame::camera::camera;
use crate::frame::twins::unpack_direction;
use crate::scene::Scene;
use crate::shaders::types;

#[test]
fn every_surface_behind_a_texel_is_in_its_list_once() {
    let session = Session::open();
    let mut room = Stage::new(&session, closed_box(1.0, lambert([0.5; 3])));
    let lists = room.lists(&photon_options(&[("resolution", "32")]), None);
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
        let lists = ring.lists(&photon_options(&[("resolution", "64"), ("geometry", geometry)]), None);
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
    let settings = photon_options(&[("resolution", "32")]);
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
            let first = stage.lists(&photon_options(&changes), None);
            let again = stage.lists(&photon_options(&changes), None);
            assert_eq!(first.count, again.count);
            assert!(again.passes.iter().all(|pass| pass.skipped.is_some()), "{changes:?}: {:?}", again.passes);
        }
    }
}

#[test]
fn a_hole_in_a_masked_surface_leaves_no_node() {
    let session = Session::open();
    let mut stage = Stage::new(&session, lattice_floor());
    for geometry in ["lists", "layers:2"] {
        // Squares of eight texels; of three views one sees the floor, the others its edge.
        let settings = photon_options(&[("resolution", "34"), ("geometry", geometry)]);
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
            let found = stage.compare(&photon_options(&[("resolution", resolution), ("trace", trace)]), &rays);
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
        let settings = photon_options(&[("resolution", "64"), ("trace", trace)]);
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
            let settings = photon_options(&changes);
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
        let settings = photon_options(&[("projection", "camera"), ("geometry", geometry)]);
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
        let found = stage.trace(&photon_options(&[("resolution", resolution)]), &rays);
        found.work("trace/march.0", "steps") as f64
    };
    let slope = (steps("512") / steps("64")).log2() / 3.0;
    assert!(slope < 0.6, "steps grow as the resolution to the power of {slope}");
}

/// A floor of 4×4 squares, every other one of which is a hole.
fn lattice_floor() -> Scene {
    let mut scene = Scene::empty("lattice");
    let floor = lattice(&mut scene, [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]]);
    place(&mut scene, vec![floor], DAffine3::IDENTITY);
    scene
}

/// Rays from far away are at distances whose rounding is coarser than the march's least step.
#[test]
fn marches_from_far_away_end() {
    let session = Session::open();
    let mut room = Stage::new(&session, closed_box(1.0, lambert([0.5; 3])));
    let settings = photon_options(&[("resolution", "128"), ("trace", "march")]);
    let mut random = Random::new(5);
    let rays: Vec<Ray> = (0..256)
        .map(|_| {
            let way = direction(&mut random);
            ray(random.point() * 0.5 - way * 1e5, way, f32::MAX)
        })
        .collect();
    let found = room.trace(&settings, &rays);
    let [steps, cut_off, misses] = ["steps", "cut off", "misses"].map(|name| found.work("trace/march", name));
    println!("{steps} steps, {misses} misses, {cut_off} cut off");
    assert!(steps < 256 * 3 * 4 * 128, "{steps} steps");
    assert_eq!(cut_off, 0);
}
