//! Virtual point lights stand for all reflected flux, and lights share their number by flux.

use glam::DVec3;

use super::probe::{light_flux, probe, vpls};
use super::scenes::{builtin, four_rooms, request, settings, view};
use super::session::Session;
use crate::renderer::FrameRequest;
use crate::scene::Scene;

const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// Relative difference, channel by channel, of the flux of all VPLs to that of all texels.
fn flux_error(session: &Session, scene: &Scene, request: &FrameRequest, count: u32) -> f64 {
    let settings = settings(&[("rsm.vpls", &count.to_string()), ("lights.resolution", "256")]);
    let frame = probe(session, scene, &settings, request, |graph, declared| {
        vec![light_flux(graph, declared), vpls(graph, declared)]
    });
    let (texels, sum) = frame.reflected_and_carried([0, 1], count);
    let error = ((sum - texels) / texels).abs().max_element();
    println!("{}, {count} VPLs: {sum:.4} W, relative error {error:.2e}", scene.name);
    error
}

#[test]
fn the_lights_carry_all_reflected_flux() {
    let session = Session::open();
    for name in ["cornell-point", "lights", "cornell-panel", "textured"] {
        let scene = builtin(name);
        let request = request([8, 8], scene.camera_view(None).expect("its camera"), &[]);
        for count in [1, 7, 256, 4096] {
            assert!(flux_error(&session, &scene, &request, count) < 1e-5);
        }
    }
}

#[test]
fn lights_share_the_number_by_flux() {
    let session = Session::open();
    let scene = four_rooms();
    let request = request([8, 8], view(DVec3::new(0.5, 0.5, 0.5), DVec3::ZERO), &[]);
    let count = 2000.0;
    let settings = settings(&[("rsm.vpls", "2000"), ("lights.resolution", "128")]);
    let frame = probe(&session, &scene, &settings, &request, |graph, declared| {
        vec![light_flux(graph, declared), vpls(graph, declared)]
    });
    let fluxes = frame.flux_of_lights(0);
    let total: f64 = fluxes.iter().map(|flux| flux.dot(LUMINANCE)).sum();
    let vpls = frame.vpls(1);
    for (index, flux) in fluxes.iter().enumerate() {
        let of_room = |x: f32| (f64::from(x) + frame.origin.x - 10.0 * index as f64).abs() < 2.0;
        let own: Vec<_> = vpls.iter().filter(|vpl| of_room(vpl.texels[0].x)).collect();
        let expected = count * flux.dot(LUMINANCE) / total;
        println!("room {index}: {} VPLs of {expected:.2}", own.len());
        assert!((own.len() as f64 - expected).abs() <= 1.0, "room {index}: {} VPLs of {expected}", own.len());
        // So does the flux that they carry, but for the lights that stand for the end of one room and the start of the next.
        let carried: f64 = own.iter().map(|vpl| vpl.flux.dot(LUMINANCE)).sum();
        assert!((carried - flux.dot(LUMINANCE)).abs() <= 1.001 * total / count);
    }
    let luminances: Vec<f64> = vpls.iter().map(|vpl| vpl.flux.dot(LUMINANCE)).collect();
    let off = luminances.iter().map(|own| (own * count / total - 1.0).abs()).fold(0.0, f64::max);
    println!("largest deviation of a VPL from the mean luminance: {off:.2e}");
    assert!(off < 1e-2, "every light stands for the same luminance, one is {off} off");
}
