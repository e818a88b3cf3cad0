//! Scenes built in memory: what changes are counted, what emissive surfaces come to.

use glam::{DAffine3, DQuat, DVec3};
use irradia::scene::{
    Alpha, Bounds, EmitterSample, Light, LightKind, Material, MaterialId, Mesh, Node, NodeId, Primitive, Scene,
    SceneError, Texture, TextureId, TextureRef, Wrap,
};
use std::f64::consts::PI;

/// A unit square in the XY plane around the origin, facing +Z.
pub(crate) fn square(material: MaterialId) -> Mesh {
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
pub(crate) fn two_squares(glow: Material) -> Scene {
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

pub(crate) fn glow() -> Material {
    Material { emissive: [1.0, 2.0, 4.0], ..Material::default() }
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
