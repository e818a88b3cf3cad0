//! Particles against closed forms, against paths, and what stands when something moves.

mod backs;
mod density;
mod events;
mod lamps;
mod mesh;
mod moving;
mod near;
mod receivers;
mod transport;

use glam::{DAffine3, DVec3};

use super::geometry::ParticleSpace;
use super::lighting::{self, Lighting};
use super::options::ParticlesOptions;
use crate::frame::rays::TracedScene;
use crate::gpu_tests::against_paths::{leaks, passes_run};
use crate::gpu_tests::scenes::{add_light, builtin, closed_box, lambert, place, quad, request, view};
use crate::gpu_tests::session::Session;
use crate::graph::Graph;
use crate::method::{Options, Preset};
use crate::renderer::{Frame, FrameRequest, PassTiming, Settings, Slot, Technique, Timing};
use crate::scene::{CameraView, LightKind, Material, Scene};

fn options(count: u32, bounces: u32) -> ParticlesOptions {
    ParticlesOptions { count, bounces: Some(bounces), gather: 8, ..ParticlesOptions::preset(Preset::Default) }
}

fn settings(options: ParticlesOptions) -> Settings {
    Settings { particles: options, ..Settings::new(Technique::Particles, Preset::Default) }
}

/// What the stages leave, read back.
pub(super) struct Stages {
    /// Albedo and area of each particle.
    matter: Vec<[f32; 4]>,
    /// Flux that lights gave, W.
    pub(super) emitted: Vec<[f32; 4]>,
    /// Received in each step, W.
    received: Vec<[f64; 3]>,
    /// That each particle sends out, W/(m² sr).
    pub(super) radiance: Vec<[f32; 4]>,
    passes: Vec<PassTiming>,
}

fn stages(session: &Session, scene: &Scene, options: &ParticlesOptions) -> Stages {
    let mut store = session.store();
    let traced = TracedScene::new(session.context.shared_device(), scene).expect("the scene fits the device");
    let mut graph = Graph::new(&mut store);
    let space = ParticleSpace::declare(&mut graph, &traced, options);
    let Lighting { emitted, scale, received, radiance } =
        lighting::light(&mut graph, &traced, &space, options, options.bounces.unwrap_or(1));
    let reads = [space.matter, emitted, scale, radiance].map(|buffer| graph.read_back_buffer(buffer));
    let steps: Vec<_> = received.iter().map(|step| graph.read_back_buffer(*step)).collect();
    let mut executed = graph.run(Timing::Passes).expect("a frame");
    let [matter, emitted, scale, radiance] =
        reads.map(|read| bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&executed.take(read)));
    let per_step = f64::from(scale[0][0]);
    let received = steps.into_iter().map(|read| {
        let words = bytemuck::pod_collect_to_vec::<u8, [u32; 3]>(&executed.take(read));
        [0, 1, 2].map(|channel| words.iter().map(|word| f64::from(word[channel])).sum::<f64>() / per_step)
    });
    let received = received.collect();
    Stages { matter, emitted, received, radiance, passes: executed.passes }
}

fn count(passes: &[PassTiming], pass: &str, name: &str) -> u64 {
    passes.iter().filter(|row| row.full_name() == pass).map(|row| row.work[name]).sum()
}

/// The standard deviation of the particles' areas over their mean.
fn spread_of_areas(matter: &[[f32; 4]]) -> f64 {
    let count = matter.len() as f64;
    let mean = matter.iter().map(|matter| f64::from(matter[3])).sum::<f64>() / count;
    (matter.iter().map(|matter| (f64::from(matter[3]) / mean - 1.0).powi(2)).sum::<f64>() / count).sqrt()
}

/// Rounding must not push points together where there are many, and of more points than a row of groups takes none is left out.
#[test]
fn many_particles_are_spread_as_evenly_as_few() {
    let session = Session::open();
    let scene = closed_box(1.5, lambert([0.5; 3]));
    let mut store = session.store();
    let traced = TracedScene::new(session.context.shared_device(), &scene).expect("the scene fits the device");
    let mut graph = Graph::new(&mut store);
    let space = ParticleSpace::declare(&mut graph, &traced, &options(300_000, 0));
    let read = graph.read_back_buffer(space.matter);
    let bytes = graph.run(Timing::Frame).expect("a frame").take(read);
    let matter = bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&bytes);
    let spread = spread_of_areas(&matter);
    assert!(spread < 0.22, "areas vary by {spread}");
    let area: f64 = matter.iter().map(|matter| f64::from(matter[3])).sum();
    assert!((area / 54.0 - 1.0).abs() < 1e-4, "{area} m² of 54");
}

#[test]
fn particles_stand_for_all_of_the_surface() {
    let session = Session::open();
    let mut scene = closed_box(1.5, lambert([0.25, 0.5, 0.75]));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.2, -0.4), DVec3::NEG_Y, [1.0; 3]);
    let made = stages(&session, &scene, &options(3000, 1));
    let area: f64 = made.matter.iter().map(|matter| f64::from(matter[3])).sum();
    assert!((area / 54.0 - 1.0).abs() < 1e-4, "{area} m² of 54");
    assert_eq!(count(&made.passes, "diffuse/particles/measure/catch", "lost"), 0);
    assert_eq!(count(&made.passes, "diffuse/particles/link/trace.0", "lost"), 0);
    // Rows along the longest edge, of a third of the spacing.
    let size = (54.0_f64 / 3000.0).sqrt() / 3.0;
    let [columns, rows] = [3.0 * 2.0_f64.sqrt(), 3.0 / 2.0_f64.sqrt()].map(|length| (length / size).ceil() as u64);
    assert_eq!(count(&made.passes, "diffuse/particles/measure/catch", "facets"), 12 * columns * rows);
    // The specular layer of the material takes its share.
    let ratio = f64::from(made.matter[7][1]) / f64::from(made.matter[7][0]);
    assert!((ratio - 2.0).abs() < 1e-2, "{:?}", made.matter[7]);
    let spread = spread_of_areas(&made.matter);
    assert!(spread < 0.22, "areas vary by {spread}");
}

/// A strip of 2.8 m by 1 cm in a room: it takes as many facets as it is long, not as many as squares of its length.
#[test]
fn slender_triangles_are_cut_along_their_length_alone() {
    let session = Session::open();
    let mut scene = closed_box(1.5, lambert([0.5; 3]));
    let strip = scene.add_material(lambert([0.5; 3])).expect("a sound material");
    let corners = [[-1.4, 0.0, 1.0], [-1.4, 0.0, 1.01], [1.4, 0.0, 1.01], [1.4, 0.0, 1.0]];
    let before = stages(&session, &scene, &options(3000, 1));
    place(&mut scene, vec![quad(corners, strip)], DAffine3::IDENTITY);
    let after = stages(&session, &scene, &options(3000, 1));
    let [before, after] = [before, after].map(|made| count(&made.passes, "diffuse/particles/measure/catch", "facets"));
    let columns = (2.8_f64 / ((54.0_f64 / 3000.0).sqrt() / 3.0)).ceil() as u64;
    // Two triangles, on both sides: the strip is seen from behind.
    assert_eq!(after - before, 2 * 2 * columns);
}

#[test]
fn the_walls_get_what_a_light_sends_out_and_pass_on_their_albedo_of_it() {
    let session = Session::open();
    let albedo = 0.6;
    let mut scene = closed_box(1.0, Material { specular: 0.0, ..lambert([albedo; 3]) });
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.2, -0.4), DVec3::NEG_Y, [2.0, 1.0, 0.5]);
    let made = stages(&session, &scene, &options(4000, 6));
    let emitted: f64 = made.emitted.iter().map(|flux| f64::from(flux[0])).sum();
    let expected = 4.0 * std::f64::consts::PI * 2.0;
    assert!((emitted / expected - 1.0).abs() < 0.01, "{emitted} W of {expected}");
    let mut before = emitted;
    for (step, received) in made.received.iter().enumerate() {
        let ratio = received[0] / before;
        assert!((ratio / f64::from(albedo) - 1.0).abs() < 0.01, "step {step}: {ratio}");
        assert!((received[1] / received[0] - 0.5).abs() < 0.01);
        before = received[0];
    }
}

/// The ratio of means and the error of blocks.
fn against_paths(session: &Session, scene: &Scene, camera: CameraView, options: ParticlesOptions) -> (f64, f64) {
    let bounces = options.bounces.map(|bounces| bounces + 1);
    crate::gpu_tests::against_paths::against_paths(session, scene, camera, &settings(options), (96, bounces))
}

#[test]
fn pictures_are_those_of_paths() {
    let session = Session::open();
    // Mirrors and glass bring light to the surfaces of the last two.
    let limited = [("cornell-point", Some(0)), ("cornell-point", Some(3)), ("corridor", Some(4))];
    for (name, bounces) in limited.into_iter().chain([("ring", None), ("water", None)]) {
        let scene = builtin(name);
        let camera = scene.camera_view(None).expect("its camera");
        let options = ParticlesOptions { gather: 16, bounces, ..options(8000, 0) };
        let (ratio, error) = against_paths(&session, &scene, camera, options);
        println!("{name}, {bounces:?} steps: mean {ratio:.3}, blocks {error:.3}");
        assert!((ratio - 1.0).abs() < 0.04, "{name}, {bounces:?} steps: {ratio}");
        assert!(error < 0.09, "{name}, {bounces:?} steps: {error}");
    }
}

#[test]
fn light_stays_out_of_dark_rooms() {
    let found = leaks(&Session::open(), &settings(options(20_000, 2)), [64, 48]);
    assert!(found.iter().all(|leak| *leak < 1e-3), "{found:?} of the lit hall's light");
}

/// The passes of the method that ran.
fn ran(frame: &Frame) -> Vec<String> {
    passes_run(frame, "diffuse/particles")
}

#[test]
fn what_did_not_change_stands() {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    let asked =
        |camera: CameraView| FrameRequest { timing: Timing::Passes, ..request([32, 24], camera, &[Slot::Diffuse]) };
    let mut renderer = session.renderer(&settings(options(2000, 2)));
    let first = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    let again = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    assert!(ran(&again).is_empty(), "{:?}", ran(&again));
    assert_eq!(first.slots, again.slots);

    let beside = view(DVec3::new(0.1, 1.0, 2.9), DVec3::new(0.0, 1.0, 0.0));
    let moved = ran(&renderer.render(&scene, &asked(beside)).expect("a frame"));
    let stands = |name: &String, stages: &[&str]| stages.iter().any(|stage| name.contains(stage));
    assert!(
        !moved.iter().any(|name| stands(name, &["/place/", "/measure/", "/link/", "/lists/", "/light/"])),
        "{moved:?}"
    );
    assert!(moved.iter().any(|name| name.ends_with("/shade")));

    let mut light = scene.lights()[0].clone();
    light.intensity = light.intensity.map(|channel| 2.0 * channel);
    scene.set_light(crate::scene::LightId(0), light).expect("a sound light");
    let relit = renderer.render(&scene, &asked(camera.clone())).expect("a frame");
    let passes = ran(&relit);
    assert!(!passes.iter().any(|name| stands(name, &["/place/", "/measure/", "/link/", "/lists/"])), "{passes:?}");
    assert!(passes.iter().any(|name| name.ends_with("/light/emit")), "{passes:?}");
    for (before, after) in first.slots[&Slot::Diffuse].pixels.iter().zip(&relit.slots[&Slot::Diffuse].pixels) {
        assert!((after[0] - 2.0 * before[0]).abs() <= 1e-3 * after[0], "{before:?} {after:?}");
    }
    renderer.invalidate();
    let anew = renderer.render(&scene, &asked(camera)).expect("a frame");
    assert_eq!(relit.slots, anew.slots, "bit by bit");
}

#[test]
fn scenes_without_need_pay_nothing() {
    let session = Session::open();
    let reason = |scene: &Scene| {
        let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
        let frame = session.render(scene, &settings(options(2000, 1)), &request([8, 8], camera, &[Slot::Diffuse]));
        let row = frame.timings.passes.into_iter().find(|pass| pass.full_name().starts_with("diffuse/particles"));
        row.and_then(|row| row.skipped).expect("a reason")
    };
    assert_eq!(reason(&closed_box(1.0, lambert([0.5; 3]))), "no light");
    let mut metal = closed_box(1.0, Material { metallic: 1.0, ..lambert([0.5; 3]) });
    add_light(&mut metal, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    assert_eq!(reason(&metal), "no diffuse surface");
}
