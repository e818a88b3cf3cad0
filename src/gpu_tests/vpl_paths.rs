//! Further bounces of `vpl`: in a closed room they carry what the walls reflect of the bounce before, they lie on the walls, and no
//! light is where none can come.

use glam::DVec3;

use super::probe::{Vpl, probe};
use super::scenes::{add_light, builtin, closed_box, floor, lambert, request, view, vpl_settings};
use super::session::Session;
use crate::frame::twins;
use crate::renderer::{FrameRequest, Slot, Timing};
use crate::scene::{LightKind, Scene};

/// The VPLs of all bounces, bounce by bounce.
fn bounces(session: &Session, scene: &Scene, counts: &[usize]) -> Vec<Vec<Vpl>> {
    let settings = vpl_settings(&[
        ("vpl.count", &counts[0].to_string()),
        ("vpl.bounces", &counts.len().to_string()),
        ("lights.resolution", "64"),
    ]);
    let camera = scene.camera_view(None).unwrap_or_else(|_| view(DVec3::new(0.1, 0.2, 0.9), DVec3::ZERO));
    let frame = probe(session, scene, &settings, &request([8, 8], camera, &[]), |graph, declared| {
        vec![graph.read_back_buffer(declared.vpl.as_ref().expect("vpl runs").vpls)]
    });
    let mut vpls = frame.vpls(0).into_iter();
    assert_eq!(vpls.len(), counts.iter().sum::<usize>());
    counts.iter().map(|&count| vpls.by_ref().take(count).collect()).collect()
}

fn flux(vpls: &[Vpl]) -> DVec3 {
    vpls.iter().map(|vpl| vpl.flux).sum()
}

fn white_room(albedo: [f32; 3]) -> Scene {
    let mut scene = closed_box(1.0, lambert(albedo));
    add_light(&mut scene, LightKind::Point, DVec3::new(0.2, 0.3, -0.1), DVec3::NEG_Y, [3.0, 2.0, 1.0]);
    scene
}

/// The VPLs of a bounce carry nearly the same flux, so which of them go on makes little difference to the sum.
#[test]
fn each_bounce_carries_what_the_walls_reflect_of_the_one_before() {
    let session = Session::open();
    let albedo = DVec3::new(0.75, 0.5, 0.25);
    let room = white_room(albedo.to_array().map(|channel| channel as f32));
    let fluxes: Vec<DVec3> = bounces(&session, &room, &[512, 342, 228, 152]).iter().map(|vpls| flux(vpls)).collect();
    for pair in fluxes.windows(2) {
        let error = (pair[1] / (pair[0] * albedo) - 1.0).abs().max_element();
        println!("{:.4} W of {:.4} W: {error:.2e} off", pair[1], pair[0] * albedo);
        assert!(error < 0.04, "{} W, not {} W", pair[1], pair[0] * albedo);
    }
}

/// More VPLs than the software driver lets one loop go through: were those beyond lost, the second bounce would be.
#[test]
fn light_of_very_many_vpls_is_all_gathered() {
    let session = Session::open();
    let room = white_room([0.7; 3]);
    let image = |count: &str| {
        let settings = vpl_settings(&[("vpl.count", count), ("vpl.bounces", "2"), ("lights.resolution", "64")]);
        let camera = view(DVec3::new(0.1, 0.2, 0.9), DVec3::ZERO);
        let frame = session.render(&room, &settings, &request([4, 4], camera, &[Slot::Diffuse]));
        let channels = frame.slots[&Slot::Diffuse].pixels.as_flattened();
        channels.iter().map(|&channel| f64::from(channel)).sum::<f64>() / channels.len() as f64
    };
    let [few, many] = ["2048", "65536"].map(image);
    println!("{few:.4} W/(m² sr) of 2,048 VPLs, {many:.4} of 65,536");
    assert!((many / few - 1.0).abs() < 0.03, "{many}, not {few}");
}

#[test]
fn paths_end_on_the_walls_and_cover_them() {
    let session = Session::open();
    let bounces = bounces(&session, &white_room([0.5; 3]), &[256, 171]);
    let mut of_wall = [0_u32; 6];
    for vpl in &bounces[1] {
        let point = vpl.texels[0].truncate().as_dvec3();
        let normal = twins::unpack_direction_in_float_unnormalized(vpl.texels[1].w).normalize().as_dvec3();
        let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
        assert!((point[axis] + normal[axis].signum()).abs() < 1e-4, "{point} is not on the wall that faces {normal}");
        of_wall[2 * axis + usize::from(normal[axis] < 0.0)] += 1;
    }
    assert!(of_wall.iter().all(|&count| count >= 14), "VPLs of each wall: {of_wall:?} of 171");
    // Each disc has the area that its VPL stands for, times the overlap.
    let area: f64 = bounces[1].iter().map(|vpl| f64::from(vpl.texels[0].w) * std::f64::consts::PI / 5.0).sum();
    assert!((area / 24.0 - 1.0).abs() < 0.1, "their discs have {area} m² of the walls' 24 m²");
}

#[test]
fn what_leaves_the_scene_is_gone() {
    let session = Session::open();
    let mut open = floor(1.0, lambert([0.8; 3]));
    add_light(&mut open, LightKind::Point, DVec3::new(0.0, 0.5, 0.0), DVec3::NEG_Y, [5.0; 3]);
    let bounces = bounces(&session, &open, &[64, 43, 29]);
    assert!(flux(&bounces[0]).x > 1.0);
    assert_eq!((flux(&bounces[1]), flux(&bounces[2])), (DVec3::ZERO, DVec3::ZERO));
}

#[test]
fn one_light_or_textures_do_and_repeats_give_the_same_bits() {
    let session = Session::open();
    for (name, counts) in [("cornell-point", &[1, 1, 1][..]), ("textured", &[33, 22, 15, 10]), ("ring", &[64, 43])] {
        let scene = builtin(name);
        let bits = || -> Vec<u32> {
            let bounces = bounces(&session, &scene, counts);
            let before = flux(&bounces[0]).max_element();
            for vpl in bounces.iter().flatten() {
                assert!(
                    vpl.flux.min_element() >= 0.0 && vpl.flux.max_element() <= 1.51 * before,
                    "{name}: {}",
                    vpl.flux
                );
                assert!(vpl.texels[0].is_finite() && vpl.texels[0].w > 0.0);
            }
            let texels = bounces.into_iter().flatten().flat_map(|vpl| vpl.texels);
            texels.flat_map(|texel| texel.to_array().map(f32::to_bits)).collect()
        };
        assert!(bits() == bits(), "{name}: other bits");
    }
}

/// What the light views leave unchanged stands: VPLs, paths and maps when the camera moves, everything when nothing does.
#[test]
fn what_did_not_change_does_not_run() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    for visibility in ["ism", "traced"] {
        let settings = vpl_settings(&[("vpl.visibility", visibility), ("vpl.count", "16"), ("vpl.bounces", "2")]);
        let mut renderer = session.renderer(&settings);
        let mut request = request([24, 16], scene.camera_view(None).expect("its camera"), &[]);
        request.timing = Timing::Passes;
        let mut ran = |request: &FrameRequest| -> Vec<String> {
            let frame = renderer.render(&scene, request).expect("a frame");
            let passes = frame.timings.passes.into_iter().filter(|pass| pass.skipped.is_none());
            passes.map(|pass| pass.pass).collect()
        };
        assert!(ran(&request).iter().any(|pass| pass.starts_with("paths/vpls")));
        assert!(ran(&request).is_empty(), "{visibility}");
        request.camera.world.translation += DVec3::new(0.05, 0.0, 0.0);
        let moved = ran(&request);
        assert!(moved.iter().any(|pass| pass.starts_with("gather/")), "{visibility}: {moved:?}");
        let stands = |pass: &String| !["vpls/", "paths/", "visibility/"].iter().any(|level| pass.starts_with(level));
        assert!(moved.iter().all(stands), "{visibility}: {moved:?}");
    }
}
