//! Copying what was asked for to the host, after the frame.

use ash::vk;

use super::barriers::Need;
use super::declare::Graph;
use super::resource::Body;
use crate::vulkan::{Barriers, Buffer, ImageBarrier, Location, Scope, VulkanError};

impl Graph<'_> {
    /// Where each read-back lies in the read-back buffer: offset and size.
    pub(super) fn provide_read_back(&mut self) -> Result<Vec<(u64, u64)>, VulkanError> {
        let mut places = Vec::new();
        let mut end = 0_u64;
        for (id, part) in &self.read_backs {
            let size = match (&self.resources[*id].body, part) {
                (Body::Image(info), Some(part)) => info.part_bytes(part.mips.start) * part.layers.len() as u64,
                (Body::Buffer { bytes }, _) => bytes.next_multiple_of(4).max(4),
                _ => 0,
            };
            places.push((end, size));
            end += size.next_multiple_of(16);
        }
        let held = self.store.read_back.as_ref().map_or(0, |buffer| buffer.size);
        if end > held {
            self.store.read_back = None;
            self.store.read_back = Some(Buffer::new(
                &self.store.device,
                "read-back",
                end,
                vk::BufferUsageFlags::TRANSFER_DST,
                Location::ReadBack,
            )?);
        }
        Ok(places)
    }

    pub(super) fn record_read_backs(&mut self, places: &[(u64, u64)]) {
        for (index, &(offset, size)) in places.iter().enumerate() {
            let (id, part) = self.read_backs[index].clone();
            let name = self.resources[id].name.clone();
            let read = Need {
                stages: vk::PipelineStageFlags2::ALL_TRANSFER,
                access: vk::AccessFlags2::TRANSFER_READ,
                layout: vk::ImageLayout::UNDEFINED,
                writes: false,
                discards: false,
            };
            let Some(target) = &self.store.read_back else { return };
            if let (Some(stored), Some(part)) = (self.store.images.get_mut(&name), part) {
                let image = stored.image.clone();
                let need = Need { layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL, ..read };
                let mut barriers = Barriers::default();
                for place in part.places() {
                    let Some(found) = stored.states[place as usize].transition(need) else { continue };
                    let [mip, layer] = image.info.level_and_layer(place);
                    let (old_layout, new_layout) = (found.old_layout, found.new_layout);
                    let layers = layer..layer + 1;
                    barriers.images.push(ImageBarrier {
                        image: &image,
                        mip,
                        layers,
                        scope: Scope::FULL,
                        old_layout,
                        new_layout,
                    });
                }
                self.store.recorder.barriers(&barriers);
                self.store.recorder.read_image(&image, part.mips.start, part.layers.clone(), target, offset);
            } else if let Some(stored) = self.store.buffers.get_mut(&name) {
                // A full barrier stands before the read-backs.
                stored.state.transition(read);
                self.store.recorder.copy(&stored.buffer, 0, target, offset, size);
            }
        }
        self.store.recorder.full_barrier();
        let host = Scope {
            from_stages: vk::PipelineStageFlags2::ALL_COMMANDS,
            from_access: vk::AccessFlags2::MEMORY_WRITE,
            to_stages: vk::PipelineStageFlags2::HOST,
            to_access: vk::AccessFlags2::HOST_READ,
        };
        self.store.recorder.barriers(&Barriers { memory: Some(host), images: Vec::new() });
    }

    pub(super) fn copy_read_backs(&self, places: &[(u64, u64)]) -> Vec<Vec<u8>> {
        let mapped = self.store.read_back.as_ref().and_then(Buffer::mapped).unwrap_or(&[]);
        let range =
            |(offset, size): (u64, u64)| Some(usize::try_from(offset).ok()?..usize::try_from(offset + size).ok()?);
        places
            .iter()
            .map(|&place| range(place).and_then(|range| mapped.get(range)).map(<[u8]>::to_vec).unwrap_or_default())
            .collect()
    }
}
