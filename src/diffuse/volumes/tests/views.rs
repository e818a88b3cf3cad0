//! What is not drawn and not looked for, since nobody reads it.

use super::counted;
use crate::gpu_tests::against_paths::passes_run;
use crate::gpu_tests::scenes::{builtin, request};
use crate::gpu_tests::session::Session;
use crate::renderer::{DirectMethod, Frame, FrameRequest, Preset, Settings, Slot, Technique, Timing};

fn rendered(
    session: &Session,
    name: &str,
    direct: DirectMethod,
    (preset, changes): (Preset, &[(&str, &str)]),
) -> Frame {
    let scene = builtin(name);
    let camera = scene.camera_view(None).expect("its camera");
    let asked = FrameRequest { timing: Timing::Passes, ..request([32, 24], camera, &Slot::ALL) };
    let mut settings = Settings::new(Technique::Volumes, preset);
    settings.methods.direct = direct;
    for (key, value) in [&[("volumes.lights", "16")], changes].concat() {
        settings.set(key, value).expect("a setting and its value");
    }
    session.render(&scene, &settings, &asked)
}

/// `lights` has a point, a spot and a sun, 8 views, and a globe whose samples have five each.
#[test]
fn views_of_emitters_are_drawn_for_whoever_reads_them() {
    let session = Session::open();
    let views =
        |frame: &Frame| ["light-views/reflective", "light-views/depth"].map(|pass| counted(frame, pass, "views"));
    let default = (Preset::Default, &[][..]);
    let by_views = (Preset::Default, &[("volumes.area_lights", "views")][..]);
    let alone = rendered(&session, "lights", DirectMethod::Traced, default);
    let all = rendered(&session, "lights", DirectMethod::Traced, by_views);
    let shadowed = rendered(&session, "lights", DirectMethod::ShadowMap, default);
    println!("{:?}, by views {:?}, with shadows {:?}", views(&alone), views(&all), views(&shadowed));
    let [every, none] = views(&all);
    assert!(every > 8 && none == 0);
    assert_eq!(views(&alone), [8, 0]);
    assert_eq!(views(&shadowed), [8, every - 8]);
    assert_eq!(alone.slots[&Slot::Diffuse], shadowed.slots[&Slot::Diffuse], "bit by bit");
    let drawn = rendered(&session, "lights", DirectMethod::ShadowMap, by_views);
    assert_eq!(views(&drawn), [every, 0]);
    assert_eq!(drawn.slots[&Slot::Direct], shadowed.slots[&Slot::Direct], "bit by bit");
}

#[test]
fn lights_from_all_around_need_no_horizons() {
    let session = Session::open();
    let looks = |changes| {
        let frame = rendered(&session, "cornell-point", DirectMethod::ShadowMap, (Preset::Draft, changes));
        passes_run(&frame, "caches/places/look").len() + passes_run(&frame, "caches/places/clear-horizons").len()
    };
    assert_eq!((looks(&[]), looks(&[("volumes.val", "paper")])), (2, 0));
}
