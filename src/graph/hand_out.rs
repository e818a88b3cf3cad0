//! Copying images that a frame left in memory into a host's.

use ash::vk;

use super::barriers::Need;
use super::bindings::ImageRef;
use super::declare::Graph;
use super::store::Store;
use crate::vulkan::{Barriers, ForeignTarget, HandOut, ImageBarrier, Scope, TimelinePoint, VulkanError};

impl Graph<'_> {
    /// Asks that the image be made, and stay so that it can be copied afterwards. The name that memory knows it by.
    pub(crate) fn want_for_copy(&mut self, image: ImageRef) -> String {
        let image = image.mip(image.mips.0);
        self.want(image);
        self.resources[image.id].image_usage |= vk::ImageUsageFlags::TRANSFER_SRC;
        self.resources[image.id].name.clone()
    }
}

impl Store {
    /// Whether [`Store::hand_out`] will be able to fill all of these, and waits until the points are reached, `patience` seconds at most. What fails here has
    /// changed nothing.
    pub(crate) fn prepare_hand_out(
        &self,
        targets: impl Iterator<Item = ForeignTarget>,
        (waits, patience): (&[TimelinePoint], f64),
    ) -> Result<(), VulkanError> {
        targets.into_iter().try_for_each(|target| self.recorder.check_target(&target))?;
        self.recorder.await_points(waits, patience)
    }

    /// Copies the first layer of the first mip level of each named image into its target; none: black. Waits until it is done.
    pub(crate) fn hand_out(
        &mut self,
        copies: &[(Option<&str>, ForeignTarget)],
        size: [u32; 2],
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
    ) -> Result<(), VulkanError> {
        let done = self.record_hand_out(copies, size, waits, signals);
        if done.is_err() {
            // The layouts that were noted may never have come about.
            self.forget();
        }
        done
    }

    fn record_hand_out(
        &mut self,
        copies: &[(Option<&str>, ForeignTarget)],
        size: [u32; 2],
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
    ) -> Result<(), VulkanError> {
        let need = Need {
            stages: vk::PipelineStageFlags2::ALL_TRANSFER,
            access: vk::AccessFlags2::TRANSFER_READ,
            layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            writes: false,
            discards: false,
        };
        self.recorder.begin_hand_out()?;
        for name in copies.iter().filter_map(|(name, _)| *name) {
            let Some(stored) = self.images.get_mut(name) else { continue };
            let Some(found) = stored.states[0].transition(need) else { continue };
            let (old_layout, new_layout) = (found.old_layout, found.new_layout);
            let (image, scope) = (&*stored.image, Scope::FULL);
            let barrier = ImageBarrier { image, mip: 0, layers: 0..1, scope, old_layout, new_layout };
            self.recorder.barriers(&Barriers { memory: None, images: vec![barrier] });
        }
        let images = &self.images;
        let copies: Vec<_> = copies
            .iter()
            .map(|&(name, to)| HandOut {
                from: name.and_then(|name| images.get(name)).map(|stored| &*stored.image),
                to,
                size,
            })
            .collect();
        self.recorder.hand_out(&copies, waits, signals)
    }
}
