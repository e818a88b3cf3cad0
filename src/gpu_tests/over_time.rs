//! Sequences measured frame by frame: what stands still is the same in every frame, what is switched arrives bit by bit.

use super::session::Session;
use crate::bench::over_time::{Comparing, FrameRecord, Played, Sequence, errors_plot, passes_plot, play};
use crate::bench::report::Run;
use crate::bench::{Options, Subject};
use crate::method::{Options as _, Preset};
use crate::renderer::options::LightmapsOptions;
use crate::renderer::{DiffuseMethod, Settings, Technique};
use crate::scene::{Flight, Scene};

fn options(frames: u32) -> Options {
    let (max_seconds, pieces) = Default::default();
    Options { size: [32, 24], frames, warmup: 1, lead_in: None, max_seconds, pictures: false, slots: true, pieces }
}

fn sequence(fps: f64) -> Sequence<'static> {
    Sequence { fps, flight: None, camera: None, lag: true, compare: None }
}

/// `lightmaps` and nothing else but direct light, with few texels and of these few a frame; further rounds would make still pictures better from frame to frame.
fn lightmaps() -> Settings {
    let options =
        LightmapsOptions { count: 1000, rays: 64, texels: 100, rounds: 1, ..LightmapsOptions::preset(Preset::Default) };
    let mut settings = Settings::new(Technique::Direct, Preset::Default);
    settings.methods.diffuse = DiffuseMethod::Lightmaps;
    Settings { lightmaps: options, ..settings }
}

fn played(session: &Session, scene: &str, settings: &[Settings], sequence: &Sequence<'_>, frames: u32) -> Vec<Run> {
    let scene = Scene::open(scene).expect("a built-in scene");
    let camera = scene.camera_view(None).expect("it has a camera");
    let subject = Subject { name: "scene", scene: &scene, camera: &camera, load_ms: 0.0 };
    let mut steps = 0;
    let Played { outcomes, failure } =
        play(&session.context, &subject, settings, &options(frames), sequence, &mut || steps += 1);
    assert_eq!((steps, failure), (2 * frames as usize * settings.len(), None));
    outcomes.into_iter().map(|outcome| outcome.expect("it came through").run).collect()
}

fn frames(run: &Run) -> &[FrameRecord] {
    &run.over_time.as_ref().expect("it was played").frames
}

fn late(run: &Run) -> Vec<f64> {
    frames(run).iter().map(|frame| frame.lag.as_ref().expect("asked for")["covered"].late).collect()
}

fn sum(frame: &FrameRecord, counter: &str) -> u64 {
    frame.counts.iter().filter(|(name, _)| name.ends_with(counter)).map(|(_, count)| count).sum()
}

#[test]
fn a_still_scene_has_the_same_error_in_every_frame() {
    let session = Session::open();
    let compare = Some(Comparing { spp: 16, cache: None });
    let contenders = [lightmaps(), Settings::new(Technique::Rsm, Preset::Draft)];
    let runs = played(&session, "cornell-point", &contenders, &Sequence { compare, ..sequence(30.0) }, 4);
    for run in &runs {
        let frames = frames(run);
        assert_eq!((frames.len(), run.frames), (4, 4));
        let error = frames[0].error.as_ref().expect("compared");
        assert!(error["covered"].rrmse > 0.0 && error["diffuse"].rrmse < 1.0, "{error:?}");
        for (number, frame) in frames.iter().enumerate() {
            assert_eq!((frame.frame as usize, frame.error.as_ref()), (number, Some(error)));
            assert_eq!(
                frame.flicker.map(|flicker| (flicker.change, flicker.reference, flicker.still)),
                (number > 0).then_some((0.0, 0.0, 1.0))
            );
            let lag = &frame.lag.as_ref().expect("asked for")["covered"];
            assert!(lag.late < 1e-6 && lag.arrived.is_none(), "{lag:?}");
        }
    }
    let text = errors_plot(&[&runs[0], &runs[1]]).expect("errors");
    let document = roxmltree::Document::parse(&text).expect("well-formed");
    let lines = document.descendants().filter(|node| node.has_tag_name("polyline"));
    let points = lines.filter_map(|node| node.attribute("points")).map(|points| points.split_whitespace().count());
    assert_eq!(points.filter(|count| *count == 4).count(), 4, "two techniques in two panels; flicker has a point less");
    assert!(passes_plot(&runs[0], None).is_some());
}

/// The lamps of one room go off with the third frame and on with the seventh: direct light is there at once, the light of the maps by and by, and each frame is
/// compared with the picture of its own time.
#[test]
fn what_is_switched_arrives_frame_by_frame() {
    let session = Session::open();
    let contenders = [lightmaps(), Settings::new(Technique::Direct, Preset::Default)];
    let runs = played(&session, "rooms-switched", &contenders, &sequence(4.0), 6);
    let late_maps = late(&runs[0]);
    println!("late: {late_maps:.3?}");
    assert!(late_maps[..2].iter().all(|late| *late < 1e-6), "{late_maps:?}");
    assert!(late_maps[2] > 0.1, "{late_maps:?}");
    assert!(late_maps[2..].windows(2).all(|pair| pair[1] < pair[0]), "{late_maps:?}");
    let arrived =
        |run: usize, frame: usize| frames(&runs[run])[frame].lag.as_ref().expect("asked for")["covered"].arrived;
    assert_eq!(arrived(0, 1), None, "nothing was to change");
    assert!(arrived(0, 2).is_some_and(|share| (0.2..0.95).contains(&share)), "{:?}", arrived(0, 2));
    assert_eq!(late(&runs[1]), [0.0; 6], "direct light is never late");
    assert!(arrived(1, 2).is_some_and(|share| (share - 1.0).abs() < 1e-9), "{:?}", arrived(1, 2));
    let renewed: Vec<u64> = frames(&runs[0]).iter().map(|frame| sum(frame, "gather.0.texels")).collect();
    println!("texels renewed: {renewed:?}");
    assert!(renewed[..2] == [0, 0] && renewed[2..] == [100; 4], "{renewed:?}");
}

/// Something moves in one of two rooms that no light passes between: seen from the other, nothing is renewed that can be seen, and nothing is late.
#[test]
fn what_moves_in_one_room_leaves_the_other_as_it_is() {
    let session = Session::open();
    let runs = ["left", "right"].map(|camera| {
        let sequence = Sequence { camera: Some(camera), ..sequence(15.0) };
        played(&session, "rooms-divided", &[lightmaps()], &sequence, 3).remove(0)
    });
    let changed = |run: &Run| {
        frames(run).iter().skip(1).any(|frame| frame.lag.as_ref().expect("asked for")["covered"].arrived.is_some())
    };
    println!("late: {:.4?} beside what moves, {:.4?} in the other room", late(&runs[0]), late(&runs[1]));
    assert!(changed(&runs[0]) && !changed(&runs[1]));
}

#[test]
fn a_flight_is_seen_frame_by_frame() {
    let session = Session::open();
    let flight = Flight::open("two-rooms").expect("a built-in flight");
    let along = Sequence { flight: Some(&flight), ..sequence(0.2) };
    let runs = played(&session, "two-rooms", &[Settings::new(Technique::Direct, Preset::Default)], &along, 4);
    assert_eq!(
        (&*runs[0].camera, runs[0].over_time.as_ref().expect("played").flight.as_deref()),
        ("flight two-rooms", Some("two-rooms"))
    );
    let lags = frames(&runs[0]).iter().map(|frame| frame.lag.as_ref().expect("asked for")["covered"]);
    assert!(lags.skip(1).all(|lag| lag.late == 0.0 && lag.arrived.is_some()), "the picture changes and is never late");
}
