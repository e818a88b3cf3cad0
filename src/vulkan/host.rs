//! A device that belongs to a host program: used, not made, and never destroyed.

#![allow(unsafe_code, reason = "the host's handles")]

use std::ffi::{CStr, c_char, c_void};
use std::sync::Arc;

use ash::ext;
use ash::vk;
use ash::vk::Handle;

use super::device::{Device, TakeTurns};
use super::features::Features;
use super::host_features::FeatureChain;
use super::instance::Instance;
use super::loader_lock;
use super::report::Survey;
use super::{Validation, VulkanError};

/// `vkGetInstanceProcAddr`, as a function of no known type.
pub(crate) type AnyFunction = unsafe extern "C" fn();

/// The handles of a host, as numbers.
pub(crate) struct HostInstance {
    pub(crate) get_instance_proc_addr: AnyFunction,
    /// Version that the instance was created for.
    pub(crate) api_version: u32,
    pub(crate) instance: u64,
    pub(crate) physical_device: u64,
}

pub(crate) struct HostDevice {
    pub(crate) instance: HostInstance,
    pub(crate) device: u64,
    pub(crate) queue: u64,
    pub(crate) queue_family: u32,
    /// Whether VK_EXT_debug_utils is enabled: passes and objects then have names in the host's tools.
    pub(crate) debug_utils: bool,
    /// What the host enabled (`Features::of_chain`).
    pub(crate) features: *const c_void,
    pub(crate) take_turns: Option<TakeTurns>,
}

/// What a device must be created with, for irradia to use it.
pub(crate) struct Requirements {
    pub(crate) features: FeatureChain,
    /// A family with graphics, compute and timestamps.
    pub(crate) queue_family: u32,
}

impl Device {
    /// On a host's device.
    ///
    /// # Safety
    /// The handles are what they are said to be and outlive the device; nobody else uses the queue while `take_turns` says so.
    pub(crate) unsafe fn of_host(host: HostDevice) -> Result<Arc<Device>, VulkanError> {
        // SAFETY: the caller's.
        let (instance, physical) = unsafe { host.instance.open(host.debug_utils) }?;
        let mut survey = Survey::of(&instance, 0, physical);
        let device = survey.report.name.clone();
        if let Some(reason) = survey.report.unfit.clone() {
            return Err(VulkanError::Unfit { device, reason });
        }
        // SAFETY: the caller's.
        let enabled = unsafe { Features::of_chain(host.features) };
        if let Some((name, needed_by)) = enabled.missing() {
            return Err(VulkanError::Host(format!(
                "it was created without the feature {name}, which {needed_by} needs"
            )));
        }
        survey.take_what_a_host_enabled(&instance, physical, enabled, host.queue_family)?;
        let walks = loader_lock::walking();
        let (handle, mut functions) = (vk::Device::from_raw(host.device), LookUp::default());
        let get_device_proc_addr = instance.raw.fp_v1_0().get_device_proc_addr;
        // SAFETY: the caller's.
        let look_up = |name: &CStr| unsafe { get_device_proc_addr(handle, name.as_ptr()) };
        // SAFETY: as above.
        let raw = unsafe { ash::Device::load_with(|name| functions.found(name, look_up(name)), handle) };
        functions.all("device")?;
        if host.debug_utils && LABELS.iter().any(|name| look_up(name).is_none()) {
            let fault = "its instance was created without VK_EXT_debug_utils, which debug_utils says that it has";
            return Err(VulkanError::Host(fault.to_owned()));
        }
        let labels = host.debug_utils.then(|| ext::debug_utils::Device::new(&instance.raw, &raw));
        let queue = vk::Queue::from_raw(host.queue);
        let parts = Device::of_parts((instance, physical, survey), (raw, queue), (labels, host.take_turns));
        drop(walks);
        parts
    }
}

/// What names of passes and objects are given by.
const LABELS: [&CStr; 3] =
    [c"vkSetDebugUtilsObjectNameEXT", c"vkCmdBeginDebugUtilsLabelEXT", c"vkCmdEndDebugUtilsLabelEXT"];

/// Functions as they are looked up. To call one that is not there would end the process.
#[derive(Default)]
struct LookUp {
    missing: Option<String>,
}

impl LookUp {
    fn found(&mut self, name: &CStr, function: vk::PFN_vkVoidFunction) -> *const c_void {
        if function.is_none() {
            self.missing.get_or_insert_with(|| name.to_string_lossy().into_owned());
        }
        function.map_or(std::ptr::null(), |function| function as *const c_void)
    }

    fn all(self, of: &str) -> Result<(), VulkanError> {
        self.missing.map_or(Ok(()), |name| {
            Err(VulkanError::Host(format!("its {of} has no function {name}, which belongs to Vulkan 1.3")))
        })
    }
}

impl Device {
    /// Whether it has timeline semaphores, if it is a host's.
    pub(crate) fn timelines_of_host(&self) -> Option<bool> {
        self.is_of_host().then(|| self.survey.features.timelines())
    }
}

impl HostInstance {
    /// # Safety
    /// The handles are what they are said to be, and outlive what is made of them.
    pub(super) unsafe fn open(&self, debug: bool) -> Result<(Instance, vk::PhysicalDevice), VulkanError> {
        if self.api_version < vk::API_VERSION_1_3 {
            let version = super::instance::version_text(self.api_version);
            return Err(VulkanError::Host(format!("its instance is of Vulkan {version}, and irradia needs 1.3")));
        }
        // SAFETY: the caller's: it is vkGetInstanceProcAddr.
        let get_instance_proc_addr = unsafe {
            std::mem::transmute::<
                AnyFunction,
                unsafe extern "system" fn(vk::Instance, *const c_char) -> vk::PFN_vkVoidFunction,
            >(self.get_instance_proc_addr)
        };
        let _walks = loader_lock::walking();
        let (handle, mut functions) = (vk::Instance::from_raw(self.instance), LookUp::default());
        // SAFETY: the caller's.
        let look_up = |name: &CStr| unsafe { get_instance_proc_addr(handle, name.as_ptr()) };
        // SAFETY: as above.
        let raw = unsafe { ash::Instance::load_with(|name| functions.found(name, look_up(name)), handle) };
        functions.all("instance")?;
        Ok((Instance::of_host(raw, debug), vk::PhysicalDevice::from_raw(self.physical_device)))
    }

    /// What its physical device must be created with.
    ///
    /// # Errors
    /// If it cannot be used at all.
    ///
    /// # Safety
    /// The handles are what they are said to be.
    pub(crate) unsafe fn requirements(&self) -> Result<Requirements, VulkanError> {
        // SAFETY: the caller's.
        let (instance, physical) = unsafe { self.open(false) }?;
        let survey = Survey::of(&instance, 0, physical);
        if let Some(reason) = survey.report.unfit {
            return Err(VulkanError::Unfit { device: survey.report.name, reason });
        }
        let offered = Features::offered(&instance, physical);
        let wanted = Features::wanted(&offered, survey.traits.texels_in_storage, Validation::Off).with_timelines();
        Ok(Requirements { features: FeatureChain::new(wanted), queue_family: survey.queue_family })
    }
}

impl Survey {
    /// Of a host's device: only what it enabled is there, and its queue is the one.
    pub(super) fn take_what_a_host_enabled(
        &mut self,
        instance: &Instance,
        device: vk::PhysicalDevice,
        enabled: Features,
        queue_family: u32,
    ) -> Result<(), VulkanError> {
        // SAFETY: the physical device belongs to the living instance.
        let families = unsafe { instance.raw.get_physical_device_queue_family_properties(device) };
        let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let family = families.get(queue_family as usize);
        match family.filter(|family| family.queue_flags.contains(wanted)) {
            None => {
                let fault = format!("its queue family {queue_family} is not for both graphics and compute");
                return Err(VulkanError::Host(fault));
            }
            Some(family) if family.timestamp_valid_bits == 0 => {
                return Err(VulkanError::Host(format!("its queue family {queue_family} has no timestamps")));
            }
            Some(family) => self.timestamp_bits = family.timestamp_valid_bits,
        }
        if self.traits.texels_in_storage && enabled.core.robust_buffer_access == vk::FALSE {
            let fault = "it was created without the feature robustBufferAccess, which lists that shaders read need";
            return Err(VulkanError::Host(fault.to_owned()));
        }
        self.queue_family = queue_family;
        self.offer.geometry_shaders = enabled.core.geometry_shader == vk::TRUE;
        self.offer.of_stage.clip_distances = enabled.core.shader_clip_distance == vk::TRUE;
        self.features = enabled;
        Ok(())
    }
}
