//! Marks that passes leave on the device, so that a lost one names the last pass that finished.
//!
//! A fill behind a barrier does it on any device, but the pass after waits for the one before: a GPU drains between passes that would overlap. The
//! vendors' extensions let the device write marks as it goes: `VK_AMD_buffer_marker`, `VK_NV_device_diagnostic_checkpoints`. The commands are in `marks.rs`.

use std::ffi::CStr;

use ash::{amd, nv};

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
