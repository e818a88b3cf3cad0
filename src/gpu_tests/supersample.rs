//! Pixels that are sampled all over because they differ from a neighbour: against pictures of many more pixels, against paths, and what stays as it is.

use glam::{DAffine3, DVec3};

use super::path_probe::{Ask, Tracer};
use super::scenes::{add_light, box_faces, builtin, floor, lambert, place, quad, request, view};
use super::session::Session;
use crate::image::ColorImage;
use crate::output::box_reduced;
use crate::renderer::{DiffuseMethod, Frame, FrameRequest, Preset, Settings, Slot, SpecularMethod, Technique, Timing};
use crate::scene::{CameraView, LightKind, Material, Projection, Scene};
use crate::slot::PixelFilter;

const SIZE: [u32; 2] = [64, 48];
const SHOWN: [Slot; 4] = [Slot::Emission, Slot::Direct, Slot::Diffuse, Slot::Specular];

fn settings(technique: Technique, supersamples: u32) -> Settings {
    let mut settings = Settings::new(technique, Preset::Default);
    settings.methods.specular = SpecularMethod::Trace;
    settings.trace.supersamples = supersamples;
    settings.particles.count = 2000;
    // So many that the noise of lamp and sky is below the error at edges.
    (settings.traced.samples, settings.trace.light_samples) = (64, 16);
    settings
}

/// A box on a floor under the sky, beside a mirror that shows both and a small lamp, by a point light. `specular`: how glossy the box is.
fn still_life(specular: f32) -> (Scene, CameraView) {
    let mut scene = floor(4.0, lambert([0.6, 0.5, 0.4]));
    let red = Material { specular, roughness: 0.4, ..lambert([0.5, 0.1, 0.1]) };
    let red = scene.add_material(red).expect("sound");
    let mut faces = box_faces([0.4, 0.5, 0.4], [red; 6]);
    // Seen from outside.
    faces.iter_mut().for_each(|face| face.indices = vec![0, 2, 1, 0, 3, 2]);
    let at = DVec3::new(0.5, 0.51, 0.3);
    place(&mut scene, faces, DAffine3::from_rotation_translation(glam::DQuat::from_rotation_y(0.4), at));
    let mirror = Material { metallic: 1.0, roughness: 0.0, base_color: [0.9, 0.9, 0.9, 1.0], ..Material::default() };
    let mirror = scene.add_material(mirror).expect("sound");
    let corners = [[-1.8, 0.0, -1.2], [0.6, 0.0, -1.6], [0.6, 1.4, -1.6], [-1.8, 1.4, -1.2]];
    place(&mut scene, vec![quad(corners, mirror)], DAffine3::IDENTITY);
    let lamp = scene.add_material(Material { emissive: [0.8, 0.7, 0.2], ..lambert([0.6; 3]) }).expect("sound");
    let corners = [[1.0, 1.2, -1.0], [1.4, 1.25, -1.0], [1.4, 1.5, -1.0], [1.0, 1.45, -1.0]];
    place(&mut scene, vec![quad(corners, lamp)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(1.5, 2.5, 2.0), DVec3::NEG_Y, [12.0; 3]);
    scene.set_sky([0.1, 0.15, 0.2]);
    (scene, view(DVec3::new(0.2, 1.3, 3.4), DVec3::new(0.0, 0.6, 0.0)))
}

fn frame(session: &Session, scene: &Scene, settings: &Settings, camera: &CameraView) -> Frame {
    let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera.clone(), &SHOWN) };
    session.render(scene, settings, &asked)
}

/// The means of eight times eight pixels each.
fn of_many_pixels(session: &Session, scene: &Scene, technique: Technique, camera: &CameraView) -> Frame {
    let asked = request(SIZE.map(|side| 8 * side), camera.clone(), &SHOWN);
    let mut frame = session.render(scene, &settings(technique, 0), &asked);
    frame.image = frame.image.map(|image| box_reduced(&image, 8));
    frame.slots.values_mut().for_each(|image| *image = box_reduced(image, 8));
    frame
}

/// What a frame shows by name, the sum included.
fn images(frame: &Frame) -> Vec<(String, &ColorImage)> {
    let image = frame.image.as_ref().map(|image| ("image".to_owned(), image));
    frame.slots.iter().map(|(slot, image)| (slot.to_string(), image)).chain(image).collect()
}

fn pixels(image: &ColorImage) -> Vec<DVec3> {
    image.pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).collect()
}

fn mean(pixels: &[DVec3]) -> f64 {
    pixels.iter().map(|pixel| pixel.element_sum()).sum::<f64>() / pixels.len() as f64
}

fn rmse(found: &[DVec3], truth: &[DVec3]) -> f64 {
    let squares = found.iter().zip(truth).map(|(a, b)| (*a - *b).length_squared());
    (squares.sum::<f64>() / found.len() as f64).sqrt()
}

fn bits(image: &ColorImage) -> Vec<[u32; 3]> {
    image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// The sum of a work counter over passes of this level.
fn work(frame: &Frame, pass: &str, what: &str) -> u64 {
    let passes = frame.timings.passes.iter().filter(|row| row.full_name().starts_with(pass));
    passes.filter_map(|row| row.work.get(what)).sum()
}

const MARKS: &str = "specular/trace/supersample/marks";
const RAYS: &str = "specular/trace/supersample/rays";

#[test]
fn edges_are_the_means_over_their_pixels() {
    let session = Session::open();
    let (scene, perspective) = still_life(0.0);
    let mut parallel = perspective.clone();
    parallel.projection = Projection::Orthographic { half_width: 2.0, half_height: 1.5, near: 0.01, far: 20.0 };
    for (technique, camera) in [(Technique::Particles, perspective), (Technique::Hybrid, parallel)] {
        let truth = of_many_pixels(&session, &scene, technique, &camera);
        let centers = frame(&session, &scene, &settings(technique, 0), &camera);
        for (supersamples, least) in [(9, 3.0), (16, 3.2)] {
            let found = frame(&session, &scene, &settings(technique, supersamples), &camera);
            for (((name, found), (_, centers)), (_, truth)) in
                images(&found).into_iter().zip(images(&centers)).zip(images(&truth))
            {
                // What is lit by the lamp and the sky alone has noise; caustics stay those of centres.
                let most = if name == "image" { 0.01 } else { 0.02 };
                let [found, centers, truth] = [found, centers, truth].map(pixels);
                let gain = rmse(&centers, &truth) / rmse(&found, &truth);
                let ratio = mean(&found) / mean(&truth);
                println!(
                    "{} {supersamples} {name}: error falls {gain:.2} times, mean {ratio:.4} of {:.4}",
                    technique.name(),
                    mean(&centers) / mean(&truth)
                );
                assert!(gain > least, "{} {supersamples} {name}: error falls {gain} times", technique.name());
                assert!((ratio - 1.0).abs() < most, "{} {supersamples} {name}: mean {ratio}", technique.name());
            }
        }
    }
}

/// Of a point light paths have no noise but that of the pixels' edges.
#[test]
fn direct_light_is_that_of_paths_all_over_pixels() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("a camera");
    let truth = Tracer::new(&session).trace(&scene, &Ask { bounces: Some(0), ..Ask::new(SIZE, 128, camera.clone()) });
    let truth = truth.slot(Slot::Direct);
    let [centers, found] = [0, 9].map(|supersamples| {
        let found = frame(&session, &scene, &settings(Technique::Particles, supersamples), &camera);
        rmse(&pixels(&found.slots[&Slot::Direct]), &truth)
    });
    println!("rmse {centers:.4} to {found:.4}");
    assert!(found < 0.18 * centers, "rmse {centers} to {found}");
}

#[test]
fn pixels_like_their_neighbours_keep_their_bits() {
    let session = Session::open();
    let (scene, camera) = still_life(1.0);
    let [centers, found] =
        [0, 9].map(|supersamples| frame(&session, &scene, &settings(Technique::Particles, supersamples), &camera));
    let marked = work(&found, MARKS, "pixels");
    let count = (SIZE[0] * SIZE[1]) as usize;
    assert!((count / 50..count / 3).contains(&(marked as usize)), "{marked} of {count} pixels");
    let mut changed = vec![false; count];
    for ((_, found), (_, centers)) in images(&found).into_iter().zip(images(&centers)) {
        for (changed, (a, b)) in changed.iter_mut().zip(bits(found).into_iter().zip(bits(centers))) {
            *changed |= a != b;
        }
    }
    let changed = changed.into_iter().filter(|&changed| changed).count() as u64;
    assert!(changed <= marked && 10 * changed > 9 * marked, "{changed} pixels changed, {marked} are marked");
    assert!(work(&found, RAYS, "rays") >= 9 * marked);
}

#[test]
fn nothing_is_traced_where_nothing_differs() {
    let session = Session::open();
    let mut scene = floor(50.0, lambert([0.5; 3]));
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.1, -1.0, 0.2), [2.0; 3]);
    let camera = view(DVec3::new(0.0, 5.0, 0.1), DVec3::ZERO);
    let [centers, found] =
        [0, 9].map(|supersamples| frame(&session, &scene, &settings(Technique::Particles, supersamples), &camera));
    assert_eq!([work(&found, MARKS, "pixels"), work(&found, RAYS, "invocations")], [0, 0]);
    for ((name, found), (_, centers)) in images(&found).into_iter().zip(images(&centers)) {
        assert_eq!(bits(found), bits(centers), "{name}");
    }
    let skipped = |name: &str| {
        let pass = found.timings.passes.iter().find(|pass| pass.full_name() == name);
        pass.and_then(|pass| pass.skipped.clone())
    };
    assert_eq!(skipped("specular/trace/walk").as_deref(), Some("no specular surface"));
    assert!(!centers.timings.passes.iter().any(|pass| pass.full_name().contains("supersample")));
    let unlit = floor(50.0, lambert([0.5; 3]));
    let found = frame(&session, &unlit, &settings(Technique::Particles, 9), &camera);
    let pass = found.timings.passes.iter().find(|pass| pass.piece == "specular/trace");
    assert_eq!(pass.and_then(|pass| pass.skipped.as_deref()), Some("no light"));
}

/// From above a slab on a floor of the same kind, lit from above: only their depths differ.
#[test]
fn a_step_between_like_surfaces_is_marked() {
    let session = Session::open();
    let mut scene = floor(50.0, lambert([0.5; 3]));
    let slab = scene.add_material(lambert([0.5; 3])).expect("sound");
    let corners = [[-1.0, 0.8, -1.0], [-1.0, 0.8, 1.0], [1.0, 0.8, 1.0], [1.0, 0.8, -1.0]];
    place(&mut scene, vec![quad(corners, slab)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::NEG_Y, [2.0; 3]);
    let camera = view(DVec3::new(0.0, 5.0, 0.0), DVec3::ZERO);
    let found = frame(&session, &scene, &settings(Technique::Direct, 9), &camera);
    // 20 pixels a side, on both sides of the edge.
    let marked = work(&found, MARKS, "pixels");
    assert!((120..200).contains(&marked), "{marked} pixels");
}

/// Light on the floor along a lamp that stands on it, where points on the lamp alone are noisy.
#[test]
fn light_beside_a_lamp_is_found_by_directions_too() {
    let session = Session::open();
    let mut scene = floor(3.0, lambert([0.6; 3]));
    let lamp = scene.add_material(Material { emissive: [1.0; 3], ..lambert([0.0; 3]) }).expect("sound");
    let corners = [[-2.0, 0.0, -0.2], [2.0, 0.0, 0.2], [2.0, 1.0, 0.2], [-2.0, 1.0, -0.2]];
    place(&mut scene, vec![quad(corners, lamp)], DAffine3::IDENTITY);
    let camera = view(DVec3::new(0.0, 1.5, 1.5), DVec3::new(0.0, 0.1, 0.2));
    let truth = pixels(&of_many_pixels(&session, &scene, Technique::Particles, &camera).slots[&Slot::Direct]);
    let [centers, found] = [0, 16].map(|supersamples| {
        let settings = settings(Technique::Particles, supersamples);
        pixels(&frame(&session, &scene, &settings, &camera).slots[&Slot::Direct])
    });
    let marked: Vec<usize> = (0..truth.len()).filter(|&pixel| centers[pixel] != found[pixel]).collect();
    let of = |pixels: &[DVec3]| -> Vec<DVec3> { marked.iter().map(|&pixel| pixels[pixel]).collect() };
    let [centers, found, truth] = [centers, found, truth].map(|pixels| of(&pixels));
    let (ratio, gain) = (mean(&found) / mean(&truth), rmse(&centers, &truth) / rmse(&found, &truth));
    println!("{} pixels: mean {ratio:.4}, error falls {gain:.2} times", marked.len());
    assert!(marked.len() > 60 && (ratio - 1.0).abs() < 0.02 && gain > 3.0, "mean {ratio}, error falls {gain} times");
}

#[test]
fn a_lone_slot_and_a_second_run_have_the_same_bits() {
    let session = Session::open();
    let (scene, camera) = still_life(1.0);
    let settings = settings(Technique::Particles, 9);
    let all = frame(&session, &scene, &settings, &camera);
    let mut renderer = session.renderer(&settings);
    for slot in SHOWN {
        let asked = FrameRequest { image: false, ..request(SIZE, camera.clone(), &[slot]) };
        for run in 0..2 {
            let alone = renderer.render(&scene, &asked).expect("a frame");
            assert_eq!(bits(&all.slots[&slot]), bits(&alone.slots[&slot]), "{slot}, run {run}");
            renderer.invalidate();
        }
    }
}

/// More than a thirty-second of the pixels, for which there is room at first.
#[test]
fn lists_grow_until_all_marked_pixels_fit() {
    let session = Session::open();
    let scene = builtin("maze");
    let camera = scene.camera_view(None).expect("a camera");
    let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera, &SHOWN) };
    let mut renderer = session.renderer(&settings(Technique::Direct, 9));
    let first = renderer.render(&scene, &asked).expect("a frame");
    let marked = work(&first, MARKS, "pixels");
    assert!(marked > u64::from(SIZE[0] * SIZE[1] / 6), "{marked} pixels");
    assert!((9 * marked..).contains(&work(&first, RAYS, "rays")));
    renderer.invalidate();
    let second = renderer.render(&scene, &asked).expect("a frame");
    for ((name, first), (_, second)) in images(&first).into_iter().zip(images(&second)) {
        assert_eq!(bits(first), bits(second), "{name}");
    }
}

/// Samples of a ring come to points of it and to what these reflect: more than there is room for as long as only first ones are counted.
#[test]
fn lists_grow_until_what_mirrors_show_fits() {
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("a camera");
    let settings = settings(Technique::Direct, 9);
    let first = frame(&session, &scene, &settings, &camera);
    assert!(work(&first, RAYS, "points") > 11 * work(&first, MARKS, "pixels"));
    // With the room that a larger picture takes.
    let mut renderer = session.renderer(&settings);
    renderer.render(&scene, &request(SIZE.map(|side| 3 * side), camera.clone(), &SHOWN)).expect("a frame");
    let second = renderer.render(&scene, &request(SIZE, camera, &SHOWN)).expect("a frame");
    assert_eq!(bits(&first.slots[&Slot::Specular]), bits(&second.slots[&Slot::Specular]));
}

#[test]
fn light_that_no_method_knows_at_points_stays_that_of_centers() {
    let session = Session::open();
    let (scene, camera) = still_life(1.0);
    let [centers, found] = [0, 9].map(|supersamples| {
        let mut settings = settings(Technique::Direct, supersamples);
        settings.methods.diffuse = DiffuseMethod::Rsm;
        assert_eq!(settings.reduced()[0].contains("slot diffuse"), supersamples > 0);
        frame(&session, &scene, &settings, &camera)
    });
    let same = |slot| bits(&centers.slots[&slot]) == bits(&found.slots[&slot]);
    assert!(same(Slot::Diffuse) && !same(Slot::Direct) && !same(Slot::Emission) && !same(Slot::Specular));
}

#[test]
fn references_of_supersampled_frames_are_box_filtered() {
    let filter = |supersamples| settings(Technique::Hybrid, supersamples).filter();
    assert_eq!([filter(0), filter(9)], [PixelFilter::Center, PixelFilter::Box]);
    let mut paper = Settings::new(Technique::Particles, Preset::Paper);
    assert_eq!((paper.trace.supersamples, paper.filter()), (9, PixelFilter::Box));
    paper.methods.specular = SpecularMethod::None;
    assert_eq!(paper.filter(), PixelFilter::Center);
}
