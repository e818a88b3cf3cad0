//! Radiance particles: which there are, which are evaluated, and what the picture reads of them.

use glam::{DAffine3, DVec3};

use super::super::options::{ParticleLists, ParticlesOptions, ParticlesReceivers};
use super::receivers::{SIZE, difference, frame, turned_floor};
use super::{against_paths, count, options, ran, settings};
use crate::gpu_tests::against_paths::leaks;
use crate::gpu_tests::scenes::{add_light, builtin, closed_box, lambert, place, quad, request, view};
use crate::gpu_tests::session::Session;
use crate::renderer::{Frame, FrameRequest, Slot, Timing};
use crate::scene::{CameraView, LightId, LightKind, Material, Node, Primitive, Projection, Scene};

fn mesh(options: ParticlesOptions) -> ParticlesOptions {
    ParticlesOptions { receivers: ParticlesReceivers::Mesh, ..options }
}

fn asked(size: [u32; 2], camera: CameraView) -> FrameRequest {
    FrameRequest { timing: Timing::Passes, ..request(size, camera, &[Slot::Diffuse]) }
}

/// Subtriangles and radiance particles that were found, and area particles that gather.
fn found(frame: &Frame) -> [u64; 3] {
    let count = |pass: &str, name: &str| count(&frame.timings.passes, &format!("diffuse/particles/find/{pass}"), name);
    [count("fit", "subtriangles"), count("used-by-lists", "radiance particles"), count("used", "particles")]
}

#[test]
fn radiance_particles_show_what_regions_show() {
    let session = Session::open();
    let regions = frame(&session, options(4000, 3));
    let found = frame(&session, mesh(options(4000, 3)));
    let [mean, pixels, blocks] = difference(&found, &regions);
    println!("mean {mean:.4}, pixels {pixels:.4}, blocks {blocks:.4}");
    assert!((mean - 1.0).abs() < 0.015 && pixels < 0.045 && blocks < 0.03, "{mean}, pixels {pixels}, blocks {blocks}");
    let finer = frame(&session, ParticlesOptions { spacing: 0.01, ..mesh(options(4000, 3)) });
    let [mean, pixels, _] = difference(&finer, &found);
    println!("finer: mean {mean:.4}, pixels {pixels:.4}");
    assert!((mean - 1.0).abs() < 5e-3 && (1e-4..0.03).contains(&pixels), "{mean}, pixels {pixels}");
}

#[test]
fn lists_of_all_are_those_of_the_used_ones() {
    let session = Session::open();
    let used = frame(&session, mesh(options(4000, 1)));
    let all = frame(&session, ParticlesOptions { lists: ParticleLists::All, ..mesh(options(4000, 1)) });
    assert_eq!(used.slots, all.slots, "bit by bit");
    let entries = |frame: &Frame| count(&frame.timings.passes, "diffuse/particles/lists/candidates", "entries");
    assert!(entries(&used) > 0 && 3 * entries(&used) < 2 * entries(&all), "{} {}", entries(&used), entries(&all));
    assert_eq!(count(&used.timings.passes, "diffuse/particles/lists/candidates", "left out"), 0);
    assert_eq!(frame(&session, mesh(options(4000, 1))).slots, used.slots, "the same every time");
}

/// A floor of squares, a slender strip along one side and a triangle that is cut more finely than the square it meets, seen from above: all radiance particles are
/// found, each once.
#[test]
fn all_that_is_seen_is_evaluated_and_shared_points_are_one() {
    let session = Session::open();
    let mut scene = Scene::empty("floor");
    let material = scene.add_material(lambert([0.5; 3])).expect("a sound material");
    let (side, line) = (4_u32, 5_u32);
    let corner = |number: u32| [(number % line) as f32 - 2.0, 0.0, (number / line) as f32 - 2.0];
    let mut positions: Vec<[f32; 3]> = (0..line * line).map(corner).collect();
    let quads = (0..side * side).map(|number| number % side + number / side * line);
    let indices = quads.flat_map(|first| [first, first + line, first + line + 1, first, first + line + 1, first + 1]);
    let mut indices: Vec<u32> = indices.collect();
    let first = positions.len() as u32;
    positions.extend([[-2.0, 0.0, 2.0], [-2.0, 0.0, 2.3], [2.0, 0.0, 2.3], [2.0, 0.0, 2.0]]);
    // Edges of 0.5 m and 1.45 m.
    positions.push([2.2614, 0.0, -0.57375]);
    indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    indices.extend([side, side + line, first + 4]);
    place(&mut scene, vec![Primitive { positions, indices, material, ..Primitive::default() }], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 2.0, 0.0), DVec3::NEG_Y, [1.0; 3]);
    let camera = view(DVec3::new(0.0, 4.6, 0.0), DVec3::ZERO);
    // Diagonals of √2 m have 4 parts like edges of 1 m.
    let options = ParticlesOptions { spacing: 0.36, ..mesh(options(2000, 0)) };
    let shown = session.render(&scene, &settings(options), &asked([400, 400], camera));
    let grid = (u64::from(4 * side + 1).pow(2), u64::from(2 * side * side * 16));
    // Two triangles of 16 rows of one part, which share an edge; two of their corners are the floor's.
    let strip = (2 + 3 * 15, 2 * 31);
    // Eight rows, of one part and from the fifth on of two: 21 points, 5 of which the floor has.
    let triangle = (16, 22);
    let all = count(&shown.timings.passes, "diffuse/particles/find/seen", "all radiance particles");
    let [subtriangles, radiance, _] = found(&shown);
    assert_eq!(all, grid.0 + strip.0 + triangle.0);
    assert_eq!((radiance, subtriangles), (all, grid.1 + strip.1 + triangle.1));
    assert_eq!(count(&shown.timings.passes, "diffuse/particles/find/fit", "unfit"), 0);
}

/// A floor that gets less and less light of a wall at its side, however its triangles' corners are ordered. Another triangle cuts one of its edges more finely.
#[test]
fn light_falls_off_whatever_the_order_of_corners() {
    let session = Session::open();
    let perspective = view(DVec3::new(0.3, 2.2, 0.2), DVec3::new(0.1, 0.0, 0.1));
    let projection = Projection::Orthographic { half_width: 1.3, half_height: 1.04, near: 0.1, far: 1e4 };
    let parallel = CameraView { projection, ..perspective.clone() };
    let shown = |indices: [u32; 6], camera: &CameraView, options: ParticlesOptions| {
        let mut scene = Scene::empty("floor and wall");
        let material = scene.add_material(lambert([0.8; 3])).expect("a sound material");
        let [a, b, c, d] = [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]];
        // Edges of 2 m, 1.7 m and 3.5 m.
        let indices = [&indices[..], &[2, 1, 4]].concat();
        let floor =
            Primitive { positions: vec![a, b, c, d, [2.34, 0.0, 2.05]], indices, ..quad([a, b, c, d], material) };
        let wall = quad([b, a, [-1.0, 1.0, -1.0], [-1.0, 1.0, 1.0]], material);
        place(&mut scene, vec![floor, wall], DAffine3::IDENTITY);
        add_light(&mut scene, LightKind::Point, DVec3::new(0.5, 1.0, 0.3), DVec3::NEG_Y, [1.0; 3]);
        session.render(
            &scene,
            &settings(ParticlesOptions { gather: 16, spacing: 0.05, ..options }),
            &asked(SIZE, camera.clone()),
        )
    };
    let orders = [[0, 1, 2, 0, 2, 3], [2, 0, 1, 3, 0, 2], [1, 2, 0, 2, 3, 0], [0, 2, 3, 2, 0, 1]];
    for (order, camera) in orders.into_iter().map(|order| (order, &perspective)).chain([(orders[0], &parallel)]) {
        let every_pixel = ParticlesOptions { receivers: ParticlesReceivers::Pixels, ..options(3000, 0) };
        let [found, expected] = [mesh(options(3000, 0)), every_pixel].map(|options| shown(order, camera, options));
        let [mean, pixels, blocks] = difference(&found, &expected);
        println!("{order:?}: mean {mean:.4}, pixels {pixels:.4}, blocks {blocks:.4}");
        assert!((mean - 1.0).abs() < 5e-3 && pixels < 0.036 && blocks < 0.015, "{mean}, {pixels}, {blocks}");
        assert_eq!(count(&found.timings.passes, "diffuse/particles/find/homes", "homes"), 0);
    }
}

/// What is not shown is not evaluated, and what nobody reads does not gather.
#[test]
fn a_smaller_view_halves_the_work() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let whole = scene.camera_view(None).expect("its camera");
    let near = view(DVec3::new(0.2, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0));
    let [all, part] = [whole, near]
        .map(|camera| found(&session.render(&scene, &settings(mesh(options(4000, 1))), &asked(SIZE, camera))));
    println!("{all:?} {part:?}");
    assert!(part.iter().zip(all).all(|(part, all)| *part > 0 && 2 * part < all), "{part:?} of {all:?}");
    assert!(all[2] < 4000);
    // Subtriangles that hang together have half as many points, and those at rims; no others are evaluated.
    assert!([all, part].iter().all(|[subtriangles, radiance, _]| 10 * radiance < 7 * subtriangles), "{part:?} {all:?}");
}

#[test]
fn radiance_particles_see_through_no_wall() {
    let session = Session::open();
    let found = leaks(&session, &settings(mesh(options(20_000, 2))), [64, 48]);
    assert!(found.iter().all(|leak| *leak < 1e-3), "{found:?} of the lit hall's light");
}

/// A wall without thickness stands on a floor that runs under it, on a line of the floor's tessellation and beside one.
#[test]
fn walls_on_lines_of_the_tessellation_let_nothing_through() {
    let session = Session::open();
    for at in [0.0_f32, 0.11] {
        let mut scene = closed_box(1.0, lambert([0.5; 3]));
        let wall = Material { double_sided: true, ..lambert([0.5; 3]) };
        let wall = scene.add_material(wall).expect("a sound material");
        let corners = [[at, -1.0, -1.0], [at, -1.0, 1.0], [at, 1.0, 1.0], [at, 1.0, -1.0]];
        place(&mut scene, vec![quad(corners, wall)], DAffine3::IDENTITY);
        add_light(&mut scene, LightKind::Point, DVec3::new(0.6, 0.2, 0.1), DVec3::NEG_Y, [1.0; 3]);
        let mean = |x: f64| {
            let camera = view(DVec3::new(x, 0.8, 0.0), DVec3::new(0.3 * x, -1.0, 0.0));
            let shown = session.render(&scene, &settings(mesh(options(6000, 2))), &asked([96, 72], camera));
            let pixels = &shown.slots[&Slot::Diffuse].pixels;
            pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / pixels.len() as f64
        };
        let (lit, dark) = (mean(0.8), mean(-0.8));
        println!("wall at {at}: {dark:.1e} of {lit:.1e}");
        assert!(lit > 0.0 && dark < 1e-3 * lit, "{at}: {dark} of {lit}");
    }
}

#[test]
fn normal_maps_turn_what_radiance_particles_receive() {
    let session = Session::open();
    for towards in [-1.0, 1.0] {
        let camera = view(DVec3::new(0.1, 0.6, 0.0), DVec3::new(0.0, -0.9, 0.0));
        let (ratio, error) = against_paths(&session, &turned_floor(towards), camera, mesh(options(4000, 0)));
        println!("{towards}: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.06 && error < 0.1, "{towards}: {ratio} {error}");
    }
}

/// Mirrors show radiance particles as pixels do. Where the ring stands the two differ: radiance particles see around no metal.
#[test]
fn mirrors_show_what_they_receive() {
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("its camera");
    let [regions, found] = [options(4000, 1), mesh(options(4000, 1))].map(|options| {
        let asked = request([96, 72], camera.clone(), &[Slot::Diffuse, Slot::Specular]);
        let shown = session.render(&scene, &settings(options), &asked);
        [Slot::Diffuse, Slot::Specular].map(|slot| {
            let pixels = &shown.slots[&slot].pixels;
            pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>()
        })
    });
    println!("{found:?} {regions:?}");
    for (found, expected) in found.into_iter().zip(regions) {
        assert!(expected > 0.0 && (found / expected - 1.0).abs() < 0.05, "{found} for {expected}");
    }
}

#[test]
fn marks_and_lists_stand_while_light_alone_moves() {
    let session = Session::open();
    for lists in [ParticleLists::Used, ParticleLists::All] {
        let mut scene = builtin("cornell-point");
        let camera = scene.camera_view(None).expect("its camera");
        let mut renderer = session.renderer(&settings(ParticlesOptions { lists, ..mesh(options(2000, 2)) }));
        let small = |camera: &CameraView| asked([32, 24], camera.clone());
        let first = renderer.render(&scene, &small(&camera)).expect("a frame");
        let again = renderer.render(&scene, &small(&camera)).expect("a frame");
        assert!(ran(&again).is_empty(), "{:?}", ran(&again));
        assert_eq!(first.slots, again.slots);

        let beside = view(DVec3::new(0.1, 1.0, 2.9), DVec3::new(0.0, 1.0, 0.0));
        let moved = ran(&renderer.render(&scene, &small(&beside)).expect("a frame"));
        let stands = |name: &String, stages: &[&str]| stages.iter().any(|stage| name.contains(stage));
        assert!(!moved.iter().any(|name| stands(name, &["/place/", "/measure/", "/link/", "/light/"])), "{moved:?}");
        let lists_made = moved.iter().any(|name| name.ends_with("/lists/fill"));
        assert_eq!(lists_made, lists == ParticleLists::Used, "{moved:?}");

        let mut light = scene.lights()[0].clone();
        light.intensity = light.intensity.map(|channel| 2.0 * channel);
        scene.set_light(LightId(0), light).expect("a sound light");
        let relit = renderer.render(&scene, &small(&beside)).expect("a frame");
        let passes = ran(&relit);
        let geometry = ["/place/", "/measure/", "/link/", "/lists/", "/find/"];
        assert!(!passes.iter().any(|name| stands(name, &geometry)), "{passes:?}");
        assert!(passes.iter().any(|name| name.ends_with("/shade/pixels")), "{passes:?}");
        renderer.invalidate();
        let anew = renderer.render(&scene, &small(&beside)).expect("a frame");
        assert_eq!(relit.slots, anew.slots, "bit by bit");
    }
}

/// Where things move, what is read is what a fresh frame reads.
#[test]
fn what_moves_takes_its_radiance_particles_along() {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let settings = settings(mesh(options(3000, 2)));
    let mut renderer = session.renderer(&settings);
    renderer.render(&scene, &asked([48, 32], camera.clone())).expect("a frame");
    let id = scene.instances().iter().last().expect("it has some").node;
    let Node { mut local, .. } = scene.nodes()[id.0];
    local.translation += DVec3::new(0.05, 0.0, 0.03);
    scene.set_local_transform(id, local).expect("a sound transform");
    let moved = renderer.render(&scene, &asked([48, 32], camera.clone())).expect("a frame");
    let whole = session.render(&scene, &settings, &asked([48, 32], camera));
    assert_eq!(found(&moved), found(&whole));
    let [moved, whole] = [&moved, &whole].map(|frame| &frame.slots[&Slot::Diffuse].pixels);
    let sum: f32 = whole.iter().map(|pixel| pixel[1]).sum();
    let off: f32 = moved.iter().zip(whole).map(|(a, b)| (a[1] - b[1]).abs()).sum();
    assert!(sum > 0.0 && off < 1e-3 * sum, "{off} of {sum}");
}
