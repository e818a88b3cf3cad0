//! `radiance-maps`: maps hold all light that comes to their caches, where it comes from; pixels reflect what paths find of it; what nobody needs is not made.

use std::f64::consts::FRAC_1_PI;

use glam::{DAffine3, DVec3};

use super::against_paths::passes_run;
use super::blocks::against;
use super::invariance::{difference, transformed};
use super::path_probe::{Ask, Tracer};
use super::probe::{Probe, Vpl, probe};
use super::scenes::{add_light, box_faces, builtin, closed_box, lambert, place, quad, request, settings_of, view};
use super::session::Session;
use crate::frame::twins;
use crate::renderer::{ColorImage, FrameRequest, PassTiming, Settings, Slot, SpecularMethod, Technique, Timing};
use crate::scene::{CameraView, Light, LightId, LightKind, Material, Scene};
use crate::slot::PixelFilter;
use crate::specular::radiance_maps::direction_of_texel;

pub(super) const SIZE: [u32; 2] = [64, 48];

pub(super) fn set(changes: &[(&str, &str)]) -> Settings {
    settings_of(Technique::Volumes, changes)
}

fn metal(color: [f32; 3], roughness: f32) -> Material {
    let [red, green, blue] = color;
    Material { base_color: [red, green, blue, 1.0], metallic: 1.0, roughness, ..Material::default() }
}

fn specular_of(session: &Session, scene: &Scene, settings: &Settings, camera: &CameraView) -> ColorImage {
    let asked = FrameRequest { image: false, ..request(SIZE, camera.clone(), &[Slot::Specular]) };
    session.render(scene, settings, &asked).slots[&Slot::Specular].clone()
}

/// The maps of a frame as they are read back: caches, how many, how many lights, texels, lights, positions.
fn maps_of(session: &Session, scene: &Scene, camera: &CameraView, changes: &[(&str, &str)]) -> (Probe, Vec<u32>) {
    let mut settings = set(changes);
    settings.methods.diffuse = crate::renderer::DiffuseMethod::None;
    let asked = request(SIZE, camera.clone(), &[Slot::Specular]);
    let probe = probe(session, scene, &settings, &asked, |graph, declared| {
        let made = declared.maps.as_ref().expect("maps are made");
        let words = [made.maps.caches, made.maps.head, made.lights.counts];
        let mut reads: Vec<_> = words.into_iter().map(|words| graph.read_back_buffer(words)).collect();
        reads.push(graph.read_back_buffer(made.maps.texels));
        reads.push(graph.read_back_buffer(made.lights.lights));
        reads.push(graph.read_back_buffer(made.positions));
        reads
    });
    let count = probe.floats(1)[3].to_bits() as usize;
    let caches = probe.floats(0).into_iter().take(count).map(f32::to_bits).collect();
    (probe, caches)
}

/// What a light sends to a point across the beam, W/m², and where it comes from.
fn arriving(light: &Vpl, point: DVec3) -> (DVec3, DVec3) {
    let difference = light.texels[0].truncate().as_dvec3() - point;
    let squared = difference.length_squared();
    let toward = difference / squared.sqrt();
    let normal = twins::unpack_direction_in_float_unnormalized(light.texels[1].w).as_dvec3().normalize();
    let facing = normal.dot(-toward).max(0.0);
    (light.flux * (FRAC_1_PI * facing / (squared + f64::from(light.texels[0].w))), toward)
}

/// Duff et al. 2017, as glsl/lib/microfacet.glsl has it.
fn frame_around(normal: DVec3) -> [DVec3; 3] {
    let side = if normal.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    [
        DVec3::new(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
        DVec3::new(b, side + normal.y * normal.y * a, -normal.y),
        normal,
    ]
}

/// A metal floor, and a wall beside it of which a narrow spot lights a patch.
pub(super) fn lit_patch() -> (Scene, CameraView) {
    let mut scene = Scene::empty("patch");
    let white = scene.add_material(lambert([0.8, 0.6, 0.4])).expect("a sound material");
    let steel = scene.add_material(metal([0.9; 3], 0.4)).expect("a sound material");
    let floor = [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]];
    let wall = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 2.0, -1.0], [-1.0, 2.0, -1.0]];
    place(&mut scene, vec![quad(floor, steel), quad(wall, white)], DAffine3::IDENTITY);
    let kind = LightKind::Spot { inner_angle: 0.05, outer_angle: 0.1 };
    add_light(&mut scene, kind, DVec3::new(0.3, 1.3, 1.5), DVec3::new(0.0, 0.0, -1.0), [30.0, 20.0, 10.0]);
    (scene, view(DVec3::new(0.0, 1.0, 2.0), DVec3::new(0.0, 0.3, 0.0)))
}

/// Every level of every map holds what all lights send to its cache, and the finest holds it where it comes from: Σ E ω over its texels is that over the lights.
#[test]
fn maps_hold_all_light_and_where_it_comes_from() {
    let session = Session::open();
    let (scene, camera) = lit_patch();
    for (fill, size) in [("none", 64), ("none", 16), ("pull-push", 16), ("footprint", 64), ("footprint", 16)] {
        let size_text = size.to_string();
        let changes = [
            ("radiance_maps.fill", fill),
            ("radiance_maps.size", &*size_text),
            ("volumes.visibility", "none"),
            ("volumes.lights", "32"),
        ];
        let (found, caches) = maps_of(&session, &scene, &camera, &changes);
        let count = found.floats(2)[0].to_bits() as usize;
        let lights: Vec<Vpl> = found.vpls(4).into_iter().take(count).collect();
        let (texels, positions) = (found.colors(3), found.colors(5));
        assert!(caches.len() > 20 && count > 4, "{} maps, {count} lights", caches.len());
        let texel_count = (4 * size * size - 1) / 3;
        let (mut light_off, mut level_off, mut way_off) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (map, &cache) in caches.iter().enumerate() {
            let point = positions[cache as usize];
            let all = lights.iter().map(|light| arriving(light, point));
            let (light, way) = all.fold((DVec3::ZERO, DVec3::ZERO), |(light, way), (amount, toward)| {
                (light + amount, way + amount.x * toward)
            });
            let texels = &texels[map * texel_count..(map + 1) * texel_count];
            let mut first = 0;
            for level in 0..=size.ilog2() {
                let side = size >> level;
                let sum: DVec3 = texels[first..first + side * side].iter().sum();
                light_off = light_off.max(((sum - light) / light).abs().max_element());
                let finest: DVec3 = texels[..size * size].iter().sum();
                level_off = level_off.max(((sum - finest) / finest).abs().max_element());
                first += side * side;
            }
            let frame = frame_around((found.eye() - point).normalize());
            let of_texel = |(texel, amount): (usize, &DVec3)| {
                let half = direction_of_texel(size as u32, [texel % size, texel / size].map(|place| place as u32));
                let local = 2.0 * half.z * half - DVec3::Z;
                amount.x * (local.x * frame[0] + local.y * frame[1] + local.z * frame[2])
            };
            let shown: DVec3 = texels[..size * size].iter().enumerate().map(of_texel).sum();
            way_off = way_off.max((shown - way).length() / light.x);
        }
        println!("{fill}, {size}²: {} maps, light off by {light_off:.1e}, its way by {way_off:.3}", caches.len());
        // Rounding of units of 2⁻²⁷, and of floats; as squares lights send a little else than as discs.
        let most = if fill == "footprint" { 0.02 } else { 1e-4 };
        assert!(light_off < most, "{fill}, {size}²: {light_off}");
        assert!(level_off < 1e-5, "{fill}, {size}²: {level_off}");
        let most = if size == 64 { 0.06 } else { 0.2 };
        assert!(way_off < most || fill == "pull-push", "{fill}, {size}²: {way_off}");
    }
}

/// The slot by paths of the light that maps hold.
fn by_paths(session: &Session, scene: &Scene, camera: &CameraView, settings: &Settings, samples: u32) -> Vec<DVec3> {
    let paths = settings.light_paths(Slot::Specular);
    let ask = Ask {
        bounces: paths.bounces,
        caustics: paths.caustics,
        mirrors: paths.mirrors,
        filter: PixelFilter::Center,
        ..Ask::new(SIZE, samples, camera.clone())
    };
    Tracer::new(session).trace(scene, &ask).slot(Slot::Specular)
}

/// A room of diffuse walls, one of them of this metal, seen from aside.
fn metal_wall(roughness: f32) -> (Scene, CameraView) {
    let mut scene = Scene::empty("metal wall");
    let [white, red, steel] = [lambert([0.7; 3]), lambert([0.7, 0.1, 0.1]), metal([0.9, 0.8, 0.6], roughness)]
        .map(|material| scene.add_material(material).expect("sound"));
    place(&mut scene, box_faces([1.0; 3], [red, white, white, white, steel, white]), DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(0.3, 0.5, 0.2), DVec3::NEG_Y, [3.0; 3]);
    (scene, view(DVec3::new(0.6, 0.1, 0.8), DVec3::new(-0.2, 0.0, -1.0)))
}

#[test]
fn reflections_are_those_of_paths_of_one_bounce() {
    let session = Session::open();
    let glossy = builtin("cornell-glossy");
    let camera = glossy.camera_view(None).expect("its camera");
    let mut cases = vec![("cornell-glossy".to_owned(), glossy, camera, 0.07, 0.11)];
    for (roughness, mean_bound, error_bound) in [(0.4, 0.03, 0.07), (0.6, 0.05, 0.1), (1.0, 0.11, 0.12)] {
        let (scene, camera) = metal_wall(roughness);
        cases.push((format!("a wall of roughness {roughness}"), scene, camera, mean_bound, error_bound));
    }
    // Along the wall: texels of half vectors are as wide there as elsewhere.
    let (scene, _) = metal_wall(0.4);
    let grazing = view(DVec3::new(-0.9, 0.1, -0.7), DVec3::new(0.6, 0.0, -1.0));
    cases.push(("a wall of roughness 0.4, seen along it".to_owned(), scene, grazing, 0.05, 0.1));
    let mut wrong = Vec::new();
    for (name, scene, camera, mean_bound, error_bound) in cases {
        let settings = set(&[]);
        let truth = by_paths(&session, &scene, &camera, &settings, 128);
        let found = specular_of(&session, &scene, &settings, &camera);
        let found: Vec<DVec3> = found.pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).collect();
        let (ratio, error) = against(&found, &truth);
        println!("{name}: mean {ratio:.3}, blocks {error:.3}");
        if (ratio - 1.0).abs() >= mean_bound || error >= error_bound {
            wrong.push(format!("{name}: {ratio} {error}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

fn bits(image: &ColorImage) -> Vec<[u32; 3]> {
    image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// Sums are whole numbers: where and in what order they grow does not show.
#[test]
fn both_ways_of_writing_and_repeats_give_the_same_bits() {
    let session = Session::open();
    let scene = builtin("cornell-glossy");
    let camera = scene.camera_view(None).expect("its camera");
    for (size, fill) in [("8", "none"), ("32", "footprint"), ("16", "search")] {
        let of = |write| {
            let changes = [("radiance_maps.write", write), ("radiance_maps.size", size), ("radiance_maps.fill", fill)];
            set(&changes)
        };
        let direct = specular_of(&session, &scene, &of("direct"), &camera);
        assert!(direct.pixels.iter().flatten().any(|&channel| channel > 0.0));
        assert_eq!(bits(&direct), bits(&specular_of(&session, &scene, &of("cached"), &camera)), "{size}², {fill}");
        let mut renderer = session.renderer(&of("direct"));
        let asked = FrameRequest { image: false, ..request(SIZE, camera.clone(), &[Slot::Specular]) };
        for _ in 0..3 {
            renderer.invalidate();
            let again = renderer.render(&scene, &asked).expect("a frame");
            assert_eq!(bits(&direct), bits(&again.slots[&Slot::Specular]), "{size}², {fill}");
        }
    }
}

#[test]
fn both_slots_share_caches_and_change_nothing_of_each_other() {
    let session = Session::open();
    let scene = builtin("cornell-glossy");
    let camera = scene.camera_view(None).expect("its camera");
    let asked =
        |slots: &[Slot]| FrameRequest { timing: Timing::Passes, image: false, ..request(SIZE, camera.clone(), slots) };
    let both = session.render(&scene, &set(&[]), &asked(&[Slot::Diffuse, Slot::Specular]));
    for pass in ["caches/places/allocate", "caches/places/ask", "light-views/reflective"] {
        assert_eq!(passes_run(&both, pass), [pass], "made once");
    }
    // Lights are the same ones where they are spread alike over the views.
    let even = set(&[("volumes.spread", "views")]);
    let even = session.render(&scene, &even, &asked(&[Slot::Diffuse, Slot::Specular]));
    assert_eq!(passes_run(&even, "caches/lights/reduce"), ["caches/lights/reduce"], "made once");
    let mut alone = set(&[]);
    alone.methods.specular = SpecularMethod::None;
    let diffuse = session.render(&scene, &alone, &asked(&[Slot::Diffuse]));
    assert_eq!(bits(&both.slots[&Slot::Diffuse]), bits(&diffuse.slots[&Slot::Diffuse]));
    let specular = session.render(&scene, &set(&[]), &asked(&[Slot::Specular]));
    assert_eq!(bits(&both.slots[&Slot::Specular]), bits(&specular.slots[&Slot::Specular]));
    assert!(passes_run(&specular, "diffuse").is_empty(), "{:?}", passes_run(&specular, "diffuse"));
}

/// More maps than there is room for at first.
#[test]
fn room_for_maps_grows() {
    let session = Session::open();
    let (scene, camera) = lit_patch();
    let asked = request(SIZE, camera, &[Slot::Specular]);
    let asked = FrameRequest { image: false, timing: Timing::Passes, ..asked };
    let mut renderer = session.renderer(&set(&[("volumes.lights", "16")]));
    let first = renderer.render(&scene, &asked).expect("a frame");
    let maps = row(&first, "specular/radiance-maps/choose").work["maps"];
    assert!(maps > 1024, "{maps} maps");
    renderer.invalidate();
    let again = renderer.render(&scene, &asked).expect("a frame");
    assert_eq!(bits(&first.slots[&Slot::Specular]), bits(&again.slots[&Slot::Specular]));
    let lit = first.slots[&Slot::Specular].pixels.iter().filter(|pixel| pixel[0] > 0.0).count();
    assert!(lit > 500, "{lit} pixels of the floor");
}

fn row(frame: &crate::renderer::Frame, name: &str) -> PassTiming {
    let rows = &frame.timings.passes;
    rows.iter().find(|pass| pass.full_name().starts_with(name)).expect("a pass of this name").clone()
}

#[test]
fn without_a_specular_surface_there_are_no_maps() {
    let session = Session::open();
    let reason = |scene: &Scene| {
        let camera = view(DVec3::new(0.7, 0.6, 0.8), DVec3::ZERO);
        let asked = FrameRequest { image: false, ..request([8, 8], camera, &[Slot::Specular]) };
        let frame = session.render(scene, &set(&[]), &asked);
        assert!(passes_run(&frame, "caches").is_empty() && passes_run(&frame, "specular").is_empty());
        row(&frame, "specular/radiance-maps").skipped.expect("a reason")
    };
    let mut diffuse = closed_box(1.0, lambert([0.5; 3]));
    add_light(&mut diffuse, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    assert_eq!(reason(&diffuse), "no specular surface");
    let mut mirrors = closed_box(1.0, metal([0.5; 3], 0.3));
    assert_eq!(reason(&mirrors), "no light");
    add_light(&mut mirrors, LightKind::Point, DVec3::ZERO, DVec3::NEG_Y, [1.0; 3]);
    assert_eq!(reason(&mirrors), "no diffuse surface");

    // One that is not in view, one that is.
    let steel = diffuse.add_material(metal([0.9; 3], 0.4)).expect("sound");
    let corners = [[-0.5, -0.5, 0.9], [-0.5, 0.5, 0.9], [0.5, 0.5, 0.9], [0.5, -0.5, 0.9]];
    place(&mut diffuse, vec![quad(corners, steel)], DAffine3::IDENTITY);
    let of = |target: DVec3| {
        let asked = request(SIZE, view(DVec3::new(0.1, 0.0, 0.0), target), &[Slot::Specular]);
        session.render(&diffuse, &set(&[]), &FrameRequest { timing: Timing::Passes, ..asked })
    };
    let (behind, before) = (of(DVec3::NEG_Z), of(DVec3::Z));
    let maps = |frame| row(frame, "specular/radiance-maps/choose").work["maps"];
    assert_eq!(maps(&behind), 0);
    assert!(maps(&before) > 10 && maps(&before) < row(&before, "caches/places/allocate").work["caches"]);
    assert!(behind.slots[&Slot::Specular].pixels.iter().all(|pixel| *pixel == [0.0; 3]));
    assert!(before.slots[&Slot::Specular].pixels.iter().any(|pixel| pixel[0] > 0.0));
}

#[test]
fn what_did_not_change_stands() {
    let session = Session::open();
    let mut scene = builtin("cornell-glossy");
    let camera = scene.camera_view(None).expect("its camera");
    let asked = FrameRequest { timing: Timing::Passes, ..request(SIZE, camera, &[Slot::Diffuse, Slot::Specular]) };
    let mut renderer = session.renderer(&set(&[]));
    let mut ran = |scene: &Scene| passes_run(&renderer.render(scene, &asked).expect("a frame"), "specular");
    let first = ran(&scene);
    for pass in ["choose", "bound", "write", "mips", "apply"] {
        assert!(first.contains(&format!("specular/radiance-maps/{pass}")), "{pass} is not among {first:?}");
    }
    assert!(ran(&scene).is_empty());
    let light = Light { intensity: [1.0, 2.0, 3.0], ..scene.lights()[0].clone() };
    scene.set_light(LightId(0), light).expect("sound");
    let relit = ran(&scene);
    assert!(relit.contains(&"specular/radiance-maps/write".to_owned()), "{relit:?}");
    assert!(!relit.contains(&"specular/radiance-maps/choose".to_owned()), "{relit:?}");
}

#[test]
fn units_of_length_and_of_light_do_not_matter() {
    let session = Session::open();
    let mut scene = builtin("cornell-glossy");
    let settings = set(&[]);
    let of = |scene: &Scene| specular_of(&session, scene, &settings, &scene.camera_view(None).expect("its camera"));
    let original = of(&scene);
    for scale in [1e-3, 1e3] {
        let copy = of(&transformed(&scene, DAffine3::from_scale(DVec3::splat(scale)), scale));
        let found = difference(&original, &copy);
        println!("scaled by {scale}: rmse {:.1e}, at most {:.1e}", found.rmse, found.most);
        assert!(found.rmse < 2e-3, "scaled by {scale}: {:.1e}", found.rmse);
    }
    let light = scene.lights()[0].clone();
    let mean = original.pixels.iter().flatten().map(|&channel| f64::from(channel)).sum::<f64>()
        / (3 * original.pixels.len()) as f64;
    for factor in [1e-6_f32, 1e4] {
        let intensity = light.intensity.map(|channel| factor * channel);
        scene.set_light(LightId(0), Light { intensity, ..light.clone() }).expect("a sound light");
        for (before, after) in original.pixels.iter().flatten().zip(of(&scene).pixels.iter().flatten()) {
            let expected = f64::from(*before) * f64::from(factor);
            let most = f64::from(factor) * (1e-4 * f64::from(*before) + 1e-5 * mean);
            assert!((f64::from(*after) - expected).abs() <= most, "{before} {after}");
        }
    }
}

/// The light of other surfaces' specular lobes is not among that of maps.
#[test]
fn paths_leave_out_what_is_specular_on_the_way() {
    let session = Session::open();
    let means = |scene: &Scene, camera: &CameraView| {
        let settings = set(&[]);
        let mut all = settings.clone();
        all.methods.specular = SpecularMethod::Path;
        all.path.bounces = Some(1);
        [&settings, &all].map(|settings| {
            let pixels = by_paths(&session, scene, camera, settings, 64);
            pixels.iter().sum::<DVec3>().element_sum() / pixels.len() as f64
        })
    };
    let (scene, camera) = metal_wall(0.5);
    let [none, all] = means(&scene, &camera);
    assert!((none / all - 1.0).abs() < 0.02, "other walls are diffuse: {none} of {all}");
    let mut facing = scene.clone();
    let steel = facing.add_material(metal([0.9; 3], 0.5)).expect("sound");
    let corners = [[-0.9, -0.9, 0.95], [-0.9, 0.9, 0.95], [0.9, 0.9, 0.95], [0.9, -0.9, 0.95]];
    place(&mut facing, vec![quad(corners, steel)], DAffine3::IDENTITY);
    let [none, all] = means(&facing, &camera);
    assert!(none < 0.8 * all && none > 0.0, "a metal wall faces it: {none} of {all}");
}

/// Both slots have lists of lights of their own, or share one: a frame has both, whatever makes them so.
#[test]
fn frames_have_both_slots_whatever_lists_they_light_by() {
    let session = Session::open();
    for sky in [0.0, 0.2] {
        let mut scene = builtin("cornell-glossy");
        scene.set_sky([sky; 3]);
        let camera = scene.camera_view(None).expect("its camera");
        let bounces = [("volumes.bounces", "3"), ("volumes.samples", "256")];
        for changes in [&[][..], &[("volumes.spread", "views")], &bounces] {
            let asked = request([32, 24], camera.clone(), &[Slot::Diffuse, Slot::Specular]);
            let frame = session.render(&scene, &set(changes), &asked);
            for slot in [Slot::Diffuse, Slot::Specular] {
                let lit = frame.slots[&slot].pixels.iter().any(|pixel| pixel[1] > 0.0);
                assert!(lit, "{slot} with {changes:?}, sky {sky}");
            }
        }
    }
}
