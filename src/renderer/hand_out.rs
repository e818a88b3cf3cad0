//! Leaving a frame in a host's images and buffers: copied on the device once the frame is settled, so that nothing is signalled before buffers have grown.

use super::declare::Declared;
use super::handed::Handed;
use crate::graph::{Graph, Store};
use crate::slot::Slot;
use crate::vulkan::{ForeignTarget, VulkanError};

/// Asks the graph for what goes to the host: the names by which memory knows these images; none: black.
pub(super) fn want(graph: &mut Graph<'_>, declared: &Declared, handed: &Handed) -> Vec<Option<String>> {
    let image = |(slot, _): &(Option<Slot>, ForeignTarget)| match slot {
        Some(slot) => declared.slot(*slot),
        None => declared.image,
    };
    handed.targets.iter().map(image).map(|image| image.map(|image| graph.want_for_copy(image))).collect()
}

/// Before the frame is made: targets that cannot be filled and points that nobody signals leave everything as it was.
pub(super) fn prepare(store: &Store, handed: &Handed) -> Result<(), VulkanError> {
    let targets = handed.targets.iter().map(|&(_, target)| target);
    store.prepare_hand_out(targets, (&handed.waits, handed.patience))
}

/// Copies them.
pub(super) fn hand_out(
    store: &mut Store,
    handed: &Handed,
    names: &[Option<String>],
    size: [u32; 2],
) -> Result<(), VulkanError> {
    if handed.targets.is_empty() && handed.signals.is_empty() {
        return Ok(());
    }
    let copies = names.iter().zip(&handed.targets).map(|(name, &(_, target))| (name.as_deref(), target));
    let copies: Vec<_> = copies.collect();
    store.hand_out(&copies, size, &handed.waits, &handed.signals)
}
