//! Reflections and refractions by rays: against closed forms and paths, which slot shows what, and what is not done.

use std::f64::consts::FRAC_1_PI;

use glam::{DAffine3, DVec3};

use super::blocks::{assert_close, mean};
use super::path_probe::{Ask, Tracer};
use super::scenes::{add_light, box_faces, builtin, closed_box, floor, lambert, place, quad, request, view};
use super::session::Session;
use crate::renderer::{
    DiffuseMethod, DirectMethod, Frame, FrameRequest, Preset, Settings, Slot, SpecularMethod, Technique, Timing,
};
use crate::scene::{CameraView, Light, LightId, LightKind, Material, Scene};
use crate::slot::{CausticPaths, LightPaths, PixelFilter};

const SIZE: [u32; 2] = [64, 48];

/// The technique with reflections followed, of many samples.
fn traced(technique: Technique) -> Settings {
    let mut settings = Settings::new(technique, Preset::Default);
    settings.methods.direct = DirectMethod::Traced;
    settings.methods.specular = SpecularMethod::Trace;
    (settings.traced.samples, settings.trace.samples, settings.trace.light_samples) = (16, 64, 16);
    settings.particles.count = 4000;
    settings
}

fn pixels(frame: &Frame, slot: Slot) -> Vec<DVec3> {
    frame.slots[&slot].pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).collect()
}

fn slots(session: &Session, scene: &Scene, settings: &Settings, camera: &CameraView) -> Frame {
    let asked = request(SIZE, camera.clone(), &[Slot::Direct, Slot::Specular]);
    session.render(scene, settings, &FrameRequest { image: false, ..asked })
}

fn mirror() -> Material {
    Material { metallic: 1.0, roughness: 0.0, ..Material::default() }
}

fn glass() -> Material {
    Material { transmission: 1.0, roughness: 0.0, thickness: 1.0, ..Material::default() }
}

/// A floor of this material, and a wall at z = -2 that faces it.
fn floor_and_wall(ground: Material, wall: Material) -> Scene {
    let mut scene = floor(20.0, ground);
    let wall = scene.add_material(wall).expect("sound");
    let corners = [[-9.0, 0.0, -2.0], [9.0, 0.0, -2.0], [9.0, 9.0, -2.0], [-9.0, 9.0, -2.0]];
    place(&mut scene, vec![quad(corners, wall)], DAffine3::IDENTITY);
    scene
}

/// At the wall, so that reflections go down to the floor.
fn at_the_wall() -> CameraView {
    view(DVec3::new(0.0, 6.0, 2.0), DVec3::new(0.0, 3.5, -2.0))
}

#[test]
fn a_mirror_shows_a_lit_floor() {
    let session = Session::open();
    let albedo = 0.6;
    let mut scene = floor_and_wall(lambert([albedo; 3]), mirror());
    let to_light = DVec3::new(0.3, 1.0, 0.5).normalize();
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, -to_light, [4.0, 2.0, 1.0]);
    let mut camera = at_the_wall();
    camera.projection = crate::scene::Projection::Perspective { vertical_fov: 0.5, aspect: None, near: 0.01 };
    let frame = slots(&session, &scene, &traced(Technique::Direct), &camera);
    let expected = DVec3::new(4.0, 2.0, 1.0) * (f64::from(albedo) * FRAC_1_PI * to_light.y);
    for pixel in pixels(&frame, Slot::Specular) {
        assert!((pixel / expected - 1.0).abs().max_element() < 2e-3, "{pixel} of {expected}");
    }
}

/// A dark floor with a mirror, rough metal, plastic and glass on it. By a point light nothing is smooth: its reflections of reflections are spikes that no few
/// paths find.
fn gallery(lamp: bool, sky: bool) -> Scene {
    let mut scene = floor(6.0, lambert([0.03; 3]));
    let things = [
        mirror(),
        Material { base_color: [0.9, 0.5, 0.2, 1.0], roughness: 0.45, ..mirror() },
        Material { roughness: 0.2, ..Material { specular: 1.0, ..lambert([0.02, 0.03, 0.05]) } },
        glass(),
        Material { thickness: 0.0, base_color: [0.9, 0.6, 0.3, 1.0], ..glass() },
    ];
    for (index, mut thing) in things.into_iter().enumerate() {
        if !lamp && !sky {
            thing.roughness = thing.roughness.max(0.5);
            if thing.transmission > 0.0 {
                thing = Material { roughness: 0.5, specular: 1.0, ..lambert([0.02; 3]) };
            }
        }
        let id = scene.add_material(thing).expect("sound");
        let mut faces = box_faces([0.4, 0.6, 0.4], [id; 6]);
        // Seen from outside.
        faces.iter_mut().for_each(|face| face.indices = vec![0, 2, 1, 0, 3, 2]);
        let at = DVec3::new(1.1 * index as f64 - 2.2, 0.61, -0.4 * (index % 2) as f64);
        place(&mut scene, faces, DAffine3::from_rotation_translation(glam::DQuat::from_rotation_y(0.5), at));
    }
    if lamp {
        let id = scene.add_material(Material { emissive: [6.0, 5.0, 4.0], ..lambert([0.0; 3]) }).expect("sound");
        let corners = [[-6.0, 1.0, -2.5], [6.0, 1.0, -2.5], [6.0, 6.0, -1.5], [-6.0, 6.0, -1.5]];
        place(&mut scene, vec![quad(corners, id)], DAffine3::IDENTITY);
    } else {
        add_light(&mut scene, LightKind::Point, DVec3::new(1.0, 3.0, 3.0), DVec3::NEG_Y, [20.0; 3]);
    }
    if sky {
        scene.set_sky([0.4, 0.5, 0.7]);
    }
    scene
}

/// The two slots by paths of the light that rays can find.
fn by_paths(session: &Session, scene: &Scene, camera: &CameraView, samples: u32) -> [Vec<DVec3>; 2] {
    let ask = Ask {
        caustics: CausticPaths::Unmirrored,
        filter: PixelFilter::Center,
        ..Ask::new(SIZE, samples, camera.clone())
    };
    let traced = Tracer::new(session).trace(scene, &ask);
    [Slot::Direct, Slot::Specular].map(|slot| traced.slot(slot))
}

#[test]
fn mirrors_metal_plastic_and_glass_are_those_of_paths() {
    let session = Session::open();
    let camera = view(DVec3::new(0.3, 1.4, 3.2), DVec3::new(0.0, 0.6, 0.0));
    // Paths find the highlights of a point light in each other's reflections badly.
    for (what, lamp, sky, most) in
        [("a point light", false, false, 0.04), ("a lamp", true, false, 0.03), ("a sky", false, true, 0.03)]
    {
        let scene = gallery(lamp, sky);
        let frame = slots(&session, &scene, &traced(Technique::Direct), &camera);
        let [direct, specular] = by_paths(&session, &scene, &camera, 64);
        assert_close(&format!("direct by {what}"), &pixels(&frame, Slot::Direct), &direct, 0.03, 0.1);
        assert_close(&format!("specular by {what}"), &pixels(&frame, Slot::Specular), &specular, most, 0.08);
    }
}

/// A mirror and a rough metal wall face each other in a grey room.
fn facing_mirrors() -> (Scene, CameraView) {
    let mut scene = Scene::empty("facing mirrors");
    let grey = scene.add_material(lambert([0.6; 3])).expect("sound");
    let mirror =
        scene.add_material(Material { base_color: [0.9, 0.8, 0.7, 1.0], roughness: 0.15, ..mirror() }).expect("sound");
    let rough = Material { base_color: [0.9, 0.8, 0.7, 1.0], metallic: 1.0, roughness: 0.4, ..Material::default() };
    let rough = scene.add_material(rough).expect("sound");
    place(&mut scene, box_faces([1.0; 3], [mirror, rough, grey, grey, grey, grey]), DAffine3::IDENTITY);
    // Paths do not find a point's light by way of mirrors behind other surfaces.
    let lamp = scene.add_material(Material { emissive: [5.0; 3], ..lambert([0.0; 3]) }).expect("sound");
    let corners = [[-0.4, 0.9, -0.4], [0.4, 0.9, -0.4], [0.4, 0.9, 0.4], [-0.4, 0.9, 0.4]];
    place(&mut scene, vec![quad(corners, lamp)], DAffine3::IDENTITY);
    (scene, view(DVec3::new(0.4, 0.1, 0.9), DVec3::new(-1.0, -0.2, -0.3)))
}

/// As many reflections as there are to be, of as many bounces as the method of the slot `diffuse` makes.
#[test]
fn mirrors_show_what_the_references_limits_say() {
    let session = Session::open();
    let (scene, camera) = facing_mirrors();
    for (depth, bounces) in [(1, Some(0)), (2, Some(1)), (8, Some(1)), (3, None)] {
        let mut settings = traced(Technique::Particles);
        settings.trace.depth = depth;
        settings.particles.bounces = bounces;
        let LightPaths { bounces: limit, caustics, mirrors } = settings.light_paths(Slot::Specular);
        let ask = Ask {
            bounces: limit,
            caustics,
            mirrors,
            filter: PixelFilter::Center,
            ..Ask::new(SIZE, 96, camera.clone())
        };
        let truth = Tracer::new(&session).trace(&scene, &ask).slot(Slot::Specular);
        let frame = slots(&session, &scene, &settings, &camera);
        assert_close(
            &format!("depth {depth}, {bounces:?} steps"),
            &pixels(&frame, Slot::Specular),
            &truth,
            0.015,
            0.04,
        );
    }
}

/// A room with a mirror in it so small that it lights nothing, and a view of it.
fn mirrored_box() -> (Scene, CameraView) {
    let mut scene = closed_box(1.5, lambert([0.4, 0.3, 0.2]));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.7, 0.8, -0.4), DVec3::NEG_Y, [3.0; 3]);
    let mirror = scene.add_material(Material { roughness: 0.1, ..mirror() }).expect("sound");
    let corners = [[-0.1, -0.1, 0.0], [0.1, -0.1, 0.05], [0.1, 0.1, 0.05], [-0.1, 0.1, 0.0]];
    place(&mut scene, vec![quad(corners, mirror)], DAffine3::IDENTITY);
    (scene, view(DVec3::new(0.05, 0.0, 0.2), DVec3::ZERO))
}

#[test]
fn mirrors_show_the_diffuse_light_that_methods_offer() {
    let session = Session::open();
    let (scene, camera) = mirrored_box();
    let [_, specular] = by_paths(&session, &scene, &camera, 64);
    let particles = slots(&session, &scene, &traced(Technique::Particles), &camera);
    assert_close("particles", &pixels(&particles, Slot::Specular), &specular, 0.02, 0.05);
    let mut hybrid = traced(Technique::Hybrid);
    (hybrid.vpl.count, hybrid.vpl.bounces) = (192, 5);
    hybrid.vpl.visibility = crate::diffuse::vpl::options::VplVisibility::Traced;
    let vpl = slots(&session, &scene, &hybrid, &camera);
    assert_close("vpl", &pixels(&vpl, Slot::Specular), &specular, 0.05, 0.08);
    let mut caches = traced(Technique::Volumes);
    caches.volumes.bounces = 16;
    let volumes = slots(&session, &scene, &caches, &camera);
    assert_close("volumes", &pixels(&volumes, Slot::Specular), &specular, 0.04, 0.08);
    let mut gathered = traced(Technique::Direct);
    gathered.methods.diffuse = DiffuseMethod::FinalGather;
    (gathered.final_gather.rays, gathered.final_gather.photons) = (64, 50_000);
    let frame = slots(&session, &scene, &gathered, &camera);
    assert_close("final-gather", &pixels(&frame, Slot::Specular), &specular, 0.02, 0.05);
    assert!(traced(Technique::Particles).reduced().is_empty() && hybrid.reduced().is_empty());
    let direct = traced(Technique::Direct);
    assert!(direct.reduced()[0].contains("final-gather, lightmaps, particles, volumes, vpl"), "{:?}", direct.reduced());
    let alone = slots(&session, &scene, &direct, &camera);
    let share = mean(&pixels(&alone, Slot::Specular)) / mean(&specular);
    assert!(share.max_element() < 0.9, "direct light alone: {share}");
}

#[test]
fn no_technique_leaves_mirrors_black() {
    let session = Session::open();
    let (scene, camera) = mirrored_box();
    for technique in [Technique::Direct, Technique::Rsm, Technique::Hybrid, Technique::Particles] {
        let mut settings = Settings::new(technique, Preset::Draft);
        settings.methods.specular = SpecularMethod::Trace;
        settings.particles.count = 1000;
        let found = mean(&pixels(&slots(&session, &scene, &settings, &camera), Slot::Specular));
        assert!(found.min_element() > 0.0, "{}: {found}", technique.name());
    }
}

/// Lamps are in one of the two slots, whatever finds direct light.
#[test]
fn mirrors_show_lamps_once() {
    let session = Session::open();
    let glowing = Material { emissive: [3.0, 2.0, 1.0], ..lambert([0.0; 3]) };
    let scene = floor_and_wall(glowing, mirror());
    let camera = at_the_wall();
    let of = |direct| {
        let mut settings = traced(Technique::Direct);
        settings.methods.direct = direct;
        let frame = slots(&session, &scene, &settings, &camera);
        [Slot::Direct, Slot::Specular].map(|slot| mean(&pixels(&frame, slot)))
    };
    let ([direct, nothing], [black, specular]) = (of(DirectMethod::Traced), of(DirectMethod::ShadowMap));
    assert_eq!(nothing, DVec3::ZERO);
    assert!(black.max_element() < 1e-3, "{black}");
    assert!((specular / direct - 1.0).abs().max_element() < 0.01, "{specular} of {direct}");
}

#[test]
fn a_lone_slot_and_a_second_run_have_the_same_bits() {
    let session = Session::open();
    let (scene, camera) = mirrored_box();
    let settings = Settings { trace: Default::default(), ..traced(Technique::Particles) };
    let bits = |frame: &Frame| -> Vec<[u32; 3]> {
        frame.slots[&Slot::Specular].pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
    };
    let all = session.render(&scene, &settings, &request(SIZE, camera.clone(), &Slot::ALL));
    let asked = FrameRequest { image: false, ..request(SIZE, camera, &[Slot::Specular]) };
    let mut renderer = session.renderer(&settings);
    let alone = renderer.render(&scene, &asked).expect("a frame");
    assert_eq!(bits(&all), bits(&alone));
    renderer.invalidate();
    assert_eq!(bits(&all), bits(&renderer.render(&scene, &asked).expect("a frame")));
}

#[test]
fn what_nothing_reflects_costs_nothing() {
    let session = Session::open();
    let rows = |scene: &Scene| {
        let camera = scene.camera_view(None).unwrap_or_else(|_| at_the_wall());
        let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera, &Slot::ALL) };
        session.render(scene, &traced(Technique::Particles), &asked).timings.passes
    };
    let matt = rows(&builtin("cornell-point"));
    let about: Vec<_> = matt.iter().filter(|pass| pass.full_name().contains("trace")).collect();
    let of_trace: Vec<_> = about.iter().filter(|pass| pass.piece == "specular/trace").collect();
    assert_eq!(of_trace.len(), 1);
    assert_eq!(of_trace[0].skipped.as_deref(), Some("no specular surface"));
    assert!(!matt.iter().any(|pass| pass.full_name().contains("mirrored")));
    let unlit = rows(&floor_and_wall(lambert([0.5; 3]), mirror()));
    let reason = |pass: &&crate::renderer::PassTiming| pass.piece == "specular/trace";
    assert_eq!(unlit.iter().find(reason).and_then(|pass| pass.skipped.as_deref()), Some("no light"));
}

#[test]
fn vpl_is_asked_of_its_light_alone() {
    let session = Session::open();
    let (scene, camera) = mirrored_box();
    let mut settings = traced(Technique::Direct);
    settings.methods.diffuse = DiffuseMethod::Vpl;
    let asked = FrameRequest { image: false, timing: Timing::Passes, ..request(SIZE, camera, &[Slot::Specular]) };
    let frame = session.render(&scene, &settings, &asked);
    let ran = |name: &str| frame.timings.passes.iter().any(|pass| pass.skipped.is_none() && pass.full_name() == name);
    assert!(ran("diffuse/vpl/gather/mirrored.0") && !ran("diffuse/vpl/gather/regions"));
    assert_eq!(frame.slots.keys().collect::<Vec<_>>(), [&Slot::Specular]);
}

#[test]
fn what_did_not_change_stands() {
    let session = Session::open();
    let (mut scene, camera) = mirrored_box();
    let mut settings = traced(Technique::Particles);
    settings.particles.count = 500;
    let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera, &[Slot::Specular]) };
    let mut renderer = session.renderer(&settings);
    let mut ran = |scene: &Scene| {
        let frame = renderer.render(scene, &asked).expect("a frame");
        let running = frame.timings.passes.into_iter().filter(|pass| pass.skipped.is_none());
        running.map(|pass| pass.full_name()).collect::<Vec<_>>()
    };
    assert!(ran(&scene).iter().any(|pass| pass == "specular/trace/walk/rays.0"));
    assert_eq!(ran(&scene), Vec::<String>::new());
    let light = Light { intensity: [1.0, 2.0, 3.0], ..scene.lights()[0].clone() };
    scene.set_light(LightId(0), light).expect("sound");
    let again = ran(&scene);
    let has = |name: &str| again.iter().any(|pass| pass.starts_with(name));
    assert!(has("specular/trace/light/punctual.0") && has("diffuse/particles/mirrored.0"), "{again:?}");
    assert!(!has("specular/trace/walk") && !has("diffuse/particles/find"), "{again:?}");
}
