//! Binding groups: a pass takes of a group what its program uses, and depends on no more.

use super::scenes::builtin;
use super::session::Session;
use crate::frame::rays::{TracedScene, traced_key};
use crate::graph::{Dependence, Graph, Store};
use crate::renderer::Timing;
use crate::scene::Scene;
use crate::shaders::trace::Closest;
use ash::vk;

/// Traces one ray through the scene; returns whether the pass ran.
fn traced(store: &mut Store, session: &Session, scene: &Scene) -> bool {
    let traced = TracedScene::new(session.context.shared_device(), scene).expect("the scene fits the device");
    let mut graph = Graph::new(store);
    let rays = graph.upload("rays", &[[0.0_f32, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0]], Dependence::NONE);
    let hits = graph.buffer("hits", 1);
    let scene_rays = traced.rays(&mut graph);
    let pass = Closest { scene_rays, rays: rays.texels(vk::Format::R32G32B32A32_SFLOAT), hits: hits.write() };
    graph.pass("test/closest", pass).threads([1, 1, 1]);
    graph.want_buffer(hits);
    graph.run(Timing::Frame).expect("a frame").passes[0].skipped.is_none()
}

#[test]
fn a_light_that_moves_runs_nothing_again_that_reads_surfaces_alone() {
    let session = Session::open();
    let mut store = session.store();
    let mut scene = builtin("cornell-point");
    assert!(traced(&mut store, &session, &scene));
    let before = traced_key(&scene);
    let (id, mut light) = (crate::scene::LightId(0), scene.lights()[0].clone());
    light.intensity = light.intensity.map(|channel| 2.0 * channel);
    scene.set_light(id, light).expect("a light");
    assert_ne!(traced_key(&scene), before, "what shines is another");
    assert!(!traced(&mut store, &session, &scene));
}
