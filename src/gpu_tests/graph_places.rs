//! Every level, layer and face of an image is a place of its own: drawn, written and kept apart from the others.

use ash::vk;

use super::session::Session;
use crate::graph::bindings::ImageRef;
use crate::graph::{ClearColor, Graph, Store};
use crate::renderer::Timing;
use crate::shaders::selftest::{HalveVolume, LookAround, Paint, PaintPush, RampVolume};
use crate::vulkan::{ImageInfo, RasterState};

const COLOR: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

fn paint(graph: &mut Graph<'_>, name: &str, image: ImageRef, color: [f32; 4]) {
    let state = RasterState { topology: vk::PrimitiveTopology::TRIANGLE_LIST, ..RasterState::default() };
    let pass = graph.raster(name, Paint { push: PaintPush { color } }, state);
    pass.color(image, Some(ClearColor::Float([9.0; 4]))).vertices(3, 1);
}

fn color_of(face: u32, frame: u32) -> [f32; 4] {
    [face as f32, 0.5, frame as f32, 1.0]
}

/// Draws each face with its number and the number in `frames`: what one sees along the axes, and how many faces were drawn.
fn cube(store: &mut Store, frames: [u32; 6]) -> (Vec<f32>, usize) {
    let mut graph = Graph::new(store);
    let info = ImageInfo { format: COLOR, extent: [8, 8, 1], mips: 1, layers: 6, volume: false };
    let cube = graph.image_with("cube", info);
    for face in 0..6 {
        paint(&mut graph, &format!("cube/face-{face}"), cube.layer(face), color_of(face, frames[face as usize]));
    }
    let seen = graph.buffer::<[f32; 4]>("seen", 6);
    graph.pass("cube/look", LookAround { cube: cube.sampled(), seen: seen.write() }).threads([6, 1, 1]);
    let faces = graph.read_back(cube);
    let seen = graph.read_back_buffer(seen);
    let mut executed = graph.run(Timing::Passes).expect("a frame");
    let drawn = executed.passes.iter().filter(|pass| pass.pass.starts_with("face-") && pass.skipped.is_none()).count();
    for (face, texels) in floats(&executed.take(faces)).chunks(4 * 64).enumerate() {
        let expected = color_of(face as u32, frames[face]);
        assert!(texels.chunks(4).all(|texel| texel == expected), "face {face} holds {:?}", &texels[..4]);
    }
    (floats(&executed.take(seen)), drawn)
}

#[test]
fn faces_of_a_cube_are_drawn_one_by_one() {
    let session = Session::open();
    let mut store = session.store();
    let expected =
        |frames: [u32; 6]| (0..6).flat_map(|face| color_of(face, frames[face as usize])).collect::<Vec<f32>>();
    assert_eq!(cube(&mut store, [1; 6]), (expected([1; 6]), 6));
    assert_eq!(cube(&mut store, [1; 6]), (expected([1; 6]), 0), "nothing changed");
    let frames = [1, 1, 1, 2, 1, 1];
    assert_eq!(cube(&mut store, frames), (expected(frames), 1), "one face is drawn, the others stand");
}

#[test]
fn one_layer_is_read_back_alone() {
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let info = ImageInfo { format: COLOR, extent: [4, 2, 1], mips: 1, layers: 3, volume: false };
    let layers = graph.image_with("layers", info);
    for layer in 0..3 {
        graph.clear_image(&format!("test/clear-{layer}"), layers.layer(layer), ClearColor::Float([layer as f32; 4]));
    }
    let read_backs = [2, 0].map(|layer| graph.read_back(layers.layer(layer)));
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    let [two, zero] = read_backs.map(|read_back| floats(&executed.take(read_back)));
    assert_eq!((two, zero), (vec![2.0; 32], vec![0.0; 32]));
}

#[test]
fn a_layer_that_nobody_has_drawn_is_named() {
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let info = ImageInfo { format: COLOR, extent: [8, 8, 1], mips: 1, layers: 6, volume: false };
    let cube = graph.image_with("cube", info);
    for face in [0, 1, 2, 4, 5] {
        paint(&mut graph, &format!("cube/face-{face}"), cube.layer(face), [0.0; 4]);
    }
    let seen = graph.buffer::<[f32; 4]>("seen", 6);
    graph.pass("cube/look", LookAround { cube: cube.sampled(), seen: seen.write() }).threads([6, 1, 1]);
    graph.want_buffer(seen);
    let error = graph.run(Timing::Frame).err().expect("a face is missing").to_string();
    assert!(error.contains("cube/look reads level 0 of layer 3 of cube"), "{error}");
}

#[test]
fn levels_are_drawn_at_their_own_size() {
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let info = ImageInfo { format: COLOR, extent: [13, 6, 1], mips: 3, layers: 1, volume: false };
    let levels = graph.image_with("levels", info);
    for level in 0..3 {
        paint(&mut graph, &format!("test/level-{level}"), levels.mip(level), [level as f32; 4]);
    }
    let read_backs = [0, 1, 2].map(|level| graph.read_back(levels.mip(level)));
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    let texels = read_backs.map(|read_back| floats(&executed.take(read_back)));
    assert_eq!(texels, [vec![0.0; 13 * 6 * 4], vec![1.0; 6 * 3 * 4], vec![2.0; 3 * 4]]);
}

/// Sums of eight, on the host.
fn halved(level: &[f32], size: [usize; 3]) -> Vec<f32> {
    let half = size.map(|side| (side / 2).max(1));
    let mut sums = vec![0.0; half.iter().product()];
    let inside = |place: [usize; 3]| (0..3).all(|axis| place[axis] < size[axis]);
    for (index, sum) in sums.iter_mut().enumerate() {
        let texel = [index % half[0], index / half[0] % half[1], index / half[0] / half[1]];
        for part in 0..8 {
            let place = [0, 1, 2].map(|axis| 2 * texel[axis] + (part >> axis & 1));
            if inside(place) {
                *sum += level[(place[2] * size[1] + place[1]) * size[0] + place[0]];
            }
        }
    }
    sums
}

#[test]
fn a_volume_is_halved_level_by_level() {
    const LEVELS: u32 = 5;
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    let size = [16_u32, 8, 12];
    let info = ImageInfo { format: vk::Format::R32_SFLOAT, extent: size, mips: LEVELS, layers: 1, volume: true };
    let volume = graph.image_with("volume", info);
    graph.pass("volume/level-0", RampVolume { image: volume.mip(0).write() }).threads(size);
    for level in 1..LEVELS {
        let halve = HalveVolume { finer: volume.mip(level - 1).sampled(), coarser: volume.mip(level).write() };
        graph.pass(&format!("volume/level-{level}"), halve).threads(size.map(|side| (side >> level).max(1)));
    }
    let read_backs: Vec<_> = (0..LEVELS).map(|level| graph.read_back(volume.mip(level))).collect();
    let mut executed = graph.run(Timing::Passes).expect("a frame");
    let mut expected: Vec<f32> = (0..16 * 8 * 12_u16).map(f32::from).collect();
    let mut sides = size.map(|side| side as usize);
    for (level, read_back) in (0..LEVELS).zip(read_backs) {
        assert_eq!(floats(&executed.take(read_back)), expected, "level {level}");
        expected = halved(&expected, sides);
        sides = sides.map(|side| (side / 2).max(1));
    }
}

#[test]
fn a_format_that_the_device_does_not_have_is_named() {
    let session = Session::open();
    let mut store = session.store();
    let mut graph = Graph::new(&mut store);
    // No device draws into compressed blocks.
    let info =
        ImageInfo { format: vk::Format::BC1_RGB_UNORM_BLOCK, extent: [4, 4, 1], mips: 1, layers: 1, volume: false };
    let image = graph.image_with("compressed", info);
    paint(&mut graph, "test/paint", image, [0.0; 4]);
    graph.want(image);
    let error = graph.run(Timing::Frame).err().expect("no such images").to_string();
    assert!(error.contains("bc1_rgb_unorm_block") && error.contains("compressed"), "{error}");
}
