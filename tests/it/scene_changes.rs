//! What callers change in scenes: what is counted, what is refused, where files come from.

use glam::{DAffine3, DVec3};
use irradia::scene::{
    Camera, Light, LightKind, LoadOptions, Material, MaterialId, Mesh, MeshId, Node, NodeId, Projection, Revisions,
    Scene, SceneError,
};

use crate::scene::{glow, two_squares};

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
