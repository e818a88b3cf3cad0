//! Keys change with everything that changes the picture, and with nothing else.

use glam::{DAffine3, DQuat};

use super::*;
use crate::scene::{Alpha, Light, LightKind, Material, Mesh, Node, Primitive, Scene, Texture, TextureRef, Wrap};

/// The parts of a small scene, so that each can be changed before they are put together.
struct Parts {
    texture: Texture,
    material: Material,
    primitive: Primitive,
    light: Light,
    mesh_at: DAffine3,
    light_at: DAffine3,
    names: &'static str,
    sky: [f32; 3],
    request: ReferenceRequest,
}

impl Parts {
    fn new() -> Parts {
        let texture = Texture {
            name: String::new(),
            width: 2,
            height: 1,
            rgba8: vec![1, 2, 3, 4, 5, 6, 7, 8],
            wrap: [Wrap::Repeat, Wrap::Mirror],
            nearest: false,
            srgb: true,
        };
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let primitive = Primitive {
            normals: Some(vec![[0.0, 0.0, 1.0]; 4]),
            tangents: Some(vec![[1.0, 0.0, 0.0, 1.0]; 4]),
            texcoords: [Some(vec![[0.5, 0.5]; 4]), None],
            colors: Some(vec![[1.0; 4]; 4]),
            indices: vec![0, 1, 2, 2, 1, 3],
            positions,
            ..Primitive::default()
        };
        let kind = LightKind::Spot { inner_angle: 0.5, outer_angle: 0.6 };
        Parts {
            texture,
            material: Material::default(),
            primitive,
            light: Light { name: String::new(), kind, intensity: [1.0, 2.0, 3.0], range: None },
            mesh_at: DAffine3::IDENTITY,
            light_at: DAffine3::IDENTITY,
            names: "",
            sky: [0.0; 3],
            request: request(SIZE),
        }
    }

    fn key(self) -> ReferenceKey {
        let name = || self.names.to_owned();
        let mut scene = Scene::empty(self.names);
        let texture = scene.add_texture(Texture { name: name(), ..self.texture }).expect("sound");
        let mut material = Material { name: name(), ..self.material };
        material.base_color_texture.get_or_insert(TextureRef::new(texture));
        let material = scene.add_material(material).expect("sound");
        let primitive = Primitive { material, ..self.primitive };
        let mesh = scene.add_mesh(Mesh { name: name(), primitives: vec![primitive] }).expect("sound");
        let light = scene.add_light(Light { name: name(), ..self.light }).expect("sound");
        let node = |local| Node { name: name(), local, ..Node::default() };
        scene.add_node(Node { mesh: Some(mesh), ..node(self.mesh_at) }).expect("sound");
        scene.add_node(Node { light: Some(light), ..node(self.light_at) }).expect("sound");
        scene.set_sky(self.sky);
        ReferenceKey::of(&scene, &self.request)
    }
}

/// Changes one thing in the parts of a scene.
type Change = fn(&mut Parts);

const CHANGES: &[(&str, Change)] = &[
    ("a vertex", |parts| parts.primitive.positions[3][2] = 1e-6),
    ("a normal", |parts| parts.primitive.normals.as_mut().expect("present")[0] = [0.0, 1.0, 0.0]),
    ("no normals", |parts| parts.primitive.normals = None),
    ("a tangent", |parts| parts.primitive.tangents.as_mut().expect("present")[0][3] = -1.0),
    ("a texture coordinate", |parts| parts.primitive.texcoords[0].as_mut().expect("present")[1][0] = 0.25),
    ("the other set of texture coordinates", |parts| parts.primitive.texcoords.swap(0, 1)),
    ("a colour", |parts| parts.primitive.colors.as_mut().expect("present")[2][1] = 0.5),
    ("a triangle", |parts| parts.primitive.indices.truncate(3)),
    ("the winding", |parts| parts.primitive.indices.swap(0, 1)),
    ("a texel", |parts| parts.texture.rgba8[5] = 7),
    ("the shape of a texture", |parts| (parts.texture.width, parts.texture.height) = (1, 2)),
    ("the border of a texture", |parts| parts.texture.wrap[1] = Wrap::Clamp),
    ("the encoding of a texture", |parts| parts.texture.srgb = false),
    ("the filter of a texture", |parts| parts.texture.nearest = true),
    ("a base colour", |parts| parts.material.base_color[1] = 0.5),
    ("a metal", |parts| parts.material.metallic = 1.0),
    ("a roughness", |parts| parts.material.roughness = 0.5),
    ("an emitter", |parts| parts.material.emissive = [1.0; 3]),
    ("an index of refraction", |parts| parts.material.ior = 1.33),
    ("a specular factor", |parts| parts.material.specular = 0.5),
    ("a specular colour", |parts| parts.material.specular_color[0] = 0.5),
    ("a transmission", |parts| parts.material.transmission = 1.0),
    ("a thickness", |parts| parts.material.thickness = 1.0),
    ("an attenuation", |parts| parts.material.attenuation_distance = 1.0),
    ("an attenuation's colour", |parts| parts.material.attenuation_color[2] = 0.5),
    ("a normal scale", |parts| parts.material.normal_scale = 0.5),
    ("a cut-out", |parts| parts.material.alpha = Alpha::Mask { cutoff: 0.5 }),
    ("a side", |parts| parts.material.double_sided = true),
    ("an unlit surface", |parts| parts.material.unlit = true),
    ("a use of a texture", |parts| parts.material.normal_texture = Some(TextureRef::new(crate::scene::TextureId(0)))),
    ("where a mesh stands", |parts| parts.mesh_at.translation.x = 1e-9),
    ("where a light stands", |parts| parts.light_at.translation.y = 1.0),
    ("where a light shines", |parts| parts.light_at = DAffine3::from_quat(DQuat::from_rotation_x(1.0))),
    ("a light's strength", |parts| parts.light.intensity[2] = 4.0),
    ("a light's kind", |parts| parts.light.kind = LightKind::Point),
    ("a light's angle", |parts| parts.light.kind = LightKind::Spot { inner_angle: 0.4, outer_angle: 0.6 }),
    ("the sky", |parts| parts.sky = [0.0, 0.0, 0.1]),
    ("the width", |parts| parts.request.size[0] += 1),
    ("the shape", |parts| parts.request.size.swap(0, 1)),
    ("where the camera stands", |parts| parts.request.camera.world.translation.z = 4.0),
    ("where the camera looks", |parts| parts.request.camera.world.matrix3.z_axis.x = 0.1),
    ("the field of view", |parts| {
        parts.request.camera.projection = Projection::Perspective { vertical_fov: 1.1, aspect: None, near: 0.1 };
    }),
    ("the projection", |parts| {
        parts.request.camera.projection =
            Projection::Orthographic { half_width: 1.0, half_height: 1.0, near: 0.1, far: 10.0 };
    }),
    ("the estimator", |parts| parts.request.estimator = Estimator::Sppm),
    ("no bounces", |parts| parts.request.bounces = Some(0)),
    ("caustics of specular paths alone", |parts| parts.request.caustics = CausticPaths::Specular),
    ("nothing specular on the way", |parts| parts.request.caustics = CausticPaths::None),
    ("no caustics in mirrors", |parts| parts.request.caustics = CausticPaths::Unmirrored),
    ("caustics in mirrors, as rays find them", |parts| parts.request.caustics = CausticPaths::Mirrored),
    ("no reflection", |parts| parts.request.mirrors = Some(0)),
    ("one reflection", |parts| parts.request.mirrors = Some(1)),
    ("one bounce", |parts| parts.request.bounces = Some(1)),
    ("the filter", |parts| parts.request.filter = PixelFilter::Box),
    ("the seed", |parts| parts.request.seed = 1),
];

#[test]
fn every_change_makes_another_key() {
    let mut keys = vec![("nothing", Parts::new().key())];
    for (what, change) in CHANGES {
        let mut parts = Parts::new();
        change(&mut parts);
        let key = parts.key();
        if let Some((same, _)) = keys.iter().find(|(_, other)| *other == key) {
            panic!("{what} and {same} have the same key");
        }
        keys.push((what, key));
    }
}

#[test]
fn names_and_other_idle_things_do_not_count() {
    let changes: [Change; 4] = [
        |parts| parts.names = "another name",
        |parts| parts.request.camera.name = "another name".to_owned(),
        |parts| parts.primitive.source_bytes = 1000,
        |parts| {
            parts.request.camera.projection =
                Projection::Perspective { vertical_fov: 1.0, aspect: Some(2.0), near: 0.1 };
        },
    ];
    let key = Parts::new().key();
    for change in changes {
        let mut parts = Parts::new();
        change(&mut parts);
        assert_eq!(parts.key(), key);
    }
    assert_eq!(ReferenceKey::parse(key.as_str()), Some(key.clone()));
    assert_eq!(ReferenceKey::parse(key.prefix()), None);
}

#[test]
fn a_key_is_the_same_in_every_process_and_on_every_machine() {
    // of version 3; another version has another key.
    assert_eq!((REFERENCE_VERSION, Parts::new().key().prefix()), (3, "98afb50796c35a92"));
}
