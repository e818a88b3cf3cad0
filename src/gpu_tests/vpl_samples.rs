//! The virtual point lights of `vpl`: they carry all reflected flux, lights share their number by flux, and they lie on surfaces.

use glam::DVec3;

use super::probe::{Probe, light_flux, probe};
use super::scenes::{builtin, four_rooms, request, view, vpl_settings};
use super::session::Session;
use crate::renderer::FrameRequest;
use crate::scene::Scene;

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
            let (texels, sum) = frame.reflected_and_carried([0, 1], count);
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
    let (texels, sum) = frame.reflected_and_carried([0, 1], 20_000);
    assert!(((sum - texels) / texels).abs().max_element() <= 1e-4, "{sum} W of {texels} W");
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
        frame.assert_vpls_on_walls(1, &bounds);
    }
}
