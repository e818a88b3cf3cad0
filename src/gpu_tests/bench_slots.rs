//! What the bench compares with references is what the contenders were timed for.

use super::session::Session;
use crate::bench::{Options, Subject, run};
use crate::image::ColorImage;
use crate::renderer::{Preset, Settings, Slot, Technique};
use crate::scene::Scene;

#[test]
fn contenders_give_the_slots_that_they_fill_and_these_add_up() {
    let session = Session::open();
    let scene = Scene::open("cornell-point").expect("a built-in scene");
    let camera = scene.camera_view(None).expect("it has a camera");
    let subject = Subject { name: "box", scene: &scene, camera: &camera, load_ms: 0.0 };
    let contenders = [Technique::Direct, Technique::Rsm].map(|technique| Settings::new(technique, Preset::Draft));
    let pieces = Vec::new();
    let options = Options {
        size: [32, 24],
        frames: 1,
        warmup: 0,
        lead_in: Some(2),
        max_seconds: None,
        pictures: false,
        slots: true,
        pieces,
    };
    let outcomes = run(&session.context, &subject, &contenders, &options, &mut || ());
    for (outcome, settings) in outcomes.into_iter().zip(&contenders) {
        let finished = outcome.expect("it came through");
        assert_eq!(
            (finished.run.lead_in, finished.run.cold_ms.is_some()),
            (2, true),
            "steady and cold frames are told apart"
        );
        let images = finished.images.expect("they were wanted");
        let filled = Slot::ALL.into_iter().filter(|slot| settings.methods.fills(*slot));
        assert!(images.slots.keys().copied().eq(filled));
        let covered = ColorImage::sum(options.size, images.slots.values());
        let values = covered.pixels.as_flattened().iter().zip(images.image.pixels.as_flattened());
        assert!(values.clone().any(|(a, _)| *a > 0.0));
        for (a, b) in values {
            assert!((a - b).abs() <= 1e-4 * b.abs().max(1e-3), "slots {a}, image {b}");
        }
    }
    // A run that is not to be compared reads nothing back.
    let options = Options { slots: false, lead_in: None, ..options };
    let outcomes = run(&session.context, &subject, &contenders[..1], &options, &mut || ());
    let finished = outcomes.into_iter().next().expect("one contender").expect("it came through");
    assert!(
        finished.images.is_none() && finished.run.cold_ms.is_none(),
        "nothing is kept: no frame is another one's past"
    );
}
