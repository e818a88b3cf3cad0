//! Voxels against a second form of the test that decides them, on the host; cones against rays and closed forms.

mod changes;
mod cones;
mod read;
mod reference;
mod shared;
mod solid;
mod surfaces;

use glam::DVec3;

use self::read::{Read, voxelise};
use crate::gpu_tests::scenes::{lambert, place};
use crate::gpu_tests::session::Session;
use crate::scene::{MaterialId, Primitive, Scene};

/// Whether the device can draw voxels.
fn draws(session: &Session) -> bool {
    let device = session.context.shared_device();
    device.offer().geometry_shaders && device.traits().draws
}

/// A scene of these triangles.
fn soup(positions: Vec<[f32; 3]>) -> Scene {
    let mut scene = Scene::empty("soup");
    let material = scene.add_material(lambert([0.5; 3])).expect("sound");
    let indices = (0..positions.len() as u32).collect();
    place(
        &mut scene,
        vec![Primitive { positions, indices, material, ..Primitive::default() }],
        glam::DAffine3::IDENTITY,
    );
    scene
}

/// A sphere of triangles, its front outside.
fn ball(radius: f32, columns: u32, material: MaterialId) -> Primitive {
    let rows = columns / 2;
    let point = |row: u32, column: u32| {
        let (polar, around) = (
            std::f64::consts::PI * f64::from(row) / f64::from(rows),
            std::f64::consts::TAU * f64::from(column % columns) / f64::from(columns),
        );
        // Both poles are one point each.
        let sine = if row == 0 || row == rows { 0.0 } else { polar.sin() };
        (DVec3::new(sine * around.cos(), polar.cos(), sine * around.sin()) * f64::from(radius)).as_vec3().to_array()
    };
    let mut positions = Vec::new();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let [a, b] = [point(row, column), point(row, column + 1)];
        let [c, d] = [point(row + 1, column), point(row + 1, column + 1)];
        positions.extend([a, b, d, a, d, c]);
    }
    let indices = (0..positions.len() as u32).collect();
    Primitive { positions, indices, material, ..Primitive::default() }
}
