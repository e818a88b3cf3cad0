//! Lists of structs that shaders read as texels: both ways of reading agree, so the two sides of a layout cannot drift.

use ash::vk;

use super::session::Session;
use crate::graph::{Dependence, Graph};
use crate::renderer::Timing;
use crate::shaders::selftest::TexelLayouts;
use crate::shaders::types;

const COUNT: usize = 7;
const TEXELS: vk::Format = vk::Format::R32G32B32A32_UINT;

/// Structs whose words are the bits of finite floats, all different.
fn records<T: bytemuck::AnyBitPattern>(seed: u32) -> Vec<T> {
    let words = COUNT * size_of::<T>() / 4;
    let words: Vec<u32> = (0..words as u32).map(|index| (1.0 + (seed * 1000 + index) as f32).to_bits()).collect();
    bytemuck::cast_slice(&words).to_vec()
}

#[test]
fn structs_and_texels_agree() {
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let instances = graph.upload("instances", &records::<types::Instance>(1), Dependence::NONE);
    let materials = graph.upload("materials", &records::<types::Material>(2), Dependence::NONE);
    let uses = graph.upload("uses", &records::<types::MaterialTextures>(3), Dependence::NONE);
    let lights = graph.upload("lights", &records::<types::Light>(4), Dependence::NONE);
    let views = graph.upload("views", &records::<types::LightView>(5), Dependence::NONE);
    let differences = graph.buffer::<u32>("differences", 5 * COUNT);
    let pass = TexelLayouts {
        instances: instances.read(),
        materials: materials.read(),
        uses: uses.read(),
        lights: lights.read(),
        views: views.read(),
        instance_texels: instances.texels(TEXELS),
        material_texels: materials.texels(TEXELS),
        use_texels: uses.texels(TEXELS),
        light_texels: lights.texels(TEXELS),
        view_texels: views.texels(TEXELS),
        differences: differences.write(),
    };
    graph.pass("test/texel-layouts", pass).groups([COUNT as u32, 1, 1]);
    let read_back = graph.read_back_buffer(differences);
    let bytes = graph.run(Timing::Frame).expect("a frame").take(read_back);
    for (index, word) in bytes.chunks_exact(4).enumerate() {
        let list = ["instances", "materials", "texture uses", "lights", "views"][index % 5];
        assert_eq!(word, [0; 4], "element {} of the {list} reads differently as texels", index / 5);
    }
}
