//! Visibility of VPLs: rays against brute force on the host, imperfect shadow maps against rays, and what leaks through walls.

use std::f64::consts::FRAC_1_PI;

use glam::{DAffine3, DVec3};

use super::probe::{Pixel, Vpl, diffuse_and_its, probe};
use super::scenes::{add_light, box_faces, builtin, lambert, place, quad, request, view, vpl_settings};
use super::session::Session;
use crate::renderer::{ColorImage, FrameRequest, Preset, Settings, Slot, Technique};
use crate::scene::{LightKind, Material, Scene};

const SIZE: [u32; 2] = [48, 36];

fn with(visibility: &str, changes: &[(&str, &str)]) -> Settings {
    let mut all = vec![("vpl.visibility", visibility), ("vpl.count", "64"), ("lights.resolution", "64")];
    all.extend(changes);
    vpl_settings(&all)
}

fn diffuse(session: &Session, scene: &Scene, request: &FrameRequest, settings: &Settings) -> ColorImage {
    session.render(scene, settings, request).slots.remove(&Slot::Diffuse).expect("it was asked for")
}

/// Mean over pixels and channels.
fn mean(image: &ColorImage) -> f64 {
    image.pixels.iter().flatten().map(|&channel| f64::from(channel)).sum::<f64>() / (3 * image.pixels.len()) as f64
}

/// rrmse of a against b.
fn relative_error(a: &ColorImage, b: &ColorImage) -> f64 {
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    let squares: f64 = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (squares / (3 * b.pixels.len()) as f64).sqrt() / mean(b)
}

/// A box of 4 m x 2 m x 2 m with a lamp in its left half. A wall across the middle leaves a gap of `gap` metres below the ceiling.
fn halves(gap: f32) -> Scene {
    let mut scene = Scene::empty("halves");
    let material = scene.add_material(Material { double_sided: true, ..lambert([0.7; 3]) }).expect("a sound material");
    let top = 1.0 - gap;
    let wall = [[0.0, -1.0, -1.0], [0.0, -1.0, 1.0], [0.0, top, 1.0], [0.0, top, -1.0]];
    let mut primitives = box_faces([2.0, 1.0, 1.0], [material; 6]);
    primitives.push(quad(wall, material));
    place(&mut scene, primitives, DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(-1.2, -0.1, 0.3), DVec3::NEG_Y, [4.0; 3]);
    scene
}

fn triangles(scene: &Scene, origin: DVec3) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for instance in scene.instances() {
        let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
        let corner = |index: &u32| {
            let position = DVec3::from(primitive.positions[*index as usize].map(f64::from));
            instance.world.transform_point3(position) - origin
        };
        let corners: Vec<DVec3> = primitive.indices.iter().map(corner).collect();
        triangles.extend(corners.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]));
    }
    triangles
}

/// Whether a triangle lies between the two points, ends left out; Möller & Trumbore 1997.
fn blocked(triangles: &[[DVec3; 3]], from: DVec3, to: DVec3) -> bool {
    let direction = to - from;
    triangles.iter().any(|[a, b, c]| {
        let (ab, ac, way) = (*b - *a, *c - *a, from - *a);
        let across = direction.cross(ac);
        let determinant = ab.dot(across);
        let around = way.cross(ab);
        let (u, v) = (way.dot(across) / determinant, direction.dot(around) / determinant);
        let distance = ac.dot(around) / determinant;
        u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 1e-4 && distance < 1.0 - 1e-4
    })
}

/// The VPL's part of a pixel's irradiance, as of a point.
fn point_term(vpl: &Vpl, pixel: &Pixel) -> DVec3 {
    let (cosines, squared) = vpl.cosines_and_square(pixel);
    vpl.flux * (FRAC_1_PI * cosines / squared)
}

/// VPLs that are small beside their distance, so that their discs are points: in a long box, lamp and receivers at its ends.
#[test]
fn rays_find_what_brute_force_finds() {
    let session = Session::open();
    let scene = halves(0.6);
    let eye = view(DVec3::new(0.3, -0.2, 0.4), DVec3::new(2.0, -0.4, -0.3));
    let request = request(SIZE, eye, &[]);
    let settings = with("traced", &[("vpl.shading", "pixels"), ("vpl.count", "4096")]);
    let frame = probe(&session, &scene, &settings, &request, |graph, declared| {
        let lights = graph.read_back_buffer(declared.vpl.as_ref().expect("vpl runs").vpls);
        diffuse_and_its(lights, graph, declared)
    });
    let (triangles, vpls) = (triangles(&scene, frame.origin), frame.vpls(3));
    let pixels = frame.pixels([0, 1], SIZE);
    let found = frame.colors(2);
    let (mut worst, mut lit) = (0.0_f64, 0);
    for (index, pixel) in pixels.iter().enumerate().step_by(29) {
        let pixel = pixel.as_ref().expect("a closed room");
        let expected: DVec3 = vpls
            .iter()
            .map(|vpl| {
                let term = point_term(vpl, pixel);
                let from = pixel.position_rs + pixel.normal * 1e-4;
                let to = vpl.texels[0].truncate().as_dvec3();
                if term == DVec3::ZERO || blocked(&triangles, from, to) { DVec3::ZERO } else { term }
            })
            .sum();
        let expected = pixel.albedo * FRAC_1_PI * expected;
        let error = ((found[index] - expected).abs() / expected.max(DVec3::splat(1e-3))).max_element();
        (worst, lit) = (worst.max(error), lit + u32::from(expected.x > 1e-3));
    }
    println!("rays against brute force: {worst:.3} apart at most, {lit} lit pixels");
    assert!(lit >= 10, "{lit} lit pixels");
    assert!(worst < 0.05, "{worst}");
}

/// With rays a pass takes few VPLs: there are as many passes as the most VPLs need.
#[test]
fn rays_reach_the_most_vpls() {
    let session = Session::open();
    let scene = halves(0.6);
    let request = request([2, 2], view(DVec3::new(0.3, -0.2, 0.4), DVec3::new(-2.0, -0.4, -0.3)), &[Slot::Diffuse]);
    let [few, most] = ["1024", "65536"].map(|count| {
        mean(&diffuse(&session, &scene, &request, &with("traced", &[("vpl.shading", "pixels"), ("vpl.count", count)])))
    });
    println!("{few:.4} of 1,024 VPLs, {most:.4} of 65,536");
    assert!((few / most - 1.0).abs() < 0.05, "{few}, {most}");
}

/// A closed wall between lamp and camera: nothing comes through it, whatever the VPLs and however they are gathered.
#[test]
fn rays_let_nothing_through_a_wall() {
    let session = Session::open();
    let scene = halves(0.0);
    let dark = request(SIZE, view(DVec3::new(0.3, 0.0, 0.5), DVec3::new(1.5, 0.1, -0.8)), &[Slot::Diffuse]);
    for shading in ["pixels", "compute", "stencil"] {
        for bounces in ["1", "3"] {
            let image = diffuse(
                &session,
                &scene,
                &dark,
                &with("traced", &[("vpl.shading", shading), ("vpl.bounces", bounces)]),
            );
            assert_eq!(mean(&image), 0.0, "{shading}, {bounces} bounces");
        }
    }
    assert!(
        mean(&diffuse(&session, &scene, &dark, &with("none", &[]))) > 0.01,
        "without visibility it does come through"
    );
}

#[test]
fn dark_rooms_stay_dark() {
    let session = Session::open();
    let scene = builtin("leak");
    let of = |camera: &str, visibility: &str| {
        let view = scene.camera_view(Some(camera)).expect("one of its cameras");
        mean(&diffuse(&session, &scene, &request(SIZE, view, &[Slot::Diffuse]), &with(visibility, &[])))
    };
    let lit = of("lit", "traced");
    assert!(lit > 0.05, "the lit hall");
    for camera in ["thin", "thick", "sealed"] {
        let [none, ism, traced] = ["none", "ism", "traced"].map(|visibility| of(camera, visibility) / lit);
        println!("{camera}: {none:.1e} without visibility, {ism:.1e} by maps, {traced:.1e} by rays");
        assert!(traced <= 1e-6, "{camera}: {traced:.1e}");
        assert!(ism < 0.5 * none, "{camera}: {ism:.1e} of {none:.1e}");
    }
}

/// A room with a wall to half its height, lit from one side: maps err at edges of shadows, not on flat walls.
#[test]
fn maps_come_close_to_rays() {
    let session = Session::open();
    let scene = halves(0.8);
    for (what, eye, target, bound) in [
        ("the lit half", DVec3::new(-0.3, 0.2, 0.5), DVec3::new(-2.0, -0.4, -0.5), 0.05),
        ("the shaded half", DVec3::new(1.9, 0.6, 0.8), DVec3::new(0.5, -0.5, -0.5), 0.45),
    ] {
        let request = request(SIZE, view(eye, target), &[Slot::Diffuse]);
        let of = |visibility: &str| {
            let settings = with(visibility, &[("vpl.count", "256"), ("vpl.shading", "pixels")]);
            diffuse(&session, &scene, &request, &settings)
        };
        let (maps, rays) = (of("ism"), of("traced"));
        let error = relative_error(&maps, &rays);
        println!("{what}: maps against rays, rrmse {error:.3}, mean ratio {:.3}", mean(&maps) / mean(&rays));
        assert!(error < bound, "{what}: {error}");
    }
}

/// A convex room hides nothing from itself: maps may take away what little is beside the corners.
#[test]
fn an_empty_room_is_not_shadowed_by_its_walls() {
    let session = Session::open();
    let scene = builtin("cornell-empty");
    let request = request(SIZE, scene.camera_view(None).expect("its camera"), &[Slot::Diffuse]);
    let of = |visibility: &str| mean(&diffuse(&session, &scene, &request, &with(visibility, &[])));
    let [none, ism, traced] = ["none", "ism", "traced"].map(of);
    println!("of the light without visibility: {:.4} by maps, {:.4} by rays", ism / none, traced / none);
    assert!((traced / none - 1.0).abs() < 1e-3);
    assert!((0.94..=1.0001).contains(&(ism / none)));
}

#[test]
fn any_map_any_count_and_any_size_give_finite_light_and_the_same_bits() {
    let session = Session::open();
    for name in ["cornell-point", "textured"] {
        let scene = builtin(name);
        for visibility in ["ism", "traced"] {
            let mut renderers = [0, 1].map(|_| session.renderer(&with(visibility, &[])));
            for (count, resolution, points, size) in [
                ("1", "8", "16", [17, 5]),
                ("33", "9", "100", [1, 1]),
                ("130", "33", "70", [33, 21]),
                ("0", "32", "64", [9, 9]),
            ] {
                let request = request(size, scene.camera_view(None).expect("its camera"), &[Slot::Diffuse]);
                let changes = [
                    ("vpl.count", count),
                    ("vpl.ism_resolution", resolution),
                    ("vpl.ism_points", points),
                    ("vpl.bounces", "2"),
                ];
                let settings = with(visibility, &changes);
                let [first, second] = renderers.each_mut().map(|renderer| {
                    renderer.set_settings(settings.clone()).expect("within their ranges");
                    let frame = renderer.render(&scene, &request).expect("a frame");
                    frame.slots[&Slot::Diffuse].clone()
                });
                assert!(first.pixels.iter().flatten().all(|value| value.is_finite() && *value >= 0.0));
                assert_eq!(
                    first.pixels.iter().any(|pixel| pixel[0] > 0.0),
                    count != "0",
                    "{name}, {visibility}, {count} VPLs"
                );
                assert!(first == second, "{name}, {visibility}: other bits");
            }
        }
    }
}

/// Against path tracing of as many bounces: visibility by maps is nearer to the truth than none, by rays nearer still; and so is each bounce
/// more to all light.
#[test]
fn each_step_lowers_the_error() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let request = request(SIZE, scene.camera_view(None).expect("its camera"), &[Slot::Diffuse]);
    let reference = |bounces: &str| {
        let mut settings = Settings::new(Technique::Path, Preset::Default);
        settings.set("path.spp", "256").expect("a number of samples");
        settings.set("path.bounces", bounces).expect("a number of bounces");
        diffuse(&session, &scene, &request, &settings)
    };
    let error = |visibility: &str, bounces: &str, of: &ColorImage| {
        let settings = with(visibility, &[("vpl.count", "256"), ("vpl.bounces", bounces), ("vpl.shading", "pixels")]);
        relative_error(&diffuse(&session, &scene, &request, &settings), of)
    };
    let one = reference("1");
    let [none, ism, traced] = ["none", "ism", "traced"].map(|visibility| error(visibility, "1", &one));
    println!("one bounce, rrmse: {none:.3} without visibility, {ism:.3} by maps, {traced:.3} by rays");
    assert!(traced < 0.15 && traced < ism && ism < none);
    let all = reference("16");
    let errors = ["1", "2", "4", "8"].map(|bounces| error("traced", bounces, &all));
    println!("1, 2, 4 and 8 bounces against 16, rrmse: {errors:.3?}");
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0]) && errors[3] < 0.2, "{errors:?}");
}
