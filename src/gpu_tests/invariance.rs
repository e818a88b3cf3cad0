//! A scene that is scaled, turned or moved as a whole, with its lights and its camera, gives the same image.
//!
//! Asserted, with the mean of the original's channels as unit, for the 99.9 % of the pixels that are least off (the others
//! are silhouettes, where a pixel shows one surface or the other): the root of their mean squared difference is below 10⁻³,
//! for the image and for direct light; and no pixel of direct light is off by more than 10⁻³, none of the image by 10⁻².
//!
//! Single pixels of the image are held to less: a virtual light sits on a texel of a light view, and where its share of the flux
//! ends at a silhouette there, rounding may put it on either side. Moving alone gives the same bits.

use glam::{DAffine3, DQuat, DVec3};

use super::scenes::{builtin, request, settings};
use super::session::Session;
use crate::renderer::{ColorImage, Frame, Slot};
use crate::scene::{Camera, CameraId, LightId, LightKind, NodeId, Projection, Scene};

const BOUND: f64 = 1e-3;
/// Over the bound, where a rasteriser moves vertices to 1/16 of a pixel instead of 1/256: so much farther may rounding move an edge.
const COARSE: f64 = 5.0;

/// Applies `transform` to everything; `scale` is the factor that it holds.
pub(super) fn transformed(scene: &Scene, transform: DAffine3, scale: f64) -> Scene {
    let mut copy = scene.clone();
    let roots: Vec<_> = scene.nodes().iter().enumerate().filter(|(_, node)| node.parent.is_none()).collect();
    for (index, node) in roots {
        copy.set_local_transform(NodeId(index), transform * node.local).expect("a finite transform");
    }
    for (index, camera) in scene.cameras().iter().enumerate() {
        let projection = match camera.projection {
            Projection::Perspective { vertical_fov, aspect, near } => {
                Projection::Perspective { vertical_fov, aspect, near: near * scale }
            }
            Projection::Orthographic { half_width, half_height, near, far } => Projection::Orthographic {
                half_width: half_width * scale,
                half_height: half_height * scale,
                near: near * scale,
                far: far * scale,
            },
        };
        copy.set_camera(CameraId(index), Camera { projection, ..camera.clone() }).expect("a sound camera");
    }
    for (index, light) in scene.lights().iter().enumerate() {
        // The same irradiance at a distance that is longer by the factor.
        let factor = if light.kind == LightKind::Directional { 1.0 } else { (scale * scale) as f32 };
        let light = crate::scene::Light {
            intensity: light.intensity.map(|channel| channel * factor),
            range: light.range.map(|range| range * scale as f32),
            ..light.clone()
        };
        copy.set_light(LightId(index), light).expect("a sound light");
    }
    copy
}

/// How far two images are apart, over the mean of the first; without the thousandth of the pixels that is furthest off.
pub(super) struct Difference {
    pub(super) rmse: f64,
    pub(super) most: f64,
}

pub(super) fn difference(original: &ColorImage, copy: &ColorImage) -> Difference {
    let channels = original.pixels.iter().flatten().map(|&channel| f64::from(channel));
    let mean = channels.sum::<f64>() / (3.0 * original.pixels.len() as f64);
    let off = |(before, after): (&[f32; 3], &[f32; 3])| {
        let channels = [0, 1, 2].map(|channel| f64::from(after[channel]) - f64::from(before[channel]));
        channels.iter().fold(0.0, |most: f64, off| most.max(off.abs())) / mean
    };
    let mut pixels: Vec<f64> = original.pixels.iter().zip(&copy.pixels).map(off).collect();
    pixels.sort_by(f64::total_cmp);
    pixels.truncate(pixels.len() * 999 / 1000);
    let squares: f64 = pixels.iter().map(|off| off * off).sum();
    Difference { rmse: (squares / pixels.len() as f64).sqrt(), most: pixels.last().copied().unwrap_or(0.0) }
}

fn assert_invariant(what: &str, transform: DAffine3, scale: f64) {
    let session = Session::open();
    let settings = settings(&[]);
    let coarse = session.context.shared_device().traits().plane_depths;
    let bound = if coarse { COARSE * BOUND } else { BOUND };
    for name in ["cornell-spot", "cornell-panel", "lights"] {
        let scene = builtin(name);
        let image = |scene: &Scene| {
            let camera = scene.camera_view(None).expect("its camera");
            session.render(scene, &settings, &request([120, 90], camera, &[Slot::Direct, Slot::Diffuse]))
        };
        let (original, copy) = (image(&scene), image(&transformed(&scene, transform, scale)));
        let of = |what: &str, original: &ColorImage, copy: &ColorImage| {
            let found = difference(original, copy);
            println!("{name} {what}: rmse {:.1e}, at most {:.1e}", found.rmse, found.most);
            found
        };
        let slots = |slot: Slot| of(&format!("{what}, {slot}"), &original.slots[&slot], &copy.slots[&slot]);
        let (direct, _) = (slots(Slot::Direct), slots(Slot::Diffuse));
        let image = |frame: &Frame| frame.image.clone().expect("it was asked for");
        let whole = of(what, &image(&original), &image(&copy));
        let rmse = direct.rmse.max(whole.rmse);
        assert!(rmse <= bound, "{name} {what}: rmse {rmse:.1e}");
        assert!(direct.most <= bound, "{name} {what}: pixels of direct light {:.1e}", direct.most);
        assert!(whole.most <= 10.0 * bound, "{name} {what}: pixels {:.1e}", whole.most);
    }
}

#[test]
fn a_scene_of_millimetres_gives_the_same_image() {
    assert_invariant("scaled by 10⁻³", DAffine3::from_scale(DVec3::splat(1e-3)), 1e-3);
}

#[test]
fn a_scene_of_kilometres_gives_the_same_image() {
    assert_invariant("scaled by 10³", DAffine3::from_scale(DVec3::splat(1e3)), 1e3);
}

#[test]
fn a_turned_scene_gives_the_same_image() {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, -0.7, 0.5).normalize(), 1.234);
    assert_invariant("turned", DAffine3::from_quat(turn), 1.0);
}

#[test]
fn a_scene_far_from_the_origin_gives_the_same_image() {
    assert_invariant("moved by 10⁵ m", DAffine3::from_translation(DVec3::new(6e4, -5e4, 6.2e4)), 1.0);
}
