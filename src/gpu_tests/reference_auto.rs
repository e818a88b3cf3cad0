//! The estimator `auto`: every slot is the very one that `path` or `sppm` makes of it.

use super::session::Session;
use crate::reference::{CausticPaths, Estimator, Job, PixelFilter, Reference, ReferenceRequest};
use crate::renderer::Slot;
use crate::scene::Scene;

const SPP: u32 = 16;

fn made(session: &Session, scene: &Scene, estimator: Estimator, bounces: Option<u32>) -> Reference {
    let request = ReferenceRequest {
        size: [24, 18],
        camera: scene.camera_view(None).expect("it has a camera"),
        estimator,
        bounces,
        caustics: CausticPaths::All,
        mirrors: None,
        filter: PixelFilter::Box,
        seed: 0,
    };
    let job = Job { context: &session.context, scene, scene_name: "scene", request: &request };
    job.make(SPP, None, &mut |_| ()).expect("made").reference()
}

fn bits(reference: &Reference, slot: Slot) -> Vec<u32> {
    reference.slots[&slot].pixels.as_flattened().iter().map(|value| value.to_bits()).collect()
}

/// Paths find the caustics of the ring on the floor; what the eye sees of them in the ring is left to photons.
#[test]
fn auto_takes_caustics_from_paths_and_their_mirror_images_from_photons() {
    let session = Session::open();
    let scene = Scene::open("ring").expect("a built-in scene");
    let [auto, paths, photons] =
        [Estimator::Auto, Estimator::Path, Estimator::Sppm].map(|estimator| made(&session, &scene, estimator, None));
    for slot in [Slot::Direct, Slot::Diffuse, Slot::Caustics] {
        assert!(bits(&auto, slot) == bits(&paths, slot), "{slot}");
    }
    assert!(bits(&auto, Slot::Specular) == bits(&photons, Slot::Specular));
    assert!(bits(&auto, Slot::Caustics) != bits(&photons, Slot::Caustics));
}

#[test]
fn auto_is_path_where_nothing_gathers_light() {
    let session = Session::open();
    let scene = Scene::open("cornell-panel").expect("a built-in scene");
    let [auto, paths] = [Estimator::Auto, Estimator::Path].map(|estimator| made(&session, &scene, estimator, Some(2)));
    for slot in Slot::ALL {
        assert!(bits(&auto, slot) == bits(&paths, slot), "{slot}");
    }
}
