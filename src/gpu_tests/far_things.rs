//! Things far away change nothing: a picture is that of the scene without them, at any distance, of any size. And a picture is that of its frame:
//! nothing in it depends on the frames before.

use glam::{DAffine3, DVec3};

use super::scenes::{add_light, box_faces, floor, lambert, place, quad, request, view};
use super::session::Session;
use crate::renderer::{DirectMethod, Frame, Preset, Renderer, Settings, Slot, Technique};
use crate::scene::{
    Animation, CameraView, Channel, Interpolation, LightKind, Material, NodeId, Primitive, Property, Scene,
};

const SIZE: [u32; 2] = [32, 24];

fn settings(technique: Technique, changes: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(technique, Preset::Default);
    let small = [("lights.resolution", "64"), ("lights.sky_samples", "4"), ("path.spp", "2"), ("sppm.spp", "2")];
    for (key, value) in small.iter().chain(changes) {
        settings.set(key, value).expect("a setting and its value");
    }
    settings
}

/// A box without a ceiling, a mirror in it, lit by a lamp and by the sun.
fn room() -> Scene {
    let mut scene = Scene::empty("room");
    let wall = scene.add_material(Material { double_sided: true, ..lambert([0.6, 0.5, 0.4]) }).expect("sound");
    let mirror = Material { metallic: 1.0, roughness: 0.1, ..Material::default() };
    let mirror = scene.add_material(mirror).expect("sound");
    let mut walls = box_faces([1.0; 3], [wall; 6]);
    walls.remove(3);
    place(&mut scene, walls, DAffine3::IDENTITY);
    let at = DAffine3::from_rotation_y(0.5) * DAffine3::from_translation(DVec3::new(0.2, -0.6, -0.3));
    place(&mut scene, box_faces([-0.3; 3], [mirror; 6]), at);
    add_light(&mut scene, LightKind::Point, DVec3::new(-0.5, 0.6, 0.2), DVec3::NEG_Y, [3.0; 3]);
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.3, -1.0, -0.2), [2.0; 3]);
    scene
}

fn eye() -> CameraView {
    view(DVec3::new(0.1, 0.3, 0.95), DVec3::new(0.0, -0.3, 0.0))
}

fn triangle(size: f32) -> Primitive {
    let positions = vec![[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0]];
    Primitive { positions, indices: vec![0, 1, 2], ..Primitive::default() }
}

fn add_specks(scene: &mut Scene) {
    for (distance, way) in [(1e2, DVec3::X), (1e3, DVec3::Y), (3e4, DVec3::NEG_Z), (1e6, DVec3::new(-0.6, 0.0, 0.8))] {
        place(scene, vec![triangle(1e-3)], DAffine3::from_translation(way * distance));
    }
    // By its vertices, as far as float32 holds them.
    let mut far = triangle(1.0);
    far.positions.iter_mut().for_each(|position| position[0] += 1e6);
    place(scene, vec![far], DAffine3::IDENTITY);
}

fn add_mountain(scene: &mut Scene) {
    let faces = box_faces([-5e3; 3], [scene.add_material(lambert([0.5; 3])).expect("sound"); 6]);
    place(scene, faces, DAffine3::from_translation(DVec3::new(-9e5, -4e5, 0.0)));
}

/// Root of the mean squared difference over the mean, without the three pixels that are furthest off: at a silhouette rounding decides what a pixel
/// or a ray shows.
fn rrmse(frame: &Frame, truth: &Frame) -> f64 {
    let [found, truth] = [frame, truth].map(|frame| &frame.image.as_ref().expect("asked for").pixels);
    let square =
        |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|channel| f64::from(a[channel] - b[channel]).powi(2)).sum::<f64>();
    let mut squares: Vec<f64> = found.iter().zip(truth).map(square).collect();
    squares.sort_by(f64::total_cmp);
    squares.truncate(squares.len() - 3);
    let mean = truth.as_flattened().iter().map(|&channel| f64::from(channel)).sum::<f64>() / (3 * truth.len()) as f64;
    (squares.iter().sum::<f64>() / (3 * squares.len()) as f64).sqrt() / mean
}

/// The scene's picture with and without what `add` adds, by every way to light.
fn assert_unchanged(what: &str, add: fn(&mut Scene), bound: f64) {
    let session = Session::open();
    let (plain, mut with) = (room(), room());
    add(&mut with);
    let mut traced = settings(Technique::Direct, &[]);
    traced.methods.direct = DirectMethod::Traced;
    let all = [
        ("rsm", settings(Technique::Rsm, &[])),
        ("hybrid", settings(Technique::Hybrid, &[("vpl.visibility", "traced")])),
        ("march", settings(Technique::Hybrid, &[("vpl.visibility", "ism"), ("photons.trace", "march")])),
        ("traced", traced),
        ("path", settings(Technique::Path, &[])),
        ("sppm", settings(Technique::Sppm, &[])),
    ];
    for (name, settings) in all {
        let image = |scene: &Scene| session.render(scene, &settings, &request(SIZE, eye(), &[]));
        let error = rrmse(&image(&with), &image(&plain));
        println!("{what}, {name}: {error:.1e}");
        assert!(error < bound, "{what}, {name}: {error:.1e}");
    }
}

#[test]
fn far_specks_change_no_picture() {
    assert_unchanged("specks", add_specks, 1e-3);
}

#[test]
fn a_far_mountain_changes_no_picture() {
    // Of 10⁻⁴ sr, it takes a texel of a light view, which moves the virtual point lights a little.
    assert_unchanged("a mountain", add_mountain, 1e-2);
}

/// A lamp in a shade whose walls are 8 cm away lights as much on a ground of 10 m as on one of 10 km.
#[test]
fn a_shade_keeps_its_light_on_any_ground() {
    let session = Session::open();
    let mean = |half: f32| {
        let mut scene = floor(half, lambert([0.5; 3]));
        let shade = scene.add_material(Material { double_sided: true, ..lambert([0.5; 3]) }).expect("sound");
        let mut walls = box_faces([0.08; 3], [shade; 6]);
        walls.remove(2);
        place(&mut scene, walls, DAffine3::from_translation(DVec3::Y));
        add_light(&mut scene, LightKind::Point, DVec3::Y, DVec3::NEG_Y, [1.0; 3]);
        let camera = view(DVec3::new(0.0, 1.5, 4.0), DVec3::new(0.0, 0.3, 0.0));
        let frame = session.render(&scene, &settings(Technique::Direct, &[]), &request(SIZE, camera, &[Slot::Direct]));
        let pixels = frame.slots[&Slot::Direct].pixels.as_flattened();
        pixels.iter().map(|&channel| f64::from(channel)).sum::<f64>() / pixels.len() as f64
    };
    let [near, far] = [5.0, 5e3].map(mean);
    assert!(near > 1e-3 && (far / near - 1.0).abs() < 0.01, "{far} and {near}");
}

/// The shadow of a cube of 10 cm by rays, on a ground of 200 m and of 200 km.
#[test]
fn a_small_cube_casts_its_shadow_on_any_ground() {
    let session = Session::open();
    let scene = |half: f32| {
        let mut scene = floor(half, lambert([0.5; 3]));
        let cube = scene.add_material(lambert([0.5; 3])).expect("sound");
        let at = DAffine3::from_translation(DVec3::Y * 0.05);
        place(&mut scene, box_faces([-0.05; 3], [cube; 6]), at);
        add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.7, -0.7, 0.2), [3.0; 3]);
        scene
    };
    let mut traced = settings(Technique::Direct, &[]);
    traced.methods.direct = DirectMethod::Traced;
    for (name, settings) in [("traced", traced), ("path", settings(Technique::Path, &[("path.spp", "8")]))] {
        let image = |half: f32| {
            let camera = view(DVec3::new(0.3, 0.3, 0.4), DVec3::new(0.05, 0.0, 0.0));
            session.render(&scene(half), &settings, &request(SIZE, camera, &[]))
        };
        let [far, near] = [1e5, 1e2].map(|half| image(half).image.expect("asked for").pixels);
        let off = far.iter().zip(&near).filter(|(far, near)| (far[0] - near[0]).abs() > 0.01).count();
        // A pixel at the shadow's edge may fall on either side.
        assert!(near.iter().any(|pixel| pixel[0] < 0.05) && off <= 3, "{name}: {off} pixels");
    }
}

fn bits(frame: &Frame) -> Vec<u32> {
    frame.image.iter().flat_map(|image| image.pixels.iter().flatten().map(|channel| channel.to_bits())).collect()
}

/// A room in which something flies away and leaves the scene's bounds behind.
fn flight() -> Scene {
    let mut scene = room();
    let mirror = scene.instances().last().expect("the mirror").node;
    let values = vec![[0.2, -0.6, -0.3, 0.0], [40.0, 30.0, -20.0, 0.0]];
    let channel = Channel {
        node: mirror,
        property: Property::Translation,
        interpolation: Interpolation::Linear,
        times: vec![0.0, 1.0],
        values,
    };
    scene.add_animation(Animation { channels: vec![channel], ..Animation::default() }).expect("the node is there");
    scene
}

#[test]
fn a_frame_alone_has_the_bits_of_the_same_frame_after_others() {
    let session = Session::open();
    let traced = [("photons.trace", "bvh"), ("vpl.visibility", "traced")];
    for technique in [Technique::Hybrid, Technique::Path] {
        let settings = settings(technique, if technique == Technique::Hybrid { &traced } else { &[] });
        let frame = |renderer: &mut Renderer, scene: &mut Scene, number: u32| {
            scene.set_frame(number);
            bits(&renderer.render(scene, &request(SIZE, eye(), &[])).expect("a frame"))
        };
        let (mut renderer, mut scene) = (session.renderer(&settings), flight());
        for number in [0, 7, 30, 3] {
            let together = frame(&mut renderer, &mut scene, number);
            let alone = frame(&mut session.renderer(&settings), &mut flight(), number);
            assert!(together == alone, "{technique:?}, frame {number}");
        }
    }
}

#[test]
fn a_moved_object_and_an_added_mesh_leave_lights_where_they_are() {
    let session = Session::open();
    let settings = settings(Technique::Hybrid, &[]);
    let mut scene = room();
    let mut renderer = session.renderer(&settings);
    let frame = |renderer: &mut Renderer, scene: &Scene| {
        bits(&renderer.render(scene, &request(SIZE, eye(), &[])).expect("a frame"))
    };
    frame(&mut renderer, &scene);
    let node: NodeId = scene.instances().last().expect("the mirror").node;
    let edits: [fn(&mut Scene, NodeId); 2] = [
        |scene, node| {
            let local = DAffine3::from_translation(DVec3::new(5.0, 3.0, -4.0)) * scene.nodes()[node.0].local;
            scene.set_local_transform(node, local).expect("finite");
        },
        |scene, _| {
            let id = scene.add_material(lambert([0.2, 0.4, 0.8])).expect("sound");
            let sheet = quad([[-0.3, -0.9, -0.3], [-0.3, -0.9, 0.3], [0.3, -0.9, 0.3], [0.3, -0.9, -0.3]], id);
            place(scene, vec![sheet], DAffine3::IDENTITY);
        },
    ];
    for edit in edits {
        edit(&mut scene, node);
        let kept = frame(&mut renderer, &scene);
        assert!(kept == frame(&mut session.renderer(&settings), &scene), "not as a fresh renderer has it");
    }
}
