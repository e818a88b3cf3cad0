//! Stochastic progressive photon mapping against path tracing and closed forms.

use glam::DVec3;

use super::scenes::{add_light, builtin, closed_box, lambert, view};
use super::session::Session;
use crate::reference::sppm::SppmSource;
use crate::reference::tracer::PathTracer;
use crate::reference::{Estimator, PixelFilter, ReferenceRequest, SampleSource, SlotSums};
use crate::renderer::Slot;
use crate::scene::{CameraView, LightKind, Material, Scene};

const SIZE: [u32; 2] = [64, 64];

fn request(estimator: Estimator, size: [u32; 2], camera: CameraView, bounces: Option<u32>) -> ReferenceRequest {
    ReferenceRequest { size, camera, estimator, bounces, filter: PixelFilter::Box, seed: 0 }
}

/// Means of all slots over all pixels and channels.
fn means(sums: &SlotSums) -> [f64; 5] {
    sums.slots.each_ref().map(|pixels| {
        let sum: f64 = pixels.iter().flatten().map(|&channel| f64::from(channel)).sum();
        sum / (3 * pixels.len()) as f64 / f64::from(sums.samples)
    })
}

fn by_photons(session: &Session, scene: &Scene, camera: &CameraView, bounces: Option<u32>, passes: u32) -> SlotSums {
    let request = request(Estimator::Sppm, SIZE, camera.clone(), bounces);
    let mut source = SppmSource::new(&session.context, scene, &request).expect("a scene that fits");
    source.sums(0, 0, passes).expect("sums")
}

fn by_paths(session: &Session, scene: &Scene, camera: &CameraView, bounces: Option<u32>, samples: u32) -> SlotSums {
    let request = request(Estimator::Path, SIZE, camera.clone(), bounces);
    let mut tracer = PathTracer::new(session.context.shared_device()).expect("a tracer");
    tracer.prepare(scene).expect("a scene that fits");
    let view = tracer.view(&request);
    tracer.sums(&view, 0, 0, samples).expect("sums")
}

fn slot(slot: Slot) -> usize {
    Slot::ALL.iter().position(|known| *known == slot).expect("a slot")
}

/// Asserts that the means of these slots differ by less than a share.
fn assert_alike(what: &str, photons: &SlotSums, paths: &SlotSums, slots: &[(Slot, f64)]) {
    let (photons, paths) = (means(photons), means(paths));
    println!("{what}: photons {photons:.5?}, paths {paths:.5?}");
    for &(kind, bound) in slots {
        let (found, expected) = (photons[slot(kind)], paths[slot(kind)]);
        assert!(expected > 0.0, "{what}: no {kind} to compare");
        assert!((found / expected - 1.0).abs() < bound, "{what}, {kind}: {found} by photons, {expected} by paths");
    }
}

#[test]
fn diffuse_light_is_that_of_paths() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("its camera");
    for bounces in [None, Some(1)] {
        let photons = by_photons(&session, &scene, &camera, bounces, 24);
        let paths = by_paths(&session, &scene, &camera, bounces, 48);
        assert_alike("cornell-point", &photons, &paths, &[(Slot::Direct, 0.01), (Slot::Diffuse, 0.03)]);
    }
}

#[test]
fn caustics_are_those_of_paths() {
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("its camera");
    let photons = by_photons(&session, &scene, &camera, None, 32);
    let paths = by_paths(&session, &scene, &camera, None, 64);
    let slots = [(Slot::Direct, 0.01), (Slot::Diffuse, 0.05), (Slot::Caustics, 0.02), (Slot::Specular, 0.05)];
    assert_alike("ring", &photons, &paths, &slots);
}

#[test]
fn a_furnace_is_twice_as_bright_as_it_glows() {
    let session = Session::open();
    let scene = builtin("furnace");
    let camera = scene.camera_view(None).expect("its camera");
    let sums = by_photons(&session, &scene, &camera, None, 16);
    let sum: f64 = means(&sums).iter().sum();
    println!("furnace: {sum}");
    assert!((sum - 2.0).abs() < 0.02, "{sum}");
}

/// Light that no photon carries is found by paths alone, with the same weights: no bias, no noise of its own.
#[test]
fn sky_and_lights_with_a_range_are_found_once() {
    let session = Session::open();
    let mut scene = builtin("ring");
    scene.set_sky([0.5, 0.6, 0.7]);
    let camera = scene.camera_view(None).expect("its camera");
    let photons = by_photons(&session, &scene, &camera, None, 32);
    let paths = by_paths(&session, &scene, &camera, None, 64);
    let slots = [(Slot::Direct, 0.02), (Slot::Diffuse, 0.05), (Slot::Caustics, 0.05), (Slot::Specular, 0.05)];
    assert_alike("ring under a sky", &photons, &paths, &slots);
}

#[test]
fn equal_arguments_give_equal_bits() {
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("its camera");
    let request = request(Estimator::Sppm, [40, 24], camera, None);
    let mut source = SppmSource::new(&session.context, &scene, &request).expect("a scene that fits");
    let both = source.sums(1, 3, 2).expect("sums");
    assert_eq!(both, source.sums(1, 3, 2).expect("sums"), "twice by one source");
    let mut other = SppmSource::new(&session.context, &scene, &request).expect("a scene that fits");
    let parts = [other.sums(1, 3, 1).expect("sums"), other.sums(1, 4, 1).expect("sums")];
    assert_eq!(both, other.sums(1, 3, 2).expect("sums"), "by another source");
    for (index, pixels) in both.slots.iter().enumerate() {
        for (pixel, both) in pixels.iter().enumerate() {
            for channel in 0..3 {
                let sum = parts[0].slots[index][pixel][channel] + parts[1].slots[index][pixel][channel];
                assert!((both[channel] - sum).abs() <= 1e-5 * sum.abs(), "passes do not know of each other");
            }
        }
    }
    assert!(means(&both)[slot(Slot::Caustics)] > 0.0);
}

#[test]
fn no_light_no_photons() {
    let session = Session::open();
    let scene = closed_box(1.0, Material { roughness: 0.2, ..lambert([0.5; 3]) });
    let camera = view(DVec3::new(0.0, 0.0, 0.9), DVec3::ZERO);
    assert_eq!(means(&by_photons(&session, &scene, &camera, None, 2)), [0.0; 5]);
}

/// Walls that meet at a corner, and a thin one between light and dark: no photon comes through.
#[test]
fn photons_stay_on_their_side() {
    let session = Session::open();
    let mut scene = closed_box(1.0, lambert([0.8; 3]));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.2, 0.3, 0.1), DVec3::NEG_Y, [1.0; 3]);
    let outside = view(DVec3::new(3.0, 2.0, 4.0), DVec3::ZERO);
    assert_eq!(means(&by_photons(&session, &scene, &outside, None, 2)), [0.0; 5]);
}

#[test]
#[ignore = "debug"]
fn debug() {
    let session = Session::open();
    let number = |name: &str| std::env::var(name).ok().and_then(|value| value.parse::<u32>().ok());
    let scene = builtin(&std::env::var("S").unwrap());
    let camera = scene.camera_view(std::env::var("C").ok().as_deref()).expect("its camera");
    let (bounces, count) = (number("B"), number("N").unwrap());
    let photons = by_photons(&session, &scene, &camera, bounces, count);
    let paths = by_paths(&session, &scene, &camera, bounces, count);
    println!("{bounces:?} {count}: photons {:.5?}\n paths {:.5?}", means(&photons), means(&paths));
}
