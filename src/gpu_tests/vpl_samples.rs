//! The virtual point lights of `vpl`: they carry all reflected flux, lights share their number by flux, and they lie on surfaces.

use glam::{DAffine3, DVec3};

use super::probe::{Probe, light_flux, probe};
use super::scenes::{add_light, box_faces, builtin, lambert, place, request, view, vpl_settings};
use super::session::Session;
use crate::frame::twins;
use crate::renderer::FrameRequest;
use crate::scene::{LightKind, Scene};

const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// The flux of the light views and the VPLs of a frame.
fn sampled(session: &Session, scene: &Scene, request: &FrameRequest, count: u32) -> Probe {
    let settings = vpl_settings(&[("vpl.count", &count.to_string()), ("lights.resolution", "128")]);
    probe(session, scene, &settings, request, |graph, declared| {
        let vpls = declared.vpl.as_ref().expect("vpl runs").vpls;
        vec![light_flux(graph, declared), graph.read_back_buffer(vpls)]
    })
}

#[test]
fn vpls_carry_all_reflected_flux() {
    let session = Session::open();
    for name in ["cornell-point", "cornell-spot", "lights", "cornell-panel", "textured"] {
        let scene = builtin(name);
        let request = request([8, 8], scene.camera_view(None).expect("its camera"), &[]);
        for count in [1, 2, 7, 256, 4096] {
            let frame = sampled(&session, &scene, &request, count);
            let texels: DVec3 = frame.flux_of_lights(0).into_iter().sum();
            let vpls = frame.vpls(1);
            assert_eq!(vpls.len(), count as usize);
            assert!(vpls.iter().all(|vpl| vpl.flux.min_element() >= 0.0 && vpl.texels[0].w > 0.0));
            let sum: DVec3 = vpls.iter().map(|vpl| vpl.flux).sum();
            let error = ((sum - texels) / texels).abs().max_element();
            println!("{name}, {count} VPLs: {sum:.4} W, relative error {error:.2e}");
            assert!(error <= 1e-4, "{name}, {count} VPLs: {sum} W of {texels} W");
        }
    }
}

/// More VPLs than blocks of texels: several share one.
#[test]
fn vpls_that_share_texels_carry_all_flux_too() {
    let session = Session::open();
    let scene = builtin("cornell-spot");
    let request = request([8, 8], scene.camera_view(None).expect("its camera"), &[]);
    let frame = sampled(&session, &scene, &request, 20_000);
    let texels: DVec3 = frame.flux_of_lights(0).into_iter().sum();
    let sum: DVec3 = frame.vpls(1).iter().map(|vpl| vpl.flux).sum();
    assert!(((sum - texels) / texels).abs().max_element() <= 1e-4, "{sum} W of {texels} W");
}

/// Four separate rooms in a row, each with its own colour, kind of light and strength.
fn four_rooms() -> Scene {
    let mut scene = Scene::empty("four rooms");
    let spot = LightKind::Spot { inner_angle: 0.4, outer_angle: 0.7 };
    let rooms = [
        ([0.9, 0.1, 0.1], LightKind::Point, [1.0, 2.0, 3.0]),
        ([0.1, 0.8, 0.2], spot, [40.0, 10.0, 10.0]),
        ([0.3, 0.3, 0.9], LightKind::Point, [0.3, 0.2, 0.1]),
        ([0.5, 0.5, 0.5], LightKind::Point, [0.001; 3]),
    ];
    for (index, (albedo, kind, intensity)) in rooms.into_iter().enumerate() {
        let center = DVec3::new(10.0 * index as f64, 0.0, 0.0);
        let wall = scene.add_material(lambert(albedo)).expect("a sound material");
        place(&mut scene, box_faces([1.0; 3], [wall; 6]), DAffine3::from_translation(center));
        add_light(&mut scene, kind, center + DVec3::new(0.1, 0.3, -0.2), DVec3::new(0.2, -1.0, 0.1), intensity);
    }
    scene
}

#[test]
fn lights_share_vpls_by_reflected_flux() {
    let session = Session::open();
    let scene = four_rooms();
    let request = request([8, 8], view(DVec3::new(0.5, 0.5, 0.5), DVec3::ZERO), &[]);
    for count in [3_u32, 10, 256, 1000] {
        let frame = sampled(&session, &scene, &request, count);
        let fluxes: Vec<f64> = frame.flux_of_lights(0).iter().map(|flux| flux.dot(LUMINANCE)).collect();
        let total: f64 = fluxes.iter().sum();
        let mut counts = [0_u32; 4];
        for vpl in frame.vpls(1) {
            let x = f64::from(vpl.texels[0].x) + frame.origin.x;
            counts[(x / 10.0).round().clamp(0.0, 3.0) as usize] += 1;
        }
        for (found, flux) in counts.iter().zip(&fluxes) {
            let share = f64::from(count) * flux / total;
            assert!((f64::from(*found) - share).abs() <= 1.0 + 1e-3, "{counts:?} of {count}, share {share}");
        }
    }
}

#[test]
fn vpls_lie_on_the_walls_and_face_the_room() {
    let session = Session::open();
    let scene = builtin("cornell-empty");
    let bounds = scene.bounds().expect("a room");
    let request = request([8, 8], scene.camera_view(None).expect("its camera"), &[]);
    for count in [5, 256, 4096] {
        let frame = sampled(&session, &scene, &request, count);
        for vpl in frame.vpls(1) {
            let point = vpl.texels[0].truncate().as_dvec3() + frame.origin;
            let normal = twins::unpack_direction_in_float_unnormalized(vpl.texels[1].w).normalize();
            let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
            assert!(normal[axis].abs() > 0.999, "every wall is straight, not {normal}");
            let wall = if normal[axis] > 0.0 { bounds.min[axis] } else { bounds.max[axis] };
            let off = (point[axis] - wall).abs();
            assert!(off < 1e-3 * bounds.radius(), "a light {off} m off its wall at {point}, normal {normal}");
        }
    }
}
