//! What is made anew when something changes, and what follows it over frames.

use glam::{DAffine3, DVec3};

use super::{ball, draws, soup, voxelise};
use crate::frame::voxels::{VoxelSettings, Voxelisation};
use crate::gpu_tests::scenes::{closed_box, lambert, place};
use crate::gpu_tests::session::Session;
use crate::scene::{NodeId, Scene};

/// A room with a ball, and the ball's node.
fn room() -> (Scene, NodeId) {
    let mut scene = closed_box(1.0, lambert([0.5; 3]));
    let material = scene.add_material(lambert([0.5; 3])).expect("sound");
    let ball = place(&mut scene, vec![ball(0.2, 24, material)], DAffine3::from_translation(DVec3::X * 0.5));
    (scene, ball)
}

#[test]
fn what_stands_is_voxelised_once_and_what_moves_anew() {
    let session = Session::open();
    let mut store = session.store();
    let settings = VoxelSettings { resolution: 64, skip_empty: true, ..VoxelSettings::default() };
    let (mut scene, node) = room();
    let first = voxelise(&mut store, &scene, &settings, 0.1);
    assert!(first.ran().iter().any(|name| name == "voxels/fill"), "{:?}", first.ran());
    let again = voxelise(&mut store, &scene, &settings, 0.1);
    assert_eq!(again.ran(), Vec::<String>::new());
    scene.set_local_transform(node, DAffine3::from_translation(DVec3::X * -0.5)).expect("a node");
    let moved = voxelise(&mut store, &scene, &settings, 0.1);
    assert!(moved.ran().iter().any(|name| name == "voxels/fill"), "{:?}", moved.ran());
    for (read, place) in [(&first, 0.3), (&moved, -0.3)] {
        assert!(read.is_set(read.voxel_at(DVec3::X * place)), "the ball's wall at {place}");
        assert!(!read.is_set(read.voxel_at(DVec3::X * -place)), "nothing is at {}", -place);
    }
    let alone = voxelise(&mut session.store(), &scene, &settings, 0.1);
    assert!(alone.bits == moved.bits && alone.levels == moved.levels, "frames do not depend on those before");
}

#[test]
fn opacity_follows_what_moves_and_then_stands_still() {
    let session = Session::open();
    let mut store = session.store();
    // A frame takes half of the difference.
    let (rate, step) = (std::f32::consts::LN_2 / 0.1, 0.1);
    let settings = VoxelSettings { resolution: 64, adaption: rate, ..VoxelSettings::default() };
    let (mut scene, node) = room();
    let first = voxelise(&mut store, &scene, &settings, step);
    let target = voxelise(&mut session.store(), &scene, &VoxelSettings { adaption: 0.0, ..settings }, step);
    assert!(first.levels == target.levels, "the first frame is there at once");
    scene.set_local_transform(node, DAffine3::from_translation(DVec3::X * -0.5)).expect("a node");
    let target = voxelise(&mut session.store(), &scene, &VoxelSettings { adaption: 0.0, ..settings }, step);
    let [old, new] = [0.3, -0.3].map(|x| first.voxel_at(DVec3::X * x));
    let [width, height, _] = first.dims();
    let number = |[x, y, z]: [usize; 3]| (z * height + y) * width + x;
    let mut opacities = Vec::new();
    let mut frames = 0;
    loop {
        let read = voxelise(&mut store, &scene, &settings, step);
        frames += 1;
        opacities.push([old, new].map(|voxel| read.levels[0][number(voxel)][3]));
        if read.ran().is_empty() {
            assert!(read.levels == target.levels, "in the end it is what is there");
            break;
        }
        assert!(frames < 20, "it goes on and on: {:?}, {opacities:?}", read.ran());
    }
    assert_eq!(opacities[..4], [[127, 128], [63, 192], [31, 224], [15, 240]], "after {frames} frames");
    // Time that stands still moves nothing.
    scene.set_local_transform(node, DAffine3::from_translation(DVec3::X * 0.5)).expect("a node");
    let read = voxelise(&mut store, &scene, &settings, 0.0);
    assert!(read.levels == target.levels);
}

#[test]
fn lists_that_are_too_small_grow() {
    let session = Session::open();
    let mut store = session.store();
    // Triangles that all span the grid: many tiles each.
    let mut positions = Vec::new();
    for index in 0..60_u8 {
        let at = f32::from(index) / 60.0;
        positions.extend([[0.0, at, 0.0], [1.0, 1.0 - at, 0.0], [1.0, at, 1.0]]);
    }
    let scene = soup(positions);
    let settings = |voxelisation| VoxelSettings { resolution: 256, voxelisation, ..VoxelSettings::default() };
    let read = voxelise(&mut store, &scene, &settings(Some(Voxelisation::Compute)), 0.0);
    assert_eq!(read.outgrown, ["voxels.tiles"]);
    assert!(voxelise(&mut store, &scene, &settings(Some(Voxelisation::Compute)), 0.0).outgrown.is_empty(), "once");
    if draws(&session) {
        // Which takes no tiles.
        let drawn = voxelise(&mut session.store(), &scene, &settings(Some(Voxelisation::Raster)), 0.0);
        assert!(read.bits == drawn.bits && drawn.outgrown.is_empty());
    }
}
