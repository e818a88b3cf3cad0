//! The host's own device: what it must be created with, and how it is handed over.

use std::ffi::c_void;

use super::border::{Guarded, call, create, handles, take};
use super::descriptor::{Descriptor, boolean, descriptors, read, write, zero};
use super::status::{Fault, Status};
use crate::method::Error;
use crate::renderer::Context;
use crate::vulkan::{AnyFunction, HostDevice, HostInstance, Requirements, TakeTurns};

/// A function of no known type: vkGetInstanceProcAddr, cast.
pub type VoidFunction = Option<unsafe extern "C" fn()>;

/// Called before and after every submission to the host's queue. From any thread, by one at a time; it must not call the library.
pub type QueueFunction = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// A host's instance and one of its physical devices.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct InstanceDescriptor {
    /// sizeof(irradia_instance_descriptor).
    pub size: usize,
    /// vkGetInstanceProcAddr, cast. Everything else is looked up by it: the library opens no loader.
    pub get_instance_proc_addr: VoidFunction,
    /// VkInstance.
    pub instance: *mut c_void,
    /// VkPhysicalDevice.
    pub physical_device: *mut c_void,
    /// The apiVersion that the instance was created for, at least VK_API_VERSION_1_3.
    pub api_version: u32,
    /// Zero.
    pub reserved: u32,
}

/// A host's device. It and all that it stands on must outlive the context and what was made on it. Nothing of it is destroyed.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct DeviceDescriptor {
    /// sizeof(irradia_device_descriptor).
    pub size: usize,
    /// Its instance and physical device.
    pub instance: *const InstanceDescriptor,
    /// VkDevice.
    pub device: *mut c_void,
    /// VkQueue, for graphics and compute.
    pub queue: *mut c_void,
    /// The queue's family.
    pub queue_family: u32,
    /// 1: VK_EXT_debug_utils is enabled on the instance; passes and objects then have names in the host's tools.
    pub debug_utils: u32,
    /// The VkPhysicalDeviceFeatures2 of what was enabled, with the structs behind it, as it stood behind VkDeviceCreateInfo; it may be the one of
    /// irradia_requirements_get(). Not needed any more once the call returns.
    pub features: *const c_void,
    /// Called before each submission to the queue; null: nobody else uses the queue while a call of the library is in progress, another context on it included.
    pub lock_queue: QueueFunction,
    /// Called after it.
    pub unlock_queue: QueueFunction,
    /// Given to both.
    pub queue_user: *mut c_void,
}

/// What a device must be created with. It stands as long as the irradia_requirements that it came from.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct RequirementsDescriptor {
    /// sizeof(irradia_requirements_descriptor).
    pub size: usize,
    /// A VkPhysicalDeviceFeatures2 and the structs behind it, for VkDeviceCreateInfo::pNext: what is required, and of the rest what is used where it is there.
    /// A host with features of its own sets theirs beside these instead.
    pub features: *const c_void,
    /// Extensions that must be enabled: none.
    pub extensions: *const *const std::ffi::c_char,
    /// How many.
    pub extension_count: usize,
    /// A family with graphics, compute and timestamps; another one with these serves too.
    pub queue_family: u32,
    /// The least apiVersion of instance and device.
    pub api_version: u32,
}

descriptors! {
    InstanceDescriptor = "instance descriptor", size_of::<InstanceDescriptor>();
    DeviceDescriptor = "device descriptor", size_of::<DeviceDescriptor>();
    RequirementsDescriptor = "requirements descriptor", size_of::<RequirementsDescriptor>();
}

/// What a device must be created with, for irradia to use it.
pub struct RequirementsHandle {
    guarded: Guarded<Requirements>,
}

handles! {
    RequirementsHandle(Requirements) = "requirements";
}

/// # Safety
/// `descriptor` is null, which is a fault, or a descriptor.
unsafe fn host_instance(descriptor: *const InstanceDescriptor) -> Result<HostInstance, Fault> {
    // SAFETY: the caller's.
    let given = unsafe { read(descriptor) }?;
    zero(given.reserved, InstanceDescriptor::NAME)?;
    let missing = |what: &str| Fault::argument(format!("the instance descriptor has no {what}"));
    let get_instance_proc_addr: AnyFunction =
        given.get_instance_proc_addr.ok_or_else(|| missing("vkGetInstanceProcAddr"))?;
    if given.instance.is_null() || given.physical_device.is_null() {
        return Err(missing("instance or no physical device"));
    }
    Ok(HostInstance {
        get_instance_proc_addr,
        api_version: given.api_version,
        instance: given.instance.addr() as u64,
        physical_device: given.physical_device.addr() as u64,
    })
}

/// Says what a device must be created with, before it is.
///
/// `requirements`: receives them; irradia_requirements_destroy() ends them.
///
/// Errors: IRRADIA_ERROR_DEVICE if the physical device cannot be used at all; the sentence says what it lacks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_requirements_create(
    instance: *const InstanceDescriptor,
    requirements: *mut *mut RequirementsHandle,
) -> Status {
    let make = || {
        // SAFETY: the host's pointers and handles are what the header asks for.
        let found = unsafe { host_instance(instance)?.requirements() }.map_err(Error::from)?;
        Ok(RequirementsHandle { guarded: Guarded::new(found) })
    };
    // SAFETY: as above.
    unsafe { create(requirements, |_| make()) }
}

/// Fills a descriptor, whose size is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_requirements_get(
    requirements: *const RequirementsHandle,
    descriptor: *mut RequirementsDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let found = unsafe { border.enter(requirements) }?;
        let filled = RequirementsDescriptor {
            size: size_of::<RequirementsDescriptor>(),
            features: found.features.head(),
            extensions: std::ptr::null(),
            extension_count: 0,
            queue_family: found.queue_family,
            api_version: ash::vk::API_VERSION_1_3,
        };
        // SAFETY: as above.
        unsafe { write(descriptor, &filled) }
    })
}

/// Ends requirements. Null is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_requirements_destroy(requirements: *mut RequirementsHandle) {
    // SAFETY: the host gives back what it was given.
    unsafe { take(requirements) };
}

struct Turns {
    lock: QueueFunction,
    unlock: QueueFunction,
    user: *mut c_void,
}

// SAFETY: the header says that they are called from any thread.
unsafe impl Send for Turns {}
// SAFETY: as above.
unsafe impl Sync for Turns {}

impl Turns {
    fn take(&self, begins: bool) {
        if let Some(function) = if begins { self.lock } else { self.unlock } {
            // SAFETY: the host's function with the host's pointer.
            unsafe { function(self.user) };
        }
    }
}

/// A context on the host's device.
///
/// # Safety
/// `descriptor` is a descriptor, and its handles are what they are said to be.
pub(super) unsafe fn context_on(descriptor: *const DeviceDescriptor) -> Result<Context, Fault> {
    // SAFETY: the caller's.
    let given = unsafe { read(descriptor) }?;
    // SAFETY: the caller's.
    let instance = unsafe { host_instance(given.instance) }?;
    if given.device.is_null() || given.queue.is_null() {
        return Err(Fault::argument("the device descriptor has no device or no queue"));
    }
    if given.lock_queue.is_some() != given.unlock_queue.is_some() {
        return Err(Fault::argument("the device descriptor has one of lock_queue and unlock_queue, not both"));
    }
    let turns = Turns { lock: given.lock_queue, unlock: given.unlock_queue, user: given.queue_user };
    let host = HostDevice {
        instance,
        device: given.device.addr() as u64,
        queue: given.queue.addr() as u64,
        queue_family: given.queue_family,
        debug_utils: boolean(given.debug_utils, "debug_utils")?,
        features: given.features,
        take_turns: given.lock_queue.is_some().then(|| Box::new(move |begins| turns.take(begins)) as TakeTurns),
    };
    // SAFETY: the caller's.
    let device = unsafe { crate::vulkan::Device::of_host(host) }.map_err(Error::from)?;
    Ok(Context::on(device))
}
