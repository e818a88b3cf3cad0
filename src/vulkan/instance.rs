//! The loader, the instance, and the validation messages it collects.

#![allow(unsafe_code, reason = "calls into the Vulkan loader")]

use std::ffi::CStr;
use std::sync::PoisonError;

use ash::{ext, vk};

use super::error::{Called, VulkanError};
use super::loader_lock;
use super::messages::{self, Messages};

/// How much the validation layer checks. Every message it gives fails a test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Validation {
    /// No layer.
    #[default]
    Off,
    /// Usage of the interface.
    Core,
    /// Usage and synchronization.
    Synchronization,
    /// Usage, and shaders instrumented to check their memory accesses. Slow.
    GpuAssisted,
}

const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The loader and an instance of it. Owned by the device; destroyed after it.
pub(crate) struct Instance {
    pub(crate) raw: ash::Instance,
    pub(crate) debug: bool,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    // The messenger's callback points into this.
    messages: Messages,
    // The loaded library must outlive every function pointer taken from it. None: the instance is a host's, which destroys it.
    entry: Option<ash::Entry>,
}

impl Instance {
    pub(crate) fn new(validation: Validation) -> Result<Instance, VulkanError> {
        let alone = loader_lock::changing();
        // SAFETY: the loader is the system's Vulkan library; its initialisers have no precondition.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| VulkanError::NoLoader(error.to_string()))?;
        // SAFETY: the entry is loaded.
        let version = unsafe { entry.try_enumerate_instance_version() }
            .called("vkEnumerateInstanceVersion")?
            .unwrap_or(vk::API_VERSION_1_0);
        if version < vk::API_VERSION_1_3 {
            return Err(VulkanError::OldLoader(version_text(version)));
        }
        // SAFETY: the entry is loaded; no layer is named.
        let available =
            unsafe { entry.enumerate_instance_extension_properties(None) }.map_err(|result| match result {
                // What some loaders answer when no driver's manifest can be read.
                vk::Result::ERROR_INCOMPATIBLE_DRIVER | vk::Result::ERROR_OUT_OF_HOST_MEMORY => VulkanError::NoDevice,
                result => VulkanError::Call {
                    call: "vkEnumerateInstanceExtensionProperties".to_owned(),
                    result: result.to_string(),
                },
            })?;
        let has = |wanted: &CStr| available.iter().any(|extension| extension.extension_name_as_c_str() == Ok(wanted));
        let layers = if validation == Validation::Off { vec![] } else { vec![validation_layer(&entry)?.as_ptr()] };
        // Drivers and the validation layer both offer debug labels; without them frames lack names, nothing else.
        let debug = has(ext::debug_utils::NAME) || validation != Validation::Off;
        let mut extensions = Vec::new();
        if debug {
            extensions.push(ext::debug_utils::NAME.as_ptr());
        }
        let application = vk::ApplicationInfo::default()
            .application_name(c"irradia")
            .engine_name(c"irradia")
            .api_version(vk::API_VERSION_1_3);
        let enabled = match validation {
            Validation::Synchronization => vec![vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION],
            Validation::GpuAssisted => {
                vec![
                    vk::ValidationFeatureEnableEXT::GPU_ASSISTED,
                    vk::ValidationFeatureEnableEXT::GPU_ASSISTED_RESERVE_BINDING_SLOT,
                ]
            }
            Validation::Off | Validation::Core => vec![],
        };
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_extension_names(&extensions)
            .enabled_layer_names(&layers);
        // Declared before the instance: the layer calls back until that is destroyed.
        let messages = Messages::default();
        let mut messenger = messages::messenger(&messages);
        if validation != Validation::Off {
            info = info.push_next(&mut features).push_next(&mut messenger);
        }
        // SAFETY: everything `info` points to lives until the end of this function.
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
            vk::Result::ERROR_INCOMPATIBLE_DRIVER => VulkanError::NoDevice,
            result => VulkanError::Call { call: "vkCreateInstance".to_owned(), result: result.to_string() },
        })?;
        // Dropped before the instance may be, which takes it again.
        drop(alone);
        let mut instance = Instance { raw, debug, messenger: None, messages, entry: Some(entry) };
        if validation != Validation::Off {
            instance.collect_messages()?;
        }
        Ok(instance)
    }

    /// A host's.
    #[cfg(feature = "capi")]
    pub(super) fn of_host(raw: ash::Instance, debug: bool) -> Instance {
        Instance { raw, debug, messenger: None, messages: Messages::default(), entry: None }
    }

    fn collect_messages(&mut self) -> Result<(), VulkanError> {
        let Some(entry) = &self.entry else { return Ok(()) };
        let functions = ext::debug_utils::Instance::new(entry, &self.raw);
        let info = messages::messenger(&self.messages);
        // SAFETY: the user data is owned by `self` and outlives the messenger, which `drop` destroys first.
        let messenger =
            unsafe { functions.create_debug_utils_messenger(&info, None) }.called("vkCreateDebugUtilsMessengerEXT")?;
        self.messenger = Some((functions, messenger));
        Ok(())
    }

    /// The messages so far.
    pub(crate) fn messages(&self) -> Vec<String> {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub(crate) fn physical_devices(&self) -> Result<Vec<vk::PhysicalDevice>, VulkanError> {
        let _alone = loader_lock::changing();
        // SAFETY: the instance is alive.
        unsafe { self.raw.enumerate_physical_devices() }.called("vkEnumeratePhysicalDevices")
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        if self.entry.is_none() {
            return;
        }
        let _alone = loader_lock::changing();
        // SAFETY: the device, the only other user, is destroyed before its instance (field order in `Device`).
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

fn validation_layer(entry: &ash::Entry) -> Result<&'static CStr, VulkanError> {
    // SAFETY: the entry is loaded.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.called("vkEnumerateInstanceLayerProperties")?;
    let found = layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(LAYER));
    if found { Ok(LAYER) } else { Err(VulkanError::NoValidationLayer) }
}

/// `1.3.230` from Vulkan's packed form.
pub(crate) fn version_text(version: u32) -> String {
    format!("{}.{}.{}", vk::api_version_major(version), vk::api_version_minor(version), vk::api_version_patch(version))
}
