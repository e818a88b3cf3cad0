//! Voxels of surfaces.

use glam::{DAffine3, DVec3};

use super::read::voxelise_in;
use super::reference::voxels_of;
use super::{Read, ball, draws, soup, voxelise};
use crate::frame::voxels::grid::VoxelGrid;
use crate::frame::voxels::{VoxelSettings, Voxelisation};
use crate::gpu_tests::scenes::{builtin, closed_box, lambert, place};
use crate::gpu_tests::session::Session;
use crate::scene::Scene;

fn settings(resolution: u32, voxelisation: Voxelisation) -> VoxelSettings {
    VoxelSettings { resolution, voxelisation: Some(voxelisation), ..VoxelSettings::default() }
}

/// Voxels by both ways, which are the same to the bit, and the same as the host finds for the triangles as they were rounded.
fn checked(session: &Session, scene: &Scene, resolution: u32) -> Read {
    let by = |voxelisation| voxelise(&mut session.store(), scene, &settings(resolution, voxelisation), 0.0);
    let read = by(Voxelisation::Compute);
    let expected = voxels_of(&read.triangles, read.dims(), i64::from(read.grid.record.units));
    let wrong = read.bits.iter().zip(&expected).filter(|(found, expected)| found != expected).count();
    assert_eq!(wrong, 0, "of {} voxels, {} triangles", read.count(), read.triangles.len());
    if draws(session) {
        let drawn = by(Voxelisation::Raster);
        let wrong = read.bits.iter().zip(&drawn.bits).filter(|(found, expected)| found != expected).count();
        assert_eq!(wrong, 0, "of {} voxels both ways find something else", read.count());
    }
    read
}

/// Numbers below 1, always the same.
fn numbers(mut seed: u64) -> impl FnMut() -> f32 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1_u64 << 24) as f32
    }
}

/// Corners as the device rounded them are those of the scene.
#[test]
fn corners_are_rounded_by_less_than_a_hundredth_of_a_voxel() {
    let session = Session::open();
    let mut next = numbers(1);
    let positions: Vec<[f32; 3]> = (0..300).map(|_| [next(), 0.6 * next(), 0.3 * next()]).collect();
    let read = checked(&session, &soup(positions.clone()), 64);
    assert_eq!(read.triangles.len(), 100);
    let scale = f64::from(read.grid.record.units) / f64::from(read.grid.record.size);
    let origin = glam::Vec3::from(read.grid.record.origin_rs).as_dvec3() + read.origin;
    let place = |corner: &[f32; 3]| ((DVec3::from(corner.map(f64::from)) - origin) * scale).to_array();
    for corners in positions.chunks(3) {
        let exact: Vec<[f64; 3]> = corners.iter().map(place).collect();
        let off = |found: &[[i64; 3]; 3]| {
            let pairs = found.iter().zip(&exact).flat_map(|(found, exact)| found.iter().zip(exact));
            pairs.map(|(found, exact)| (*found as f64 - exact).abs()).fold(0.0, f64::max)
        };
        let nearest = read.triangles.iter().map(off).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 1.01, "{nearest} units off");
    }
}

#[test]
fn a_plane_at_an_angle_fills_what_the_exact_test_says() {
    let session = Session::open();
    let quad =
        vec![[0.0, 0.1, 0.0], [1.0, 0.35, 0.2], [0.9, 0.8, 1.1], [0.0, 0.1, 0.0], [0.9, 0.8, 1.1], [-0.1, 0.55, 0.9]];
    for resolution in [16, 64, 128] {
        let read = checked(&session, &soup(quad.clone()), resolution);
        assert!(read.count() > 100, "{resolution}: {}", read.count());
    }
}

#[test]
fn triangles_of_every_shape_fill_what_the_exact_test_says() {
    let session = Session::open();
    let mut next = numbers(7);
    let mut positions: Vec<[f32; 3]> = Vec::new();
    for size in [1.0_f32, 0.3, 0.03, 0.003, 1e-4] {
        for _ in 0..40 {
            let at = [next(), next(), next()];
            let mut corner = || [0, 1, 2].map(|axis: usize| at[axis] + size * (next() - 0.5));
            positions.extend([corner(), corner(), corner()]);
        }
        // Slivers.
        for _ in 0..20 {
            let ends = [[next(), next(), next()], [next(), next(), next()]];
            let middle = [0, 1, 2].map(|axis: usize| 0.5 * (ends[0][axis] + ends[1][axis]) + 1e-4 * size * next());
            positions.extend([ends[0], middle, ends[1]]);
        }
    }
    let read = checked(&session, &soup(positions), 128);
    assert!(read.triangles.len() >= 250, "{}", read.triangles.len());
}

#[test]
fn a_ball_is_closed_at_every_size_of_its_triangles() {
    let session = Session::open();
    for columns in [8, 64, 400] {
        let mut scene = Scene::empty("ball");
        let material = scene.add_material(lambert([0.5; 3])).expect("sound");
        place(&mut scene, vec![ball(1.0, columns, material)], DAffine3::IDENTITY);
        let read = checked(&session, &scene, 64);
        // From the middle nothing outside is reached through faces of empty voxels.
        let dims = read.dims();
        let mut reached = vec![false; read.bits.len()];
        let mut waiting = vec![read.voxel_at(DVec3::ZERO)];
        while let Some(voxel) = waiting.pop() {
            let number = (voxel[2] * dims[1] + voxel[1]) * dims[0] + voxel[0];
            if read.bits[number] || std::mem::replace(&mut reached[number], true) {
                continue;
            }
            assert!(
                (0..3).all(|axis| voxel[axis] > 0 && voxel[axis] + 1 < dims[axis]),
                "{columns}: a way out at {voxel:?}"
            );
            for axis in 0..3 {
                let step = |by: isize| {
                    [0, 1, 2].map(|along| voxel[along].wrapping_add_signed(if along == axis { by } else { 0 }))
                };
                waiting.extend([step(1), step(-1)]);
            }
        }
        let inside = reached.iter().filter(|reached| **reached).count();
        assert!(inside > 50_000, "{inside} voxels inside");
    }
}

#[test]
fn walls_are_one_voxel_thick_wherever_they_lie() {
    let session = Session::open();
    let read = checked(&session, &closed_box(1.0, lambert([0.5; 3])), 64);
    // Walls from the middle of one voxel to that of another one.
    assert_eq!(read.count(), 62_usize.pow(3) - 60_usize.pow(3));
    // Squares in voxels' borders, and by the same amounts off them, in a box that says where these are.
    for off in [0.0_f32, 1e-7, -1e-7, 0.3] {
        let box_of = [
            [0.0, 0.0, 0.0],
            [61.0, 0.0, 0.0],
            [0.0, 61.0, 0.0],
            [61.0, 61.0, 61.0],
            [61.0, 61.0, 60.9],
            [61.0, 60.9, 61.0],
        ];
        let at = 20.5 + off;
        let square = [
            [10.5, at, 10.5],
            [20.5, at, 10.5],
            [20.5, at, 20.5],
            [10.5, at, 10.5],
            [20.5, at, 20.5],
            [10.5, at, 20.5],
        ];
        let read = checked(&session, &soup([box_of, square].concat()), 64);
        let layers: Vec<usize> = (0..64).filter(|&y| read.is_set([15, y, 15])).collect();
        assert_eq!(layers.len(), 1, "{off}: layers {layers:?}");
    }
}

#[test]
fn what_reaches_beyond_the_grid_is_cut() {
    let session = Session::open();
    let mut next = numbers(3);
    // Around a grid from 0 to 1; the far ones lie nearly in planes z = 0.1 and 0.5.
    let mut positions: Vec<[f32; 3]> = (0..300).map(|_| [0, 1, 2].map(|_: usize| 4.0 * next() - 1.5)).collect();
    let far = 3e4;
    positions.extend([[-far, -far, 0.1], [far, -far, 0.1], [0.0, far, 0.1]]);
    positions.extend([[0.2, 0.3, 0.5], [far, 0.1, 0.5], [0.4, -far, 0.5]]);
    let scene = soup(positions.clone());
    let by = |voxelisation| {
        let settings = settings(32, voxelisation);
        voxelise_in(&mut session.store(), &scene, &settings, 0.0, |data| {
            VoxelGrid::of(DVec3::ZERO - data.origin, DVec3::ONE - data.origin, 1.0, 32)
        })
    };
    let read = by(Voxelisation::Compute);
    assert!(read.triangles.len() > 100, "{} triangles", read.triangles.len());
    assert!(read.bits == voxels_of(&read.triangles, read.dims(), i64::from(read.grid.record.units)));
    if draws(&session) {
        assert!(read.bits == by(Voxelisation::Raster).bits);
    }
    // A point of a triangle within the grid lies in a voxel that is set, but for what cutting and rounding move.
    let size = f64::from(read.grid.record.size);
    let mut tested = 0;
    for corners in positions.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|corner: usize| DVec3::from(corners[corner].map(f64::from)));
        for _ in 0..400 {
            let (u, v) = (f64::from(next()), f64::from(next()));
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let point = a + (b - a) * u + (c - a) * v;
            if point.min_element() > 0.0 && point.max_element() < 1.0 {
                let around =
                    (0..27).map(|at| DVec3::new(f64::from(at % 3), f64::from(at / 3 % 3), f64::from(at / 9)) - 1.0);
                let mut found = around.map(|way| read.is_set(read.voxel_at(point + 0.05 * size * way)));
                assert!(found.any(|set| set), "nothing is at {point}");
                tested += 1;
            }
        }
    }
    assert!(tested > 1000, "{tested} points");
    for z in [0.1, 0.5] {
        let [x, y, z] = read.voxel_at(DVec3::new(0.35, 0.2, z));
        assert!(read.is_set([x, y, z]), "a far triangle passes there");
    }
}

#[test]
fn scale_and_repetition_change_no_bit() {
    let session = Session::open();
    let scene = |scale: f64| {
        let mut scene = Scene::empty("scaled");
        let material = scene.add_material(lambert([0.5; 3])).expect("sound");
        place(&mut scene, vec![ball(1.0, 40, material)], DAffine3::from_scale(DVec3::splat(scale)));
        place(
            &mut scene,
            vec![ball(0.3, 9, material)],
            DAffine3::from_scale_rotation_translation(
                DVec3::splat(scale),
                glam::DQuat::from_rotation_y(0.3),
                DVec3::new(2.0, 0.5, 0.3) * scale,
            ),
        );
        scene
    };
    let one = checked(&session, &scene(1.0), 128);
    let again = checked(&session, &scene(1.0), 128);
    assert!(one.bits == again.bits && one.levels == again.levels);
    for scale in [1e-3, 1.0 / 1024.0, 1024.0, 1e3] {
        let other = checked(&session, &scene(scale), 128);
        assert_eq!(other.grid.dims(), one.grid.dims());
        let off = one.bits.iter().zip(&other.bits).filter(|(a, b)| a != b).count();
        // By a power of two not one; by others corners round to another unit here and there.
        let most = if scale.log2().fract() == 0.0 { 0 } else { one.count() / 200 };
        assert!(off <= most, "{scale}: {off} of {} voxels", one.count());
    }
}

#[test]
fn levels_keep_the_mean_and_walls_stay_closed_along_their_normal() {
    let session = Session::open();
    for name in ["cornell-point", "two-rooms"] {
        let read = checked(&session, &builtin(name), 128);
        let mean = |level: &[[u8; 4]], channel: usize| {
            level.iter().map(|texel| f64::from(texel[channel])).sum::<f64>() / (255.0 * level.len() as f64)
        };
        let exact = read.count() as f64 / read.bits.len() as f64;
        for (number, level) in read.levels.iter().enumerate() {
            let off = mean(level, 3) - exact;
            // Rounding goes both ways: truncated, a level would lose up to half a step of 255.
            assert!(off.abs() < 5e-4, "{name}, level {number}: {off}");
            eprintln!(
                "{name}: level {number}: mean {:.5} of {exact:.5}, along x {:.5}",
                mean(level, 3),
                mean(level, 0)
            );
        }
    }
    let read = checked(&session, &closed_box(1.0, lambert([0.5; 3])), 128);
    let middle_of_wall = |level: usize| {
        let side = read.dims()[0] >> level;
        let at = |x: usize| read.levels[level][(side / 2 * side + side / 2) * side + x];
        (0..side / 2).map(at).max_by_key(|texel| texel[0]).expect("a row")
    };
    for level in 0..read.levels.len() {
        let [x, y, _, mean] = middle_of_wall(level);
        assert_eq!(x, 255, "level {level}: seen along its normal");
        let share = 255 >> level;
        assert!(y.abs_diff(share) <= 2 && mean.abs_diff(share) <= 2, "level {level}: {y} across, {mean} in the mean");
    }
}
