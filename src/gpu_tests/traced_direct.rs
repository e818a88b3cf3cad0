//! Direct light by rays: against the path tracer, which finds the same light by other code, and against closed forms.

use glam::{DAffine3, DVec3};

use super::scenes::{add_light, box_faces, builtin, floor, lambert, lattice, place, quad, request, view};
use super::session::Session;
use crate::renderer::{DirectMethod, Frame, FrameRequest, Preset, Settings, Slot, Technique, Timing};
use crate::scene::{CameraView, Light, LightId, LightKind, Material, MaterialId, Projection, Scene};

const SIZE: [u32; 2] = [64, 48];

/// The technique `direct` with its light traced.
fn traced(samples: u32) -> Settings {
    let mut settings = Settings::new(Technique::Direct, Preset::Default);
    settings.methods.direct = DirectMethod::Traced;
    settings.traced.samples = samples;
    settings
}

fn true_light(samples: u32) -> Settings {
    let mut settings = Settings::new(Technique::Path, Preset::Default);
    (settings.path.spp, settings.path.bounces) = (samples, Some(0));
    settings
}

fn direct_of(frame: &Frame) -> Vec<DVec3> {
    frame.slots[&Slot::Direct].pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).collect()
}

fn asked(camera: CameraView) -> FrameRequest {
    FrameRequest { image: false, ..request(SIZE, camera, &[Slot::Direct]) }
}

/// The slot `direct` in the scene's own view.
fn direct(session: &Session, scene: &Scene, settings: &Settings) -> Vec<DVec3> {
    let camera = scene.camera_view(None).expect("a view");
    direct_of(&session.render(scene, settings, &asked(camera)))
}

/// The root mean square difference over the mean of `truth`, and the ratio of the means. Without the three pixels that are furthest off: at a
/// silhouette rounding decides which surface a pixel shows.
fn compared(what: &str, found: &[DVec3], truth: &[DVec3]) -> (f64, f64) {
    let mut pairs: Vec<(DVec3, DVec3)> = found.iter().copied().zip(truth.iter().copied()).collect();
    let square = |(found, truth): &(DVec3, DVec3)| (found - truth).length_squared();
    pairs.sort_by(|one, other| square(one).total_cmp(&square(other)));
    pairs.truncate(pairs.len() - 3);
    let count = (3 * pairs.len()) as f64;
    let mean = |of: fn(&(DVec3, DVec3)) -> DVec3| pairs.iter().map(|pair| of(pair).element_sum()).sum::<f64>() / count;
    let [found, truth] = [mean(|pair| pair.0), mean(|pair| pair.1)];
    let (error, ratio) = ((pairs.iter().map(square).sum::<f64>() / count).sqrt() / truth, found / truth);
    println!("{what}: rmse {error:.2e} of the mean, ratio of the means {ratio:.6}");
    (error, ratio)
}

/// The scene without what its surfaces emit.
fn without_emission(mut scene: Scene) -> Scene {
    for index in 0..scene.materials().len() {
        let material = Material { emissive: [0.0; 3], ..scene.materials()[index].clone() };
        scene.set_material(MaterialId(index), material).expect("sound");
    }
    scene
}

/// The scene with some of its punctual lights put out.
fn without_light(scene: &Scene, dark: impl Fn(usize) -> bool) -> Scene {
    let mut scene = scene.clone();
    for index in (0..scene.lights().len()).filter(|&index| dark(index)) {
        let light = Light { intensity: [0.0; 3], ..scene.lights()[index].clone() };
        scene.set_light(LightId(index), light).expect("sound");
    }
    scene
}

/// Paths choose among lights at random, so each light is traced alone: then they have no noise either.
fn true_punctual_light(session: &Session, scene: &Scene) -> Vec<DVec3> {
    let mut sum = vec![DVec3::ZERO; SIZE[0] as usize * SIZE[1] as usize];
    for kept in 0..scene.lights().len() {
        let scene = without_light(scene, |light| light != kept);
        for (sum, light) in sum.iter_mut().zip(direct(session, &scene, &true_light(1))) {
            *sum += light;
        }
    }
    sum
}

#[test]
fn punctual_lights_are_as_paths_find_them() {
    let session = Session::open();
    for name in ["cornell-point", "cornell-spot", "lights"] {
        let scene = without_emission(builtin(name));
        let truth = true_punctual_light(&session, &scene);
        let (error, _) = compared(name, &direct(&session, &scene, &traced(4)), &truth);
        assert!(error < 1e-3, "{name}: {error:.2e}");
    }
}

/// A glossy floor and a rough one below a lamp, a block between them, and a sky.
fn lamp_over_gloss(sky: [f32; 3], emission: f32) -> Scene {
    let metal = Material { metallic: 1.0, roughness: 0.25, ..lambert([0.9, 0.7, 0.4]) };
    let mut scene = floor(1.0, metal);
    let lamp = Material { emissive: [emission; 3], base_color: [0.0, 0.0, 0.0, 1.0], ..lambert([0.0; 3]) };
    let lamp = scene.add_material(lamp).expect("sound");
    let plain = scene.add_material(lambert([0.6, 0.6, 0.7])).expect("sound");
    let over = [[-0.4, 1.0, -0.6], [0.4, 1.0, -0.6], [0.4, 1.0, -0.1], [-0.4, 1.0, -0.1]];
    place(&mut scene, vec![quad(over, lamp)], DAffine3::IDENTITY);
    // Turned inside out: its faces look outwards.
    let mut block = box_faces([0.2, 0.3, 0.2], [plain; 6]);
    block.iter_mut().for_each(|face| face.indices.reverse());
    place(&mut scene, block, DAffine3::from_translation(DVec3::new(0.3, 0.3, -0.4)));
    scene.set_sky(sky);
    scene
}

#[test]
fn surfaces_and_sky_are_as_paths_find_them() {
    let session = Session::open();
    let camera = view(DVec3::new(0.1, 0.9, 1.7), DVec3::new(0.0, 0.2, 0.0));
    let mut all_kinds = lamp_over_gloss([0.3, 0.5, 0.8], 6.0);
    add_light(&mut all_kinds, LightKind::Point, DVec3::new(-0.7, 0.8, 0.5), DVec3::NEG_Y, [0.3, 0.4, 0.2]);
    let panel = builtin("cornell-panel");
    let view_of_panel = panel.camera_view(None).expect("a view");
    let cases = [
        ("panel", panel, view_of_panel, 0.03),
        ("sky", lamp_over_gloss([0.3, 0.5, 0.8], 0.0), camera.clone(), 0.03),
        ("lamp", lamp_over_gloss([0.0; 3], 6.0), camera.clone(), 0.06),
        ("all kinds", all_kinds, camera, 0.06),
    ];
    for (what, scene, camera, bound) in cases {
        let asked = FrameRequest { size: [40, 30], ..asked(camera) };
        let render = |settings: &Settings| direct_of(&session.render(&scene, settings, &asked));
        let truth = render(&true_light(1024));
        let (few, _) = compared(&format!("{what}, 4 samples"), &render(&traced(4)), &truth);
        let (error, ratio) = compared(&format!("{what}, 256 samples"), &render(&traced(256)), &truth);
        assert!(error < bound && error < few / 4.0, "{what}: {error:.2e}, with 4 samples {few:.2e}");
        assert!((ratio - 1.0).abs() < 5e-3, "{what}: {ratio}");
    }
}

/// The top of the block all but touches the sphere: a ray that starts too high or goes too far meets the sphere itself. The truth is
/// noisy there; such rays lose a third of the light.
#[test]
fn an_emitter_does_not_hide_itself() {
    let session = Session::open();
    let scene = without_light(&builtin("lights"), |_| true);
    let truth = direct(&session, &scene, &true_light(512));
    let (_, ratio) = compared("sphere on a block", &direct(&session, &scene, &traced(64)), &truth);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

/// Where a pixel of a perspective view sees the plane y = 0.
fn point_of_floor(camera: &CameraView, pixel: u32) -> Option<DVec3> {
    point_of_floor_beside(camera, pixel, [0.0; 2])
}

/// So many pixels beside the middle of one.
fn point_of_floor_beside(camera: &CameraView, pixel: u32, beside: [f64; 2]) -> Option<DVec3> {
    let Projection::Perspective { vertical_fov, .. } = camera.projection else { return None };
    let [column, row] = [pixel % SIZE[0], pixel / SIZE[0]].map(f64::from);
    let center = [column + 0.5 + beside[0], row + 0.5 + beside[1]];
    let [width, height] = SIZE.map(f64::from);
    let scale = (0.5 * vertical_fov).tan() / height;
    let ray = DVec3::new((2.0 * center[0] - width) * scale, (height - 2.0 * center[1]) * scale, -1.0);
    let (ray, eye) = (camera.world.transform_vector3(ray), camera.world.translation);
    (ray.y < 0.0).then(|| eye - ray * (eye.y / ray.y))
}

#[test]
fn a_plane_under_a_point_light_shows_cosine_over_squared_distance() {
    let session = Session::open();
    let mut scene = floor(2.0, lambert([0.5, 0.25, 0.75]));
    let light = DVec3::new(0.4, 1.1, -0.3);
    add_light(&mut scene, LightKind::Point, light, DVec3::NEG_Y, [3.0; 3]);
    // From above, from where the plane is seen edge-on, and through a telescope, where positions are at their worst.
    let eyes = [[0.3, 2.4, 0.5, 60.0], [1.9, 0.05, 0.4, 60.0], [12.0, 3.0, 1.0, 60.0], [250.0, 180.0, 90.0, 0.8]];
    for [x, y, z, degrees] in eyes {
        let eye = DVec3::new(x, y, z);
        let projection = Projection::Perspective { vertical_fov: f64::to_radians(degrees), aspect: None, near: 0.01 };
        let camera = CameraView { projection, ..view(eye, DVec3::ZERO) };
        let found = direct_of(&session.render(&scene, &traced(0), &asked(camera.clone())));
        let mut seen = 0;
        for (pixel, found) in (0..).zip(found) {
            // Every device draws the floor's edges within 1/16 of a pixel of where they are.
            let reach = 1.0 / 16.0;
            let corners = [[-reach, -reach], [reach, -reach], [-reach, reach], [reach, reach]];
            let on_floor = |point: Option<DVec3>| point.is_some_and(|point| point.abs().max_element() < 1.95);
            if !corners.iter().all(|beside| on_floor(point_of_floor_beside(&camera, pixel, *beside))) {
                continue;
            }
            let Some(point) = point_of_floor(&camera, pixel) else { continue };
            let to_light = light - point;
            let irradiance = 3.0 * to_light.normalize().y / to_light.length_squared();
            let expected = DVec3::new(0.5, 0.25, 0.75) * (irradiance / std::f64::consts::PI);
            let error = ((found - expected) / expected).abs().max_element();
            // Half of a unit in the last place of the albedo's half floats.
            assert!(error < 5e-4, "{found} in place of {expected} at {point} from {eye}");
            seen += 1;
        }
        assert!(seen > 20, "only {seen} pixels show the plane from {eye}");
    }
}

#[test]
fn no_traced_light_leaks_into_dark_rooms() {
    let session = Session::open();
    let scene = builtin("leak");
    let light = |camera: &str| {
        let camera = scene.camera_view(Some(camera)).expect("one of its cameras");
        let pixels = direct_of(&session.render(&scene, &traced(4), &asked(camera)));
        pixels.iter().map(|pixel| pixel.element_sum()).sum::<f64>() / (3 * pixels.len()) as f64
    };
    assert!(light("lit") > 0.1, "the lit hall");
    for camera in ["thin", "thick", "sealed"] {
        assert_eq!(light(camera), 0.0, "{camera}");
    }
}

/// A quad of 4×4 texels, every other one cut out, high above the floor, as large as the floor sees it from the light.
#[test]
fn cut_out_surfaces_cast_cut_out_shadows() {
    let session = Session::open();
    let mut scene = floor(1.0, lambert([0.5; 3]));
    let lattice = lattice(&mut scene, [[-0.5, 1.5, -0.5], [-0.5, 1.5, 0.5], [0.5, 1.5, 0.5], [0.5, 1.5, -0.5]]);
    place(&mut scene, vec![lattice], DAffine3::IDENTITY);
    // At twice the lattice's height: its shadow just covers the floor, texel by texel.
    let light = DVec3::new(0.0, 3.0, 0.0);
    add_light(&mut scene, LightKind::Point, light, DVec3::NEG_Y, [5.0; 3]);
    let camera = view(DVec3::new(0.3, 1.2, 1.4), DVec3::ZERO);
    let found = direct_of(&session.render(&scene, &traced(0), &asked(camera.clone())));
    let (mut lit, mut dark) = (0, 0);
    for (pixel, found) in (0..).zip(found) {
        let Some(point) = point_of_floor(&camera, pixel).filter(|point| point.abs().max_element() < 0.98) else {
            continue;
        };
        let cell = (point + 1.0) * 2.0;
        // Borders of texels apart.
        if [cell.x, cell.z].iter().any(|place| (place - place.round()).abs() < 0.02) {
            continue;
        }
        let opaque = (cell.x.floor() as u32 + cell.z.floor() as u32).is_multiple_of(2);
        assert_eq!(found.x == 0.0, opaque, "{found} at {point}");
        if opaque { dark += 1 } else { lit += 1 }
    }
    assert!(lit > 200 && dark > 200, "{lit} lit, {dark} dark");
}

#[test]
fn traced_light_is_the_same_in_every_run() {
    let scene = builtin("lights");
    let bits = |frame: &Frame| -> Vec<u32> {
        frame.slots[&Slot::Direct].pixels.iter().flatten().map(|channel| channel.to_bits()).collect()
    };
    let session = Session::open();
    let asked = asked(scene.camera_view(None).expect("a view"));
    let mut renderer = session.renderer(&traced(4));
    let first = bits(&renderer.render(&scene, &asked).expect("a frame"));
    renderer.invalidate();
    assert!(first == bits(&renderer.render(&scene, &asked).expect("a frame")));
    assert!(first == bits(&Session::open().render(&scene, &traced(4), &asked)));
}

/// Every pass's name, and why it did not run.
fn passes(frame: &Frame) -> Vec<(String, Option<&str>)> {
    frame.timings.passes.iter().map(|pass| (pass.full_name(), pass.skipped.as_deref())).collect()
}

#[test]
fn only_lights_that_there_are_cost_passes() {
    let session = Session::open();
    let run = |scene: &Scene, settings: &Settings| {
        let camera = scene.camera_view(None).expect("a view");
        let frame = session.render(scene, settings, &FrameRequest { timing: Timing::Passes, ..asked(camera) });
        let names = passes(&frame).into_iter().filter(|(name, _)| name.starts_with("direct") || name.contains("view"));
        names.map(|(name, reason)| (name, reason.map(str::to_owned))).collect::<Vec<_>>()
    };
    let skipped = |name: &str, reason: &str| (name.to_owned(), Some(reason.to_owned()));
    let runs = |name: &str| (name.to_owned(), None);
    let nothing_around = "no sky, no emissive surface";
    assert_eq!(
        run(&builtin("cornell-point"), &traced(4)),
        [
            runs("direct/traced/punctual"),
            skipped("direct/traced/emitters", "no emissive surface"),
            skipped("direct/traced/directions", nothing_around)
        ]
    );
    let panel = builtin("cornell-panel");
    assert_eq!(
        run(&panel, &traced(4)),
        [
            skipped("direct/traced/punctual", "no punctual light"),
            runs("direct/traced/emitters"),
            runs("direct/traced/directions")
        ]
    );
    let without_samples = run(&panel, &traced(0));
    assert_eq!(without_samples[1], skipped("direct/traced/emitters", "no samples asked for"));
    assert_eq!(run(&floor(1.0, lambert([0.5; 3])), &traced(4)), [skipped("direct/traced", "no light")]);
}

/// The scene for rays is there if it is used, follows edits, and goes with the method.
#[test]
fn a_renderer_holds_what_rays_meet_while_it_sends_any() {
    let session = Session::open();
    let mut scene = builtin("cornell-point");
    let request = asked(scene.camera_view(None).expect("a view"));
    let mut renderer = session.renderer(&Settings::new(Technique::Direct, Preset::Default));
    let bytes = |frame: &Frame| frame.timings.memory_bytes["scene"];
    let mapped = bytes(&renderer.render(&scene, &request).expect("a frame"));
    renderer.set_settings(traced(4)).expect("within their ranges");
    let first = renderer.render(&scene, &request).expect("a frame");
    assert!(bytes(&first) > mapped);
    let again = renderer.render(&scene, &request).expect("a frame");
    assert!(passes(&again).iter().all(|(_, skipped)| skipped.is_some()), "nothing changed");

    // A block that moves far beyond the walls takes the middle of the scene along; the G-buffer keeps the origin that it had.
    let block = scene.instances().last().expect("it has blocks").node;
    let far = DAffine3::from_translation(DVec3::new(9.0, 0.0, 0.0)) * scene.nodes()[block.0].local;
    scene.set_local_transform(block, far).expect("finite");
    let edited = direct_of(&renderer.render(&scene, &request).expect("a frame"));
    let fresh = direct_of(&session.render(&scene, &traced(4), &request));
    let (error, _) = compared("an edited scene", &edited, &fresh);
    assert!(error < 1e-3, "{error:.2e}");
    assert!(compared("the edit", &direct_of(&first), &fresh).0 > 0.01, "it shows");

    renderer.set_settings(Settings::new(Technique::Direct, Preset::Default)).expect("a preset");
    let last = renderer.render(&scene, &request).expect("a frame");
    assert!(bytes(&last) < bytes(&first), "the memory is given back");
}
