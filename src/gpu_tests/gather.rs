//! `rsm` against its definition: the sum over the virtual point lights, in f64 on the host, at every pixel.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::probe::{Pixel, Vpl, diffuse_and_its, probe, vpls};
use super::scenes::{builtin, request, settings};
use super::session::Session;

const SIZE: [u32; 2] = [64, 48];

/// Σ Φ/π · (n·−ω)⁺ (n_x·ω)⁺ / (d² + A/π), W/m².
fn irradiance(vpls: &[Vpl], pixel: &Pixel) -> DVec3 {
    let of_light = |vpl: &Vpl| {
        let (cosines, squared) = vpl.cosines_and_square(pixel);
        vpl.flux * (FRAC_1_PI * cosines / (squared + f64::from(vpl.texels[0].w)))
    };
    vpls.iter().map(of_light).sum()
}

#[test]
fn a_pixel_gathers_the_sum_over_all_lights() {
    let session = Session::open();
    for (name, count) in
        [("cornell-empty", "256"), ("cornell-empty", "1024"), ("cornell-panel", "100"), ("lights", "64")]
    {
        let scene = builtin(name);
        let request = request(SIZE, scene.camera_view(None).expect("its camera"), &[]);
        let settings = settings(&[("rsm.vpls", count)]);
        let frame = probe(&session, &scene, &settings, &request, |graph, declared| {
            diffuse_and_its(vpls(graph, declared), graph, declared)
        });
        let lights = frame.vpls(3);
        let diffuse_alone = !scene.facts().specular;
        let (mut worst, mut of_maximum) = (0.0_f64, 0.0_f64);
        let found = frame.colors(2);
        let maximum = found.iter().map(|radiance| radiance.max_element()).fold(0.0, f64::max);
        assert!(maximum > 0.0);
        for (pixel, found) in frame.pixels([0, 1], SIZE).iter().zip(&found) {
            let Some(pixel) = pixel else {
                assert_eq!(*found, DVec3::ZERO, "nothing is where nothing is");
                continue;
            };
            assert!(diffuse_alone, "the test knows no specular layer");
            let expected = pixel.albedo * FRAC_1_PI * irradiance(&lights, pixel);
            let error = (*found - expected).abs();
            worst = worst.max((error / expected.max(DVec3::splat(1e-3 * maximum))).max_element());
            of_maximum = of_maximum.max(error.max_element() / maximum);
        }
        println!("{name}, {count} VPLs: error {worst:.2e} of the pixel, {of_maximum:.2e} of the image's maximum");
        assert!(worst <= 1e-4, "{name}: {worst:.2e}");
    }
}

/// The packing that shader and twin share.
#[test]
fn lights_lie_on_the_walls_and_face_the_room() {
    let session = Session::open();
    let scene = builtin("cornell-empty");
    let bounds = scene.bounds().expect("a room");
    let request = request([8, 8], scene.camera_view(None).expect("its camera"), &[]);
    let frame = probe(&session, &scene, &settings(&[]), &request, |graph, declared| vec![vpls(graph, declared)]);
    frame.assert_vpls_on_walls(0, &bounds);
}
