//! Where the picture reads the particles' light, and how many links each reads itself.

use glam::{DAffine3, DVec3};

use super::super::options::{ParticlesOptions, ParticlesReceivers};
use super::{against_paths, count, options, settings};
use crate::gpu_tests::scenes::{add_light, builtin, closed_box, floor, lambert, place, quad, request, view};
use crate::gpu_tests::session::Session;
use crate::renderer::{Frame, FrameRequest, Slot, Timing};
use crate::scene::{LightKind, Material, Primitive, Scene, Texture, TextureRef, Wrap};

pub(super) const SIZE: [u32; 2] = [160, 128];
/// Of blocks, pixels.
const BLOCK: usize = 8;

pub(super) fn frame(session: &Session, options: ParticlesOptions) -> Frame {
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera, &[Slot::Diffuse]) };
    session.render(&scene, &settings(options), &asked)
}

/// The ratio of the means, and the error of pixels and of blocks over the mean.
pub(super) fn difference(found: &Frame, expected: &Frame) -> [f64; 3] {
    let green = |frame: &Frame| frame.slots[&Slot::Diffuse].pixels.iter().map(|pixel| f64::from(pixel[1])).collect();
    let [found, expected]: [Vec<f64>; 2] = [found, expected].map(green);
    let blocks = |pixels: &[f64]| -> Vec<f64> {
        let width = SIZE[0] as usize;
        let columns = width / BLOCK;
        let mut sums = vec![0.0; columns * (SIZE[1] as usize / BLOCK)];
        for (index, value) in pixels.iter().enumerate() {
            sums[index / width / BLOCK * columns + index % width / BLOCK] += value / (BLOCK * BLOCK) as f64;
        }
        sums
    };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let error = |a: &[f64], b: &[f64]| {
        let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
        (squares / a.len() as f64).sqrt() / mean(b)
    };
    [mean(&found) / mean(&expected), error(&found, &expected), error(&blocks(&found), &blocks(&expected))]
}

#[test]
fn regions_show_what_every_pixel_would() {
    let session = Session::open();
    let all = frame(&session, ParticlesOptions { receivers: ParticlesReceivers::Pixels, ..options(4000, 3) });
    let regions = frame(&session, options(4000, 3));
    let [mean, pixels, blocks] = difference(&regions, &all);
    assert!((mean - 1.0).abs() < 3e-3 && pixels < 0.03 && blocks < 0.012, "{mean}, pixels {pixels}, blocks {blocks}");
    let count = count(&regions.timings.passes, "diffuse/particles/find/homes", "regions");
    assert!((500..6000).contains(&count), "{count} regions of {} pixels", SIZE[0] * SIZE[1]);
}

#[test]
fn a_quarter_of_the_links_each_has_all_of_the_light() {
    let session = Session::open();
    let many = ParticlesOptions { gather: 16, ..options(4000, 3) };
    let whole = frame(&session, many.clone());
    let quarters = frame(&session, ParticlesOptions { interleave: 4, ..many.clone() });
    let [mean, _, blocks] = difference(&quarters, &whole);
    assert!((mean - 1.0).abs() < 5e-3, "{mean}");
    assert!((1e-3..0.04).contains(&blocks), "blocks {blocks}");
}

/// A room whose floor's normals are all turned by 30° towards -x or +x, where a lamp brightens the one wall.
pub(super) fn turned_floor(towards: f32) -> Scene {
    let mut scene = closed_box(1.0, lambert([0.5; 3]));
    let component = |value: f32| (127.5 + 127.5 * value).round() as u8;
    let (along, up) = (component(towards * 0.5), component(0.75_f32.sqrt()));
    let texture = Texture {
        name: String::new(),
        width: 1,
        height: 1,
        rgba8: vec![along, component(0.0), up, 255],
        wrap: [Wrap::Repeat; 2],
        nearest: true,
        srgb: false,
    };
    let normal_texture = Some(TextureRef::new(scene.add_texture(texture).expect("a sound texture")));
    let material = Material { normal_texture, ..lambert([0.5; 3]) };
    let material = scene.add_material(material).expect("a sound material");
    let corners = [[-1.0, -0.9, -1.0], [-1.0, -0.9, 1.0], [1.0, -0.9, 1.0], [1.0, -0.9, -1.0]];
    let floor = Primitive {
        normals: Some(vec![[0.0, 1.0, 0.0]; 4]),
        tangents: Some(vec![[1.0, 0.0, 0.0, 1.0]; 4]),
        texcoords: [Some(vec![[0.5, 0.5]; 4]), None],
        ..quad(corners, material)
    };
    place(&mut scene, vec![floor], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(-0.7, 0.3, 0.1), DVec3::NEG_Y, [1.0; 3]);
    scene
}

/// What a normal map turns to the light wall receives more than what it turns away, as paths have it.
#[test]
fn normal_maps_turn_what_is_received() {
    let session = Session::open();
    for towards in [-1.0, 1.0] {
        let camera = view(DVec3::new(0.1, 0.6, 0.0), DVec3::new(0.0, -0.9, 0.0));
        let (ratio, error) = against_paths(&session, &turned_floor(towards), camera, options(4000, 0));
        println!("{towards}: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.06 && error < 0.1, "{towards}: {ratio} {error}");
    }
}

/// A floor along which one looks: its pixels are rows of metres and not squares, which no region of several stands for.
#[test]
fn regions_are_small_where_one_looks_along_a_surface() {
    let session = Session::open();
    let mut scene = floor(20.0, lambert([0.5; 3]));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 2.0, 0.0), DVec3::NEG_Y, [1.0; 3]);
    let camera = view(DVec3::new(0.0, 0.2, 18.0), DVec3::new(0.0, 0.2, 0.0));
    let asked = FrameRequest { timing: Timing::Passes, ..request([128, 96], camera, &[Slot::Diffuse]) };
    let frame = session.render(&scene, &settings(options(1000, 0)), &asked);
    // Depth changes by 1/y of itself from row to row, y rows below the horizon: by less than 4 % in a square of two rows from the 25th of 48 on.
    let regions = count(&frame.timings.passes, "diffuse/particles/find/homes", "regions");
    assert!((3000..4500).contains(&regions), "{regions} regions");
}
