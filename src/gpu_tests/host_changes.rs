//! What a host program changes between frames: vertices of meshes, and a frame that it stops.

use glam::{DAffine3, DVec3};

use super::scenes::{add_light, builtin, closed_box, lambert, place, quad, request, settings_of, view};
use super::session::Session;
use crate::method::Error;
use crate::renderer::{DirectMethod, FrameRequest, Progress, Technique};
use crate::scene::{LightKind, MaterialId, Mesh, MeshId, Node, NodeId, Scene};
use crate::shaders::types;
use crate::slot::Slot;
use crate::vulkan::VulkanError;
use std::sync::{Arc, Mutex};

/// A room with a white block in it whose top lies at `height`.
fn room(height: f32) -> Scene {
    let mut scene = closed_box(2.0, lambert([0.7; 3]));
    let white = scene.add_material(lambert([0.9; 3])).expect("it is sound");
    let top = [[-0.5, height, 0.5], [0.5, height, 0.5], [0.5, height, -0.5], [-0.5, height, -0.5]];
    place(&mut scene, vec![quad(top, white)], DAffine3::IDENTITY);
    add_light(&mut scene, LightKind::Point, DVec3::new(0.0, 1.8, 0.0), DVec3::NEG_Y, [20.0; 3]);
    scene
}

fn seen(size: [u32; 2]) -> FrameRequest {
    request(size, view(DVec3::new(0.0, 1.0, 1.9), DVec3::new(0.0, -1.0, 0.0)), &[Slot::Direct, Slot::Diffuse])
}

/// A mesh whose vertices moved is, to the bit, one that was there from the beginning: to rasterisers, to rays, to what is kept of particles.
#[test]
fn vertices_move_between_frames() {
    let session = Session::open();
    for technique in [Technique::Hybrid, Technique::Particles] {
        let settings = settings_of(technique, &[("particles.count", "2000"), ("vpl.count", "200")]);
        let mut scene = room(-1.0);
        let mesh = MeshId(scene.meshes().len() - 1);
        let mut renderer = session.renderer(&settings);
        let before = renderer.render(&scene, &seen([32, 32])).expect("a frame");
        scene.set_mesh(mesh, room(-0.2).meshes()[mesh.0].clone()).expect("it is sound");
        let after = renderer.render(&scene, &seen([32, 32])).expect("a frame");
        let fresh = session.renderer(&settings).render(&room(-0.2), &seen([32, 32])).expect("a frame");
        for slot in [Slot::Direct, Slot::Diffuse] {
            assert!(before.slots[&slot] != after.slots[&slot], "{technique:?}: {slot} shows the old vertices");
            assert!(after.slots[&slot] == fresh.slots[&slot], "{technique:?}: {slot} is not that of a fresh scene");
        }
    }
}

/// Of many instances those that moved are sent, and nothing else; a material alone sends no instance.
#[test]
fn what_changed_is_sent_and_nothing_else() {
    const COUNT: usize = 10_000;
    const MOVED: usize = 1_000;
    let session = Session::open();
    let mut scene = Scene::empty("many");
    let material = scene.add_material(lambert([0.5; 3])).expect("it is sound");
    let corners = [[-0.4, 0.0, 0.4], [0.4, 0.0, 0.4], [0.4, 0.0, -0.4], [-0.4, 0.0, -0.4]];
    let mesh = Mesh { primitives: vec![quad(corners, material)], ..Mesh::default() };
    let mesh = scene.add_mesh(mesh).expect("it is sound");
    let place = |index: usize, height: f64| {
        DAffine3::from_translation(DVec3::new((index % 100) as f64, height, (index / 100) as f64))
    };
    for index in 0..COUNT {
        let node = Node { mesh: Some(mesh), local: place(index, 0.0), ..Node::default() };
        scene.add_node(node).expect("it is sound");
    }
    let light = add_light(&mut scene, LightKind::Directional, DVec3::ZERO, DVec3::new(0.1, -1.0, 0.2), [3.0; 3]);
    let settings = settings_of(Technique::Direct, &[]);
    let request = request([64, 64], view(DVec3::new(50.0, 60.0, 120.0), DVec3::new(50.0, 0.0, 50.0)), &[Slot::Direct]);
    let mut renderer = session.renderer(&settings);
    let first = renderer.render(&scene, &request).expect("a frame");
    let record = size_of::<types::Instance>();
    assert!(first.timings.upload_bytes > (COUNT * record) as u64);
    let still = renderer.render(&scene, &request).expect("a frame");
    assert_eq!(still.timings.upload_bytes, 0);
    let moved: Vec<_> = (0..MOVED).map(|index| (NodeId(7 * index), place(7 * index, 3.0))).collect();
    scene.animate(&moved).expect("they are there");
    let after = renderer.render(&scene, &request).expect("a frame");
    assert_eq!(after.timings.upload_bytes, (MOVED * record) as u64);
    let fresh = session.render(&scene, &settings, &request);
    assert!(after.slots == fresh.slots && after.slots != still.slots, "it shows what a fresh renderer shows");
    let dimmed = crate::scene::Light { intensity: [1.0; 3], ..scene.lights()[light.0].clone() };
    scene.set_light(light, dimmed).expect("it is sound");
    assert_eq!(renderer.render(&scene, &request).expect("a frame").timings.upload_bytes, 0);
}

/// Of meshes and materials those that changed are sent; textures never again.
#[test]
fn a_changed_mesh_and_a_changed_material_are_sent_alone() {
    let session = Session::open();
    let mut scene = builtin("textured");
    let quads = [0.0, 0.3, 0.6].map(|height: f32| {
        let corners = [[-0.2, height, 0.2], [0.2, height, 0.2], [0.2, height, -0.2], [-0.2, height, -0.2]];
        quad(corners, MaterialId(0))
    });
    let mesh = scene.add_mesh(Mesh { primitives: quads.to_vec(), ..Mesh::default() }).expect("it is sound");
    scene.add_node(Node { mesh: Some(mesh), ..Node::default() }).expect("it is sound");
    let mut settings = settings_of(Technique::Direct, &[]);
    settings.methods.direct = DirectMethod::Traced;
    let request = request([48, 32], scene.camera_view(None).expect("a view"), &[Slot::Direct]);
    let mut renderer = session.renderer(&settings);
    let first = renderer.render(&scene, &request).expect("a frame");

    let mut moved = scene.meshes()[mesh.0].clone();
    moved.primitives[1].positions.iter_mut().for_each(|position| position[1] += 0.2);
    scene.set_mesh(mesh, moved.clone()).expect("it is sound");
    let after = renderer.render(&scene, &request).expect("a frame");
    // Three quads: 18 indices of 4 bytes; of vertices at most one a corner of each triangle, 12 bytes of position, 8 of normal and of tangent, 16 of coordinates, 4 of colour. Their
    // three instances besides.
    let most = 18 * (4 + 12 + 8 + 8 + 16 + 4) + 3 * size_of::<types::Instance>() as u64;
    assert!((1..=most).contains(&after.timings.upload_bytes), "{} of {most}", after.timings.upload_bytes);
    assert!(after.slots != first.slots && after.slots == session.render(&scene, &settings, &request).slots);

    let mut material = scene.materials()[0].clone();
    material.base_color = [0.2, 0.9, 0.3, 1.0];
    scene.set_material(MaterialId(0), material).expect("it is sound");
    let painted = renderer.render(&scene, &request).expect("a frame");
    assert_eq!(painted.timings.upload_bytes, size_of::<types::Material>() as u64);
    assert!(painted.slots != after.slots && painted.slots == session.render(&scene, &settings, &request).slots);

    // Another number of triangles, another set of attributes: all is sent, and shows.
    moved.primitives[0].indices.truncate(3);
    moved.primitives[2].colors = Some(vec![[0.5; 4]; 4]);
    scene.set_mesh(mesh, moved).expect("it is sound");
    let other = renderer.render(&scene, &request).expect("a frame");
    assert!(other.timings.upload_bytes > most);
    assert!(other.slots != painted.slots && other.slots == session.render(&scene, &settings, &request).slots);

    let mut texture = scene.textures()[0].clone();
    texture.rgba8.fill(77);
    let bytes = texture.rgba8.len() as u64;
    scene.add_texture(texture).expect("it is sound");
    let more = renderer.render(&scene, &request).expect("a frame");
    assert!(more.timings.upload_bytes > bytes && more.slots == other.slots);
}

#[test]
fn a_frame_that_is_stopped_leaves_the_renderer_as_it_was() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let camera = scene.camera_view(None).expect("a view");
    for technique in [Technique::Path, Technique::Hybrid] {
        let settings = settings_of(technique, &[("path.spp", "8")]);
        let mut renderer = session.renderer(&settings);
        let heard = Arc::new(Mutex::new(Vec::new()));
        let hears = heard.clone();
        let mut wanted = request([16, 16], camera.clone(), &[Slot::Diffuse]);
        wanted.progress = Some(Progress::new(move |done| {
            let mut heard = hears.lock().expect("nobody panics");
            heard.push(done);
            heard.len() < 2
        }));
        let stopped = renderer.render(&scene, &wanted);
        if technique == Technique::Path {
            assert!(matches!(stopped, Err(Error::Vulkan(VulkanError::Cancelled))), "{stopped:?}");
            assert_eq!(heard.lock().expect("nobody panics").len(), 2);
        }
        let hears = heard.clone();
        wanted.progress = Some(Progress::new(move |done| {
            hears.lock().expect("nobody panics").push(done);
            true
        }));
        heard.lock().expect("nobody panics").clear();
        renderer.cancel().ask();
        assert!(matches!(renderer.render(&scene, &wanted), Err(Error::Vulkan(VulkanError::Cancelled))));
        // What the stopped one left is taken up: nothing is invalidated.
        let frame = renderer.render(&scene, &wanted).expect("nobody stops it");
        let heard = heard.lock().expect("nobody panics").clone();
        let fresh = session.renderer(&settings).render(&scene, &wanted).expect("a frame");
        assert!(frame.slots == fresh.slots, "{technique:?}");
        assert!(heard.iter().all(|done| (0.0..=1.0).contains(done)), "{heard:?}");
        if technique == Technique::Path {
            assert!(heard.is_sorted() && heard.len() > 4 && heard.last() == Some(&1.0), "{heard:?}");
        }
    }
}
