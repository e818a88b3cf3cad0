//! The commands that leave crash markers, and the last one that a lost device left.

#![allow(unsafe_code, reason = "commands of extensions")]

use ash::{nv, vk};
use std::ffi::c_void;

use super::crash_markers::Marking;
use super::device::Device;
use super::memory::Buffer;
use super::recorder::{Barriers, Recorder, Scope};

impl Device {
    /// Whether a lost device can name a pass.
    pub(crate) fn marks_passes(&self) -> bool {
        !matches!(self.marking, Marking::None)
    }

    /// The last pass of a lost device that finished, by what the driver knows of it: its slot.
    fn checkpoint(&self, checkpoints: &nv::device_diagnostic_checkpoints::Device) -> Option<usize> {
        // SAFETY: the queue is the device's own, and this call's.
        let mut found = self.submit(|queue| unsafe {
            let count = checkpoints.get_queue_checkpoint_data_len(queue);
            let mut found = vec![vk::CheckpointDataNV::default(); count];
            checkpoints.get_queue_checkpoint_data(queue, &mut found);
            found
        });
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
