//! Whether passes write all of what they say they write whole: a frame made under two patterns that fill such places before each pass. A word that
//! follows both was not written.

use ash::vk;

use super::bindings::{Access, BufferUse, ImageUse};
use super::declare::{Graph, places};
use super::resource::{Body, Left};
use crate::vulkan::{Barriers, Buffer, Image, ImageBarrier, Location, Scope, VulkanError, texel_bytes};

/// No word that a pass would write, whether it is taken for a float or not.
#[cfg(test)]
const PATTERNS: [u32; 2] = [0x4B3C_2D1F, 0x3A29_180D];

/// The passes of a frame that leave words of what they say they write whole, each with the resource and the number of words. `declare` declares
/// the same frame each time.
///
/// # Errors
/// As [`Graph::run`].
#[cfg(test)]
pub(crate) fn unwritten(
    store: &mut super::store::Store,
    declare: impl Fn(&mut Graph<'_>),
) -> Result<Vec<(String, usize)>, VulkanError> {
    let mut frames = Vec::new();
    for pattern in PATTERNS {
        store.forget();
        let mut graph = Graph::new(store);
        graph.proof = Some(super::resource::Proof { pattern, left: Vec::new() });
        declare(&mut graph);
        frames.push(graph.run(super::timing::Timing::Frame)?.left);
    }
    let words = |bytes: &[u8]| -> Vec<u32> {
        bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
    };
    let mut found = Vec::new();
    for ((what, first), (_, second)) in frames[0].iter().zip(&frames[1]) {
        let pairs = words(first).into_iter().zip(words(second));
        let count = pairs.filter(|&(first, second)| [first, second] == PATTERNS).count();
        if count > 0 {
            found.push((what.clone(), count));
        }
    }
    Ok(found)
}

impl Graph<'_> {
    /// The places that a pass says it writes whole, as far as a pattern can stand in them.
    fn wholes(&self, index: usize) -> Vec<(Access, usize, u32)> {
        let pass = &self.passes[index];
        let whole = |access: &&Access| match access {
            Access::Image { image, usage: ImageUse::StorageWrite, .. } => match &self.resources[*image].body {
                Body::Image(info) => texel_bytes(info.format) >= 4 && info.format != vk::Format::R16G16B16A16_SFLOAT,
                _ => false,
            },
            Access::Buffer { usage: BufferUse::Write, .. } => true,
            _ => false,
        };
        let places_of = |access: &Access| places(access).into_iter().map(|(place, ..)| place).collect::<Vec<_>>();
        let accesses = pass.accesses().filter(whole);
        accesses.flat_map(|access| places_of(access).into_iter().map(|(id, part)| (access.clone(), id, part))).collect()
    }

    /// Records a transfer of an image that is in the layout for storage, and stays so.
    fn in_layout(&self, image: &Image, [mip, layer]: [u32; 2], layout: vk::ImageLayout, transfer: impl FnOnce()) {
        let general = vk::ImageLayout::GENERAL;
        let turn = |old_layout, new_layout| {
            let images =
                vec![ImageBarrier { image, mip, layers: layer..layer + 1, scope: Scope::FULL, old_layout, new_layout }];
            self.store.recorder.barriers(&Barriers { memory: None, images });
        };
        turn(general, layout);
        transfer();
        turn(layout, general);
    }

    /// Between the pass's barriers and its work.
    pub(super) fn fill_wholes(&self, index: usize) {
        let Some(proof) = &self.proof else { return };
        let recorder = &self.store.recorder;
        recorder.full_barrier();
        for (access, id, part) in self.wholes(index) {
            match (&access, &self.resources[id].body) {
                (Access::Image { .. }, Body::Image(info)) => {
                    let value = match info.format {
                        vk::Format::R32_UINT | vk::Format::R32G32_UINT | vk::Format::R32G32B32A32_UINT => {
                            vk::ClearColorValue { uint32: [proof.pattern; 4] }
                        }
                        _ => vk::ClearColorValue { float32: [f32::from_bits(proof.pattern); 4] },
                    };
                    let image = self.memory_of_image(id);
                    let place = image.info.level_and_layer(part);
                    self.in_layout(&image, place, vk::ImageLayout::TRANSFER_DST_OPTIMAL, || {
                        recorder.clear_image(&image, place, value);
                    });
                }
                _ => recorder.fill(&self.memory_of_buffer(id), 0, vk::WHOLE_SIZE, proof.pattern),
            }
        }
        recorder.full_barrier();
    }

    /// After the pass's work.
    pub(super) fn keep_wholes(&mut self, index: usize) -> Result<(), VulkanError> {
        if self.proof.is_none() {
            return Ok(());
        }
        self.store.recorder.full_barrier();
        for (_, id, part) in self.wholes(index) {
            let resource = &self.resources[id];
            let bytes = match &resource.body {
                Body::Image(info) => info.part_bytes(info.level_and_layer(part)[0]),
                Body::Buffer { bytes } => bytes / 4 * 4,
                _ => continue,
            };
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            let buffer = Buffer::new(&self.store.device, "proof", bytes.max(4), usage, Location::ReadBack)?;
            match &resource.body {
                Body::Image(_) => {
                    let image = self.memory_of_image(id);
                    let [mip, layer] = image.info.level_and_layer(part);
                    self.in_layout(&image, [mip, layer], vk::ImageLayout::TRANSFER_SRC_OPTIMAL, || {
                        self.store.recorder.read_image(&image, mip, layer..layer + 1, &buffer, 0);
                    });
                }
                _ => self.store.recorder.copy(&self.memory_of_buffer(id), 0, &buffer, 0, bytes),
            }
            let what = format!("{} leaves {}", self.passes[index].full_name(), resource.name);
            self.proof.as_mut().expect("asked above").left.push(Left { what, buffer });
        }
        self.store.recorder.full_barrier();
        Ok(())
    }

    /// Once the frame is finished.
    pub(super) fn take_wholes(&mut self) -> Vec<(String, Vec<u8>)> {
        let left = self.proof.take().map(|proof| proof.left).unwrap_or_default();
        left.into_iter().map(|left| (left.what, left.buffer.mapped().unwrap_or(&[]).to_vec())).collect()
    }
}
