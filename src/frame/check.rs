//! Whether what a frame shows are numbers: every image that is read back is looked at on the device, and if one is wrong, what each pass writes.

use std::cell::RefCell;
use std::rc::Rc;

use ash::vk;

use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{Graph, Output, ReadBack};
use crate::shaders::check::{Image, ImagePush, Texels, TexelsPush};
use crate::vulkan::ImageInfo;

/// Outputs that are looked at, at most; those of the passes beyond are not.
const MOST_OUTPUTS: usize = 1024;

/// Texels of each thing that was looked at that are no numbers, or negative.
#[derive(Clone, Copy)]
pub(crate) struct Faults(ReadBack);

/// Declares a look at each of the images, which hold radiance.
pub(crate) fn check_images(graph: &mut Graph<'_>, images: &[(String, ImageRef)]) -> Faults {
    let faults = graph.buffer::<u32>("check.faults", images.len().max(1));
    graph.fill_buffer("check/clear", faults, 0);
    for (word, (name, image)) in images.iter().enumerate() {
        look_at(graph, &format!("check/{name}"), *image, (faults, word), true);
    }
    Faults(graph.read_back_buffer(faults))
}

impl Faults {
    /// The first thing that has some, by its number, and how many.
    pub(crate) fn first(self, take: impl FnOnce(ReadBack) -> Vec<u8>) -> Option<(usize, u32)> {
        let bytes = take(self.0);
        let words = bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
        words.enumerate().find(|(_, count)| *count > 0)
    }
}

/// Looks at what every pass writes, as far as it is known to be floats.
pub(crate) struct PassChecks {
    faults: BufferRef<u32>,
    /// The pass and what it wrote, for each word of `faults`.
    names: Rc<RefCell<Vec<String>>>,
}

impl PassChecks {
    /// Lets a look follow each pass that is declared from now on. `radiance`: images of radiance, below zero nowhere. `texels`: the buffers that hold
    /// floats ([`Graph::float_texels`] of the same frame).
    pub(crate) fn declare(
        graph: &mut Graph<'_>,
        radiance: Vec<String>,
        texels: Vec<(String, vk::Format)>,
    ) -> PassChecks {
        let faults = graph.buffer::<u32>("check.faults_of_passes", MOST_OUTPUTS);
        graph.fill_buffer("check/clear", faults, 0);
        let names = Rc::new(RefCell::new(Vec::new()));
        let noted = names.clone();
        graph.watch(Box::new(move |graph, pass, outputs| {
            for (resource, output) in outputs {
                let mut names = noted.borrow_mut();
                let word = names.len();
                if word >= MOST_OUTPUTS {
                    return;
                }
                let name = format!("check/{pass}.{resource}");
                match output {
                    Output::Image(image) if is_flat_and_float(image.info()) => {
                        look_at(graph, &name, *image, (faults, word), radiance.contains(resource));
                    }
                    Output::Buffer(buffer) => {
                        let Some((_, format)) = texels.iter().find(|(known, _)| known == resource) else { continue };
                        let count = (buffer.count() / components(*format)) as u32;
                        let push = TexelsPush { count, word: word as u32 };
                        let look = Texels { texels: buffer.texels(*format), faults: faults.read_write(), push };
                        graph.pass(&name, look).threads([count, 1, 1]);
                    }
                    Output::Image(_) => continue,
                }
                names.push(pass.to_owned());
            }
        }));
        PassChecks { faults, names }
    }

    /// Once all passes are declared.
    pub(crate) fn read_back(&self, graph: &mut Graph<'_>) -> Faults {
        Faults(graph.read_back_buffer(self.faults))
    }

    /// The pass that wrote thing number `index`.
    pub(crate) fn pass(&self, index: usize) -> Option<String> {
        self.names.borrow().get(index).cloned()
    }
}

fn look_at(
    graph: &mut Graph<'_>,
    name: &str,
    image: ImageRef,
    (faults, word): (BufferRef<u32>, usize),
    radiance: bool,
) {
    let size = image.size();
    let push = ImagePush { size, word: word as u32, negative: u32::from(radiance) };
    let look = Image { image: image.sampled(), faults: faults.read_write(), push };
    graph.pass(name, look).pixels(size);
}

fn is_flat_and_float(info: ImageInfo) -> bool {
    use vk::Format as F;
    let floats = [
        F::R32_SFLOAT,
        F::R16_SFLOAT,
        F::R32G32_SFLOAT,
        F::R16G16_SFLOAT,
        F::R32G32B32A32_SFLOAT,
        F::R16G16B16A16_SFLOAT,
    ];
    floats.contains(&info.format) && info.layers == 1 && !info.volume
}

/// 32-bit components of a texel.
fn components(format: vk::Format) -> usize {
    match format {
        vk::Format::R32_SFLOAT => 1,
        vk::Format::R32G32_SFLOAT => 2,
        _ => 4,
    }
}
