//! Photons where they start: how many, with which flux.

use std::f64::consts::PI;

use glam::DVec3;

use super::photons_probe::{photon_settings, photons, total};
use super::scenes::{add_light, builtin, closed_box};
use super::session::Session;
use crate::renderer::Timing;
use crate::scene::{LightKind, Material, Scene};

fn mirror() -> Material {
    Material { metallic: 1.0, roughness: 0.0, ..Material::default() }
}

fn mirror_box(kind: LightKind) -> Scene {
    let mut scene = closed_box(1.0, mirror());
    add_light(&mut scene, kind, DVec3::new(0.2, 0.3, -0.1), DVec3::new(0.3, -0.8, 0.1), [2.0, 1.0, 0.25]);
    scene
}

#[test]
fn photons_carry_the_flux_that_specular_surfaces_receive() {
    let session = Session::open();
    let scene = mirror_box(LightKind::Point);
    let expected = 4.0 * PI * DVec3::new(2.0, 1.0, 0.25);
    for most in ["1", "100", "38000", "1000000"] {
        let settings =
            photon_settings(&[("photons.max", most), ("photons.bounces", "1"), ("lights.resolution", "128")]);
        let found = photons(&session, &scene, &settings, Timing::Frame);
        let flux = total(found.arrivals.iter().map(|photon| photon.flux));
        println!("{most}: level {}, {} photons, {flux} W of {expected} W", found.level, found.emitted);
        assert!(found.emitted <= most.parse().expect("a number") && found.emitted > 0);
        assert_eq!(found.emitted, found.arrivals.len());
        assert!(((flux - expected) / expected).abs().max_element() < 1e-3, "{flux} W of {expected} W");
    }
}

#[test]
fn ring() {
    let session = Session::open();
    let settings = photon_settings(&[]);
    let found = photons(&session, &builtin("ring"), &settings, Timing::Passes);
    for pass in &found.passes {
        println!("{} {} {:?} {:?} {:?}", pass.piece, pass.pass, pass.ms, pass.skipped, pass.work);
    }
    println!("emitted {}, rays {:?}, landed {}", found.emitted, found.ray_counts, found.landed.len());
}
