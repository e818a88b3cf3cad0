//! A list of records on the device of which, when some change, only those are sent.

use std::sync::Arc;

use ash::vk;
use bytemuck::Pod;

use crate::vulkan::{Buffer, Device, VulkanError, buffer_with, overwrite};

/// The list, and what the device has of it.
pub(super) struct SentList<T> {
    name: &'static str,
    pub(super) buffer: Arc<Buffer>,
    records: Vec<T>,
    /// Bytes sent so far.
    pub(super) sent: u64,
}

impl<T: Pod> SentList<T> {
    pub(super) fn new(device: &Arc<Device>, name: &'static str, records: Vec<T>) -> Result<SentList<T>, VulkanError> {
        let bytes: &[u8] = bytemuck::cast_slice(&records);
        let buffer = buffer_with(device, name, bytes, vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER)?;
        let sent = bytes.len() as u64;
        Ok(SentList { name, buffer, records, sent })
    }

    /// Sends what differs from what the device has; all of it if the number of records changed.
    pub(super) fn update(&mut self, device: &Arc<Device>, records: Vec<T>) -> Result<(), VulkanError> {
        if self.records.len() == records.len() {
            let parts = changed(bytemuck::cast_slice(&self.records), bytemuck::cast_slice(&records), size_of::<T>());
            if overwrite(device, &mut self.buffer, &parts)? {
                self.sent += parts.iter().map(|(_, bytes)| bytes.len() as u64).sum::<u64>();
                self.records = records;
                return Ok(());
            }
        }
        let SentList { name, buffer, records, sent } = SentList::new(device, self.name, records)?;
        *self = SentList { name, buffer, records, sent: self.sent + sent };
        Ok(())
    }
}

/// The runs of records of `stride` bytes that differ: where each begins, and its new bytes.
fn changed<'a>(old: &[u8], new: &'a [u8], stride: usize) -> Vec<(u64, &'a [u8])> {
    let differs: Vec<usize> = old
        .chunks_exact(stride)
        .zip(new.chunks_exact(stride))
        .enumerate()
        .filter(|(_, (old, new))| old != new)
        .map(|(index, _)| index)
        .collect();
    let runs = differs.chunk_by(|before, after| before + 1 == *after);
    let bytes = |run: &[usize]| {
        let start = run[0] * stride;
        (start as u64, &new[start..start + run.len() * stride])
    };
    runs.map(bytes).collect()
}

#[cfg(test)]
mod tests {
    use super::changed;

    #[test]
    fn runs_of_changed_records_are_sent_together() {
        let old = [0_u8; 12];
        let new = [0, 1, 1, 0, 0, 0, 0, 0, 2, 2, 2, 2];
        assert_eq!(changed(&old, &new, 2), [(0, &new[0..4]), (8, &new[8..12])]);
        assert!(changed(&old, &old, 2).is_empty());
    }
}
