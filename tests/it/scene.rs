//! Scenes built in memory: what changes are counted, what emissive surfaces come to.

use glam::{DAffine3, DQuat, DVec3};
use irradia::scene::{
    Alpha, Bounds, Camera, EmitterSample, Light, LightKind, LoadOptions, Material, MaterialId, Mesh, MeshId, Node,
    NodeId, Primitive, Projection, Revisions, Scene, SceneError, Texture, TextureId, TextureRef, Wrap,
};
use std::f64::consts::PI;

/// A unit square in the XY plane around the origin, facing +Z.
fn square(material: MaterialId) -> Mesh {
    let primitive = Primitive {
        positions: vec![[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]],
        texcoords: [Some(vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]), None],
        indices: vec![0, 1, 2, 0, 2, 3],
        material,
        ..Primitive::default()
    };
    Mesh { name: "square".into(), primitives: vec![primitive] }
}

/// A scene with a matt square (node 0) and, half as large in each direction, a glowing one (node 1).
fn two_squares(glow: Material) -> Scene {
    let mut scene = Scene::empty("squares");
    let matt = scene.add_material(Material::default()).expect("it is sound");
    let glowing = scene.add_material(glow).expect("it is sound");
    for (material, scale) in [(matt, 1.0), (glowing, 0.5)] {
        let mesh = scene.add_mesh(square(material)).expect("it is sound");
        let local = DAffine3::from_scale(DVec3::splat(scale));
        scene.add_node(Node { mesh: Some(mesh), local, ..Node::default() }).expect("it is sound");
    }
    scene
}

fn glow() -> Material {
    Material { emissive: [1.0, 2.0, 4.0], ..Material::default() }
}

/// What of `before` a change has counted up.
fn changed(before: Revisions, after: Revisions) -> [bool; 4] {
    let pairs = [
        (before.geometry, after.geometry),
        (before.materials, after.materials),
        (before.lights, after.lights),
        (before.camera, after.camera),
    ];
    pairs.map(|(before, after)| before != after)
}

#[test]
fn each_change_counts_up_what_it_changes() {
    let mut scene = two_squares(glow());
    let camera = Camera {
        name: "eye".into(),
        projection: Projection::Perspective { vertical_fov: 1.0, aspect: None, near: 0.1 },
    };
    let camera = scene.add_camera(camera).expect("it is sound");
    let light = Light { name: String::new(), kind: LightKind::Point, intensity: [1.0; 3], range: None };
    let light = scene.add_light(light).expect("it is sound");
    let camera_node = scene.add_node(Node { camera: Some(camera), ..Node::default() }).expect("it is sound");
    let light_node =
        scene.add_node(Node { light: Some(light), parent: Some(camera_node), ..Node::default() }).expect("it is sound");
    let moved = DAffine3::from_translation(DVec3::X);

    type Change<'a> = (&'a str, Box<dyn Fn(&mut Scene)>, [bool; 4]);
    let changes: Vec<Change> = vec![
        (
            "a matt object",
            Box::new(move |scene| scene.set_local_transform(NodeId(0), moved).expect("it exists")),
            [true, false, false, false],
        ),
        (
            "the same again",
            Box::new(move |scene| scene.set_local_transform(NodeId(0), moved).expect("it exists")),
            [false; 4],
        ),
        (
            "a glowing object",
            Box::new(move |scene| scene.set_local_transform(NodeId(1), moved).expect("it exists")),
            [true, false, true, false],
        ),
        (
            "a light",
            Box::new(move |scene| scene.set_local_transform(light_node, moved).expect("it exists")),
            [false, false, true, false],
        ),
        (
            "a camera with a light on it",
            Box::new(move |scene| scene.set_local_transform(camera_node, moved).expect("it exists")),
            [false, false, true, true],
        ),
        (
            "a colour",
            Box::new(|scene| {
                scene.set_material(MaterialId(0), Material { metallic: 1.0, ..Material::default() }).expect("it exists")
            }),
            [false, true, false, false],
        ),
        (
            "a glow",
            Box::new(|scene| scene.set_material(MaterialId(1), Material::default()).expect("it exists")),
            [false, true, true, false],
        ),
        ("the sky", Box::new(|scene| scene.set_sky([0.5; 3])), [false, false, true, false]),
        ("the same sky", Box::new(|scene| scene.set_sky([0.5; 3])), [false; 4]),
        (
            "the same light",
            Box::new(move |scene| {
                let same = scene.lights()[light.0].clone();
                scene.set_light(light, same).expect("it exists");
            }),
            [false; 4],
        ),
        ("time without animation", Box::new(|scene| scene.set_time(1.0)), [false; 4]),
    ];
    for (what, change, expected) in changes {
        let before = scene.revisions();
        change(&mut scene);
        assert_eq!(changed(before, scene.revisions()), expected, "{what}");
    }
    assert_eq!(scene.instances()[0].world, moved);
    assert_eq!(scene.world_transform(light_node).translation, DVec3::X * 2.0);
}

#[test]
fn bounds_are_tight_and_follow_the_nodes() {
    let mut scene = two_squares(Material::default());
    let turned = DAffine3::from_rotation_translation(DQuat::from_rotation_z(PI / 4.0), DVec3::new(1e6, 0.0, 0.0));
    scene.bounds();
    scene.set_local_transform(NodeId(0), turned).expect("it exists");
    scene.set_local_transform(NodeId(1), turned).expect("it exists");
    let Bounds { min, max } = scene.bounds().expect("it has triangles");
    let half_diagonal = 0.5f64.sqrt();
    assert!((max - DVec3::new(1e6 + half_diagonal, half_diagonal, 0.0)).length() < 1e-9, "{max}");
    assert!((min - DVec3::new(1e6 - half_diagonal, -half_diagonal, 0.0)).length() < 1e-9, "{min}");
}

#[test]
fn what_contradicts_itself_is_not_taken() {
    let mut scene = two_squares(glow());
    let before = scene.revisions();
    let broken = [
        Primitive { indices: vec![0, 1, 4], ..square(MaterialId(0)).primitives[0].clone() },
        Primitive { indices: vec![0, 1], ..square(MaterialId(0)).primitives[0].clone() },
        Primitive { normals: Some(vec![[0.0, 0.0, 1.0]]), ..square(MaterialId(0)).primitives[0].clone() },
        Primitive { positions: vec![[f32::INFINITY; 3]; 4], ..square(MaterialId(0)).primitives[0].clone() },
        Primitive { material: MaterialId(2), ..square(MaterialId(0)).primitives[0].clone() },
    ];
    for primitive in broken {
        let error = scene.add_mesh(Mesh { name: "broken".into(), primitives: vec![primitive] });
        assert!(matches!(error, Err(SceneError::InvalidObject { .. } | SceneError::UnknownId { .. })), "{error:?}");
    }
    assert!(scene.add_node(Node { parent: Some(NodeId(2)), ..Node::default() }).is_err());
    assert!(scene.set_local_transform(NodeId(0), DAffine3::from_translation(DVec3::splat(f64::NAN))).is_err());
    assert!(scene.set_local_transform(NodeId(2), DAffine3::IDENTITY).is_err());
    assert!(scene.add_material(Material { emissive: [f32::NAN; 3], ..Material::default() }).is_err());
    assert!(
        scene
            .add_material(Material { base_color_texture: Some(TextureRef::new(TextureId(0))), ..Material::default() })
            .is_err()
    );
    assert!(
        scene
            .add_light(Light { name: String::new(), kind: LightKind::Point, intensity: [-1.0; 3], range: None })
            .is_err()
    );
    assert_eq!(scene.revisions(), before);
    assert_eq!(scene.instances().len(), 2);
}

/// A closed unit cube around the origin whose fronts look outwards or inwards.
fn cube(inwards: bool) -> Scene {
    let mut scene = Scene::empty("cube");
    let material = scene.add_material(Material { double_sided: true, ..Material::default() }).expect("it is sound");
    let mesh = scene.add_mesh(square(material)).expect("it is sound");
    let turn = DAffine3::from_rotation_y(if inwards { PI } else { 0.0 });
    let sides = (0..4).map(|side| DQuat::from_rotation_y(f64::from(side) * PI / 2.0));
    let ends = [PI / 2.0, -PI / 2.0].map(DQuat::from_rotation_x);
    for rotation in sides.chain(ends) {
        let local = DAffine3::from_quat(rotation) * DAffine3::from_translation(DVec3::Z * 0.5) * turn;
        scene.add_node(Node { mesh: Some(mesh), local, ..Node::default() }).expect("it is sound");
    }
    scene
}

#[test]
fn objects_are_seen_from_outside_and_rooms_from_inside() {
    for inwards in [false, true] {
        let mut scene = cube(inwards);
        let view = scene.camera_view(None).expect("a view is always found");
        let bounds = scene.bounds().expect("it has triangles");
        let eye = view.world.translation;
        let inside = eye.cmpgt(bounds.min).all() && eye.cmplt(bounds.max).all();
        assert_eq!(inside, inwards, "{view:?}");
        // The same, larger and far away, is seen the same way.
        for node in 0..scene.nodes().len() {
            let far = DAffine3::from_translation(DVec3::new(1e6, 0.0, -3e5)) * DAffine3::from_scale(DVec3::splat(1e3));
            let local = far * scene.nodes()[node].local;
            scene.set_local_transform(NodeId(node), local).expect("it exists");
        }
        let far = scene.camera_view(None).expect("a view is always found").world;
        if inwards {
            // Eyes are so many metres above the floor, so only the side is the same.
            let bounds = scene.bounds().expect("it has triangles");
            assert!(far.translation.cmpgt(bounds.min).all() && far.translation.cmplt(bounds.max).all(), "{far:?}");
            continue;
        }
        assert!(((far.translation - DVec3::new(1e6, 0.0, -3e5)) / 1e3 - eye).length() < 1e-6, "{far:?}");
    }
}

fn total_power(samples: &[EmitterSample]) -> [f64; 3] {
    std::array::from_fn(|channel| samples.iter().map(|sample| f64::from(sample.power[channel])).sum())
}

#[track_caller]
fn assert_close(actual: f64, expected: f64, relative: f64) {
    assert!((actual - expected).abs() <= relative * expected.abs(), "{actual} is not {expected}");
}

#[test]
fn emitters_carry_the_power_of_the_surfaces() {
    let area = 0.25;
    for sides in [1.0, 2.0] {
        let scene = two_squares(Material { double_sided: sides == 2.0, ..glow() });
        for count in [1, 2, 7, 64, 1000] {
            let samples = scene.emitter_samples(count);
            assert_eq!(samples.len(), count);
            for (channel, radiance) in [1.0, 2.0, 4.0].into_iter().enumerate() {
                assert_close(total_power(&samples)[channel], radiance * area * PI * sides, 1e-6);
            }
            assert_close(samples.iter().map(|sample| sample.area).sum(), area, 1e-9);
            assert!(samples.iter().all(|sample| sample.node == NodeId(1) && sample.two_sided == (sides == 2.0)));
        }
    }
    assert!(two_squares(Material::default()).emitter_samples(16).is_empty());
    assert!(two_squares(Material { unlit: true, ..glow() }).emitter_samples(16).is_empty());
}

#[test]
fn emitters_cover_a_square_evenly() {
    // Sixteen emitters on a square: every quarter of it holds four, and together they sit in its middle.
    let samples = two_squares(glow()).emitter_samples(16);
    for (right, top) in [(false, false), (false, true), (true, false), (true, true)] {
        let quarter = samples
            .iter()
            .filter(|sample| (sample.position.x > 0.0) == right && (sample.position.y > 0.0) == top)
            .count();
        assert!((3..=5).contains(&quarter), "{quarter} in the quarter {right} {top}");
    }
    let mean = samples.iter().map(|sample| sample.position).sum::<DVec3>() / 16.0;
    assert!(mean.length() < 0.03, "{mean}");
    for sample in &samples {
        assert!(sample.position.abs().max_element() <= 0.25 && sample.position.z == 0.0);
        assert_eq!(sample.normal, DVec3::Z);
    }
}

#[test]
fn emitters_share_themselves_out_by_power() {
    // A second glowing square of four times the area gets four times the emitters.
    let mut scene = two_squares(glow());
    let mesh = scene.instances()[1].mesh;
    let large = scene.add_node(Node { mesh: Some(mesh), ..Node::default() }).expect("it is sound");
    let samples = scene.emitter_samples(50);
    assert_eq!(samples.iter().filter(|sample| sample.node == large).count(), 40);
}

#[test]
fn emitters_move_with_the_scene() {
    let mut scene = two_squares(glow());
    let before = scene.emitter_samples(32);
    let motion = DAffine3::from_scale_rotation_translation(
        DVec3::splat(3.0),
        DQuat::from_rotation_y(1.0),
        DVec3::new(1e5, -7.0, 2.0),
    );
    for node in [0, 1] {
        let local = motion * scene.nodes()[node].local;
        scene.set_local_transform(NodeId(node), local).expect("it exists");
    }
    for (before, after) in before.iter().zip(scene.emitter_samples(32)) {
        assert!((motion.transform_point3(before.position) - after.position).length() < 1e-9);
        assert!((motion.matrix3 * before.normal / 3.0 - after.normal).length() < 1e-9);
        assert_close(after.area, before.area * 9.0, 1e-9);
    }
}

#[test]
fn mirrored_surfaces_still_emit_towards_their_front() {
    let mut scene = two_squares(glow());
    scene.set_local_transform(NodeId(1), DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0))).expect("it exists");
    assert!(scene.emitter_samples(8).iter().all(|sample| sample.normal == DVec3::Z));
}

#[test]
fn emissive_textures_weigh_the_power() {
    let mut scene = Scene::empty("texture");
    // The left half glows, the right half does not.
    let texture = Texture {
        name: String::new(),
        width: 2,
        height: 1,
        rgba8: vec![255, 255, 255, 255, 0, 0, 0, 255],
        wrap: [Wrap::Clamp; 2],
        nearest: true,
        srgb: true,
    };
    let texture = scene.add_texture(texture).expect("it is sound");
    let material =
        Material { emissive: [1.0; 3], emissive_texture: Some(TextureRef::new(texture)), ..Material::default() };
    let material = scene.add_material(material).expect("it is sound");
    let mesh = scene.add_mesh(square(material)).expect("it is sound");
    scene.add_node(Node { mesh: Some(mesh), ..Node::default() }).expect("it is sound");
    let samples = scene.emitter_samples(10);
    assert_close(total_power(&samples)[0], 0.5 * PI, 2e-3);
    assert_close(samples.iter().map(|sample| sample.area).sum(), 0.5, 2e-3);
    assert!(samples.iter().all(|sample| sample.position.x <= 0.0), "they stand where it glows");
}

/// The glowing square alone, cut out by a texture of 16×16 texels of which some are opaque.
fn cut_square(opaque: impl Fn(u32, u32) -> bool, nearest: bool) -> Scene {
    let mut scene = Scene::empty("cut");
    let alpha = |texel: u32| if opaque(texel % 16, texel / 16) { 255 } else { 0 };
    let texture = Texture {
        name: String::new(),
        width: 16,
        height: 16,
        rgba8: (0..256).flat_map(|texel| [255, 255, 255, alpha(texel)]).collect(),
        wrap: [Wrap::Clamp; 2],
        nearest,
        srgb: true,
    };
    let texture = TextureRef::new(scene.add_texture(texture).expect("it is sound"));
    let material = Material { alpha: Alpha::Mask { cutoff: 0.5 }, base_color_texture: Some(texture), ..glow() };
    let material = scene.add_material(material).expect("it is sound");
    let mesh = scene.add_mesh(square(material)).expect("it is sound");
    scene.add_node(Node { mesh: Some(mesh), ..Node::default() }).expect("it is sound");
    scene
}

#[test]
fn what_alpha_cuts_away_emits_nothing() {
    // Texels 3 to 6 across, 9 to 12 down. With a cutoff of one half a linear filter takes (ln 2 − 1/2)/2 of a texel at each corner.
    let kept = |column: u32, row: u32| (3..7).contains(&column) && (9..13).contains(&row);
    for (nearest, taken) in [(true, 0.0), (false, 2.0 * (2_f64.ln() - 0.5))] {
        let samples = cut_square(kept, nearest).emitter_samples(32);
        let area = (16.0 - taken) / 256.0;
        assert_close(samples.iter().map(|sample| sample.area).sum(), area, 2e-3);
        assert_close(total_power(&samples)[2], 4.0 * area * PI, 2e-3);
        for sample in &samples {
            let [x, y] = [sample.position.x + 0.5, 0.5 - sample.position.y].map(|place| 16.0 * place);
            assert!((3.0..=7.0).contains(&x) && (9.0..=13.0).contains(&y), "{x} {y}");
        }
        let mean = samples.iter().map(|sample| sample.position).sum::<DVec3>() / 32.0;
        assert!((mean - DVec3::new(5.0 / 16.0 - 0.5, 0.5 - 11.0 / 16.0, 0.0)).length() < 0.01, "{mean}");
    }
}

#[test]
fn a_surface_that_is_wholly_cut_is_no_emitter() {
    let mut scene = cut_square(|_, _| false, true);
    assert!(scene.emitter_samples(8).is_empty() && !scene.facts().emissive && !scene.facts().lit());
    // It becomes one when its material is made opaque.
    let opaque = Material { alpha: Alpha::Opaque, ..scene.materials()[0].clone() };
    scene.set_material(MaterialId(0), opaque).expect("it exists");
    assert!(scene.facts().emissive);
    assert_close(total_power(&scene.emitter_samples(8))[0], PI, 1e-6);
}

/// Adds an axis-aligned box; its fronts look inwards or outwards.
fn add_box(scene: &mut Scene, center: DVec3, size: DVec3, inwards: bool) {
    let material = scene.add_material(Material::default()).expect("it is sound");
    let corner = |bits: usize| std::array::from_fn(|axis| if bits >> axis & 1 == 0 { -0.5 } else { 0.5 });
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut indices: Vec<u32> = quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    if inwards {
        indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
    }
    let primitive = Primitive { positions: (0..8).map(corner).collect(), indices, material, ..Primitive::default() };
    let mesh = scene.add_mesh(Mesh { name: "box".into(), primitives: vec![primitive] }).expect("it is sound");
    let local = DAffine3::from_translation(center) * DAffine3::from_scale(size);
    scene.add_node(Node { mesh: Some(mesh), local, ..Node::default() }).expect("it is sound");
}

fn is_within(point: DVec3, center: DVec3, size: DVec3) -> bool {
    (point - center).abs().cmplt(size * 0.5).all()
}

/// The position and the viewing direction of a scene's automatic view, which is the same each time.
fn automatic_view(scene: &Scene) -> (DVec3, DVec3) {
    let view = scene.camera_view(None).expect("a view is always found");
    assert!(view.automatic && view.world.is_finite());
    assert_eq!(view, scene.camera_view(None).expect("a view is always found"));
    (view.world.translation, -view.world.matrix3.z_axis)
}

#[test]
fn rooms_are_seen_from_inside_with_and_without_outer_walls() {
    let (center, size) = (DVec3::new(20.0, 1.5, -7.0), DVec3::new(8.0, 3.0, 5.0));
    for outer_walls in [false, true] {
        let mut scene = Scene::empty("room");
        add_box(&mut scene, center, size, true);
        // A cupboard against one wall, a table in the middle: nobody stands in them.
        let solids = [
            (DVec3::new(16.5, 1.0, -7.0), DVec3::new(1.0, 2.0, 4.0)),
            (DVec3::new(20.0, 0.4, -7.0), DVec3::new(2.0, 0.8, 1.0)),
        ];
        for (center, size) in solids {
            add_box(&mut scene, center, size, false);
        }
        if outer_walls {
            add_box(&mut scene, center, size + 0.6, false);
        }
        let (eye, forward) = automatic_view(&scene);
        assert!(is_within(eye, center, size), "{eye}");
        assert!(solids.iter().all(|&(center, size)| !is_within(eye, center, size)), "{eye}");
        assert!(eye.y > 0.7 && eye.y < 2.5, "eye height {}", eye.y);
        assert!(forward.y.abs() < 1e-6, "level: {forward}");
        // There is space in front of the eye.
        assert!(is_within(eye + forward * 2.0, center, size), "{eye} {forward}");
    }
}

#[test]
fn objects_are_seen_from_outside() {
    let mut scene = Scene::empty("table");
    add_box(&mut scene, DVec3::new(0.0, 0.75, 0.0), DVec3::new(2.0, 0.1, 1.0), false);
    for x in [-0.9, 0.9] {
        add_box(&mut scene, DVec3::new(x, 0.35, 0.0), DVec3::new(0.1, 0.7, 1.0), false);
    }
    let bounds = scene.bounds().expect("it has triangles");
    let (eye, forward) = automatic_view(&scene);
    assert!(!is_within(eye, bounds.center(), bounds.size()), "{eye}");
    assert!((bounds.center() - eye).normalize().dot(forward) > 0.999);
}

#[test]
fn an_empty_scene_has_a_view() {
    automatic_view(&Scene::empty("nothing"));
}

#[test]
fn a_mesh_that_is_replaced_counts_as_geometry_and_where_it_shines_as_light() {
    let mut scene = two_squares(glow());
    let (matt, glowing) = (scene.meshes()[0].clone(), scene.meshes()[1].clone());
    let raised = |mesh: &Mesh| {
        let mut mesh = mesh.clone();
        mesh.primitives[0].positions.iter_mut().for_each(|position| position[2] += 3.0);
        mesh
    };
    let before = scene.revisions();
    scene.set_mesh(MeshId(0), raised(&matt)).expect("it is sound");
    assert_eq!(changed(before, scene.revisions()), [true, false, false, false]);
    assert_ne!(before.meshes, scene.revisions().meshes);
    assert_eq!(scene.bounds().expect("triangles").max.z, 3.0);
    let before = scene.revisions();
    scene.set_mesh(MeshId(1), raised(&glowing)).expect("it is sound");
    assert_eq!(changed(before, scene.revisions()), [true, false, true, false]);
    let before = scene.revisions();
    let two = Mesh { primitives: [matt.primitives.clone(), matt.primitives.clone()].concat(), ..Mesh::default() };
    assert!(matches!(scene.set_mesh(MeshId(0), two), Err(SceneError::InvalidObject { .. })));
    let mut endless = matt.clone();
    endless.primitives[0].positions[0][0] = f32::INFINITY;
    assert!(scene.set_mesh(MeshId(0), endless).is_err());
    assert!(matches!(scene.set_mesh(MeshId(2), matt), Err(SceneError::UnknownId { kind: "mesh", .. })));
    assert_eq!(before, scene.revisions(), "what is refused changes nothing");
}

#[test]
fn nodes_are_animated_together_or_not_at_all() {
    let mut scene = two_squares(Material::default());
    let up = |height: f64| DAffine3::from_translation(DVec3::new(0.0, height, 0.0));
    scene.animate(&[(NodeId(0), up(1.0)), (NodeId(1), up(2.0))]).expect("two nodes");
    assert_eq!([0, 1].map(|node| scene.world_transform(NodeId(node)).translation.y), [1.0, 2.0]);
    let before = scene.revisions();
    assert!(scene.animate(&[(NodeId(0), up(5.0)), (NodeId(7), up(5.0))]).is_err());
    assert!(scene.animate(&[(NodeId(0), up(5.0)), (NodeId(1), up(f64::NAN))]).is_err());
    assert_eq!(scene.world_transform(NodeId(0)).translation.y, 1.0);
    assert_eq!(before, scene.revisions());
}

#[test]
fn files_of_a_scene_may_come_from_the_caller() {
    let json = br#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "../a%20file.bin"}]}"#;
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|axis| axis.to_le_bytes()).collect();
    let read = |uri: &str| if uri == "../a file.bin" { Ok(bytes.clone()) } else { Err(format!("no {uri}")) };
    let scene = Scene::from_bytes_by("held", json, &read, &LoadOptions::default()).expect("a triangle");
    assert_eq!(scene.meshes()[0].primitives[0].positions, corners);
    let none = |_: &str| Err("the caller has no such file".to_owned());
    let error = Scene::from_bytes_by("held", json, &none, &LoadOptions::default()).expect_err("no file").to_string();
    assert!(error.contains("the caller has no such file"), "{error}");
    let little = LoadOptions::default().with(|options| options.file_bytes = json.len() as u64 + 35);
    assert!(Scene::from_bytes_by("held", json, &read, &little).is_err(), "beyond the limit");
}
