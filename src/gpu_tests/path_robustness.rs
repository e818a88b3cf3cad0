//! Traced paths in odd scenes: nothing but finite numbers, no pass that is not needed, the same picture at any scale and place.

use glam::{DAffine3, DVec3};

use super::path_probe::{Ask, Tracer, assert_near, mean, turned};
use super::scenes::{add_light, box_faces, builtin, closed_box, lambert, place, quad, view};
use super::session::Session;
use crate::scene::{LightKind, Material, Scene};

#[test]
fn strange_materials_and_lights_stay_finite() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let ask = |eye: DVec3| Ask { bounces: Some(4), ..Ask::new([24, 24], 2, view(eye, DVec3::ZERO)) };
    let eye = DVec3::new(0.7, 0.6, 0.8);
    for roughness in [0.0, 0.01, 0.3, 1.0] {
        let metal = Material { metallic: 1.0, roughness, ..Material::default() };
        let glass = Material { transmission: 1.0, thickness: 1.0, roughness, ior: 0.0, ..Material::default() };
        for material in [metal, glass, Material { roughness, ..Material::default() }] {
            for position in [DVec3::new(0.1, 0.5, 0.0), DVec3::Y, DVec3::ONE] {
                let mut scene = closed_box(1.0, material.clone());
                add_light(&mut scene, LightKind::Point, position, DVec3::NEG_Y, [2.0; 3]);
                let id = scene.add_material(Material { emissive: [3.0; 3], double_sided: true, ..lambert([1.0; 3]) });
                let id = id.expect("sound");
                let sheet = quad([[-0.3, 0.0, -0.3], [-0.3, 0.0, 0.3], [0.3, 0.0, 0.3], [0.3, 0.0, -0.3]], id);
                place(&mut scene, vec![quad([[0.3; 3]; 4], id), sheet], DAffine3::IDENTITY);
                tracer.trace(&scene, &ask(eye)).assert_finite(&format!("{material:?}, a light at {position}"));
            }
        }
    }
    tracer.trace(&Scene::empty("nothing"), &ask(eye)).assert_finite("nothing");
}

#[test]
fn scale_and_place_do_not_matter() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let mut means = Vec::new();
    for (scale, middle) in [(1.0, DVec3::ZERO), (1e3, DVec3::ZERO), (1e-3, DVec3::ZERO), (1.0, DVec3::splat(1e5))] {
        let mut scene = Scene::empty("room");
        let wall = scene.add_material(lambert([0.5, 0.6, 0.7])).expect("sound");
        let lamp = scene.add_material(Material { emissive: [3.0; 3], ..lambert([0.5; 3]) }).expect("sound");
        let metal = Material { metallic: 1.0, roughness: 0.3, ..Material::default() };
        let metal = scene.add_material(metal).expect("sound");
        let at = DAffine3 { translation: middle, ..DAffine3::from_scale(DVec3::splat(scale)) };
        place(&mut scene, box_faces([1.0; 3], [wall, wall, metal, lamp, wall, wall]), at);
        place(&mut scene, box_faces([0.3; 3], [wall; 6]), at * turned(1.0, DVec3::new(0.0, -0.4, 0.0)));
        let mut camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
        camera.world.translation = camera.world.translation * scale + middle;
        camera.projection =
            crate::scene::Projection::Perspective { vertical_fov: 1.0, aspect: None, near: 0.01 * scale };
        let ask = Ask { bounces: Some(3), ..Ask::new([32, 32], 8, camera) };
        means.push(mean(&tracer.trace(&scene, &ask).image()));
        assert_near(&format!("scale {scale}, around {middle}"), means[means.len() - 1], means[0], 0.01);
    }
}

#[test]
fn what_a_scene_lacks_is_not_recorded() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let sky = || {
        let mut scene = closed_box(1.0, Material { metallic: 1.0, roughness: 0.1, ..Material::default() });
        scene.set_sky([1.0; 3]);
        scene
    };
    for (scene, light, particle) in
        [(builtin("cornell-point"), true, false), (sky(), false, false), (builtin("ring"), true, true)]
    {
        let camera = scene.camera_view(None).expect("a view");
        let traced = tracer.trace(&scene, &Ask { bounces: Some(2), ..Ask::new([16, 16], 1, camera) });
        traced.assert_finite(&scene.name);
        let ran = |piece: &str, pass: &str| {
            let mut rows = traced.cost.passes.iter().filter(|row| row.skipped.is_none());
            rows.any(|row| row.piece == piece && (pass.is_empty() || row.pass == pass))
        };
        assert_eq!(ran("path", "light"), light, "{}: next-event estimation", scene.name);
        assert_eq!(ran("particle", ""), particle, "{}: paths from lights", scene.name);
        assert!(ran("path", "scatter"), "{}", scene.name);
    }
}
