//! Backs of one-sided surfaces: light where others see them, and nothing else where nobody does.

use glam::{DAffine3, DVec3};

use super::moving::{add_block, moves, shift_and_turn};
use super::{against_paths, options, stages};
use crate::frame::rays::TracedScene;
use crate::gpu_tests::scenes::{add_light, box_faces, builtin, lambert, place, quad, view};
use crate::gpu_tests::session::Session;
use crate::scene::{LightKind, Scene};

/// A lamp under a shelf that faces upwards, in a room.
fn shelf() -> Scene {
    let mut scene = Scene::empty("shelf");
    let grey = scene.add_material(lambert([0.5; 3])).expect("a sound material");
    let red = scene.add_material(lambert([0.8, 0.7, 0.7])).expect("a sound material");
    place(&mut scene, box_faces([1.0; 3], [grey; 6]), DAffine3::IDENTITY);
    let corners = [[-0.8, 0.2, -0.9], [-0.8, 0.2, 0.5], [0.8, 0.2, 0.5], [0.8, 0.2, -0.9]];
    place(&mut scene, vec![quad(corners, red)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(0.2, -0.4, -0.3), DVec3::NEG_Y, [1.0; 3]);
    scene
}

#[test]
fn backs_that_others_see_are_lit() {
    let session = Session::open();
    // From below the shelf, and past it.
    for (eye, target) in [
        (DVec3::new(0.0, -0.7, 0.9), DVec3::new(0.0, 0.2, -0.4)),
        (DVec3::new(0.0, -0.2, 0.95), DVec3::new(0.0, -0.3, -1.0)),
    ] {
        let (ratio, error) = against_paths(&session, &shelf(), view(eye, target), options(8000, 3));
        println!("mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.03 && error < 0.08, "{ratio} {error}");
    }
}

/// Which backs count stays, so that particles keep their numbers.
#[test]
fn what_moves_under_a_shelf_is_traced_again_alone() {
    let mut scene = shelf();
    let block = add_block(&mut scene, DVec3::new(-0.4, -0.6, 0.1));
    let camera = view(DVec3::new(0.0, -0.7, 0.9), DVec3::new(0.0, 0.2, -0.4));
    moves(&mut scene, &camera, (0.5, 1e-3), |scene, _| shift_and_turn(scene, block));
}

/// The blocks have no bottoms, but only the floor under them sees that.
#[test]
fn insides_of_things_have_no_particles() {
    let session = Session::open();
    let marks = |scene: &Scene| {
        let traced = TracedScene::new(session.context.shared_device(), scene).expect("the scene fits the device");
        traced.backs().iter().map(|word| word.count_ones()).sum::<u32>()
    };
    assert_eq!(marks(&shelf()), 2);
    for name in ["cornell-point", "corridor", "maze", "two-rooms", "leak"] {
        assert_eq!(marks(&builtin(name)), 0, "{name}");
    }
    // The area of the shelf counts twice.
    let made = stages(&session, &shelf(), &options(4000, 1));
    let area: f64 = made.matter.iter().map(|matter| f64::from(matter[3])).sum();
    assert!((area / (24.0 + 2.0 * 1.6 * 1.4) - 1.0).abs() < 1e-3, "{area} m²");
}
