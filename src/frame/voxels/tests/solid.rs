//! Closed meshes that are filled, and what is none.

use glam::{DAffine3, DQuat, DVec3};

use super::{ball, voxelise};
use crate::frame::voxels::VoxelSettings;
use crate::gpu_tests::scenes::{box_faces, closed_box, lambert, place};
use crate::gpu_tests::session::Session;
use crate::scene::{MaterialId, Primitive, Scene};

const SOLID: VoxelSettings = VoxelSettings {
    resolution: 128,
    voxelisation: None,
    solid: true,
    adaption: 0.0,
    directional: true,
    skip_empty: false,
    cone_width: 0.5,
};

/// A room in which something lies that `of` makes for the material.
fn room_with(of: impl Fn(MaterialId) -> Vec<Primitive>, local: DAffine3) -> Scene {
    let mut scene = closed_box(1.0, lambert([0.5; 3]));
    let material = scene.add_material(lambert([0.5; 3])).expect("sound");
    place(&mut scene, of(material), local);
    scene
}

fn turned_inside_out(mut primitive: Primitive) -> Primitive {
    primitive.indices.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
    primitive
}

/// How many voxels filling adds.
fn added(session: &Session, scene: &Scene) -> usize {
    let solid = voxelise(&mut session.store(), scene, &SOLID, 0.0);
    let hollow = voxelise(&mut session.store(), scene, &VoxelSettings { solid: false, ..SOLID }, 0.0);
    assert!(solid.bits.iter().zip(&hollow.bits).all(|(solid, hollow)| *solid || !*hollow), "surfaces stay");
    solid.count() - hollow.count()
}

#[test]
fn a_ball_is_filled_and_the_room_around_it_is_not() {
    let session = Session::open();
    let at = DAffine3::from_translation(DVec3::new(0.2, -0.1, 0.3));
    let scene = room_with(|material| vec![ball(0.5, 48, material)], at);
    let read = voxelise(&mut session.store(), &scene, &SOLID, 0.0);
    let size = f64::from(read.grid.record.size);
    let (mut wrong, mut inside) = (0, 0);
    let dims = read.dims();
    for (number, &set) in read.bits.iter().enumerate() {
        let voxel = [number % dims[0], number / dims[0] % dims[1], number / dims[0] / dims[1]];
        let origin = glam::Vec3::from(read.grid.record.origin_rs).as_dvec3() + read.origin;
        let center = origin + (DVec3::from(voxel.map(|at| at as f64)) + 0.5) * size;
        let distance = (center - at.translation).length();
        let room = center.abs().max_element() < 1.0 - 2.0 * size;
        inside += usize::from(distance < 0.5);
        // A polyhedron in place of a ball, and voxels that touch it.
        wrong += usize::from(if distance < 0.49 { !set } else { room && distance > 0.5 + size && set });
    }
    assert_eq!(wrong, 0, "of {inside} voxels inside");
    // A mirror image, which turns its corners the other way round, is as solid; one that is inside out is a shell.
    let mirrored = DAffine3 { translation: at.translation, ..DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)) };
    let plain = added(&session, &scene);
    assert!(plain > inside / 2, "{plain} of {inside}");
    assert_eq!(
        added(&session, &room_with(|material| vec![ball(0.5, 48, material)], mirrored)).abs_diff(plain) * 100 / plain,
        0
    );
    assert_eq!(added(&session, &room_with(|material| vec![turned_inside_out(ball(0.5, 48, material))], at)), 0);
}

#[test]
fn what_is_open_is_not_filled() {
    let session = Session::open();
    let open = |material| {
        let mut ball = ball(0.5, 24, material);
        ball.indices.truncate(ball.indices.len() - 6);
        vec![ball]
    };
    assert_eq!(added(&session, &room_with(open, DAffine3::IDENTITY)), 0, "a triangle is missing");
    assert_eq!(added(&session, &closed_box(1.0, lambert([0.5; 3]))), 0, "a room whose fronts look inwards");
    // The room's fronts look outwards: it spans all of the grid, and is taken for a room.
    let mut room = Scene::empty("inside out");
    let material = room.add_material(lambert([0.5; 3])).expect("sound");
    let faces = box_faces([1.0; 3], [material; 6]).into_iter().map(turned_inside_out).collect();
    place(&mut room, faces, DAffine3::IDENTITY);
    assert_eq!(added(&session, &room), 0);
}

#[test]
fn parts_of_several_materials_close_each_other_and_overlaps_are_solid() {
    let session = Session::open();
    let cube = |material| box_faces([0.3; 3], [material; 6]).into_iter().map(turned_inside_out).collect::<Vec<_>>();
    let turn = DAffine3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.7, 0.2));
    let mut scene = room_with(cube, turn);
    let one = added(&session, &scene);
    let read = voxelise(&mut session.store(), &scene, &SOLID, 0.0);
    let exact = (0.6 / f64::from(read.grid.record.size)).powi(3);
    assert!(one as f64 > 0.7 * exact && (one as f64) < exact, "{one} of {exact}");
    let material = scene.add_material(lambert([0.5; 3])).expect("sound");
    place(&mut scene, cube(material), DAffine3::from_translation(DVec3::splat(0.1)));
    let both = voxelise(&mut session.store(), &scene, &SOLID, 0.0);
    for place in [DVec3::splat(0.08), DVec3::ZERO, DVec3::splat(0.3)] {
        assert!(both.is_set(both.voxel_at(place)), "{place} lies within");
    }
    assert!(!both.is_set(both.voxel_at(DVec3::new(-0.7, 0.7, 0.1))));
}

/// Points on an edge that one of its two faces has, with triangles without area between them, which are not drawn: as they are rounded, rows of voxels slip through.
#[test]
fn a_row_that_slips_through_a_crack_fills_nothing_outside() {
    let session = Session::open();
    let [a, b] = [[-0.61, -0.43, -0.37], [0.53, 0.47, 0.71]];
    let [c, d] = [[0.57, -0.51, 0.11], [-0.37, 0.61, -0.23]];
    let on_edge = |index: u32| [0, 1, 2].map(|axis: usize| a[axis] + (b[axis] - a[axis]) * index as f32 / 60.0);
    let mut positions: Vec<[f32; 3]> = [[c, a, d], [c, d, b], [a, c, b]].concat();
    for index in 0..60 {
        let [from, to] = [on_edge(index), if index == 59 { b } else { on_edge(index + 1) }];
        positions.extend([d, from, to]);
        if index > 0 {
            positions.extend([from, a, to]);
        }
    }
    // Whichever way round makes the volume positive.
    let of = |turn: bool| {
        let (positions, corners) = (positions.clone(), 0..positions.len() as u32);
        let primitive = move |material| Primitive {
            positions: positions.clone(),
            indices: corners.clone().collect(),
            material,
            ..Primitive::default()
        };
        room_with(
            move |material| vec![if turn { turned_inside_out(primitive(material)) } else { primitive(material) }],
            DAffine3::IDENTITY,
        )
    };
    let scene = [false, true].map(of).into_iter().max_by_key(|scene| added(&session, scene)).expect("two");
    assert!(added(&session, &scene) > 10_000, "it is filled");
    let read = voxelise(&mut session.store(), &scene, &SOLID, 0.0);
    let [a, b, c, d] = [a, b, c, d].map(|corner| DVec3::from(corner.map(f64::from)));
    let size = f64::from(read.grid.record.size);
    let outside = |point: DVec3| {
        [[a, b, c, d], [a, b, d, c], [a, c, d, b], [b, c, d, a]].into_iter().any(|[u, v, w, other]| {
            let normal = (v - u).cross(w - u).normalize();
            (point - u).dot(normal) * (other - u).dot(normal).signum() < -1.8 * size
        })
    };
    let dims = read.dims();
    let origin = glam::Vec3::from(read.grid.record.origin_rs).as_dvec3() + read.origin;
    let wrong = read.bits.iter().enumerate().filter(|(number, set)| {
        let voxel = [number % dims[0], number / dims[0] % dims[1], number / dims[0] / dims[1]];
        let center = origin + (DVec3::from(voxel.map(|at| at as f64)) + 0.5) * size;
        **set && center.abs().max_element() < 1.0 - 2.0 * size && outside(center)
    });
    assert_eq!(wrong.count(), 0);
}
