//! What receivers see of near things for themselves.

use glam::DVec3;

use super::super::options::ParticlesOptions;
use super::receivers::{SIZE, difference, frame};
use super::{options, ran, settings};
use crate::gpu_tests::scenes::{builtin, closed_box, lambert, request, view};
use crate::gpu_tests::session::Session;
use crate::method::Preset;
use crate::renderer::{FrameRequest, Settings, Slot, Technique, Timing};
use crate::scene::Material;

/// In a box that shines evenly all is as bright, whether it is near or far: in its corners as well.
#[test]
fn near_rays_add_and_take_nothing_where_all_is_as_bright() {
    let session = Session::open();
    let scene = closed_box(1.0, Material { emissive: [1.0; 3], ..lambert([0.5; 3]) });
    let camera = view(DVec3::new(0.3, 0.2, 0.1), DVec3::new(-1.0, -1.0, -1.0));
    let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera, &[Slot::Diffuse]) };
    let shown = |near| session.render(&scene, &settings(ParticlesOptions { near, ..options(2000, 2) }), &asked);
    let [mean, pixels, _] = difference(&shown(8), &shown(0));
    assert!((mean - 1.0).abs() < 2e-3 && pixels < 0.02, "{mean}, pixels {pixels}");
}

/// 600 particles are half a metre apart: what they see of light around a corner is not what points between them do.
#[test]
fn near_rays_show_what_few_particles_do_not() {
    let session = Session::open();
    let scene = builtin("two-rooms");
    let camera = scene.camera_view(None).expect("its camera");
    let asked = request(SIZE, camera, &[Slot::Diffuse]);
    let mut path = Settings::new(Technique::Path, Preset::Default);
    (path.path.spp, path.path.bounces) = (64, Some(4));
    let expected = session.render(&scene, &path, &asked);
    let [without, with] = [0, 8].map(|near| {
        let options = ParticlesOptions { near, gather: 16, ..options(600, 3) };
        let [mean, _, blocks] = difference(&session.render(&scene, &settings(options), &asked), &expected);
        println!("{near} rays a side: mean {mean:.3}, blocks {blocks:.3}");
        assert!((mean - 1.0).abs() < 0.1, "{near}: {mean}");
        blocks
    });
    assert!(with < 0.93 * without, "{without} without, {with} with");
}

#[test]
fn who_asks_for_no_near_rays_does_not_pay() {
    let session = Session::open();
    let looks = |near| {
        let passes = ran(&frame(&session, ParticlesOptions { near, ..options(2000, 1) }));
        passes.iter().filter(|name| name.contains("near") || name.contains("far")).count()
    };
    assert_eq!((looks(0), looks(4)), (0, 3), "clearing, reading and looking");
}
