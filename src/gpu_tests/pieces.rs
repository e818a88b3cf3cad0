//! Pieces of a frame repeated on their own.

use super::scenes::{builtin, request};
use super::session::Session;
use crate::bench::{Options, Subject, run};
use crate::renderer::{
    Frame, FrameRequest, FrameTimings, PassTiming, Preset, RepeatError, Repetition, Settings, Slot, Technique,
};
use crate::scene::Scene;

fn asked(scene: &Scene) -> FrameRequest {
    request([48, 40], scene.camera_view(None).expect("a view"), &Slot::ALL)
}

fn hybrid() -> Settings {
    Settings::new(Technique::Hybrid, Preset::Draft)
}

fn ran(timings: &FrameTimings) -> Vec<String> {
    let ran = timings.passes.iter().filter(|pass| pass.skipped.is_none());
    ran.map(PassTiming::full_name).collect()
}

fn bits(frame: &Frame) -> Vec<u32> {
    let slots = frame.slots.values().flat_map(|image| image.pixels.as_flattened());
    let image = frame.image.as_ref().expect("it was asked for");
    image.pixels.as_flattened().iter().chain(slots).map(|channel| channel.to_bits()).collect()
}

#[test]
fn a_piece_runs_alone_and_leaves_the_picture_as_it_was() {
    let session = Session::open();
    let scene = builtin("ring");
    let mut renderer = session.renderer(&hybrid());
    let request = asked(&scene);
    let before = renderer.render(&scene, &request).expect("a frame");
    let all = ran(&before.timings);
    for piece in ["light-views", "diffuse/vpl", "caustics/photons", "compose"] {
        let expected: Vec<&String> = all.iter().filter(|name| name.starts_with(piece)).collect();
        let rounds = renderer.repeat_piece(&scene, &request, piece, 2).expect("it can be repeated");
        assert_eq!(rounds.len(), 2);
        for Repetition { passes, whole } in rounds {
            assert!(
                !expected.is_empty() && ran(&passes).iter().eq(expected.iter().copied()),
                "{piece}: {:?}",
                ran(&passes)
            );
            assert_eq!(ran(&whole), ran(&passes));
            let sum: f64 = passes.passes.iter().filter_map(|pass| pass.ms).sum();
            assert!(sum > 0.0 && sum <= passes.gpu_ms && whole.gpu_ms > 0.0, "{piece}: {sum} of {} ms", passes.gpu_ms);
        }
        let after = renderer.render(&scene, &request).expect("a frame");
        assert!(bits(&after) == bits(&before), "{piece} leaves another picture");
        assert_eq!(ran(&after.timings), all, "{piece}: what it left is not mixed with the rest");
    }
}

/// The first photons land with counts that later stages have gone on with: what made these comes along.
#[test]
fn a_piece_that_interleaves_with_others_is_repeated_with_them() {
    let session = Session::open();
    let scene = builtin("ring");
    let piece = "caustics/photons/trace/land.0";
    let mut renderer = session.renderer(&hybrid());
    let rounds = renderer.repeat_piece(&scene, &asked(&scene), piece, 2).expect("it can be repeated");
    let names = rounds.iter().map(|round| ran(&round.passes)).collect::<Vec<_>>();
    assert_eq!(names[0], names[1]);
    assert!(names[0].iter().any(|name| name == piece) && names[0].len() > 1, "{names:?}");
    let splatted = names[0].iter().any(|name| name.contains("splat") || name.contains("compose"));
    assert!(!splatted, "what comes after it does not: {names:?}");
}

#[test]
fn what_cannot_be_repeated_says_why() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let mut renderer = session.renderer(&hybrid());
    let mut fault = |piece: &str| renderer.repeat_piece(&scene, &asked(&scene), piece, 1).expect_err("a fault");
    let unknown = fault("caustics/foton");
    assert!(matches!(unknown, RepeatError::Unknown { .. }), "{unknown}");
    assert!(unknown.to_string().contains("diffuse/vpl") && unknown.to_string().contains("light-views"), "{unknown}");
    for piece in ["caustics/photons", "caustics/photons/lists"] {
        let skipped = fault(piece);
        assert!(matches!(skipped, RepeatError::Skipped { .. }), "{skipped}");
        assert!(skipped.to_string().contains("no specular or transmissive surface"), "{skipped}");
    }
    let mut path = session.renderer(&Settings::new(Technique::Path, Preset::Draft));
    let samples = path.repeat_piece(&scene, &asked(&scene), "path", 1).expect_err("a fault");
    assert!(matches!(samples, RepeatError::Samples(_)), "{samples}");
}

#[test]
fn the_bench_times_pieces_alone_and_subtotals_add_up() {
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("it has a camera");
    let subject = Subject { name: "ring", scene: &scene, camera: &camera, load_ms: 0.0 };
    let contenders = [Settings::new(Technique::Direct, Preset::Draft), hybrid()];
    let pieces = vec!["caustics/photons".to_owned()];
    let options = Options {
        size: [32, 24],
        frames: 2,
        warmup: 0,
        lead_in: None,
        max_seconds: None,
        pictures: false,
        slots: false,
        pieces,
    };
    let outcomes = run(&session.context, &subject, &contenders, &options, &mut || ());
    let runs: Vec<_> = outcomes.into_iter().map(|outcome| outcome.expect("it came through").run).collect();
    let [direct, hybrid] = &runs[..] else { panic!("two contenders") };
    let lacking = direct.piece_alone[0].skipped.as_ref().expect("it has no caustics");
    assert!(lacking.contains("there is no piece") && lacking.contains("light-views"), "{lacking}");
    let alone = &hybrid.piece_alone[0];
    let photons = hybrid.pieces.iter().find(|piece| piece.piece == alone.piece).expect("it has the piece");
    assert_eq!((alone.skipped.as_ref(), alone.in_frame_ms), (None, photons.ms));
    assert!(alone.ms.min > 0.0 && alone.whole_ms.min > 0.0 && alone.also.is_empty(), "{alone:?}");
    let sum: f64 = hybrid.passes.iter().map(|pass| pass.ms.min).sum();
    let top: f64 = hybrid.pieces.iter().filter(|piece| piece.within.is_none()).map(|piece| piece.ms.min).sum();
    assert!(top >= sum && top <= hybrid.serialised_ms.median, "{sum} ms, {top} ms, {:?}", hybrid.serialised_ms);

    let options = Options { pieces: vec!["caustics/foton".to_owned()], ..options };
    for outcome in run(&session.context, &subject, &contenders, &options, &mut || ()) {
        let failure = outcome.expect_err("no contender has it").to_string();
        assert!(failure.contains("caustics/foton") && failure.contains("pieces: "), "{failure}");
    }
}
