//! Every lobe in a white furnace: nothing reflects more than it gets, what absorbs nothing shows the furnace's own radiance, and
//! the ways of finding light agree.

use glam::{DAffine3, DVec3};

use super::path_probe::{Ask, Traced, Tracer, assert_near, mean, sphere};
use super::scenes::{box_faces, lambert, place, view};
use super::session::Session;
use crate::renderer::Slot;
use crate::scene::{CameraView, Material, Projection, Scene};

const SIZE: [u32; 2] = [64, 64];

/// What surrounds the object, at a radiance of 1.
#[derive(Clone, Copy, PartialEq)]
enum Furnace {
    /// Found by paths that leave the scene.
    Sky,
    /// Found by paths that run into it, by next-event estimation, and by paths of its own.
    Walls,
}

fn furnace(kind: Furnace, material: &Material, smooth: bool) -> Scene {
    let mut scene = Scene::empty("furnace");
    let id = scene.add_material(material.clone()).expect("a sound material");
    place(&mut scene, vec![sphere(8, smooth, id)], DAffine3::IDENTITY);
    match kind {
        Furnace::Sky => scene.set_sky([1.0; 3]),
        Furnace::Walls => {
            let wall = Material { emissive: [1.0; 3], ..lambert([0.0; 3]) };
            let wall = scene.add_material(wall).expect("a sound material");
            place(&mut scene, box_faces([6.0; 3], [wall; 6]), DAffine3::IDENTITY);
        }
    }
    scene
}

fn trace(tracer: &mut Tracer, scene: &Scene, samples: u32) -> Traced {
    let camera = view(DVec3::new(1.6, 1.2, 1.9), DVec3::ZERO);
    tracer.trace(scene, &Ask::new(SIZE, samples, camera))
}

/// Standard error of the image's mean.
fn noise(traced: &Traced) -> f64 {
    Slot::ALL.map(|slot| traced.error(slot).powi(2)).iter().sum::<f64>().sqrt()
}

fn metal(color: f32, roughness: f32) -> Material {
    Material { metallic: 1.0, roughness, ..lambert([color; 3]) }
}

fn glass(thickness: f32, roughness: f32) -> Material {
    Material { transmission: 1.0, roughness, thickness, ..Material::default() }
}

#[test]
fn what_absorbs_nothing_is_not_seen() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let materials = [
        ("white paper", lambert([1.0; 3])),
        ("a mirror", metal(1.0, 0.0)),
        ("smooth solid glass", glass(1.0, 0.0)),
        ("smooth thin glass", glass(0.0, 0.0)),
    ];
    for (what, material) in materials {
        for kind in [Furnace::Sky, Furnace::Walls] {
            let traced = trace(&mut tracer, &furnace(kind, &material, false), 4);
            let image = traced.image();
            let worst = image.iter().map(|pixel| (*pixel - 1.0).abs().max_element()).fold(0.0, f64::max);
            let off = (mean(&image).x - 1.0).abs();
            println!("{what}: mean {off:.1e} ± {:.1e} off, worst pixel {worst:.1e}", noise(&traced));
            assert!(off < (4.0 * noise(&traced)).max(1e-3), "{what}: the mean is {off} off");
            // No path that leaves the scene knows a weight; the walls of glass draw reflection by a share that grazing facets differ from.
            assert!(
                kind == Furnace::Walls || worst < 0.01 || material.transmission > 0.0,
                "{what}: a pixel is {worst} off"
            );
        }
    }
}

#[test]
fn no_lobe_makes_light() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let mut materials: Vec<(String, Material)> = Vec::new();
    for roughness in [0.0, 0.45, 1.0] {
        materials.push((format!("metal of roughness {roughness}"), metal(1.0, roughness)));
        materials.push((format!("plastic of roughness {roughness}"), Material { roughness, ..Material::default() }));
        materials.push((format!("thin glass of roughness {roughness}"), glass(0.0, roughness)));
        materials.push((format!("solid glass of roughness {roughness}"), glass(1.0, roughness)));
    }
    let half = Material { transmission: 0.5, metallic: 0.3, roughness: 0.5, ..Material::default() };
    materials.push(("a bit of everything".to_owned(), half));
    for (what, material) in &materials {
        let max_diffuse = (1.0 - material.metallic) * (1.0 - material.transmission);
        for smooth in [false, true] {
            let [sky, walls] =
                [Furnace::Sky, Furnace::Walls].map(|kind| trace(&mut tracer, &furnace(kind, material, smooth), 4));
            let image = sky.image();
            let most = image.iter().map(|pixel| pixel.max_element()).fold(0.0, f64::max);
            let [a, b] = [&sky, &walls].map(|traced| mean(&traced.image()).x);
            let noise = noise(&sky).hypot(noise(&walls));
            let faces = if smooth { "smooth" } else { "flat" };
            println!("{what}, {faces}: sky {a:.4}, walls {b:.4} ± {noise:.1e}, brightest pixel {most:.3}");
            // The diffuse lobe under a specular one is Schlick's by the half vector, which at grazing angles adds up to more than 1.
            assert!(a < 1.001 || max_diffuse > 0.0, "{what}, {faces}: {a} comes out of 1");
            assert!((a - b).abs() < (4.0 * noise).max(0.002), "{what}, {faces}: {a} by the sky, {b} by the walls");
        }
    }
}

/// ∫ of the diffuse lobe and of a mirror's, at a view of this cosine: F(v·n) + ∫ albedo·(1 − F(v·h))·cosθ/π dω.
fn plastic_reflectance(albedo: f64, cosine: f64) -> f64 {
    let fresnel = |cosine: f64| 0.04 + 0.96 * (1.0 - cosine).powi(5);
    let viewer = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let steps = 400;
    let mut below = 0.0;
    for i in 0..steps {
        for j in 0..steps {
            let [u, v] = [i, j].map(|step| (f64::from(step) + 0.5) / f64::from(steps));
            let (sine, azimuth) = (u.sqrt(), std::f64::consts::TAU * v);
            let light = DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), (1.0 - u).sqrt());
            below += 1.0 - fresnel(viewer.dot((viewer + light).normalize()));
        }
    }
    fresnel(cosine) + albedo * below / f64::from(steps * steps)
}

#[test]
fn plastic_reflects_what_its_lobes_integrate_to() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let material = Material { base_color: [0.5, 0.5, 0.5, 1.0], roughness: 0.0, ..Material::default() };
    let mut scene = super::scenes::floor(1.0, material);
    scene.set_sky([1.0; 3]);
    for degrees in [0.0_f64, 45.0, 75.0] {
        let angle = degrees.to_radians();
        let projection = Projection::Orthographic { half_width: 0.2, half_height: 0.2, near: 0.0, far: 10.0 };
        let camera = CameraView::look_at(DVec3::new(angle.sin(), angle.cos(), 0.0), DVec3::ZERO, DVec3::Z, projection);
        let traced = tracer.trace(&scene, &Ask::new([32, 32], 128, camera));
        let expected = DVec3::splat(plastic_reflectance(0.5, angle.cos()));
        assert_near(&format!("plastic seen at {degrees}°"), traced.mean(Slot::Direct), expected, 0.003);
    }
}
