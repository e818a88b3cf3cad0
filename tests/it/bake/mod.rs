//! `irradia bake`: the file that it writes shows the light that it was made of.

mod command;
mod file;
mod kept;
mod materials;

use irradia::bake::{BakeError, BakeOptions, Baked, Stage, bake};
use irradia::glam::{DAffine3, DVec3};
use irradia::renderer::{
    CausticsMethod, Context, ContextOptions, DiffuseMethod, FrameRequest, Preset, Renderer, Settings, Slot, Technique,
    Validation,
};
use irradia::scene::{CameraView, Light, LightKind, LightSpec, Material, Mesh, Node, Primitive, Projection, Scene};

fn context() -> Context {
    let options = ContextOptions { validation: Validation::Synchronization, ..ContextOptions::default() };
    Context::new(&options).expect("a device")
}

/// Few and coarse texels.
fn options(count: u32) -> BakeOptions {
    let mut options = BakeOptions::default();
    (options.lightmaps.count, options.lightmaps.rays) = (count, 128);
    options
}

fn baked(context: &Context, scene: &Scene, options: &BakeOptions) -> (Baked, Scene) {
    let mut stages = 0;
    let baked = bake(context, scene, options, |_| stages += 1).expect("it has light");
    assert_eq!((stages, context.validation_messages()), (3, Vec::<String>::new()));
    let loaded = Scene::from_bytes("baked", &baked.glb, None).expect("a scene");
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    (baked, loaded)
}

/// The sum of some slots.
fn picture(context: &Context, scene: &Scene, settings: Settings, camera: CameraView, slots: &[Slot]) -> Vec<[f32; 3]> {
    let request = FrameRequest::new([96, 72], camera).with(|request| {
        (request.slots, request.image) = (slots.to_vec(), false);
    });
    let frame = Renderer::new(context, settings).expect("a renderer").render(scene, &request).expect("a frame");
    let mut sum = vec![[0.0; 3]; 96 * 72];
    for slot in frame.slots.values() {
        for (sum, pixel) in sum.iter_mut().zip(&slot.pixels) {
            *sum = [0, 1, 2].map(|channel| sum[channel] + pixel[channel]);
        }
    }
    sum
}

/// What the baked scene shows through its first camera, or through another one.
fn shown(context: &Context, scene: &Scene, camera: Option<&CameraView>) -> Vec<[f32; 3]> {
    let camera = camera.cloned().unwrap_or_else(|| scene.camera_view(None).expect("a camera"));
    picture(context, scene, Settings::new(Technique::Direct, Preset::Default), camera, &[Slot::Emission])
}

/// The ratio of means, and the root of the mean square error over the mean of the second.
fn compared(found: &[[f32; 3]], expected: &[[f32; 3]]) -> [f64; 2] {
    let values = || found.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    let count = values().count() as f64;
    let mean = values().map(|(_, b)| b).sum::<f64>() / count;
    let error = (values().map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / count).sqrt();
    [values().map(|(a, _)| a).sum::<f64>() / count / mean, error / mean]
}

fn view(eye: DVec3, target: DVec3) -> CameraView {
    let projection = Projection::Perspective { vertical_fov: 1.0, aspect: None, near: 0.01 };
    let up = if (target - eye).cross(DVec3::Y).length() < 1e-6 { DVec3::NEG_Z } else { DVec3::Y };
    CameraView::look_at(eye, target, up, projection)
}

/// Diffuse alone.
fn lambert(albedo: [f32; 3]) -> Material {
    let [red, green, blue] = albedo;
    Material { base_color: [red, green, blue, 1.0], specular: 0.0, ..Material::default() }
}

/// Adds a square in a plane y = `height`, seen from above as front, with texture coordinates.
fn add_square(scene: &mut Scene, [half, height]: [f32; 2], material: Material) {
    let material = scene.add_material(material).expect("sound");
    let positions = vec![[-half, height, -half], [-half, height, half], [half, height, half], [half, height, -half]];
    let texcoords = [Some(vec![[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]), None];
    let indices = vec![0, 1, 2, 0, 2, 3];
    let primitives = vec![Primitive { positions, texcoords, indices, material, ..Primitive::default() }];
    let mesh = scene.add_mesh(Mesh { name: "square".to_owned(), primitives }).expect("sound");
    scene.add_node(Node { mesh: Some(mesh), ..Node::default() }).expect("sound");
}

fn add_point_light(scene: &mut Scene, position: DVec3, intensity: f32) {
    let light = Light { name: String::new(), kind: LightKind::Point, intensity: [intensity; 3], range: None };
    scene.add_light_spec(&LightSpec { light, position, direction: DVec3::NEG_Y }).expect("sound");
}

/// The settled light of the methods, from the scene's camera, in a scene that is lit through a door too.
#[test]
fn the_picture_is_that_of_the_settled_maps() {
    let context = context();
    for (name, most) in [("cornell-point", 0.05), ("two-rooms", 0.08)] {
        let scene = Scene::open(name).expect("a built-in scene");
        let options = options(8000);
        let (_, loaded) = baked(&context, &scene, &options);
        let mut settings = Settings::new(Technique::Direct, Preset::Default);
        settings.set("lightmaps.settle", "true").expect("the same as always");
        settings.methods.diffuse = DiffuseMethod::Lightmaps;
        settings.methods.caustics = CausticsMethod::Points;
        settings.lightmaps = options.lightmaps;
        let camera = scene.camera_view(None).expect("its camera");
        let slots = [Slot::Emission, Slot::Direct, Slot::Diffuse, Slot::Caustics];
        let expected = picture(&context, &scene, settings, camera.clone(), &slots);
        let [ratio, error] = compared(&shown(&context, &loaded, None), &expected);
        println!("{name}: mean {ratio:.4}, rrmse {error:.4}");
        assert!((ratio - 1.0).abs() < 0.02 && error < most, "{name}: {ratio} {error}");

        let found = loaded.camera_views();
        assert_eq!(found.len(), scene.camera_views().len().max(1));
        let same = |a: &DAffine3, b: &DAffine3| a.abs_diff_eq(*b, 1e-9);
        assert!(same(&found[0].world, &camera.world) && found[0].projection == camera.projection, "{:?}", found[0]);
    }
}

/// In a closed box of albedo ρ that emits L_e everywhere, L = L_e/(1 − ρ), and E = π·L: π·L_e of it from what emits. ρ = 1/2, L_e = 1.
#[test]
fn a_furnace_has_its_closed_form() {
    let context = context();
    let scene = Scene::open("furnace").expect("a built-in scene");
    let (baked, loaded) = baked(&context, &scene, &options(2000));
    let pi = std::f32::consts::PI;
    let close = |values: &[[f32; 3]], expected: f32, within: f32| {
        let lit: Vec<f32> = values.iter().flatten().copied().filter(|value| *value > 0.0).collect();
        let mean = lit.iter().sum::<f32>() / lit.len() as f32;
        let farthest = lit.iter().map(|value| (value / expected - 1.0).abs()).fold(0.0, f32::max);
        println!("{mean} in place of {expected}, farthest {farthest:.3}");
        assert!((mean / expected - 1.0).abs() < 0.01 && farthest < within, "{mean} {expected} {farthest}");
    };
    close(&baked.parts[&Slot::Direct].pixels, pi, 0.15);
    close(&baked.parts[&Slot::Diffuse].pixels, pi, 0.06);
    close(&baked.irradiance.pixels, 2.0 * pi, 0.1);
    assert!(baked.parts[&Slot::Caustics].pixels.iter().flatten().all(|&value| value == 0.0), "nothing is specular");
    close(&shown(&context, &loaded, None), 2.0, 0.06);
}

/// A sheet has other light on its front than on its back, and both come from where they should.
#[test]
fn both_sides_of_a_sheet_have_their_own_light() {
    let context = context();
    let mut scene = Scene::empty("sheet");
    add_square(&mut scene, [1.0, 0.0], Material { double_sided: true, ..lambert([0.5; 3]) });
    add_point_light(&mut scene, DVec3::new(0.0, 2.0, 0.0), 8.0);
    add_point_light(&mut scene, DVec3::new(0.0, -2.0, 0.0), 1.0);
    let (_, loaded) = baked(&context, &scene, &options(2000));
    assert_eq!(loaded.facts().triangles, 2 * scene.facts().triangles);
    for (side, intensity) in [(1.0, 8.0), (-1.0, 1.0)] {
        let camera = view(DVec3::new(0.0, 0.4 * side, 0.0), DVec3::ZERO);
        let found = shown(&context, &loaded, Some(&camera));
        let middle = found[36 * 96 + 48][0];
        let expected = 0.5 / std::f32::consts::PI * intensity / 4.0;
        println!("{middle} in place of {expected}");
        assert!((middle / expected - 1.0).abs() < 0.02, "{middle} {expected}");
        assert!(found.iter().all(|pixel| pixel[0] > 0.5 * expected && pixel[0] < 1.1 * expected), "no stripes");
    }
}

/// The mean albedo of a texture whose texels are finer than those of the map.
#[test]
fn fine_textures_keep_their_mean() {
    let context = context();
    let mut scene = Scene::empty("checkers");
    let texture = materials::checkers(&mut scene, 64);
    add_square(&mut scene, [1.0, 0.0], Material { base_color_texture: Some(texture), ..lambert([0.8; 3]) });
    add_point_light(&mut scene, DVec3::new(0.0, 2.0, 0.0), 8.0);
    let (_, loaded) = baked(&context, &scene, &options(600));
    let camera = view(DVec3::new(0.0, 0.4, 0.0), DVec3::ZERO);
    let found = shown(&context, &loaded, Some(&camera));
    let mean = found.iter().map(|pixel| pixel[0]).sum::<f32>() / found.len() as f32;
    // Half of the texels are black.
    let expected = 0.4 / std::f32::consts::PI * 8.0 / 4.0;
    println!("{mean} in place of {expected}");
    assert!((mean / expected - 1.0).abs() < 0.03, "{mean} {expected}");
}

/// The image's size is known before any light is.
#[test]
fn what_is_too_long_is_said_before_the_work() {
    let context = context();
    let mut scene = Scene::empty("strip");
    add_square(&mut scene, [1.0, 0.0], lambert([0.5; 3]));
    let long = DAffine3::from_scale(DVec3::new(100.0, 1.0, 1e-3));
    scene.set_local_transform(irradia::scene::NodeId(0), long).expect("sound");
    add_point_light(&mut scene, DVec3::new(0.0, 2.0, 0.0), 8.0);
    let mut options = options(100);
    (options.lightmaps.texel, options.detail) = (0.015, 2);
    let mut stages = Vec::new();
    let error = bake(&context, &scene, &options, |stage| stages.push(stage)).expect_err("26,000 texels in a row");
    assert!(matches!(error, BakeError::TooLarge { .. }) && stages == [Stage::Light], "{error} {stages:?}");
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let context = context();
    let scene = Scene::open("ring").expect("a built-in scene");
    let [first, again] = [0, 1].map(|_| baked(&context, &scene, &options(500)).0);
    assert!(first.glb == again.glb && first.irradiance == again.irradiance && first.parts == again.parts);
    assert!(first.parts[&Slot::Caustics].pixels.iter().flatten().any(|&value| value > 0.0), "the ring's");
}
