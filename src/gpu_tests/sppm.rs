//! Stochastic progressive photon mapping against path tracing and closed forms.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::scenes::{add_light, box_faces, builtin, closed_box, lambert, place, view};
use super::session::Session;
use crate::estimator::path::PathTracer;
use crate::estimator::sppm::PhotonMapper;
use crate::estimator::{EstimateRequest, Estimating, RequestSource, SampleSource, SlotSums};
use crate::frame::rays::TracedScene;
use crate::renderer::Slot;
use crate::scene::{CameraView, Light, LightKind, LightSpec, Material, Scene};
use crate::slot::{CausticPaths, PixelFilter};

const SIZE: [u32; 2] = [64, 64];

fn request(size: [u32; 2], camera: CameraView, bounces: Option<u32>) -> EstimateRequest {
    EstimateRequest {
        size,
        camera,
        bounces,
        caustics: CausticPaths::All,
        mirrors: None,
        filter: PixelFilter::Box,
        seed: 0,
    }
}

/// Means of all slots over all pixels and channels.
fn means(sums: &SlotSums) -> [f64; 5] {
    sums.slots.each_ref().map(|pixels| {
        let sum: f64 = pixels.iter().flatten().map(|&channel| f64::from(channel)).sum();
        sum / (3 * pixels.len()) as f64 / f64::from(sums.samples)
    })
}

fn photon_source(session: &Session, scene: &Scene, request: &EstimateRequest) -> RequestSource {
    let device = session.context.shared_device();
    let scene = Arc::new(TracedScene::new(device, scene).expect("a scene that fits"));
    RequestSource::new(
        Box::new(PhotonMapper::new(session.context.pipelines()).expect("a mapper")),
        scene,
        request.clone(),
    )
}

fn by_photons(session: &Session, scene: &Scene, camera: &CameraView, bounces: Option<u32>, passes: u32) -> SlotSums {
    let request = request(SIZE, camera.clone(), bounces);
    let mut source = photon_source(session, scene, &request);
    source.sums(0, 0, passes).expect("sums")
}

fn by_paths(session: &Session, scene: &Scene, camera: &CameraView, bounces: Option<u32>, samples: u32) -> SlotSums {
    let request = request(SIZE, camera.clone(), bounces);
    let device = session.context.shared_device();
    let mut tracer = PathTracer::new(session.context.pipelines()).expect("a tracer");
    tracer.set_scene(Arc::new(TracedScene::new(device, scene).expect("a scene that fits")));
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
    let photons = by_photons(&session, &scene, &camera, None, 16);
    let paths = by_paths(&session, &scene, &camera, None, 16);
    assert_alike("cornell-point", &photons, &paths, &[(Slot::Direct, 1e-5), (Slot::Diffuse, 0.015)]);
}

/// Where light must scatter on the ring once before it reaches the floor, and twice at most.
#[test]
fn caustics_are_those_of_paths() {
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("its camera");
    for (bounces, passes) in [(1, 32), (2, 16)] {
        let photons = by_photons(&session, &scene, &camera, Some(bounces), passes);
        let paths = by_paths(&session, &scene, &camera, Some(bounces), passes);
        let slots = [(Slot::Direct, 1e-5), (Slot::Caustics, 0.03)];
        assert_alike("ring", &photons, &paths, &slots);
        if bounces == 1 {
            // Direct light in a mirror takes no photons.
            assert_alike("ring", &photons, &paths, &[(Slot::Specular, 1e-5)]);
        }
    }
}

#[test]
fn a_furnace_is_twice_as_bright_as_it_glows() {
    let session = Session::open();
    let mut scene = builtin("furnace");
    let camera = scene.camera_view(None).expect("its camera");
    // A sky that nobody sees has paths go on beyond the measurement points, to find it alone.
    for sky in [0.0, 1.0] {
        scene.set_sky([sky; 3]);
        let sums = by_photons(&session, &scene, &camera, None, 8);
        let sum: f64 = means(&sums).iter().sum();
        println!("furnace under a sky of {sky}: {sum}");
        assert!((sum - 2.0).abs() < 0.02, "{sum}");
    }
}

/// What sends out no photons is found by paths alone, and what does not by them.
#[test]
fn sky_and_lights_with_a_range_are_found_once() {
    let session = Session::open();
    let camera = view(DVec3::new(0.8, 0.7, 0.8), DVec3::new(-0.3, -0.6, -0.4));
    for (sky, range, point) in [(1.0, None, 0.0), (0.0, Some(3.0), 2.0), (0.5, None, 2.0)] {
        let mut scene = Scene::empty("box without a lid");
        let id = scene.add_material(lambert([0.6; 3])).expect("a sound material");
        let mut faces = box_faces([1.0; 3], [id; 6]);
        faces.remove(3);
        place(&mut scene, faces, DAffine3::IDENTITY);
        scene.set_sky([sky; 3]);
        let light = Light { name: String::new(), kind: LightKind::Point, intensity: [point; 3], range };
        if point > 0.0 {
            let (position, direction) = (DVec3::new(0.1, -0.2, 0.1), DVec3::NEG_Y);
            scene.add_light_spec(&LightSpec { light, position, direction }).expect("a sound light");
        }
        let photons = by_photons(&session, &scene, &camera, None, 16);
        let paths = by_paths(&session, &scene, &camera, None, 16);
        let exact = sky == 0.0 || point == 0.0;
        let slots = [(Slot::Direct, 1e-5), (Slot::Diffuse, if exact { 1e-5 } else { 0.02 })];
        assert_alike("box without a lid", &photons, &paths, &slots);
    }
}

#[test]
fn equal_arguments_give_equal_bits() {
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("its camera");
    let request = request([40, 24], camera, None);
    let mut source = photon_source(&session, &scene, &request);
    let both = source.sums(1, 3, 2).expect("sums");
    assert_eq!(both, source.sums(1, 3, 2).expect("sums"), "twice by one source");
    let mut other = photon_source(&session, &scene, &request);
    let parts = [other.sums(1, 3, 1).expect("sums"), other.sums(1, 4, 1).expect("sums")];
    assert_eq!(both, other.sums(1, 3, 2).expect("sums"), "by another source");
    for (index, pixels) in both.slots.iter().enumerate() {
        for (pixel, both) in pixels.iter().enumerate() {
            for (channel, both) in both.iter().enumerate() {
                let sum = parts[0].slots[index][pixel][channel] + parts[1].slots[index][pixel][channel];
                assert!((both - sum).abs() <= 1e-5 * sum.abs(), "passes do not know of each other");
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

/// The walls of a lit box are as thin as can be.
#[test]
fn photons_stay_on_their_side() {
    let session = Session::open();
    let mut scene = closed_box(1.0, lambert([0.8; 3]));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.2, 0.3, 0.1), DVec3::NEG_Y, [1.0; 3]);
    let outside = view(DVec3::new(3.0, 2.0, 4.0), DVec3::ZERO);
    assert_eq!(means(&by_photons(&session, &scene, &outside, None, 2)), [0.0; 5]);
}
