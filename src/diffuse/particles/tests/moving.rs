//! Surfaces that move: what is done again, and what comes of it.

use glam::{DAffine3, DQuat, DVec3};

use super::super::options::{ParticleDensity, ParticlesOptions};
use crate::gpu_tests::scenes::{box_faces, builtin, floor, lambert, place, request, view};
use crate::gpu_tests::session::Session;
use crate::method::{Options, Preset};
use crate::renderer::{Frame, FrameRequest, Settings, Slot, Technique, Timing};
use crate::scene::{CameraView, Node, NodeId, Scene};

fn settings(count: u32) -> Settings {
    let (bounces, density) = (Some(3), ParticleDensity::Even);
    let particles =
        ParticlesOptions { count, bounces, density, gather: 8, ..ParticlesOptions::preset(Preset::Default) };
    Settings { particles, ..Settings::new(Technique::Particles, Preset::Default) }
}

fn asked(camera: &CameraView) -> FrameRequest {
    FrameRequest { timing: Timing::Passes, ..request([48, 32], camera.clone(), &[Slot::Diffuse]) }
}

/// What a pass of the method counted.
pub(super) fn counted(frame: &Frame, pass: &str, name: &str) -> u64 {
    let prefix = format!("diffuse/particles/{pass}");
    let passes = frame.timings.passes.iter().filter(|row| row.full_name().starts_with(&prefix));
    passes.filter_map(|row| row.work.get(name)).sum()
}

/// The mean difference of two pictures, over the mean of the second.
pub(super) fn difference(found: &Frame, expected: &Frame) -> f64 {
    let [found, expected] = [found, expected].map(|frame| &frame.slots[&Slot::Diffuse].pixels);
    let values = || found.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    let sum: f64 = values().map(|(_, b)| b).sum();
    assert!(sum > 0.0);
    values().map(|(a, b)| (a - b).abs()).sum::<f64>() / sum
}

/// Moves a scene twice: what is made of it is what a fresh renderer makes, up to `most`, though less than `share` of the links are traced again.
pub(super) fn moves(scene: &mut Scene, camera: &CameraView, (share, most): (f64, f64), step: impl Fn(&mut Scene, u32)) {
    let (session, settings) = (Session::open(), settings(3000));
    let mut renderer = session.renderer(&settings);
    renderer.render(scene, &asked(camera)).expect("a frame");
    for number in 1..3 {
        step(scene, number);
        let moved = renderer.render(scene, &asked(camera)).expect("a frame");
        let whole = session.render(scene, &settings, &asked(camera));
        let [again, all] = [&moved, &whole].map(|frame| counted(frame, "link/trace", "rays"));
        let facets = [&moved, &whole].map(|frame| counted(frame, "measure/catch", "facets"));
        let difference = difference(&moved, &whole);
        println!("{}: {again} links of {all}, facets {facets:?}, difference {difference:.1e}", scene.name);
        assert!(again > 0 && (again as f64) < share * all as f64, "{again} links of {all}");
        assert!(facets[0] < facets[1] / 2, "{facets:?}");
        assert!(difference <= most, "{}: {difference}", scene.name);
        let still = renderer.render(scene, &asked(camera)).expect("a frame");
        assert_eq!(still.slots, moved.slots);
        let ran = still.timings.passes.iter().find(|row| row.skipped.is_none() && row.piece.contains("particles"));
        assert!(ran.is_none(), "{ran:?}");
    }
}

/// A block of 0.4 m.
pub(super) fn add_block(scene: &mut Scene, at: DVec3) -> NodeId {
    let material = scene.add_material(lambert([0.6, 0.3, 0.2])).expect("a sound material");
    let mut faces = box_faces([0.2; 3], [material; 6]);
    for face in &mut faces {
        face.indices.reverse();
    }
    place(scene, faces, DAffine3::from_translation(at))
}

pub(super) fn shift_and_turn(scene: &mut Scene, node: NodeId) {
    let Node { mut local, .. } = scene.nodes()[node.0];
    local.translation += DVec3::new(0.04, 0.0, 0.02);
    local.matrix3 = glam::DMat3::from_quat(DQuat::from_rotation_y(0.1)) * local.matrix3;
    scene.set_local_transform(node, local).expect("a sound transform");
}

#[test]
fn an_animation_traces_what_it_crosses() {
    let mut scene = builtin("animated");
    let camera = scene.camera_view(None).expect("its camera");
    moves(&mut scene, &camera, (0.25, 1e-3), Scene::set_frame);
}

/// Two in a maze, one before an emissive panel, one before a mirror, one under the sky.
#[test]
fn blocks_trace_what_they_cross() {
    let mut maze = builtin("maze");
    let mut panel = builtin("cornell-panel");
    let mut ring = builtin("ring");
    let mut open = floor(2.0, lambert([0.5; 3]));
    open.set_sky([1.0, 1.5, 2.0]);
    let maze_blocks = [DVec3::new(-3.0, 0.3, 0.75), DVec3::new(0.75, 0.3, -2.25)].map(|at| add_block(&mut maze, at));
    let camera = maze.camera_view(None).expect("its camera");
    moves(&mut maze, &camera, (0.05, 1e-3), |scene, _| {
        maze_blocks.iter().for_each(|block| shift_and_turn(scene, *block))
    });
    for (scene, at, share) in [
        (&mut panel, DVec3::new(0.3, 1.2, 0.2), 0.5),
        (&mut ring, DVec3::new(0.6, 0.4, 0.6), 0.5),
        (&mut open, DVec3::new(0.3, 0.3, 0.0), 0.5),
    ] {
        let block = add_block(scene, at);
        let far = view(DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO);
        let camera = scene.camera_view(None).unwrap_or(far);
        moves(scene, &camera, (share, 1e-3), |scene, _| shift_and_turn(scene, block));
    }
}

/// A stretched thing has another area, and with it all particles other places.
#[test]
fn what_changes_its_shape_is_made_anew() {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let block = add_block(&mut scene, DVec3::new(0.3, 1.2, 0.2));
    let camera = scene.camera_view(None).expect("its camera");
    let settings = settings(1000);
    let mut renderer = session.renderer(&settings);
    let first = renderer.render(&scene, &asked(&camera)).expect("a frame");
    let Node { mut local, .. } = scene.nodes()[block.0];
    local.matrix3 *= 1.1;
    scene.set_local_transform(block, local).expect("a sound transform");
    let stretched = renderer.render(&scene, &asked(&camera)).expect("a frame");
    assert_eq!(counted(&stretched, "link/trace", "rays"), counted(&first, "link/trace", "rays"));
    assert_eq!(difference(&stretched, &session.render(&scene, &settings, &asked(&camera))), 0.0);
}
