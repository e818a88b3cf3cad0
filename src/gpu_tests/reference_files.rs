//! References by the path tracer: however their samples come together, the bits are the same.

use super::session::Session;
use crate::output::target::tests::TestFolder;
use crate::reference::{
    Cache, CausticPaths, Estimator, Job, PixelFilter, ReferenceFile, ReferenceRequest, Shard, merge,
};
use crate::renderer::{FrameRequest, Preset, Settings, Slot, Technique};
use crate::scene::{Material, MaterialId, Scene};

const SIZE: [u32; 2] = [20, 12];
const SPP: u32 = 48;

fn request(scene: &Scene) -> ReferenceRequest {
    ReferenceRequest {
        size: SIZE,
        camera: scene.camera_view(None).expect("it has a camera"),
        estimator: Estimator::Path,
        bounces: Some(1),
        caustics: CausticPaths::All,
        mirrors: None,
        filter: PixelFilter::Center,
        seed: 0,
    }
}

fn bits(file: &ReferenceFile) -> Vec<u32> {
    let reference = file.reference();
    let images = reference.slots.values().chain([&reference.image]).chain(reference.half_differences.values());
    images.flat_map(|image| image.pixels.as_flattened()).map(|value| value.to_bits()).collect()
}

#[test]
fn resumed_and_sharded_references_are_those_made_at_once() {
    let session = Session::open();
    let folder = TestFolder::new("gpu-references");
    let scene = Scene::open("cornell-point").expect("a built-in scene");
    let request = request(&scene);
    let job = Job { context: &session.context, scene: &scene, scene_name: "box", request: &request };
    let whole = job.make(SPP, None, &mut |_| ()).expect("made");
    assert_eq!(whole.spp(), SPP);
    assert!(whole.reference().rays_per_second > 0.0);

    let cache = Cache::at(folder.0.join("cache"));
    job.make(16, Some(&cache), &mut |_| ()).expect("made");
    let resumed = job.make(SPP, Some(&cache), &mut |_| ()).expect("made");
    assert!(bits(&resumed) == bits(&whole));

    let shard = |index| {
        let path = folder.0.join(format!("{index}.exr"));
        job.make_shard(SPP, Shard { index, count: 2 }, &path, &mut |_| ()).expect("made");
        path
    };
    let merged = merge(&[2, 1].map(shard)).expect("complete");
    assert!(bits(&merged) == bits(&whole));
}

#[test]
fn a_technique_takes_other_samples_than_the_reference_that_it_is_compared_with() {
    let session = Session::open();
    let scene = Scene::open("cornell-point").expect("a built-in scene");
    let request = request(&scene);
    let job = Job { context: &session.context, scene: &scene, scene_name: "box", request: &request };
    let reference = job.make(16, None, &mut |_| ()).expect("made").reference();
    let mut settings = Settings::new(Technique::Path, Preset::Default);
    (settings.path.spp, settings.path.bounces) = (16, request.bounces);
    let asked = FrameRequest { slots: vec![Slot::Diffuse], ..FrameRequest::new(SIZE, request.camera.clone()) };
    let frame = session.render(&scene, &settings, &asked);
    let (ours, theirs) = (&frame.slots[&Slot::Diffuse].pixels, &reference.slots[&Slot::Diffuse].pixels);
    let squares = ours.as_flattened().iter().zip(theirs.as_flattened()).map(|(a, b)| f64::from(a - b).powi(2));
    let difference = (squares.sum::<f64>() / (3 * ours.len()) as f64).sqrt();
    // Both have the same variance, so their difference has twice as much.
    let ratio = difference / (2_f64.sqrt() * reference.noise["diffuse"].rmse);
    assert!((0.8..1.25).contains(&ratio), "{ratio}");
}

/// In a furnace of emission Le and albedo ρ everything has radiance Le/(1 − ρ): half of it comes over more than thirteen
/// vertices if ρ is 0.95, more than one submission holds.
#[test]
fn long_paths_are_not_cut_off() {
    let session = Session::open();
    let mut scene = Scene::open("furnace").expect("a built-in scene");
    for index in 0..scene.materials().len() {
        let material = Material { base_color: [0.95, 0.95, 0.95, 1.0], ..scene.materials()[index].clone() };
        scene.set_material(MaterialId(index), material).expect("sound");
    }
    let emitted = f64::from(scene.materials()[0].emissive[0]);
    let asked = ReferenceRequest { bounces: None, ..request(&scene) };
    let job = Job { context: &session.context, scene: &scene, scene_name: "furnace", request: &asked };
    let mean = job.make(64, None, &mut |_| ()).expect("made").reference().image_noise().mean;
    let expected = emitted / (1.0 - 0.95);
    assert!((mean / expected - 1.0).abs() < 0.03, "{mean} instead of {expected}");
}
