//! The logical device: chosen, created, and shared by everything made on it.

#![allow(unsafe_code, reason = "creation and destruction of the device")]

use std::collections::BTreeMap;
use std::ffi::CStr;
use std::mem::ManuallyDrop;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};

use super::crash_markers::{CrashMarkers, Marking, extension};
use super::error::{Called, VulkanError};
use super::features::Features;
use super::instance::{Instance, Validation};
use super::limits::Offer;
use super::loader_lock;
use super::program::BindingKind;
use super::report::{self, DeviceReport, Survey};
use super::traits::DeviceTraits;

/// Which device, and how closely it is watched.
#[derive(Clone, Debug, Default)]
pub struct ContextOptions {
    /// A part of the device's name, or its index; `None`: the first discrete GPU, else integrated, else CPU.
    pub device: Option<String>,
    /// What the validation layer checks.
    pub validation: Validation,
    /// Whether passes leave marks on the device.
    pub crash_markers: CrashMarkers,
}

/// Called around each submission to a host's queue: `true` before, `false` after.
pub(crate) type TakeTurns = Box<dyn Fn(bool) + Send + Sync>;

/// A logical device with one queue for everything. Shared by `Arc` with all that is made on it, and so destroyed last.
pub(crate) struct Device {
    pub(crate) raw: ash::Device,
    physical: vk::PhysicalDevice,
    queue: Mutex<vk::Queue>,
    /// A host's turns at its queue.
    turns: Option<TakeTurns>,
    pub(crate) survey: Survey,
    pub(crate) labels: Option<ext::debug_utils::Device>,
    pub(super) marking: Marking,
    /// Memory as file descriptors, of a device that was made here and has them.
    #[cfg(feature = "capi")]
    pub(super) sharing: Option<khr::external_memory_fd::Device>,
    allocator: ManuallyDrop<Mutex<Allocator>>,
    live: Mutex<BTreeMap<u64, (String, u64)>>,
    next_id: AtomicU64,
    /// Made here, and so destroyed here.
    owned: bool,
    // Destroyed after the device.
    instance: Instance,
}

impl Device {
    pub(crate) fn new(options: &ContextOptions) -> Result<Arc<Device>, VulkanError> {
        Device::with_traits(options, |known| known)
    }

    /// With traits made of those that the driver is known for.
    pub(crate) fn with_traits(
        options: &ContextOptions,
        traits: impl FnOnce(DeviceTraits) -> DeviceTraits,
    ) -> Result<Arc<Device>, VulkanError> {
        let instance = Instance::new(options.validation)?;
        let (physical, mut survey) = choose(&instance, options.device.as_deref())?;
        survey.traits = traits(survey.traits);
        let priorities = [1.0];
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(survey.queue_family)
            .queue_priorities(&priorities)];
        let mut features = Features::wanted(&survey.features, survey.traits.texels_in_storage, options.validation);
        let mut features = features.chain();
        let available = extensions_of(&instance, physical)?;
        let available: Vec<&CStr> = available.iter().filter_map(|name| name.extension_name_as_c_str().ok()).collect();
        let marker = extension(options.crash_markers, &available);
        let sharing = sharing(&available);
        let enabled: Vec<_> = marker.iter().chain(&sharing).map(|name| name.as_ptr()).collect();
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&enabled)
            .push_next(&mut features);
        // The functions of the device are looked up too.
        let alone = loader_lock::changing();
        // SAFETY: the physical device belongs to the instance; the features were found present by the survey.
        let raw = unsafe { instance.raw.create_device(physical, &info, None) }.called("vkCreateDevice")?;
        // SAFETY: the family and its queue 0 were asked for above.
        let queue = unsafe { raw.get_device_queue(survey.queue_family, 0) };
        let marking = Marking::new(options.crash_markers, marker, &instance.raw, &raw);
        let labels = instance.debug.then(|| ext::debug_utils::Device::new(&instance.raw, &raw));
        #[cfg(feature = "capi")]
        let sharing = sharing.map(|_| khr::external_memory_fd::Device::new(&instance.raw, &raw));
        drop(alone);
        let allocator = match allocator_on(&instance, &raw, physical) {
            Ok(allocator) => ManuallyDrop::new(Mutex::new(allocator)),
            Err(error) => {
                let _alone = loader_lock::changing();
                // SAFETY: nothing else was made on the device.
                unsafe { raw.destroy_device(None) };
                return Err(error);
            }
        };
        let device = Device {
            raw,
            physical,
            queue: Mutex::new(queue),
            turns: None,
            survey,
            labels,
            marking,
            #[cfg(feature = "capi")]
            sharing,
            allocator,
            live: Mutex::default(),
            next_id: AtomicU64::new(1),
            owned: true,
            instance,
        };
        Ok(Arc::new(device))
    }

    /// A host's, of its parts.
    #[cfg(feature = "capi")]
    pub(super) fn of_parts(
        (instance, physical, survey): (Instance, vk::PhysicalDevice, Survey),
        (raw, queue): (ash::Device, vk::Queue),
        (labels, turns): (Option<ext::debug_utils::Device>, Option<TakeTurns>),
    ) -> Result<Arc<Device>, VulkanError> {
        let allocator = allocator_on(&instance, &raw, physical)?;
        Ok(Arc::new(Device {
            marking: Marking::new(CrashMarkers::default(), None, &instance.raw, &raw),
            labels,
            raw,
            physical,
            queue: Mutex::new(queue),
            turns,
            survey,
            sharing: None,
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            live: Mutex::default(),
            next_id: AtomicU64::new(1),
            owned: false,
            instance,
        }))
    }

    #[cfg(feature = "capi")]
    pub(super) fn is_of_host(&self) -> bool {
        !self.owned
    }

    #[cfg(feature = "capi")]
    pub(super) fn format_features(&self, format: vk::Format) -> vk::FormatFeatureFlags {
        // SAFETY: the physical device belongs to the instance, which is alive.
        unsafe { self.instance.raw.get_physical_device_format_properties(self.physical, format) }
            .optimal_tiling_features
    }

    /// Whether memory of such buffers can be exported so.
    #[cfg(feature = "capi")]
    pub(super) fn exports_buffers(
        &self,
        usage: vk::BufferUsageFlags,
        handle: vk::ExternalMemoryHandleTypeFlags,
    ) -> bool {
        let info = vk::PhysicalDeviceExternalBufferInfo::default().usage(usage).handle_type(handle);
        let mut found = vk::ExternalBufferProperties::default();
        // SAFETY: the physical device belongs to the instance, which is alive.
        unsafe {
            self.instance.raw.get_physical_device_external_buffer_properties(self.physical, &info, &mut found);
        }
        let features = found.external_memory_properties.external_memory_features;
        features.contains(vk::ExternalMemoryFeatureFlags::EXPORTABLE)
    }

    /// The best type of memory among `types`, a bit each: the device's own, or else the first.
    #[cfg(feature = "capi")]
    pub(super) fn memory_type(&self, types: u32) -> u32 {
        // SAFETY: the physical device belongs to the instance, which is alive.
        let memory = unsafe { self.instance.raw.get_physical_device_memory_properties(self.physical) };
        let usable = |index: &u32| types >> index & 1 == 1;
        let own = |index: &u32| {
            let flags = memory.memory_types[*index as usize].property_flags;
            usable(index) && flags.contains(vk::MemoryPropertyFlags::DEVICE_LOCAL)
        };
        (0..memory.memory_type_count).find(own).or_else(|| (0..32).find(usable)).unwrap_or_default()
    }

    /// Fills a struct that extends the properties of the physical device.
    #[cfg(feature = "capi")]
    pub(super) fn properties_into(&self, properties: &mut impl vk::ExtendsPhysicalDeviceProperties2) {
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(properties);
        // SAFETY: the physical device belongs to the instance, which is alive.
        unsafe { self.instance.raw.get_physical_device_properties2(self.physical, &mut all) };
    }

    /// Calls `submit` while nobody else submits, the host included.
    pub(super) fn submit<R>(&self, submit: impl FnOnce(vk::Queue) -> R) -> R {
        let queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(turns) = &self.turns {
            turns(true);
        }
        let done = submit(*queue);
        if let Some(turns) = &self.turns {
            turns(false);
        }
        done
    }

    pub(crate) fn report(&self) -> &DeviceReport {
        &self.survey.report
    }

    /// Whether the device has images of this kind at all.
    pub(crate) fn has_images(
        &self,
        format: vk::Format,
        kind: vk::ImageType,
        usage: vk::ImageUsageFlags,
        flags: vk::ImageCreateFlags,
    ) -> Result<bool, VulkanError> {
        let tiling = vk::ImageTiling::OPTIMAL;
        // SAFETY: the physical device belongs to the instance, which is alive.
        let found = unsafe {
            let raw = &self.instance.raw;
            raw.get_physical_device_image_format_properties(self.physical, format, kind, tiling, usage, flags)
        };
        match found {
            Err(vk::Result::ERROR_FORMAT_NOT_SUPPORTED) => Ok(false),
            found => found.called("vkGetPhysicalDeviceImageFormatProperties").map(|_| true),
        }
    }

    pub(crate) fn offer(&self) -> &Offer {
        &self.survey.offer
    }

    pub(crate) fn traits(&self) -> DeviceTraits {
        self.survey.traits
    }

    /// Before a draw, or a blit, which drivers draw.
    pub(crate) fn check_draws(&self) -> Result<(), VulkanError> {
        if self.traits().draws {
            return Ok(());
        }
        let reason = "its driver draws nothing with vectors of this width (LP_NATIVE_VECTOR_WIDTH)".to_owned();
        Err(VulkanError::Unfit { device: self.report().name.clone(), reason })
    }

    /// What a binding of this kind is to the device.
    pub(crate) fn descriptor_type(&self, kind: BindingKind) -> vk::DescriptorType {
        match kind {
            BindingKind::TexelBuffer if self.traits().texels_in_storage => vk::DescriptorType::STORAGE_BUFFER,
            kind => kind.descriptor_type(),
        }
    }

    pub(crate) fn limits(&self) -> &vk::PhysicalDeviceLimits {
        &self.survey.properties.limits
    }

    pub(crate) fn messages(&self) -> Vec<String> {
        self.instance.messages()
    }

    pub(crate) fn allocator(&self) -> MutexGuard<'_, Allocator> {
        self.allocator.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes that an allocation lives; its number names it to [`Device::forget`].
    pub(crate) fn register(&self, name: &str, bytes: u64) -> u64 {
        let id = self.next_id.fetch_add(1, Ordering::Relaxed);
        self.live.lock().unwrap_or_else(PoisonError::into_inner).insert(id, (name.to_owned(), bytes));
        id
    }

    pub(crate) fn forget(&self, id: u64) {
        self.live.lock().unwrap_or_else(PoisonError::into_inner).remove(&id);
    }

    /// Names and bytes of all allocations that live, in the order of their making.
    pub(crate) fn live_allocations(&self) -> Vec<(String, u64)> {
        self.live.lock().unwrap_or_else(PoisonError::into_inner).values().cloned().collect()
    }

    /// Gives an object the name that tools and messages show.
    pub(crate) fn set_name(&self, object: impl vk::Handle, name: &str) {
        let (Some(labels), Ok(name)) = (&self.labels, std::ffi::CString::new(name)) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(object).object_name(&name);
        let _shared = loader_lock::walking();
        // SAFETY: the object was made on this device and is alive in the caller's hands. A refused name loses nothing.
        let _ = unsafe { labels.set_debug_utils_object_name(&info) };
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        for (name, bytes) in self.live_allocations() {
            tracing::error!("leak: {name} ({bytes} bytes) outlives its device");
        }
        if self.owned {
            // SAFETY: nobody submits any more. Of a host's device the work of this one was waited for, frame by frame.
            let _ = unsafe { self.raw.device_wait_idle() };
        }
        // SAFETY: every object made on the device holds it by `Arc`, so none is left; the allocator goes first, since
        // it frees its memory blocks through the device.
        unsafe { ManuallyDrop::drop(&mut self.allocator) };
        if self.owned {
            let _alone = loader_lock::changing();
            // SAFETY: as above.
            unsafe { self.raw.destroy_device(None) };
        }
    }
}

fn allocator_on(
    instance: &Instance,
    raw: &ash::Device,
    physical_device: vk::PhysicalDevice,
) -> Result<Allocator, VulkanError> {
    let description = AllocatorCreateDesc {
        instance: instance.raw.clone(),
        device: raw.clone(),
        physical_device,
        // Leaks are named by our own register, which also knows who is alive before shutdown.
        debug_settings: {
            let mut settings = gpu_allocator::AllocatorDebugSettings::default();
            settings.log_leaks_on_shutdown = false;
            settings
        },
        buffer_device_address: false,
        allocation_sizes: gpu_allocator::AllocationSizes::default(),
    };
    Allocator::new(&description).map_err(|error| {
        tracing::error!("gpu-allocator: {error}");
        VulkanError::OutOfMemory { what: "the allocator".to_owned(), mib: 0.0, last_pass: "none".to_owned() }
    })
}

/// The extension that exports memory, for hosts alone.
fn sharing<'a>(available: &[&'a CStr]) -> Option<&'a CStr> {
    let wanted = cfg!(feature = "capi").then_some(khr::external_memory_fd::NAME)?;
    available.iter().copied().find(|name| *name == wanted)
}

fn extensions_of(
    instance: &Instance,
    physical: vk::PhysicalDevice,
) -> Result<Vec<vk::ExtensionProperties>, VulkanError> {
    // SAFETY: the physical device belongs to the instance.
    let found = unsafe { instance.raw.enumerate_device_extension_properties(physical) };
    found.called("vkEnumerateDeviceExtensionProperties")
}

fn choose(instance: &Instance, asked: Option<&str>) -> Result<(vk::PhysicalDevice, Survey), VulkanError> {
    let surveys = report::survey(instance)?;
    if surveys.is_empty() {
        return Err(VulkanError::NoDevice);
    }
    let names = surveys
        .iter()
        .map(|(_, survey)| format!("{} {}", survey.report.index, survey.report.name))
        .collect::<Vec<_>>()
        .join(", ");
    let unfit = |survey: &Survey| match &survey.report.unfit {
        Some(reason) => Err(VulkanError::Unfit { device: survey.report.name.clone(), reason: reason.clone() }),
        None => Ok(()),
    };
    let Some(asked) = asked else {
        let first_reason = unfit(&surveys[0].1);
        return match surveys.into_iter().find(|(_, survey)| survey.report.default) {
            Some(chosen) => Ok(chosen),
            None => Err(first_reason.err().unwrap_or(VulkanError::NoDevice)),
        };
    };
    let wanted = asked.to_lowercase();
    let matches = |survey: &Survey| survey.report.name.to_lowercase().contains(&wanted);
    let position = match asked.parse::<usize>() {
        Ok(index) if index < surveys.len() => Some(index),
        _ => surveys.iter().position(|(_, survey)| matches(survey)),
    };
    match position.and_then(|position| surveys.into_iter().nth(position)) {
        Some((device, survey)) => unfit(&survey).map(|()| (device, survey)),
        None => Err(VulkanError::NoSuchDevice { asked: asked.to_owned(), known: names }),
    }
}
