//! Particles that are farther apart where everything is far.

use glam::{DAffine3, DVec3};

use super::super::options::{ParticleDensity, ParticleTransport, ParticlesOptions};
use super::moving::{add_block, counted, difference, shift_and_turn};
use super::{against_paths, count, options, settings, stages};
use crate::gpu_tests::scenes::{add_light, box_faces, closed_box, lambert, place, quad, request, view};
use crate::gpu_tests::session::Session;
use crate::renderer::{FrameRequest, Slot, Timing};
use crate::scene::{LightKind, Material, MaterialId, Primitive, Scene};

fn grey() -> MaterialId {
    MaterialId(0)
}

/// Walls on a wide ground under a sky.
fn on_the_ground(faces: Vec<Primitive>) -> Scene {
    let mut scene = Scene::empty("outdoors");
    assert_eq!(scene.add_material(lambert([0.5; 3])).expect("a sound material"), grey());
    let [low, far] = [-1.05, 30.0];
    let corners = [[-far, low, -far], [-far, low, far], [far, low, far], [far, low, -far]];
    place(&mut scene, vec![quad(corners, grey())], DAffine3::IDENTITY);
    place(&mut scene, faces, DAffine3::IDENTITY);
    scene.set_sky([1.0, 1.2, 1.5]);
    scene
}

/// A room that is open towards +x.
fn open_room() -> Scene {
    let mut faces = box_faces([1.5, 1.0, 1.5], [grey(); 6]);
    faces.remove(1);
    on_the_ground(faces)
}

fn of(density: ParticleDensity, options: ParticlesOptions) -> ParticlesOptions {
    ParticlesOptions { density, ..options }
}

#[test]
fn far_ground_leaves_its_particles_to_rooms() {
    let session = Session::open();
    let scene = open_room();
    let camera = view(DVec3::new(1.2, 0.3, 0.6), DVec3::new(-1.0, -0.2, -0.5));
    let [even, adaptive] = [ParticleDensity::Even, ParticleDensity::Adaptive].map(|density| {
        let options = ParticlesOptions { gather: 16, ..of(density, options(6000, 4)) };
        against_paths(&session, &scene, camera.clone(), options)
    });
    println!("evenly {even:?}, adaptive {adaptive:?}");
    assert!((adaptive.0 - 1.0).abs() < 0.02 && adaptive.1 < 0.06, "{adaptive:?}");
    assert!(adaptive.1 < 0.65 * even.1, "{even:?} {adaptive:?}");
}

#[test]
fn particles_of_all_spacings_stand_for_all_of_the_surface() {
    let session = Session::open();
    let scene = open_room();
    let made = stages(&session, &scene, &options(6000, 1));
    let area: f64 = made.matter.iter().map(|matter| f64::from(matter[3])).sum();
    // The backs of the three upright walls are seen from the ground.
    let [upright, level] = [3.0 * 2.0 * 3.0, 2.0 * 3.0 * 3.0];
    assert!((area / (3600.0 + 2.0 * upright + level) - 1.0).abs() < 1e-4, "{area} m²");
    assert_eq!(count(&made.passes, "diffuse/particles/measure/catch", "lost"), 0);
    // The widest stand for 64 times as much as the closest, in the mean; those at edges for less.
    let mut areas: Vec<f32> = made.matter.iter().map(|matter| matter[3]).collect();
    areas.sort_by(f32::total_cmp);
    let ratio = areas[areas.len() - areas.len() / 100] / areas[areas.len() / 2];
    assert!((40.0..110.0).contains(&ratio), "{ratio}");
}

/// Behind a wall of 5 mm particles lie many times closer than before it.
#[test]
fn no_light_comes_through_walls_to_closer_particles() {
    let session = Session::open();
    let mut faces = box_faces([1.005; 3], [grey(); 6]);
    for face in &mut faces {
        face.indices.reverse();
    }
    faces.extend(box_faces([1.0; 3], [grey(); 6]));
    let scene = on_the_ground(faces);
    let [inside, outside] = [
        (DVec3::new(0.7, 0.5, 0.6), DVec3::new(-0.8, -0.6, -0.7)),
        (DVec3::new(4.0, 1.0, 3.0), DVec3::new(0.0, -0.5, 0.0)),
    ]
    .map(|(eye, target)| {
        let asked = request([64, 48], view(eye, target), &[Slot::Diffuse]);
        let frame = session.render(&scene, &settings(options(8000, 3)), &asked);
        frame.slots[&Slot::Diffuse].pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>()
    });
    assert!(inside < 1e-3 * outside, "{inside} of {outside}");
}

/// Close particles in a hollow right under the ground are nearer to most of it than its own, which are far apart.
#[test]
fn what_lies_under_the_ground_takes_none_of_its_light() {
    let session = Session::open();
    let light = |hollow: bool| {
        let mut scene = on_the_ground(box_faces([0.5; 3], [grey(); 6]));
        if hollow {
            let below = DAffine3::from_translation(DVec3::new(0.0, -1.15, 0.0));
            place(&mut scene, box_faces([20.0, 0.05, 20.0], [grey(); 6]), below);
        }
        let made = stages(&session, &scene, &options(12_000, 0));
        made.emitted.iter().map(|flux| f64::from(flux[1])).sum::<f64>()
    };
    let [without, with] = [false, true].map(light);
    assert!((with / without - 1.0).abs() < 0.02, "{with} W of {without}");
}

/// Of a lamp of 0.1 mW no less arrives if there is one of 10 W elsewhere, though all is counted in steps of what that one sends.
#[test]
fn faint_light_beside_bright_light_is_all_passed_on() {
    let session = Session::open();
    let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::new(-0.5, -0.4, -0.6));
    let [alone, beside] = [false, true].map(|bright| {
        let mut scene = closed_box(1.0, lambert([0.7; 3]));
        add_light(&mut scene, LightKind::Point, DVec3::new(0.1, 0.2, 0.0), DVec3::NEG_Y, [1e-5; 3]);
        let far = DVec3::new(10.0, 0.0, 0.0);
        place(&mut scene, box_faces([1.0; 3], [grey(); 6]), DAffine3::from_translation(far));
        if bright {
            add_light(&mut scene, LightKind::Point, far, DVec3::NEG_Y, [1.0; 3]);
        }
        let frame =
            session.render(&scene, &settings(options(8000, 6)), &request([64, 48], camera.clone(), &[Slot::Diffuse]));
        frame.slots[&Slot::Diffuse].pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>()
    });
    assert!((beside / alone - 1.0).abs() < 0.03, "{}", beside / alone);
}

/// A sunlit ground stands for 64 times as much surface as what it lights in a room: where its few links end by chance, spots showed. Where something is specular they do.
#[test]
fn wide_particles_leave_no_spots() {
    let session = Session::open();
    let spots = |specular: bool| {
        let mut scene = open_room();
        scene.set_sky([0.0; 3]);
        add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.3, -1.0, 0.2), [3.0; 3]);
        if specular {
            let metal = Material { metallic: 1.0, roughness: 0.3, ..Material::default() };
            let metal = scene.add_material(metal).expect("a sound material");
            let corners = [[29.0, -1.0, 29.0], [29.0, -1.0, 29.01], [29.01, -1.0, 29.01], [29.01, -1.0, 29.0]];
            place(&mut scene, vec![quad(corners, metal)], DAffine3::IDENTITY);
        }
        let [scattered, gathered] = [ParticleTransport::TwoWay, ParticleTransport::GatherOnly]
            .map(|transport| stages(&session, &scene, &ParticlesOptions { transport, ..options(6000, 1) }));
        let mut areas: Vec<f32> = scattered.matter.iter().map(|matter| matter[3]).collect();
        areas.sort_by(f32::total_cmp);
        let most = 4.0 * areas[areas.len() / 2];
        let pairs = scattered.radiance.iter().zip(&gathered.radiance).zip(&scattered.matter);
        let close = pairs.filter(|(_, matter)| matter[3] < most);
        let squares: Vec<f64> = close.map(|((a, b), _)| f64::from(a[1] - b[1]).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let [without, with] = [false, true].map(spots);
    println!("off by {without:.4} W/(m² sr), {with:.4} with few links");
    assert!(without < 0.7 * with, "{without} of {with}");
}

/// How far apart particles are depends on all that is around: what moves makes everything anew, and the frame is a fresh one's.
#[test]
fn what_moves_under_a_sky_makes_all_anew() {
    let session = Session::open();
    let camera = view(DVec3::new(1.2, 0.3, 0.6), DVec3::new(-1.0, -0.2, -0.5));
    let asked = FrameRequest { timing: Timing::Passes, ..request([64, 48], camera, &[Slot::Diffuse]) };
    for (density, anew) in [(ParticleDensity::Even, false), (ParticleDensity::Adaptive, true)] {
        let mut scene = open_room();
        // More stand than move.
        let places = [DVec3::new(-0.3, -0.7, 0.2), DVec3::new(-1.0, -0.7, 1.0), DVec3::new(0.8, -0.7, -1.0)];
        let [block, ..] = places.map(|at| add_block(&mut scene, at));
        let settings = settings(of(density, options(3000, 2)));
        let mut renderer = session.renderer(&settings);
        renderer.render(&scene, &asked).expect("a frame");
        shift_and_turn(&mut scene, block);
        let moved = renderer.render(&scene, &asked).expect("a frame");
        let whole = session.render(&scene, &settings, &asked);
        let [again, all] = [&moved, &whole].map(|frame| counted(frame, "link/trace", "rays"));
        assert_eq!(again == all, anew, "{density:?}: {again} links of {all}");
        assert!(difference(&moved, &whole) <= if anew { 0.0 } else { 1e-3 }, "{density:?}");
    }
}

/// Why particles lie evenly, and that they do.
#[test]
fn particles_lie_evenly_where_nothing_is_far() {
    let session = Session::open();
    let reason = |scene: &Scene, options: ParticlesOptions| {
        let made = stages(&session, scene, &options);
        let row = made.passes.into_iter().find(|row| row.full_name() == "diffuse/particles/place/distances");
        row.expect("the pass").skipped.map(|reason| reason.to_string())
    };
    let mut closed = closed_box(1.0, lambert([0.5; 3]));
    add_light(&mut closed, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    assert_eq!(reason(&closed, options(500, 0)), Some("neither a sky nor a sun shines".to_string()));
    let open = open_room();
    assert_eq!(reason(&open, options(500, 0)), None);
    assert_eq!(reason(&open, of(ParticleDensity::Even, options(500, 0))), Some("particles lie evenly".to_string()));
}
