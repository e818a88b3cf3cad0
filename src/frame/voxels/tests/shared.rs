//! Voxels as methods ask for them.

use std::collections::BTreeSet;
use std::rc::Rc;

use ash::vk;
use glam::{DAffine3, DVec3};

use super::{ball, draws};

use crate::frame::light_set::LightSet;
use crate::frame::scene_data::SceneData;
use crate::frame::voxels::{VoxelSettings, Voxelisation, shaders};
use crate::gpu_tests::scenes::{closed_box, lambert, place, request, view};
use crate::gpu_tests::session::Session;
use crate::graph::{Dependence, Graph};
use crate::method::{FrameCx, Inputs};
use crate::renderer::declare::Shared;
use crate::renderer::{Preset, Settings, Technique, Timing};
use crate::shaders::selftest::{Cones, ConesPush};

#[test]
fn two_that_ask_alike_share_voxels_and_only_listed_programs_run() {
    let session = Session::open();
    let mut scene = closed_box(1.0, lambert([0.5; 3]));
    let material = scene.add_material(lambert([0.5; 3])).expect("sound");
    place(&mut scene, vec![ball(0.3, 8, material)], DAffine3::IDENTITY);
    let settings = Settings::new(Technique::Direct, Preset::Default);
    let request = request([8, 8], view(DVec3::Z, DVec3::ZERO), &[]);
    let drawn = draws(&session).then_some(Voxelisation::Raster);
    let most = VoxelSettings { resolution: 32, solid: true, adaption: 1.0, ..VoxelSettings::default() };
    let least = VoxelSettings { skip_empty: false, voxelisation: drawn, ..VoxelSettings::default() };
    for asked in [most, least] {
        let mut store = session.store();
        let device = store.device().clone();
        let data = SceneData::update(&device, store.pipelines(), None, &scene).expect("the scene fits the device");
        let set = LightSet::default();
        let mut graph = Graph::new(&mut store);
        let shared = Shared::declare(&mut graph, &scene, &data, &request, &settings);
        let frame = shared.inputs(&mut graph, &data, &set, None, Inputs::default(), &settings);
        let made = [0, 1].map(|_| FrameCx::new(&mut graph, &frame, Inputs::default()).voxels(&asked));
        assert!(Rc::ptr_eq(&made[0], &made[1]));
        let cone = graph.upload("cone", &[[0.0_f32, 0.0, 0.0, 0.1], [0.5; 4], [0.0; 4]], Dependence::NONE);
        let answers = graph.buffer("answers", 1);
        let pass = Cones {
            voxels: made[0].group.clone(),
            cones: cone.texels(vk::Format::R32G32B32A32_SFLOAT),
            answers: answers.write(),
            push: ConesPush { count: 1 },
        };
        graph.pass("test/cones", pass).threads([1, 1, 1]);
        graph.want_buffer(answers);
        graph.run(Timing::Frame).expect("a frame");
        let ran: BTreeSet<&str> = store.uses.iter().map(|used| used.program).collect();
        let ran: BTreeSet<&str> = ran.into_iter().filter(|program| program.starts_with("voxels/")).collect();
        assert_eq!(ran, shaders(&asked).into_iter().collect::<BTreeSet<_>>());
    }
}
