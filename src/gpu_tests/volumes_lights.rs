//! The virtual area lights of `volumes`: they carry all reflected flux, lie on surfaces, and none is dark.

use std::f64::consts::PI;

use glam::DVec3;

use super::flux::spot_power;
use super::probe::{Probe, Vpl, light_flux, probe};
use super::scenes::{add_light, builtin, closed_box, lambert, request, settings_of, view};
use super::session::Session;
use crate::frame::twins;
use crate::renderer::{FrameRequest, Technique};
use crate::scene::{LightKind, Scene};

/// The flux of the light views, the lights, how many lights and groups there are.
fn reduced(session: &Session, scene: &Scene, request: &FrameRequest, changes: &[(&str, &str)]) -> Probe {
    let settings = settings_of(Technique::Volumes, changes);
    probe(session, scene, &settings, request, |graph, declared| {
        let lights = declared.volumes.as_ref().expect("volumes runs").lights.as_deref().expect("light views");
        let reads = [graph.read_back_buffer(lights.lights), graph.read_back_buffer(lights.counts)];
        [light_flux(graph, declared)].into_iter().chain(reads).collect()
    })
}

/// The lights of a probe.
fn lights(frame: &Probe) -> Vec<Vpl> {
    let count = frame.floats(2)[0].to_bits() as usize;
    frame.vpls(1).into_iter().take(count).collect()
}

#[test]
fn lights_carry_all_reflected_flux() {
    let session = Session::open();
    for name in ["cornell-point", "cornell-spot", "lights", "cornell-panel", "textured"] {
        let scene = builtin(name);
        let request = request([8, 8], scene.camera_view(None).expect("its camera"), &[]);
        for (side, lod) in [("16", "0"), ("64", "2"), ("512", "4")] {
            let changes = [
                ("volumes.lights", side),
                ("volumes.lod", lod),
                ("lights.resolution", "128"),
                ("volumes.area_lights", "views"),
            ];
            let frame = reduced(&session, &scene, &request, &changes);
            let (lights, texels) = (lights(&frame), frame.flux_of_lights(0).into_iter().sum::<DVec3>());
            assert!(lights.iter().all(|light| light.flux.max_element() > 0.0), "{name}: a light without flux");
            let sum: DVec3 = lights.iter().map(|light| light.flux).sum();
            let error = ((sum - texels) / texels).abs().max_element();
            println!("{name}, {side}²: {} lights, relative error {error:.2e}", lights.len());
            assert!(error <= 2e-6, "{name}, {side}²: {sum} W of {texels} W");
        }
    }
}

/// In a closed white box: what a spot sends out is what the lights carry.
#[test]
fn lights_carry_what_a_spot_sends() {
    let session = Session::open();
    for degrees in [15_f64, 30.0, 45.0, 60.0] {
        let mut scene = closed_box(1.0, lambert([1.0; 3]));
        let (inner, outer) = ((0.5 * degrees).to_radians(), degrees.to_radians());
        let kind = LightKind::Spot { inner_angle: inner as f32, outer_angle: outer as f32 };
        add_light(&mut scene, kind, DVec3::new(0.2, 0.3, -0.1), DVec3::new(0.5, -1.0, 0.3), [3.0, 0.5, 7.0]);
        let request = request([8, 8], view(DVec3::new(0.9, 0.8, 0.7), DVec3::ZERO), &[]);
        let frame = reduced(&session, &scene, &request, &[]);
        let sum: DVec3 = lights(&frame).iter().map(|light| light.flux).sum();
        let expected = DVec3::new(3.0, 0.5, 7.0) * spot_power(f64::from(inner as f32), f64::from(outer as f32));
        let error = ((sum - expected) / expected).abs().max_element();
        println!("{degrees}°: relative error {error:.2e}");
        assert!(error <= 0.005, "{degrees}°: {sum} W of {expected} W");
    }
}

#[test]
fn lights_lie_on_the_walls() {
    let session = Session::open();
    let scene = builtin("cornell-empty");
    let bounds = scene.bounds().expect("a room");
    let request = request([8, 8], scene.camera_view(None).expect("its camera"), &[]);
    for side in ["16", "64", "128"] {
        let frame = reduced(&session, &scene, &request, &[("volumes.lights", side)]);
        for light in lights(&frame) {
            let point = light.texels[0].truncate().as_dvec3() + frame.origin;
            let off =
                (0..3).map(|axis| (point[axis] - bounds.min[axis]).abs().min((point[axis] - bounds.max[axis]).abs()));
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off < 1e-3 * bounds.radius(), "{side}²: a light {off} m off the walls at {point}");
            let inward = (bounds.min + bounds.max) * 0.5 - point;
            let normal = twins::unpack_direction_in_float_unnormalized(light.texels[1].w).as_dvec3();
            assert!(normal.dot(inward) > 0.0, "it faces the room");
        }
    }
}

/// On a flat floor seen along its normal: the area of a disc is the surface that the texels of its block see, and the paper's is π times that in the denominator.
#[test]
fn areas_add_up_to_the_lit_floor() {
    let session = Session::open();
    let mut scene = super::scenes::floor(1.0, lambert([0.5; 3]));
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    let request = request([8, 8], view(DVec3::new(0.0, 2.0, 0.1), DVec3::ZERO), &[]);
    for (form, factor) in [("disc", 1.0), ("paper", PI)] {
        let frame = reduced(&session, &scene, &request, &[("volumes.val", form)]);
        let area: f64 = lights(&frame).iter().map(|light| PI * f64::from(light.texels[0].w)).sum();
        assert!((area / (4.0 * factor) - 1.0).abs() < 0.01, "{form}: {area} m²");
    }
}
