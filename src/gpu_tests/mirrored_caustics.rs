//! Caustics in what mirrors and glass show: against closed forms, in which slot they are, and what is not done.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::{DAffine3, DVec3};

use super::blocks::assert_close;
use super::path_probe::{Ask, Tracer};
use super::scenes::{add_light, floor, lambert, place, quad, request, view};
use super::session::Session;
use crate::renderer::{DirectMethod, Frame, FrameRequest, Preset, Settings, Slot, SpecularMethod, Technique, Timing};
use crate::scene::{CameraView, LightKind, Material, Projection, Scene};
use crate::slot::{CausticPaths, PixelFilter};

const SIZE: [u32; 2] = [64, 48];
const ALBEDO: f64 = 0.6;

/// One reflection before the eye and one of photons.
fn settings(caustics: &str, changes: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(Technique::Direct, Preset::Default);
    settings.methods.direct = DirectMethod::Traced;
    settings.methods.specular = SpecularMethod::Trace;
    settings.methods.set(Slot::Caustics, caustics).expect("a method");
    let few = [("trace.depth", "1"), ("photons.bounces", "1"), ("points.bounces", "1")];
    for (key, value) in few.iter().chain(changes) {
        settings.set(key, value).expect("a setting and its value");
    }
    settings
}

fn specular(frame: &Frame) -> Vec<DVec3> {
    frame.slots[&Slot::Specular].pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).collect()
}

fn asked(camera: &CameraView) -> FrameRequest {
    FrameRequest { image: false, ..request(SIZE, camera.clone(), &[Slot::Specular]) }
}

fn mirror() -> Material {
    Material { metallic: 1.0, roughness: 0.0, ..Material::default() }
}

/// A spot light whose cone holds a square plate of metal, which reflects it to a floor; a mirror shows that to the camera.
struct Reflector {
    scene: Scene,
    camera: CameraView,
    plate: DVec3,
    axes: [DVec3; 2],
    /// The light's image behind the plate.
    image: DVec3,
    intensity: DVec3,
}

/// Of the plate.
const HALF: f64 = 0.15;
/// The mirror's plane.
const MIRROR_Z: f64 = -2.0;

fn reflector() -> Reflector {
    let mut scene = floor(4.0, lambert([ALBEDO as f32; 3]));
    let metal = scene.add_material(mirror()).expect("sound");
    let wall = [[-4.0, 0.0, -2.0], [4.0, 0.0, -2.0], [4.0, 4.0, -2.0], [-4.0, 4.0, -2.0]];
    place(&mut scene, vec![quad(wall, metal)], DAffine3::IDENTITY);
    let (light, plate, target) = (DVec3::new(-0.4, 2.0, -0.6), DVec3::new(0.8, 0.8, -0.6), DVec3::new(-0.6, 0.0, -0.7));
    let normal = ((light - plate).normalize() + (target - plate).normalize()).normalize();
    let u = normal.cross(DVec3::Y).normalize();
    let axes = [u, normal.cross(u)];
    let corner = |x: f64, y: f64| (plate + HALF * (x * axes[0] + y * axes[1])).as_vec3().to_array();
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    place(&mut scene, vec![quad(corners, metal)], DAffine3::IDENTITY);
    let intensity = [9.0, 6.0, 3.0];
    let spot = LightKind::Spot { inner_angle: 0.2, outer_angle: 0.22 };
    add_light(&mut scene, spot, light, plate - light, intensity);
    let image = light - 2.0 * (light - plate).dot(normal) * normal;
    let mut camera = view(DVec3::new(-0.3, 3.4, 1.5), DVec3::new(-0.65, 0.0, -3.3));
    camera.projection = Projection::Perspective { vertical_fov: 0.24, aspect: None, near: 0.01 };
    Reflector { scene, camera, plate, axes, image, intensity: DVec3::from(intensity.map(f64::from)) }
}

impl Reflector {
    /// Where on the floor the mirror shows what is at a place of the picture, as if the mirror were a window.
    fn on_floor(&self, x: f64, y: f64) -> Option<DVec3> {
        let Projection::Perspective { vertical_fov, .. } = self.camera.projection else { unreachable!("it is one") };
        let [width, height] = SIZE.map(f64::from);
        let half = (0.5 * vertical_fov).tan();
        let local = DVec3::new(half * width / height * (2.0 * x / width - 1.0), half * (1.0 - 2.0 * y / height), -1.0);
        let (eye, way) = (self.camera.world.translation, self.camera.world.transform_vector3(local));
        let at = eye - way * (eye.y / way.y);
        (way.y < 0.0 && at.z < MIRROR_Z).then(|| DVec3::new(at.x, 0.0, 2.0 * MIRROR_Z - at.z))
    }

    /// The place on the plate that the light to a point of the floor comes from, in halves of its side.
    fn on_plate(&self, point: DVec3) -> [f64; 2] {
        let normal = self.axes[0].cross(self.axes[1]);
        let way = point - self.image;
        let at = self.image + way * ((self.plate - self.image).dot(normal) / way.dot(normal));
        self.axes.map(|axis| (at - self.plate).dot(axis) / HALF)
    }

    fn irradiance(&self, point: DVec3) -> DVec3 {
        let way = self.image - point;
        self.intensity * (way.normalize().y / way.length_squared())
    }

    /// What the plate receives, W.
    fn flux(&self) -> DVec3 {
        let normal = self.axes[0].cross(self.axes[1]);
        let steps = 64;
        let step = |index: usize| (2.0 * index as f64 + 1.0) / steps as f64 - 1.0;
        let places = (0..steps * steps).map(|index| [step(index % steps), step(index / steps)]);
        let solid_angle = places.map(|[x, y]| {
            let way = self.plate + HALF * (x * self.axes[0] + y * self.axes[1]) - self.image;
            way.normalize().dot(normal).abs() / way.length_squared()
        });
        self.intensity * (solid_angle.sum::<f64>() * (2.0 * HALF / steps as f64).powi(2))
    }
}

/// The flux that the mirror shows is what landed; where the plate's light falls it is that of the lamp's image.
#[test]
fn a_mirror_shows_the_caustic_on_the_floor() {
    let session = Session::open();
    let shown = reflector();
    let without = specular(&session.render(&shown.scene, &settings("none", &[]), &asked(&shown.camera)));
    for caustics in ["photons", "points"] {
        let with = specular(&session.render(&shown.scene, &settings(caustics, &[]), &asked(&shown.camera)));
        let (mut flux, mut inside, mut most_off) = (DVec3::ZERO, Vec::new(), 0.0_f64);
        for (index, (with, without)) in with.iter().zip(&without).enumerate() {
            let [x, y] = [index % SIZE[0] as usize, index / SIZE[0] as usize].map(|place| place as f64);
            let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.5)];
            let [a, b, c, d, middle] = corners.map(|(dx, dy)| shown.on_floor(x + dx, y + dy));
            let (Some(a), Some(b), Some(c), Some(d), Some(middle)) = (a, b, c, d, middle) else { continue };
            let irradiance = (*with - *without) * (PI / ALBEDO);
            assert!(irradiance.min_element() >= -1e-5, "{irradiance}");
            flux += irradiance * (0.5 * (c - a).cross(d - b).length());
            let [u, v] = shown.on_plate(middle).map(f64::abs);
            if u.max(v) < 0.7 {
                let ratio = irradiance / shown.irradiance(middle);
                inside.push(ratio);
                most_off = most_off.max((ratio - 1.0).abs().max_element());
            }
            assert!(u.max(v) < 1.5 || irradiance.max_element() == 0.0, "{caustics}: {irradiance} at {u}, {v}");
        }
        let ratio = flux / shown.flux();
        let mean = inside.iter().sum::<DVec3>() / inside.len() as f64;
        println!("{caustics}: flux {ratio:.4}, inside {mean:.4} of {}, off by {most_off:.4} at most", inside.len());
        assert!((ratio - 1.0).abs().max_element() < 0.02, "{caustics}: flux {ratio}");
        assert!(inside.len() > 100 && (mean - 1.0).abs().max_element() < 0.02, "{caustics}: inside {mean}");
        assert!(most_off < 0.15, "{caustics}: off by {most_off}");
    }
}

/// A floor under a pane that the sun shines through, seen from above.
#[test]
fn glass_shows_the_floor_that_the_sun_lights_through_it() {
    let session = Session::open();
    let tint = DVec3::new(0.9, 0.7, 0.5);
    let mut scene = floor(8.0, lambert([ALBEDO as f32; 3]));
    let pane = Material {
        transmission: 1.0,
        roughness: 0.0,
        base_color: tint.as_vec3().extend(1.0).to_array(),
        ..Material::default()
    };
    let pane = scene.add_material(pane).expect("sound");
    let corners = [[-8.0, 1.0, -8.0], [-8.0, 1.0, 8.0], [8.0, 1.0, 8.0], [8.0, 1.0, -8.0]];
    place(&mut scene, vec![quad(corners, pane)], DAffine3::IDENTITY);
    let to_sun = DVec3::new(0.4, 1.0, 0.3).normalize();
    let sun = [4.0, 3.0, 2.0];
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, -to_sun, sun);
    let mut camera = view(DVec3::new(0.0, 4.0, 1.5), DVec3::new(0.2, 0.0, 0.1));
    camera.projection = Projection::Perspective { vertical_fov: 0.3, aspect: None, near: 0.01 };
    let to_eye = (camera.world.translation - DVec3::new(0.2, 0.0, 0.1)).normalize();
    let passed = |cosine: f64| tint * (1.0 - 0.04 - 0.96 * (1.0 - cosine).powi(5));
    let expected =
        DVec3::from(sun.map(f64::from)) * to_sun.y * passed(to_sun.y) * passed(to_eye.y) * (ALBEDO * FRAC_1_PI);
    let black = specular(&session.render(&scene, &settings("none", &[]), &asked(&camera)));
    assert!(black.iter().all(|pixel| pixel.max_element() == 0.0), "rays to lights end at glass");
    for caustics in ["photons", "points"] {
        let changes = [("photons.max", "200000"), ("points.photons", "200000"), ("lights.resolution", "256")];
        let frame = session.render(&scene, &settings(caustics, &changes), &asked(&camera));
        let pixels = specular(&frame);
        assert_close(caustics, &pixels, &vec![expected; pixels.len()], 0.02, 0.05);
    }
}

#[test]
fn a_second_run_has_the_same_bits_and_slots_alone_too() {
    let session = Session::open();
    let shown = reflector();
    let bits = |frame: &Frame| frame.slots[&Slot::Specular].pixels.as_flattened().iter().map(|v| v.to_bits()).collect();
    for caustics in ["photons", "points"] {
        let all = request(SIZE, shown.camera.clone(), &Slot::ALL);
        let settings = settings(caustics, &[("trace.supersamples", "4")]);
        let first: Vec<u32> = bits(&session.render(&shown.scene, &settings, &all));
        let mut renderer = session.renderer(&settings);
        let alone = asked(&shown.camera);
        for _ in 0..2 {
            assert!(first == bits(&renderer.render(&shown.scene, &alone).expect("a frame")), "{caustics}");
            renderer.invalidate();
        }
    }
}

#[test]
fn where_no_mirror_is_in_view_no_photon_is_readied() {
    let session = Session::open();
    let shown = reflector();
    let photons = |camera: &CameraView| {
        let asked = FrameRequest { timing: Timing::Passes, ..asked(camera) };
        let frame = session.render(&shown.scene, &settings("photons", &[]), &asked);
        let place = frame.timings.passes.iter().find(|pass| pass.pass == "mirrored/place").expect("it is declared");
        place.work["photons"]
    };
    assert!(photons(&shown.camera) > 1000);
    assert_eq!(photons(&view(DVec3::new(-2.0, 1.0, 1.0), DVec3::new(-2.2, 0.0, 1.2))), 0);
    let asked = FrameRequest { timing: Timing::Passes, ..asked(&shown.camera) };
    let mut scene = floor(1.0, lambert([0.5; 3]));
    add_light(&mut scene, LightKind::Point, DVec3::Y, DVec3::NEG_Y, [1.0; 3]);
    let matt = session.render(&scene, &settings("photons", &[]), &asked);
    assert!(!matt.timings.passes.iter().any(|pass| pass.full_name().contains("mirrored")));
}

/// The references that this is compared with: all paths, divided between the two slots as rays divide them.
#[test]
fn paths_have_caustics_in_mirrors_beside_what_rays_find() {
    let session = Session::open();
    let mut shown = reflector();
    let lamp = shown.scene.add_material(Material { emissive: [8.0; 3], ..lambert([0.0; 3]) }).expect("sound");
    let corners = [[-1.5, 2.5, -1.5], [0.5, 2.5, -1.5], [0.5, 2.5, 0.5], [-1.5, 2.5, 0.5]];
    place(&mut shown.scene, vec![quad(corners, lamp)], DAffine3::IDENTITY);
    let glass = Material { transmission: 1.0, roughness: 0.0, ..Material::default() };
    let glass = shown.scene.add_material(glass).expect("sound");
    let corners = [[-1.0, 0.6, -1.5], [0.5, 0.6, -1.5], [0.5, 0.6, 0.0], [-1.0, 0.6, 0.0]];
    place(&mut shown.scene, vec![quad(corners, glass)], DAffine3::IDENTITY);
    let camera = view(DVec3::new(-0.3, 0.3, 1.2), DVec3::new(-0.3, 0.8, -2.0));
    let size = [32, 24];
    let slots = |caustics| {
        let ask = Ask { caustics, filter: PixelFilter::Center, ..Ask::new(size, 16, camera.clone()) };
        let traced = Tracer::new(&session).trace(&shown.scene, &ask);
        [Slot::Direct, Slot::Specular].map(|slot| traced.slot(slot).iter().sum::<DVec3>())
    };
    let [all, unmirrored, mirrored] = [CausticPaths::All, CausticPaths::Unmirrored, CausticPaths::Mirrored].map(slots);
    assert_eq!(mirrored[0], unmirrored[0]);
    assert!(mirrored[0].x < all[0].x, "the lamp behind glass is in the other slot: {} {}", mirrored[0], all[0]);
    assert!(mirrored[1].x > 1.02 * unmirrored[1].x, "{} {}", mirrored[1], unmirrored[1]);
    let sums = [mirrored, all].map(|slots| slots[0] + slots[1]);
    assert!((sums[0] / sums[1] - 1.0).abs().max_element() < 1e-4, "{} {}", sums[0], sums[1]);
}
