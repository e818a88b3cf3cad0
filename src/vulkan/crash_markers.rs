//! Marks that passes leave on the device, so that a lost one names the last pass that finished.
//!
//! A fill behind a barrier does it on any device, but the pass after waits for the one before: a GPU drains between passes that would overlap. The
//! vendors' extensions let the device write marks as it goes: `VK_AMD_buffer_marker`, `VK_NV_device_diagnostic_checkpoints`.

#![allow(unsafe_code, reason = "commands of extensions")]

use std::ffi::{CStr, c_void};
use std::sync::PoisonError;

use ash::{amd, nv, vk};

use super::device::Device;
use super::memory::Buffer;
use super::recorder::{Barriers, Recorder, Scope};

/// Whether passes leave marks when they have finished.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CrashMarkers {
    /// They do: a lost device names the last pass. Costs time on a GPU whose driver has no extension for it.
    #[default]
    On,
    /// They do not: for times that are to be quoted.
    Off,
}

/// How passes of a device leave marks.
pub(crate) enum Marking {
    None,
    /// A fill behind a barrier.
    Fill,
    Amd(amd::buffer_marker::Device),
    Nvidia(nv::device_diagnostic_checkpoints::Device),
}

/// The extension to enable out of those that a device has.
pub(super) fn extension<'a>(markers: CrashMarkers, available: &[&'a CStr]) -> Option<&'a CStr> {
    let wanted = [amd::buffer_marker::NAME, nv::device_diagnostic_checkpoints::NAME];
    let found = |wanted: &&CStr| available.iter().copied().find(|name| name == wanted);
    wanted.iter().find_map(found).filter(|_| markers == CrashMarkers::On)
}

impl Marking {
    /// For a device on which `extension` was enabled.
    pub(super) fn new(
        markers: CrashMarkers,
        extension: Option<&CStr>,
        instance: &ash::Instance,
        device: &ash::Device,
    ) -> Marking {
        match (markers, extension) {
            (CrashMarkers::Off, _) => Marking::None,
            (_, Some(name)) if name == amd::buffer_marker::NAME => {
                Marking::Amd(amd::buffer_marker::Device::new(instance, device))
            }
            (_, Some(name)) if name == nv::device_diagnostic_checkpoints::NAME => {
                Marking::Nvidia(nv::device_diagnostic_checkpoints::Device::new(instance, device))
            }
            _ => Marking::Fill,
        }
    }
}

impl Device {
    /// Whether a lost device can name a pass.
    pub(crate) fn marks_passes(&self) -> bool {
        !matches!(self.marking, Marking::None)
    }

    /// The last pass of a lost device that finished, by what the driver knows of it: its slot.
    fn checkpoint(&self, checkpoints: &nv::device_diagnostic_checkpoints::Device) -> Option<usize> {
        let queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the queue is the device's own, and locked.
        let mut found = unsafe {
            let count = checkpoints.get_queue_checkpoint_data_len(*queue);
            let mut found = vec![vk::CheckpointDataNV::default(); count];
            checkpoints.get_queue_checkpoint_data(*queue, &mut found);
            found
        };
        found
            .retain(|data| data.stage == vk::PipelineStageFlags::BOTTOM_OF_PIPE && !data.p_checkpoint_marker.is_null());
        found.iter().map(|data| data.p_checkpoint_marker.addr() - 1).max()
    }
}

impl Recorder {
    /// Notes on the device, in word `slot` of `markers`, that the pass recorded last has finished; its work was done in `stages`.
    pub(crate) fn mark(&self, markers: &Buffer, slot: u32, stages: vk::PipelineStageFlags2) {
        let offset = u64::from(slot) * 4;
        match &self.device.marking {
            Marking::None => {}
            Marking::Fill => {
                let scope = Scope {
                    from_stages: stages,
                    from_access: vk::AccessFlags2::NONE,
                    to_stages: vk::PipelineStageFlags2::ALL_TRANSFER,
                    to_access: vk::AccessFlags2::NONE,
                };
                self.barriers(&Barriers { memory: Some(scope), images: Vec::new() });
                self.fill(markers, offset, 4, 1);
            }
            Marking::Amd(extension) => {
                let stage = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
                // SAFETY: the command buffer is recording; the word lies within the buffer, which transfers may write.
                unsafe { extension.cmd_write_buffer_marker(self.commands, stage, markers.raw, offset, 1) };
            }
            Marking::Nvidia(extension) => {
                // No memory is meant: the driver hands the number back.
                let marker = std::ptr::without_provenance::<c_void>(slot as usize + 1);
                // SAFETY: the command buffer is recording; the driver does not follow the pointer.
                unsafe { extension.cmd_set_checkpoint(self.commands, marker) };
            }
        }
    }

    /// The last of `count` slots from `first` on whose pass finished, when a submission failed.
    pub(crate) fn last_marked(&self, markers: &Buffer, first: usize, count: usize) -> Option<usize> {
        if let Marking::Nvidia(extension) = &self.device.marking {
            return self.device.checkpoint(extension).filter(|slot| (first..first + count).contains(slot));
        }
        let words: &[u32] = bytemuck::try_cast_slice(markers.mapped()?).ok()?;
        words.iter().skip(first).take(count).rposition(|word| *word != 0).map(|place| first + place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vendors_extensions_are_used_where_there_are_any() {
        let [amd, nvidia] = [amd::buffer_marker::NAME, nv::device_diagnostic_checkpoints::NAME];
        let other = c"VK_KHR_swapchain";
        assert_eq!(extension(CrashMarkers::On, &[other, nvidia]), Some(nvidia));
        assert_eq!(extension(CrashMarkers::On, &[nvidia, amd]), Some(amd));
        assert_eq!(extension(CrashMarkers::On, &[other]), None);
        assert_eq!(extension(CrashMarkers::Off, &[amd, nvidia]), None, "times are not to hold any of it");
    }
}
