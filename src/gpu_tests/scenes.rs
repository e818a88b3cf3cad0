//! Scenes built in memory, and their parts.

use glam::{DAffine3, DVec3};

use crate::renderer::{DiffuseMethod, FrameRequest, Preset, Settings, Slot, Technique};
use crate::scene::{
    Alpha, CameraView, Light, LightKind, LightSpec, Material, MaterialId, Mesh, Node, NodeId, Primitive, Projection,
    Scene, Texture, TextureRef, Wrap,
};

/// Diffuse alone: no specular layer takes a share.
pub(crate) fn lambert(albedo: [f32; 3]) -> Material {
    let [red, green, blue] = albedo;
    Material { base_color: [red, green, blue, 1.0], specular: 0.0, ..Material::default() }
}

/// Two triangles; `corners` counter-clockwise as seen from the front.
pub(crate) fn quad(corners: [[f32; 3]; 4], material: MaterialId) -> Primitive {
    Primitive { positions: corners.to_vec(), indices: vec![0, 1, 2, 0, 2, 3], material, ..Primitive::default() }
}

/// The six faces of the box from -`half` to `half`, each with its material: -x, +x, -y, +y, -z, +z.
pub(crate) fn box_faces(half: [f32; 3], materials: [MaterialId; 6]) -> Vec<Primitive> {
    let face = |index: usize| {
        let (axis, sign) = (index / 2, if index.is_multiple_of(2) { -1.0 } else { 1.0 });
        let corner = |u: f32, v: f32| {
            let mut point = [0.0; 3];
            point[axis] = sign * half[axis];
            point[(axis + 1) % 3] = u * half[(axis + 1) % 3];
            point[(axis + 2) % 3] = v * sign * half[(axis + 2) % 3];
            point
        };
        // Front faces look inwards.
        quad([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)], materials[index])
    };
    (0..6).map(face).collect()
}

/// Places a mesh of these primitives.
pub(crate) fn place(scene: &mut Scene, primitives: Vec<Primitive>, local: DAffine3) -> NodeId {
    let mesh = scene.add_mesh(Mesh { name: String::new(), primitives }).expect("a sound mesh");
    scene.add_node(Node { mesh: Some(mesh), local, ..Node::default() }).expect("a sound node")
}

/// A closed box around the origin, all of one material.
pub(crate) fn closed_box(half: f32, material: Material) -> Scene {
    let mut scene = Scene::empty("box");
    let id = scene.add_material(material).expect("a sound material");
    place(&mut scene, box_faces([half; 3], [id; 6]), DAffine3::IDENTITY);
    scene
}

/// A square in the plane y = 0, seen from above as front.
pub(crate) fn floor(half: f32, material: Material) -> Scene {
    let mut scene = Scene::empty("floor");
    let id = scene.add_material(material).expect("a sound material");
    let corners = [[-half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half]];
    place(&mut scene, vec![quad(corners, id)], DAffine3::IDENTITY);
    scene
}

/// A square of 4×4 texels, every other one of which is a hole; `corners` as [`quad`] takes them.
pub(crate) fn lattice(scene: &mut Scene, corners: [[f32; 3]; 4]) -> Primitive {
    let alpha = |texel: u32| if (texel % 4 + texel / 4).is_multiple_of(2) { 255 } else { 0 };
    let texture = Texture {
        name: String::new(),
        width: 4,
        height: 4,
        rgba8: (0..16).flat_map(|texel| [255, 255, 255, alpha(texel)]).collect(),
        wrap: [Wrap::Repeat; 2],
        nearest: true,
        srgb: true,
    };
    let texture = TextureRef::new(scene.add_texture(texture).expect("sound"));
    let material =
        Material { alpha: Alpha::Mask { cutoff: 0.5 }, base_color_texture: Some(texture), ..lambert([0.5; 3]) };
    let material = scene.add_material(material).expect("sound");
    let texcoords = vec![[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    Primitive { texcoords: [Some(texcoords), None], ..quad(corners, material) }
}

/// Four separate rooms in a row, each with its own colour, kind of light and strength.
pub(crate) fn four_rooms() -> Scene {
    let mut scene = Scene::empty("four rooms");
    let spot = LightKind::Spot { inner_angle: 0.4, outer_angle: 0.7 };
    let rooms = [
        ([0.9, 0.1, 0.1], LightKind::Point, [1.0, 2.0, 3.0]),
        ([0.1, 0.8, 0.2], spot, [40.0, 10.0, 10.0]),
        ([0.3, 0.3, 0.9], LightKind::Point, [0.3, 0.2, 0.1]),
        ([0.5, 0.5, 0.5], LightKind::Point, [0.001; 3]),
    ];
    for (index, (albedo, kind, intensity)) in rooms.into_iter().enumerate() {
        let center = DVec3::new(10.0 * index as f64, 0.0, 0.0);
        let wall = scene.add_material(lambert(albedo)).expect("a sound material");
        let grey = scene.add_material(lambert([0.6; 3])).expect("a sound material");
        let faces = box_faces([1.0; 3], [wall, wall, grey, grey, wall, grey]);
        place(&mut scene, faces, DAffine3::from_translation(center));
        add_light(&mut scene, kind, center + DVec3::new(0.1, 0.3, -0.2), DVec3::new(0.2, -1.0, 0.1), intensity);
    }
    scene
}

pub(crate) fn add_light(
    scene: &mut Scene,
    kind: LightKind,
    position: DVec3,
    direction: DVec3,
    intensity: [f32; 3],
) -> crate::scene::LightId {
    let light = Light { name: String::new(), kind, intensity, range: None };
    scene.add_light_spec(&LightSpec { light, position, direction }).expect("a sound light")
}

/// A perspective view with a vertical angle of 60°.
pub(crate) fn view(eye: DVec3, target: DVec3) -> CameraView {
    let up = if (target - eye).cross(DVec3::Y).length() < 1e-6 { DVec3::NEG_Z } else { DVec3::Y };
    CameraView::look_at(
        eye,
        target,
        up,
        Projection::Perspective { vertical_fov: 60_f64.to_radians(), aspect: None, near: 0.01 },
    )
}

pub(crate) fn builtin(name: &str) -> Scene {
    Scene::builtin(name).expect("a built-in scene").expect("it loads")
}

/// A room of which one wall is missing, under a sky.
pub(crate) fn open_room() -> (Scene, CameraView) {
    let mut scene = Scene::empty("open room");
    let wall = scene.add_material(lambert([0.6, 0.5, 0.4])).expect("a sound material");
    let mut faces = box_faces([1.0; 3], [wall; 6]);
    faces.truncate(5);
    place(&mut scene, faces, DAffine3::IDENTITY);
    scene.set_sky([1.0, 1.2, 1.5]);
    (scene, view(DVec3::new(0.2, 0.1, 0.9), DVec3::new(0.0, -0.3, -1.0)))
}

/// A closed box with a square lamp in it.
pub(crate) fn lamp_box() -> (Scene, CameraView) {
    let mut scene = closed_box(1.0, lambert([0.7, 0.5, 0.3]));
    let lamp = scene.add_material(Material { emissive: [5.0; 3], ..lambert([0.0; 3]) }).expect("a sound material");
    let corners = [[-0.3, 0.7, -0.3], [0.3, 0.7, -0.3], [0.3, 0.7, 0.3], [-0.3, 0.7, 0.3]];
    place(&mut scene, vec![quad(corners, lamp)], DAffine3::IDENTITY);
    (scene, view(DVec3::new(0.1, -0.1, 0.9), DVec3::new(0.0, -0.3, -1.0)))
}

/// A floor under the sun, and a wall that it lights.
pub(crate) fn sunlit_corner() -> (Scene, CameraView) {
    let mut scene = floor(1.0, lambert([0.7; 3]));
    let wall = scene.add_material(lambert([0.7, 0.2, 0.2])).expect("a sound material");
    let corners = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 2.0, -1.0], [-1.0, 2.0, -1.0]];
    place(&mut scene, vec![quad(corners, wall)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.2, -1.0, -0.7), [3.0; 3]);
    (scene, view(DVec3::new(0.0, 1.0, 1.5), DVec3::new(0.0, 0.5, -1.0)))
}

/// A built-in scene and its camera.
pub(crate) fn with_camera(name: &str) -> (Scene, CameraView) {
    let scene = builtin(name);
    let camera = scene.camera_view(None).expect("its camera");
    (scene, camera)
}

/// The rsm technique at its default preset with these changes.
pub(crate) fn settings(changes: &[(&str, &str)]) -> Settings {
    settings_of(Technique::Rsm, changes)
}

/// Any technique, likewise.
pub(crate) fn settings_of(technique: Technique, changes: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(technique, Preset::Default);
    for (key, value) in changes {
        settings.set(key, value).expect("a setting and its value");
    }
    settings
}

/// The same with virtual point lights gathered at regions.
pub(crate) fn vpl_settings(changes: &[(&str, &str)]) -> Settings {
    let mut settings = settings(changes);
    settings.methods.diffuse = DiffuseMethod::Vpl;
    settings
}

/// The image and these slots.
pub(crate) fn request(size: [u32; 2], camera: CameraView, slots: &[Slot]) -> FrameRequest {
    FrameRequest { slots: slots.to_vec(), ..FrameRequest::new(size, camera) }
}
